//! Changing the shape of a mesh: by a displacement field, with as many triangles as that needs.
//!
//! Derivation: docs/concepts/springback.md.

mod cone;
mod field;
mod outline;
mod refine;
mod stage;
mod wall;
mod warp;

pub use field::DisplacementField;
pub use stage::{stage, Stage};
pub use wall::{walled, WallEnd, WallFault, WallShape, Walled};
pub use warp::{warped, Warped};
