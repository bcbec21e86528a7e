//! Flank milling of ruled surfaces: where a cylinder or a cone stands along a strip between two rails.
//!
//! The flank touches both rails in every position. That leaves the line of its axis one freedom beside its way along the
//! strip: how far apart the two contacts lie along the rails. It is chosen so that the surface that the moving tool leaves is as
//! near to the strip as can be. Derivation and comparison with other methods: docs/concepts/flank.md.

mod course;
mod cutter;
mod error;
mod fit;
mod heights;
mod method;
mod movement;
mod pass;
mod spacing;
mod stand;
mod strip;
mod swept;
mod touch;

pub use cutter::Flank;
pub use error::FlankError;
pub use method::Method;
pub use pass::{flank_pass, FlankPose, FlankWays};
pub use spacing::{positions, positions_within};
pub use stand::Stand;
pub use strip::{RuledStrip, Side};

#[cfg(test)]
mod tests;
