//! FreeCAD's path commands to motion: whole jobs, of whatever operations.

use styluscam_motion::{Event, EventKind, Program, SetupRecord, ToolRecord};
use thiserror::Error;

use crate::machine::Machine;
use crate::read_error::ReadError;
use crate::reader::{read_sections, Section};

/// A section of commands that cannot be read.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{label}: {error}")]
pub struct PathError {
    /// The section's label.
    pub label: String,
    /// What is wrong, at which command.
    pub error: Box<ReadError>,
}

/// Commands of one object of a job: an operation, a tool controller, a work offset.
#[derive(Clone, Debug, PartialEq)]
pub struct PathSection {
    /// What it is called.
    pub label: String,
    /// The operation's kind; none for what is no operation.
    pub kind: Option<String>,
    /// What `Path.toGCode()` gives: one command a line, mm and mm/s.
    pub text: String,
    /// Whether flood coolant or mist is on around it.
    pub coolant: Option<EventKind>,
}

/// The commands as the internal machine's language.
const LANGUAGE: &str = include_str!("../machines/inside/freecad_path.toml");

/// Reads a job's commands. `setup` is its record; its work offset is the one that the commands begin with, or its own.
///
/// Codes that nobody knows are handed on as they stand, as long as they move no axis. The spindle stops at the end.
///
/// # Errors
/// [`PathError`] for the first command that cannot be read.
pub fn read_path(sections: &[PathSection], tools: &[ToolRecord], setup: SetupRecord) -> Result<Program, PathError> {
    let machine = Machine::from_toml(LANGUAGE).map_err(|error| PathError {
        label: "FreeCAD's path commands".into(),
        error: Box::new(ReadError { line: 0, column: 0, word: String::new(), fault: error.into() }),
    })?;
    let texts: Vec<String> = sections.iter().map(text_of).collect();
    let parts: Vec<Section> = sections
        .iter()
        .zip(&texts)
        .map(|(section, text)| Section {
            operation: section.kind.as_deref().map(|kind| (section.label.as_str(), kind)),
            coolant: section.coolant.as_ref(),
            text,
        })
        .collect();
    let reading = read_sections(&parts, &machine, tools).map_err(|(index, error)| PathError {
        label: sections.get(index).map(|section| section.label.clone()).unwrap_or_default(),
        error: Box::new(error),
    })?;
    let mut program = reading.program;
    let wcs = if reading.not_stated.contains(&"G54") { setup.wcs.clone() } else { program.setup.wcs.clone() };
    program.setup = SetupRecord { wcs, ..setup };
    stop_spindle(&mut program);
    Ok(program)
}

/// A section's commands; a tool controller that starts no spindle leaves it standing.
fn text_of(section: &PathSection) -> String {
    let mut text = with_remarks(&section.text);
    let has =
        |words: &[&str]| text.lines().any(|line| line.split(' ').next().is_some_and(|word| words.contains(&word)));
    if section.kind.is_none() && has(&["M6", "M06"]) && !has(&["M3", "M03", "M4", "M04"]) {
        text.push_str("M5\n");
    }
    text
}

/// Remarks take a whole command: brackets inside are part of them.
fn with_remarks(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.lines() {
        match line.strip_prefix('(') {
            Some(remark) => {
                out.push(';');
                out.push_str(remark.strip_suffix(')').unwrap_or(remark));
            }
            None => out.push_str(line),
        }
        out.push('\n');
    }
    out
}

fn stop_spindle(program: &mut Program) {
    let turns = program.events.iter().rev().find_map(|event| match event.kind {
        EventKind::SpindleOn { .. } => Some(true),
        EventKind::SpindleOff | EventKind::ToolChange { .. } => Some(false),
        _ => None,
    });
    if turns == Some(true) {
        program.events.push(Event { before: program.moves.len(), kind: EventKind::SpindleOff });
    }
}
