//! The engagement angle of a round tool along plane paths, exact at every position that is measured.
//!
//! What is measured, in one definition: at a position of the path, a direction of the tool's rim is *engaged* where it lies less than
//! a right angle from the heading and a chip thicker than 1 um is cut there. The engagement angle is the angle of all engaged
//! directions together. Material is what lies in the stock and in the pocket, and that no move has swept before: walls are
//! not material.
//!
//! So a direction ahead is engaged where the rim's point lies in the pocket, in the stock, outside the discs of the tool's radius along
//! the path of the last radius up to one step of 0.02 radii before, and outside the discs 1 um larger along all that came
//! earlier (more, where the text rounds positions). The 1 um is not taken off the chip that the step itself cuts, which thins out towards the sides at any depth: that would
//! take a degree off every angle; but 1e-7 mm is, so that a rim on the edge of a disc cuts nothing. The discs along a straight or circular piece are exactly the points within the
//! radius of the piece: the angles at which the rim enters and leaves them are those of crossings with circles and lines,
//! found in closed form. Nothing is sampled but the positions along the path, a step apart and at its corners.
//!
//! It knows nothing of how a path was planned. Derived in docs/concepts/engagement.md.

mod area;
mod cells;
mod error;
mod open;
mod rim;
mod runs;
mod sweeps;
mod walk;

#[cfg(test)]
mod tests;

use styluscam_motion::Watch;

pub use error::EngagementError;
pub use runs::{Engaged, Ground, PlaneRun, PlaneRunKind, RunEngagement, Swept, CHIP};

pub(crate) use area::Area;
pub(crate) use cells::Cells;
pub(crate) use sweeps::Sweeps;

/// The engagement along every run of a path, in the order in which they are cut.
///
/// # Errors
/// What is not a path, an outline or a radius; `Cancelled` when the watch is cancelled.
pub fn engagement(
    runs: &[PlaneRun],
    ground: &Ground<'_>,
    watch: &Watch,
) -> Result<Vec<RunEngagement>, EngagementError> {
    error::check(runs, ground)?;
    walk::Walk::new(ground).along(runs, watch)
}
