//! The intermediate stages of a text: each operation of a stage is checked against the shape of its stage, as a program of its own.

use styluscam_motion::{Event, Move, Program, Watch};
use styluscam_verify::{Limits, Pairing, Report, Subject};

use super::{excess, limits, Against, Reading};
use crate::{JobDocument, JobError, Scene};
use styluscam_post::Machine;

/// Adds to the report of a whole text what its intermediate stages are found to do to their own shapes.
///
/// # Errors
/// Tools that do not build, `Cancelled`.
pub(super) fn judged(
    job: &JobDocument,
    scene: &Scene,
    machine: &Machine,
    reading: &Reading,
    mut whole: Report,
    watch: &Watch,
) -> Result<Report, JobError> {
    for (stage, angle) in scene.stages.iter().zip(&job.part.stages) {
        let against = Against::new(job, stage)?;
        let ids: Vec<&str> = against.expected.iter().map(|operation| operation.id.as_str()).collect();
        let (program, unknown) =
            own(&reading.program, &ids, |index| reading.unknown_positions.iter().any(|run| run.contains(&index)));
        if program.moves.is_empty() {
            continue; // the operation is missing, which the whole text's report states
        }
        let of_job = limits(job, stage, &against, machine);
        let excess_by_operation = excess(job, stage, &program);
        let limits = Limits { excess_by_operation, shape_only: true, ..of_job };
        let subject = Subject { pairing: Pairing::Alone, ..against.subject(&unknown) };
        let report = styluscam_verify::judge(&program, &subject, &limits, watch)?;
        whole = whole.with_stage(report, &format!("stage of {angle} degrees"));
    }
    Ok(whole)
}

/// The moves of some operations, by their ids, with all events; and those of them whose positions are not known.
fn own(program: &Program, ids: &[&str], is_unknown: impl Fn(usize) -> bool) -> (Program, Vec<std::ops::Range<usize>>) {
    let mut operations = Vec::new();
    let numbers: Vec<Option<u32>> = program
        .operations
        .iter()
        .map(|operation| {
            ids.contains(&operation.id.as_str()).then(|| {
                operations.push(operation.clone());
                operations.len() as u32 - 1
            })
        })
        .collect();
    let number = |step: &Move| numbers.get(step.operation as usize).copied().flatten();
    let mut before = Vec::with_capacity(program.moves.len() + 1);
    let (mut moves, mut unknown) = (Vec::new(), Vec::new());
    for (index, step) in program.moves.iter().enumerate() {
        before.push(moves.len());
        let Some(operation) = number(step) else { continue };
        if is_unknown(index) {
            unknown.push(moves.len()..moves.len() + 1);
        }
        moves.push(Move { operation, ..step.clone() });
    }
    before.push(moves.len());
    let event = |event: &Event| {
        let at = before.get(event.before).copied().unwrap_or(moves.len());
        Event { before: at, kind: event.kind.clone() }
    };
    let events = program.events.iter().map(event).collect();
    let own = Program { operations, events, moves: moves.clone(), cycles: Vec::new(), ..program.clone() };
    (own, unknown)
}
