//! Freeform curves and surfaces of a model: B-splines, and the feet of points on any surface that can be evaluated.

mod curve;
mod feet;
mod nurbs;

pub use curve::{CurvePoint, NurbsCurve};
pub use feet::{Foot, FootSearch, Pole};
pub use nurbs::NurbsSurface;

use crate::Vector;

/// A point of a surface and its derivatives, mm and mm per unit of each parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Where.
    pub point: Vector,
    /// Derivatives along u and along v.
    pub along: [Vector; 2],
}
