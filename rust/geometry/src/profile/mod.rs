//! Convex profiles, parametrised by slope.
//!
//! A profile is the curve from the tool's tip (r = 0, z = 0) to its base. The slope is the angle
//! between the surface's outward normal and -Z on the tool, +Z on the part: 0 at the tip, a right
//! angle where the wall is vertical. By slope everything is finite, also where dz/dr is not.
//!
//! A new smooth curve is one file with an `impl Meridian` and an arm in [`Curve`]; a new kind is one file in [`kinds`] that
//! puts curves, kinks and straight parts together.

mod arc;
mod chain;
mod clothoid;
mod conic;
mod curve;
mod cycloid;
mod distance;
mod fitted;
mod formula;
mod involute;
mod kind;
pub mod kinds;
mod meridian;
#[cfg(test)]
mod numbers;
mod outline;
mod parts;
mod points;
mod power;
mod proof;
#[cfg(test)]
pub(crate) mod samples;
mod solve;

pub use chain::{Profile, Straight};
pub use kind::ProfileReport;
pub use kinds::ProfileDocument;
pub use outline::{Curved, OutlinePart};

use arc::Arc;
use chain::Builder;
use clothoid::Clothoid;
use conic::{Ellipse, Parabola};
use curve::Curve;
use cycloid::Cycloid;
use fitted::Fitted;
use involute::Involute;
use meridian::Meridian;
use power::Power;
