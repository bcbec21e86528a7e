//! Reading a text in order to post it for another machine.

use std::ops::Range;

use styluscam_motion::{EventKind, Program};
use thiserror::Error;

use crate::machine::Machine;
use crate::read_error::ReadError;
use crate::reader::{read, Reading};

/// Why a text cannot be posted for another machine.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RepostError {
    /// The machine that it was written for does not read it.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The other machine's text would lose something, or add it.
    #[error("line {line}: {what}")]
    Lost {
        /// The line, from 1.
        line: u32,
        /// What it holds.
        what: &'static str,
    },
}

impl RepostError {
    /// What to do where something would be lost.
    pub const HINT: &'static str = "post it by the machine that it is for";
}

/// The program of a `text` that was written for `machine`, to be posted for `target`.
///
/// # Errors
/// [`RepostError`] for what cannot be read, and for what the other machine's text would lose.
pub fn read_to_post(text: &str, machine: &Machine, target: &Machine) -> Result<Program, RepostError> {
    let reading = read(text, machine, &[])?;
    if let Some((line, what)) = loss(&reading, target) {
        return Err(RepostError::Lost { line, what });
    }
    let mut program = reading.program;
    program.forget_old_header();
    program.name_tools();
    Ok(program)
}

fn loss(reading: &Reading, target: &Machine) -> Option<(u32, &'static str)> {
    let program = &reading.program;
    if let Some(line) = reading.bare_line.filter(|_| target.tool.length.is_some()) {
        return Some((line, "a move without the tool's length offset, which the other machine's text would have"));
    }
    let changes = |before: usize| {
        program.events.iter().any(|e| e.before == before && matches!(e.kind, EventKind::ToolChange { .. }))
    };
    // a tool change is posted with the retract of the other machine: away first and then across
    let inside = |first: usize| first > 0 && first < program.moves.len() && !changes(first);
    if let Some(step) = reading.machine_moves.iter().find(|step| inside(step.before)) {
        return Some((step.line, "a move in the machine's own coordinates means nothing on another machine"));
    }
    let lost = |run: &&Range<usize>| inside(run.start);
    if let Some(run) = reading.unknown_heights.iter().chain(&reading.unknown_positions).find(lost) {
        let line = program.moves.get(run.start).map_or(0, |step| step.line);
        return Some((line, "a move while the position of an axis is not known, as after a probe"));
    }
    let line = *reading.optional_lines.first()?;
    Some((line, "a line that runs or not by a switch of the machine cannot be posted"))
}
