//! What the spindle does in an operation: what the job states, with the speed of rolling contact worked out.
//!
//! A tool that goes along a wall at the feed f and turns at n touches it at the radius r of its profile at the wall's slope. Where
//! it touches, its surface moves by f - 2 pi r n along the wall: it rolls without sliding at n = f / (2 pi r). The wall is on the
//! right of a loop that is run as it is traced, and there a tool that turns clockwise moves backwards.

use std::f64::consts::TAU;

use serde_json::Value;
use styluscam_geometry::Tool;
use styluscam_motion::SpindleDirection;

use crate::resolve::faces_of;
use crate::{Direction, JobDocument, JobError, OperationSection, Scene, Spindle};

/// A radius of contact that is smaller than this is none, mm: any speed that rolls there is beyond every spindle.
const LEAST_RADIUS: f64 = 1e-3;

/// Speed, rev/min, and sense of an operation's spindle; none while it is not driven. `index` is the operation's number in the
/// job.
///
/// # Errors
/// A rolling spindle where the tool touches with its tip only, faces that do not exist.
pub(crate) fn turns(
    job: &JobDocument,
    scene: &Scene,
    tool: &Tool,
    section: &OperationSection,
    index: usize,
) -> Result<Option<(f64, SpindleDirection)>, JobError> {
    match section.common.spindle {
        Spindle::Off | Spindle::Free => Ok(None),
        Spindle::Fixed { rpm, direction } => Ok(Some((rpm, direction))),
        Spindle::Rolling => {
            let slope = scene.steepest(&scene.facing_up(&faces_of(job, scene, section, index)?));
            let (radius, _) = tool.point_at(slope);
            if radius < LEAST_RADIUS {
                let message = format!(
                    "the spindle cannot roll: on the steepest of the faces, at {:.1} degrees, the tool touches {radius:.3} mm from its axis",
                    slope.to_degrees()
                );
                let hint = "select walls, or set mode = \"free\"";
                return Err(JobError::document("conflict", format!("operations[{index}].spindle.mode"), message, hint));
            }
            Ok(Some((section.kind().cut_feed(&section.common) / (TAU * radius), SpindleDirection::Clockwise)))
        }
    }
}

/// Refuses an operation that cuts, where `written`, the document as its author wrote it, neither states its spindle nor what it follows from:
/// what is left out is a spindle that stands, and a cutter that stands breaks.
///
/// # Errors
/// An operation without a spindle in a job that cuts, and that names no material.
pub(crate) fn stated(job: &JobDocument, written: &Value) -> Result<(), JobError> {
    if job.process.process.as_kind().forms() || job.process.common.material.is_some() {
        return Ok(());
    }
    let is_stated = |index: &usize| {
        written.pointer(&format!("/operations/{index}/spindle")).is_some_and(|spindle| !spindle.is_null())
    };
    let Some(index) = (0..job.operations.len()).find(|index| !is_stated(index)) else { return Ok(()) };
    let message = "the spindle is not stated, and a cutter must turn";
    let hint =
        "add spindle = { mode = \"fixed\", rpm = 8000 }, or process.material, which speeds and feeds follow from; \
                spindle = { mode = \"off\" } where it is switched by hand";
    Err(JobError::document("missing", format!("operations[{index}].spindle"), message, hint))
}

/// Refuses a rolling spindle where the wall is not always on the same side of the path.
///
/// # Errors
/// Rows, and loops that are run in both directions, or in the other one.
pub(crate) fn check(section: &OperationSection, path: &str) -> Result<(), JobError> {
    if section.common.spindle != Spindle::Rolling {
        return Ok(());
    }
    // what cuts upright walls goes along them
    let (key, message, hint) = match (section.kind().cuts_upright_walls(), section.common.direction) {
        (true, Direction::Same | Direction::Climb) => return Ok(()),
        (true, Direction::Alternate | Direction::Conventional) => (
            "direction",
            "the spindle rolls along walls on the right of the path only",
            "set direction = \"same\", or the spindle's mode = \"free\"",
        ),
        (false, _) => (
            "spindle.mode",
            "the spindle rolls along walls, and this operation does not go along them",
            "set mode = \"free\", or form the walls by \"z-level\" or \"spiral\"",
        ),
    };
    Err(JobError::document("conflict", format!("{path}.{key}"), message, hint))
}
