//! What a part is, before anything is planned: an open surface or a closed body, a sheet of one thickness or a solid,
//! how it stands in each of six directions, how high its border lies, how hollow and how narrow it is.
//!
//! All of it is measured by rays and nearest points from some thousand points spread evenly over the surface: quick, the
//! same for the same triangles, and reported as shares of the area. It chooses and warns; nothing is cut by it.

pub(crate) mod adjacency;
mod formable;
mod heights;
mod hollows;
mod rays;
mod sampled;
mod samples;
mod shell;
mod sides;
mod steepness;
mod thickness;

#[cfg(test)]
mod tests;

pub use formable::Unformable;
pub use heights::{Border, Heights};
pub use hollows::{FaceLook, Hollows};
pub(crate) use rays::Rays;
pub use sampled::Body;
pub(crate) use samples::in_triangle;
pub use shell::Shell;
pub use sides::{Side, SIDES};
pub use thickness::Thickness;
