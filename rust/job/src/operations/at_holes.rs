//! What operations at round holes share: which faces are none, where material begins over them.

use super::{Context, PassContext};
use crate::holes::{leaning_hole, Hole};
use crate::JobError;

/// Holes lean from this angle on, rad.
const LEANS: f64 = 1e-3;

/// Refuses named faces that are no wall of one of the upright holes found among them; `path` is the operation's.
///
/// # Errors
/// "leaning-hole", "no-hole".
pub(super) fn check_walls(given: &PassContext<'_>, found: &[Hole], path: &str) -> Result<(), JobError> {
    let refused =
        |code, message: String, hint: &str| Err(JobError::document(code, format!("{path}.faces"), message, hint));
    let Some(face) = given.faces.iter().find(|face| !found.iter().any(|hole| hole.faces.contains(face))) else {
        return Ok(());
    };
    if let Some(angle) = leaning_hole(given.scene, *face).filter(|angle| *angle > LEANS) {
        let message = format!("Face{face} is a hole whose axis leans by {:.2} degrees", angle.to_degrees());
        return refused("leaning-hole", message, "turn the part with setup.up, so that the hole is upright");
    }
    let message = format!("Face{face} is no wall of a round upright hole that is open above");
    refused("no-hole", message, "name walls of holes only; see `styluscam part show`")
}

/// That none of the faces of the operation at `path` is the wall of a hole.
pub(super) fn no_hole(path: &str) -> JobError {
    let message = "none of the faces is the wall of a round upright hole that is open above";
    JobError::document("no-hole", format!("{path}.faces"), message, "select walls of holes; see `styluscam part show`")
}

/// Refuses jobs of sheets.
///
/// # Errors
/// "conflict".
pub(super) fn check_solid(context: &Context<'_>) -> Result<(), JobError> {
    if context.scene.sheet.is_none() {
        return Ok(());
    }
    let message = "holes are drilled into solids, and this job forms a sheet";
    Err(JobError::document("conflict", context.path.clone(), message, "remove setup.sheet"))
}

/// Where material may begin over a hole, mm: its wall, or the stock that the job states.
pub(super) fn begins(hole: &Hole, given: &PassContext<'_>) -> f64 {
    let is_stated = given.scene.stock_words.is_some();
    hole.top.max(if is_stated { given.top } else { hole.top })
}

/// How far the tool goes on below through holes where that is not stated, mm.
pub(super) fn breakthrough() -> f64 {
    0.5
}

/// How far above a hole's top rapids end where that is not stated, mm.
pub(super) fn retract_height() -> f64 {
    1.0
}
