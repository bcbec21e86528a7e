//! Tools that lean: what they enter on their way, and what they leave of the ruled surfaces that they mill with their side.
//!
//! All else that is checked of moves is checked of upright tools; here are the moves that begin or end with a tool that leans. Between
//! two positions the tip goes straight and the axis turns with it: a reader gives moves so short that this holds.

mod collision;
mod found;
mod moves;
mod report;
mod surface;
mod swept;
mod turning;

use std::borrow::Cow;

use styluscam_motion::{Cancelled, Program, Watch};

use crate::assignment::Assignment;
use crate::segments::Segment;
use crate::subject::{Limits, Subject};

pub(crate) use found::Judged;
pub(crate) use moves::{leaning_moves, LeaningMove};
pub use report::{AxisTurning, FlankFaceError, OperationFlank};

/// Checks the moves of leaning tools.
///
/// # Errors
/// `Cancelled`.
pub(crate) fn judged(
    program: &Program,
    assignment: &Assignment,
    subject: &Subject,
    limits: &Limits,
    watch: &Watch,
) -> Result<Judged, Cancelled> {
    let moves = leaning_moves(program, assignment, subject);
    if moves.is_empty() && !subject.expected.iter().any(|operation| operation.expectation.flank().is_some()) {
        return Ok(Judged::default());
    }
    let mut judged = Judged::default();
    collision::judge(&moves, subject, limits, watch, &mut judged)?;
    for (number, operation) in subject.expected.iter().enumerate() {
        let Some(passes) = operation.expectation.flank() else { continue };
        let Some(tool) = subject.tools.get(operation.tool) else { continue };
        let of_operation: Vec<&LeaningMove> = moves.iter().filter(|step| step.expected == Some(number)).collect();
        let errors = swept::judge(&of_operation, passes, (tool, height(subject)), watch, &mut judged)?;
        let turning = turning::judge(&of_operation, &mut judged);
        judged.flanks.push(OperationFlank { operation: operation.id.clone(), faces: errors, turning });
    }
    Ok(judged)
}

/// How high up a tool the part may reach, mm.
fn height(subject: &Subject) -> f64 {
    let (low, high) = subject.mesh.bounds();
    (high - low).norm()
}

/// The moves of leaning tools among those of upright ones, for what is checked of all alike: feeds, spindle, coolant.
pub(crate) fn with_leaning<'a>(segments: &'a [Segment], leaning: &[LeaningMove]) -> Cow<'a, [Segment]> {
    if leaning.is_empty() {
        return Cow::Borrowed(segments);
    }
    let mut all: Vec<Segment> = segments.iter().copied().chain(leaning.iter().map(LeaningMove::segment)).collect();
    all.sort_by_key(|segment| segment.index);
    Cow::Owned(all)
}
