//! Shapes: convex profiles, tools, sheets, meshes and their index.
//!
//! Lengths are millimetres, angles radians. Nothing here knows what a path is.

mod cutter;
mod error;
mod frame;
mod mesh;
mod profile;
mod sheet;
mod tool;

pub use cutter::{Cutter, SupportingLine};
pub use error::GeometryError;
pub use frame::Frame;
pub use mesh::{Bvh, Mesh, Node};
pub use profile::{Clothoid, Meridian, Profile, ProfileDocument};
pub use sheet::{ModelFace, Sheet, SheetLaw};
pub use tool::{Tool, ToolDocument};

/// A point or vector of space, mm.
pub type Vector = nalgebra::Vector3<f64>;
