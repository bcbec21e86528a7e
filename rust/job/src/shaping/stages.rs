//! Intermediate stages of a part whose walls are steeper than its sheet withstands in one pass.
//!
//! Derivation: docs/concepts/stages.md.

use std::sync::Arc;

use styluscam_geometry::{stage, Mesh};
use styluscam_verify::Support;

use super::section::Stages;
use crate::faces;
use crate::numbers::shown;
use crate::operations::Fact;
use crate::part::Undone;
use crate::{materials, JobDocument, JobError, Part, Shaped};

const KEY: &str = "part.stages";
/// Stages at most: each is a whole program.
const MOST: usize = 20;
/// The gentlest and the steepest stage, degrees.
const ANGLES: [f64; 2] = [5.0, 89.0];
/// The first of stages that are spread is so much gentler than what the sheet withstands, degrees: its triangles may be steeper
/// than it by a little.
const RESERVE: f64 = 1.0;
/// Triangles that are steeper count as a wall of the part when they have more area than this, mm^2, and this share of all.
const AREA: (f64, f64) = (1.0, 1e-3);

/// Checks what the schema cannot state of the stages.
///
/// # Errors
/// Angles that do not rise, a process that has no stages.
pub fn check(job: &JobDocument) -> Result<(), JobError> {
    let Some(stages) = &job.part.stages else { return Ok(()) };
    let process = &job.process.process;
    let kind = process.as_kind();
    if !kind.forms() || kind.support() != Support::Rim || kind.channels().len() > 1 {
        let message = format!("process.kind = {:?} has no intermediate stages as it is", process.name());
        let hint =
            "remove part.stages; stages are for sheets that hang free, with one tool: kind = \"spif\", or a female die";
        return Err(JobError::document("conflict", KEY, message, hint));
    }
    let angles = match stages {
        Stages::Angles(angles) => angles,
        Stages::Count(count) if (1.0..=MOST as f64).contains(count) && count.fract() == 0.0 => return Ok(()),
        Stages::Count(count) => {
            let message = format!("{} stages: expected a whole number from 1 to {MOST}", shown(*count));
            let hint = "state how many, or list their wall angles: [50.0, 65.0]";
            return Err(JobError::document("out-of-range", KEY, message, hint));
        }
    };
    let [low, high] = ANGLES;
    if let Some(index) = (0..angles.len()).find(|index| !(low..=high).contains(&angles[*index])) {
        let message = format!("a stage of {} degrees: stages have walls of {low} to {high}", shown(angles[index]));
        return Err(JobError::document(
            "out-of-range",
            format!("{KEY}[{index}]"),
            message,
            "choose another wall angle",
        ));
    }
    if let Some(index) = (1..angles.len()).find(|index| angles[*index] <= angles[index - 1]) {
        let message = format!("a stage of {} degrees follows one of {}", angles[index], angles[index - 1]);
        let hint = "list the stages' wall angles from the gentlest to the steepest; the part itself comes after them";
        return Err(JobError::document("order", format!("{KEY}[{index}]"), message, hint));
    }
    if angles.is_empty() {
        let hint = "list wall angles, state how many stages, or remove the key";
        return Err(JobError::document("empty", KEY, "the list has no stage", hint));
    }
    if angles.len() > MOST {
        let message = format!("{} stages: at most {MOST} are planned", angles.len());
        return Err(JobError::document("out-of-range", KEY, message, "take larger steps"));
    }
    Ok(())
}

/// The wall angles of the job's stages of a part, degrees.
///
/// # Errors
/// A number of stages for a part that takes none.
pub fn angles(job: &JobDocument, part: &Part) -> Result<Vec<f64>, JobError> {
    match &job.part.stages {
        None => Ok(Vec::new()),
        Some(Stages::Angles(angles)) => Ok(angles.clone()),
        Some(Stages::Count(count)) => spread(job, part, *count),
    }
}

/// Angles from what the sheet withstands in one pass, by its wall angle and by the sine law, with even steps to the part's
/// steepest wall, to hundredths of a degree.
fn spread(job: &JobDocument, part: &Part, count: f64) -> Result<Vec<f64>, JobError> {
    let Some(sheet) = job.setup.sheet else { return Ok(Vec::new()) };
    let wall = materials::wall_angle(job, &sheet);
    let of_sine = sheet.min_thickness.map_or(90.0, |least| libm::acos(least / sheet.thickness).to_degrees());
    let limit = wall.most_deg.min(wall.sure_deg).min(of_sine);
    let placed = part.mesh.placed(&job.setup.turn());
    let steepest = steepest(&placed, &upper(job, part, &placed)).to_degrees();
    let first = (limit - RESERVE).clamp(ANGLES[0], ANGLES[1]);
    if steepest <= limit {
        let message = format!(
            "the part's steepest wall is {steepest:.1} degrees, and the sheet withstands {limit:.1} in one pass: there is nothing to \
             divide into stages"
        );
        let hint = "remove part.stages, or list the wall angles that you want: [40.0, 50.0]";
        return Err(JobError::document("not-needed", KEY, message, hint));
    }
    let hundredths = |degrees: f64| (100.0 * degrees).round() / 100.0;
    let step = (steepest - first) / count;
    Ok((0..count as u32).map(|i| hundredths(first + f64::from(i) * step).min(ANGLES[1])).collect())
}

/// The steepest slope that more than slivers of some triangles have, rad.
fn steepest(mesh: &Mesh, keep: &[bool]) -> f64 {
    let mut walls: Vec<(f64, f64)> = (0..keep.len())
        .filter(|triangle| keep[*triangle])
        .map(|triangle| (libm::acos(mesh.normal(triangle).z.clamp(0.0, 1.0)), mesh.area(triangle)))
        .collect();
    let enough = AREA.0.min(AREA.1 * walls.iter().map(|(_, area)| area).sum::<f64>());
    walls.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut area = 0.0;
    let found = walls.into_iter().find(|wall| {
        area += wall.1;
        area >= enough
    });
    found.map_or(0.0, |wall| wall.0)
}

/// Which triangles of a part that lies as it is formed are its upper side.
fn upper(job: &JobDocument, part: &Part, placed: &Mesh) -> Vec<bool> {
    let rims = faces::rims(&part.target().placed(&job.setup.turn()));
    (0..rims.len()).map(|triangle| !rims[triangle] && !placed.looks_down(triangle)).collect()
}

/// A stage of a part, as it is formed, for a wall angle in degrees.
pub fn staged(job: &JobDocument, part: &Part, angle_deg: f64) -> Result<Part, JobError> {
    let frame = job.setup.turn();
    let placed = part.mesh.placed(&frame);
    let keep = upper(job, part, &placed);
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
    Ok(Part {
        mesh: stage.mesh.placed(&back),
        inward: part.inward,
        outward: part.outward,
        shaped: Some(shaped),
        curves: Arc::default(),
    })
}
