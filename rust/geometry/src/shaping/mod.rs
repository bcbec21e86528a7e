//! Changing the shape of a mesh: by a displacement field, with as many triangles as that needs.
//!
//! Derivation: docs/concepts/springback.md.

mod field;
mod refine;
mod warp;

pub use field::DisplacementField;
pub use warp::{warped, Warped};
