//! Shapes: convex profiles, tools, sheets, surfaces of a model and triangles of its faces, meshes and their index.
//!
//! Lengths are millimetres, angles radians. Nothing here knows what a path is.

#![cfg_attr(test, allow(clippy::disallowed_methods))] // what tests expect may come from std

mod chamfer;
mod curvature;
mod cutter;
mod elementary;
mod error;
mod facets;
mod frame;
mod freeform;
mod mesh;
mod piecewise;
mod plane;
mod profile;
mod scallop;
mod shaping;
mod sheet;
mod stock;
mod tool;
mod tool_body;
mod tool_flank;
mod tool_parts;
mod trimmed;

pub use chamfer::{chamfered, check_chamfers, ChamferEdge, ChamferSize};
pub use curvature::{bend, wall_axes, Bend};
pub use cutter::{Cutter, Height, SupportingLine};
pub use elementary::{Axes, ElementaryKind, ElementarySurface, Spacing};
pub use error::GeometryError;
pub use facets::{Creased, Facets};
pub use frame::Frame;
pub use freeform::{CurvePoint, Foot, FootSearch, NurbsCurve, NurbsSurface, Pole, SurfacePoint};
pub use mesh::{Bvh, Filled, Mending, Mesh, Node, Shape, Soup};
pub use plane::{circle_outline, rectangle_outline, PlaneCircle, PlanePiece, PlanePoint};
pub use profile::{kinds, Curved, OutlinePart, Profile, ProfileDocument, ProfileReport, Straight};
pub use shaping::{stage, walled, warped, DisplacementField, Stage, WallEnd, WallFault, WallShape, Walled, Warped};
pub use sheet::{ModelFace, Sheet, SheetLaw};
pub use stock::{Solid, Stock};
pub use tool::{Base, CutterMaterial, Holder, Tool, ToolDocument};
pub use tool_body::ToolBody;
pub use tool_flank::ToolFlank;
pub use tool_parts::ToolPart;
pub use trimmed::{mesh_trimmed, EdgeUse, FaceTriangles, TrimmedFault, GUIDES};

/// A point or vector of space, mm.
pub type Vector = nalgebra::Vector3<f64>;
