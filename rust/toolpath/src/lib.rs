//! From geometry to motion: where the tool may stand, and in which order it goes there.

#![cfg_attr(test, allow(clippy::disallowed_methods))] // what tests expect may come from std

pub mod budget;
mod error;
mod fitting;
pub mod forming;
mod lattice;
mod linking;
mod nearest;
pub mod offset;
mod segment;
mod surface;

pub use error::PlanError;
pub use lattice::{Cells, Lattice};
pub use linking::{join, link, AlongSurface, AtDepth, Heights, LinkRules, Links, OverClearance, Position, Rates, Run};
pub use segment::{Curve, Pace, Segment};
pub use surface::{PathPoint, Surface};

/// A run of the tool along the surface: what a strategy makes and linking joins.
#[derive(Clone, Debug, PartialEq)]
pub struct Pass {
    /// Tip positions in order; the first is repeated at the end when closed.
    pub points: Vec<PathPoint>,
    /// Whether it ends where it begins.
    pub closed: bool,
    /// Number of the level or row, from 0.
    pub group: usize,
}
