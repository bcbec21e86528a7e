//! Intermediate stages of a part whose walls are steeper than its sheet withstands in one pass.
//!
//! Derivation: docs/concepts/stages.md.

use styluscam_geometry::stage;
use styluscam_verify::Support;

use crate::faces;
use crate::operations::Fact;
use crate::part::Undone;
use crate::{JobDocument, JobError, Part, Shaped};

const KEY: &str = "part.stages";
/// Stages at most: each is a whole program.
const MOST: usize = 20;

/// Checks what the schema cannot state of the stages.
///
/// # Errors
/// Angles that do not rise, a process that has no stages.
pub fn check(job: &JobDocument) -> Result<(), JobError> {
    let stages = &job.part.stages;
    if stages.is_empty() {
        return Ok(());
    }
    let process = &job.process.process;
    let kind = process.as_kind();
    if !kind.forms() || kind.support() != Support::Rim || kind.channels().len() > 1 {
        let message = format!("process.kind = {:?} has no intermediate stages as it is", process.name());
        let hint =
            "remove part.stages; stages are for sheets that hang free, with one tool: kind = \"spif\", or a female die";
        return Err(JobError::document("conflict", KEY, message, hint));
    }
    if let Some(index) = (1..stages.len()).find(|index| stages[*index] <= stages[index - 1]) {
        let message = format!("a stage of {} degrees follows one of {}", stages[index], stages[index - 1]);
        let hint = "list the stages' wall angles from the gentlest to the steepest; the part itself comes after them";
        return Err(JobError::document("order", format!("{KEY}[{index}]"), message, hint));
    }
    if stages.len() > MOST {
        let message = format!("{} stages: at most {MOST} are planned", stages.len());
        return Err(JobError::document("out-of-range", KEY, message, "take larger steps"));
    }
    Ok(())
}

/// A stage of a part, as it is formed, for a wall angle in degrees.
pub fn staged(job: &JobDocument, part: &Part, angle_deg: f64) -> Result<Part, JobError> {
    let frame = job.setup.turn();
    let placed = part.mesh.placed(&frame);
    let rims = faces::rims(&part.target().placed(&frame));
    let keep: Vec<bool> = (0..rims.len()).map(|t| !rims[t] && !placed.looks_down(t)).collect();
    let stage = stage(&placed, &keep, angle_deg.to_radians()).map_err(JobError::geometry(KEY))?;
    let words = format!(
        "stage of {angle_deg} degrees: the lowest shape above the part whose walls are no steeper; up to {:.3} mm are left to the \
         next stages",
        stage.above
    );
    let back = frame.inverse();
    let shaped = Shaped {
        target: stage.target.placed(&back),
        facts: vec![Fact { fact: "left_to_stages", value: stage.above, unit: "mm", words }],
        linear: 0.0,
        undone: Undone::Nowhere,
        names: part.names().to_vec(),
        trim: Vec::new(),
    };
    Ok(Part { mesh: stage.mesh.placed(&back), inward: part.inward, outward: part.outward, shaped: Some(shaped) })
}
