//! What the spindle does in an operation: what the job states, with the speed of rolling contact worked out.
//!
//! A tool that goes along a wall at the feed f and turns at n touches it at the radius r of its profile at the wall's slope. Where
//! it touches, its surface moves by f - 2 pi r n along the wall: it rolls without sliding at n = f / (2 pi r). The wall is on the
//! right of a loop that is run as it is traced, and there a tool that turns clockwise moves backwards.

use std::f64::consts::TAU;

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

/// Refuses a spindle that is not driven where tools cut, and a rolling one where the wall is not always on the same side of the path.
///
/// # Errors
/// A free spindle of a cutter; rows, and loops that are run in both directions, or in the other one.
pub(crate) fn check(job: &JobDocument, section: &OperationSection, path: &str) -> Result<(), JobError> {
    if section.common.spindle == Spindle::Free && !job.process.process.as_kind().forms() {
        let message = "a spindle that is not driven is for a stylus, and this process cuts";
        let hint = "set mode = \"fixed\", with rpm";
        return Err(JobError::document("conflict", format!("{path}.spindle.mode"), message, hint));
    }
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
