//! The engagement angle of a round tool along plane paths, exact at every position that is measured.
//!
//! What is measured, in one definition: at a position of the path, a direction of the tool's rim is *engaged* where it lies less than
//! a right angle from the heading and a chip thicker than 1 um is cut there. The engagement angle is the angle of all engaged
//! directions together. Material is what lies in the stock and in the pocket, and that no move has swept before: walls are
//! not material.
//!
//! So a direction ahead is engaged where the rim's point lies in the pocket, in the stock, outside the discs of the tool's radius along
//! the path of the last radius up to one step of 0.02 radii before, and outside the discs 1 um larger along all that came
//! earlier. The 1 um is not taken off the chip that the step itself cuts, which thins out towards the sides at any depth: that would
//! take a degree off every angle. The discs along a straight or circular piece are exactly the points within the
//! radius of the piece: the angles at which the rim enters and leaves them are those of crossings with circles and lines,
//! found in closed form. Nothing is sampled but the positions along the path, a step apart and at its corners.
//!
//! It knows nothing of how a path was planned.

mod area;
mod cells;
mod error;
mod open;
mod rim;
mod walk;

#[cfg(test)]
mod tests;

use styluscam_motion::Watch;

pub use error::EngagementError;

/// Thickness of a chip from which it counts, mm.
const CHIP: f64 = 1e-3;
/// Length of a step, in radii of the tool.
const STEP: f64 = 0.02;
/// Path of which the sweep is taken as it is, in radii of the tool: longer than a step, so that 1 um beside it is no angle.
const RECENT: f64 = 1.0;

/// What a stretch of a plane path is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaneRunKind {
    /// Cutting.
    Cut,
    /// The way into the material: a helix or a ramp, seen from above.
    Entry,
    /// At depth, through what is cleared: it should cut nothing.
    Link,
    /// Over the stock: it neither cuts nor clears.
    Rapid,
}

/// A stretch of a plane path.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneRun {
    /// Points (x, y, bulge of the piece that begins there), mm.
    pub points: Vec<[f64; 3]>,
    /// What it is for.
    pub kind: PlaneRunKind,
}

/// The engagement along one run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunEngagement {
    /// Where it was measured.
    pub measures: Vec<Engaged>,
}

/// The engagement at one position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Engaged {
    /// The tool's centre, mm.
    pub at: [f64; 2],
    /// Length of the run up to there, mm.
    pub travelled: f64,
    /// The engagement angle, rad.
    pub angle: f64,
    /// Distance from the centre to the pocket's nearest wall, mm; infinite beyond two radii.
    pub clearance: f64,
}

/// What a path cuts.
#[derive(Clone, Copy, Debug)]
pub struct Ground<'a> {
    /// The tool's radius, mm.
    pub radius: f64,
    /// Outlines (x, y, bulge) of the material, mm; islands are outlines within outlines.
    pub stock: &'a [Vec<[f64; 3]>],
    /// Outlines of the pocket, mm.
    pub pocket: &'a [Vec<[f64; 3]>],
}

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
