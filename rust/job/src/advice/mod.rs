//! What the faces of an operation ask of a tool: how they slope and curve, and their concave corners.

mod corner;
mod creases;
mod fillets;
mod patch;
#[cfg(test)]
mod tests;
mod walls;

pub use corner::Corner;
pub use styluscam_geometry::Bend;
pub use walls::{walls, Wall, Walls};
