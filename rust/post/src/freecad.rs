//! FreeCAD's path commands to motion: whole jobs, of whatever operations.

use std::collections::BTreeMap;

use styluscam_motion::{Event, EventKind, Program, SetupRecord, ToolRecord, UnitAxis};
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
/// A straight command with I, J, K states the axis of a tool that leans; in others it stands upright.
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
    let texts: Vec<(String, Axes)> = sections.iter().map(text_of).collect();
    let parts: Vec<Section> = sections
        .iter()
        .zip(&texts)
        .map(|(section, (text, axes))| Section {
            operation: section.kind.as_deref().map(|kind| (section.label.as_str(), kind)),
            coolant: section.coolant.as_ref(),
            text,
            axes,
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

/// The axes of tools that lean, by the lines of a section.
type Axes = BTreeMap<u32, UnitAxis>;

/// A section's commands; a tool controller that starts no spindle leaves it standing.
fn text_of(section: &PathSection) -> (String, Axes) {
    let mut axes = Axes::new();
    let mut text = with_remarks(&section.text, &mut axes);
    let has =
        |words: &[&str]| text.lines().any(|line| line.split(' ').next().is_some_and(|word| words.contains(&word)));
    if section.kind.is_none() && has(&["M6", "M06"]) && !has(&["M3", "M03", "M4", "M04"]) {
        text.push_str("M5\n");
    }
    (text, axes)
}

/// The commands without the axes of tools that lean, which come into `axes`. Remarks take a whole command: brackets inside are part
/// of them.
fn with_remarks(text: &str, axes: &mut Axes) -> String {
    let mut out = String::with_capacity(text.len());
    for (line, number) in text.lines().zip(1..) {
        if let Some((line, axis)) = leaning(line) {
            axes.insert(number, axis);
            out.push_str(&line);
            out.push('\n');
            continue;
        }
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

/// How far the length of a unit vector with six decimals may be from 1.
const ROUNDED: f64 = 2e-6;

/// A straight command without the axis that it states, and that axis; none where it states none that is one.
fn leaning(command: &str) -> Option<(String, UnitAxis)> {
    let name = command.split(' ').next().filter(|name| ["G0", "G00", "G1", "G01"].contains(name))?;
    let is_of_axis = |word: &&str| word.starts_with(['I', 'J', 'K']);
    if !command.split(' ').any(|word| is_of_axis(&word)) {
        return None;
    }
    let mut axis = [None; 3];
    for word in command.split(' ').filter(is_of_axis) {
        let (letter, value) = word.split_at(1);
        let at = axis.get_mut(usize::from(letter.bytes().next()?.checked_sub(b'I')?))?;
        *at = Some(value.parse::<f64>().ok()?);
    }
    let [Some(x), Some(y), Some(z)] = axis else { return None };
    let length = libm::sqrt(x * x + y * y + z * z);
    if (length - 1.0).abs() > ROUNDED {
        return None;
    }
    let axis = UnitAxis::new([x / length, y / length, z / length]).ok()?;
    let rest: Vec<&str> = command.split(' ').skip(1).filter(|word| !is_of_axis(word)).collect();
    Some((format!("{name} {}", rest.join(" ")), axis))
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

#[cfg(test)]
mod tests {
    use styluscam_motion::{Move, ToolReference};

    use super::*;
    use crate::path_text::path_text;

    fn read(text: &str) -> Result<Program, PathError> {
        let tool = ToolRecord {
            name: "T1".into(),
            number: 1,
            length_offset: 1,
            description: String::new(),
            reference: ToolReference::Tip,
            reference_height: 0.0,
            diameter: 6.0,
        };
        let section = |kind: Option<&str>, text: &str| PathSection {
            label: "blade".into(),
            kind: kind.map(Into::into),
            text: text.into(),
            coolant: None,
        };
        let sections = [section(None, "M6 T1\nM3 S500\n"), section(Some("flank"), text)];
        read_path(&sections, &[tool], SetupRecord::default())
    }

    #[test]
    fn tools_that_lean_are_read_as_they_were_written() {
        let lean = |x: f64, y: f64| UnitAxis::new([x, y, libm::sqrt(1.0 - x * x - y * y)]).unwrap();
        let mut written = Program::empty(SetupRecord::default(), vec![], vec![]);
        written.moves = vec![
            Move::rapid([1.0, 2.0, 50.0]).with_axis(lean(0.123_456_7, -0.3)),
            Move::feed([1.0, 2.5, -3.0], 600.0).with_axis(lean(0.2, 1.0 / 3.0)),
            Move::feed([1.0, 2.5, -4.0], 600.0),
            Move::rapid([1.0, 2.5, 50.0]).with_axis(lean(-0.1, 0.0)),
        ];
        let found = read(&path_text(&written).unwrap()).unwrap();
        assert_eq!(found.moves.len(), written.moves.len());
        for (ours, theirs) in found.moves.iter().zip(&written.moves) {
            assert_eq!((ours.end.tip, ours.feed, ours.kind), (theirs.end.tip, theirs.feed, theirs.kind));
            let (read, wanted) = (ours.end.axis.vector(), theirs.end.axis.vector());
            assert!((0..3).all(|i| (read[i] - wanted[i]).abs() < 1e-6), "{ours:?} {theirs:?}");
        }
        assert_eq!(found.moves[2].end.axis, UnitAxis::UP);
    }

    #[test]
    fn words_that_are_no_axis_are_refused_with_their_line() {
        for words in ["I1 J0", "I0.5 J0 K1", "I0.6 K0.8", "I0"] {
            let error = read(&format!("G0 X1 Y1 Z5\nG1 X2 Y1 Z5 {words} F5\n")).unwrap_err();
            assert_eq!((error.label.as_str(), error.error.line), ("blade", 2), "{words}: {error}");
        }
    }
}
