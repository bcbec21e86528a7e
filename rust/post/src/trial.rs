//! A trial of a machine file: a small program goes out and must come back as it was.

use styluscam_motion::{
    Event, EventKind, Move, MoveKind, OperationRecord, Program, SetupRecord, SpindleDirection, ToolRecord,
    ToolReference,
};
use thiserror::Error;

use crate::machine::Machine;
use crate::post_error::PostError;
use crate::read_error::ReadError;
use crate::reader::{read, Reading};
use crate::writer::{post, Posted};

/// A machine file whose own text does not read back.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TrialError {
    /// The small program could not be posted. Correct the machine file at the place that the error names.
    #[error(transparent)]
    Post(#[from] PostError),
    /// The text cannot be read by the machine's own rules: a template writes what `[reader]` or `[line]` refuses. Make them agree.
    #[error("the posted text cannot be read back: {error}")]
    Read {
        /// What is wrong with it.
        error: Box<ReadError>,
        /// The text.
        text: String,
    },
    /// The text reads as another program: a template moves an axis, changes a tool, leaves out a word. Correct the template.
    #[error("the posted text reads back as another program: {what}")]
    Differs {
        /// What differs.
        what: String,
        /// The text.
        text: String,
    },
}

impl TrialError {
    /// A stable name for scripts.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Self::Post(error) => error.code(),
            Self::Read { .. } => "machine-trial-read",
            Self::Differs { .. } => "machine-trial-differs",
        }
    }

    /// Where: a key of the machine file, or a line of the text.
    #[must_use]
    pub fn place(&self) -> String {
        match self {
            Self::Post(error) => error.place(),
            Self::Read { error, .. } => error.place(),
            Self::Differs { .. } => "templates".into(),
        }
    }

    /// What to do, in a sentence.
    #[must_use]
    pub fn hint(&self) -> String {
        match self {
            Self::Post(error) => error.hint(),
            Self::Read { error, .. } => format!("make the templates and [reader] agree; {}", error.hint()),
            Self::Differs { .. } => {
                "templates must not move an axis, nor leave out or add a tool change or a unit".into()
            }
        }
    }
}

/// Posts a small program for `machine` with every event that it has words for, reads the text back and compares.
///
/// # Errors
/// [`TrialError`]: the machine file contradicts itself.
pub fn try_out(machine: &Machine) -> Result<Posted, TrialError> {
    machine.check().map_err(PostError::from)?;
    let program = small_program(machine);
    let posted = post(&program, machine)?;
    match read(&posted.text, machine, &program.tools) {
        Err(error) => Err(TrialError::Read { error: error.into(), text: posted.text }),
        Ok(reading) => match difference(&program, &posted, &reading, machine) {
            Some(what) => Err(TrialError::Differs { what, text: posted.text }),
            None => Ok(posted),
        },
    }
}

/// What was posted and does not come back, in words.
fn difference(program: &Program, posted: &Posted, reading: &Reading, machine: &Machine) -> Option<String> {
    let (sent, came) = (words_of(program), words_of(&reading.program));
    if sent != came {
        return Some(format!("events {sent:?} became {came:?}"));
    }
    if reading.program.setup.wcs != program.setup.wcs {
        return Some(format!("work offset {} became {}", program.setup.wcs, reading.program.setup.wcs));
    }
    let lines = program.moves.iter().zip(&posted.line_of_move);
    lines.filter_map(|(step, line)| move_difference(step, *line, reading, machine)).next()
}

fn words_of(program: &Program) -> Vec<&EventKind> {
    let said =
        |kind: &&EventKind| !matches!(kind, EventKind::Comment { .. } | EventKind::Stop { .. } | EventKind::Raw { .. });
    program.events.iter().map(|e| &e.kind).filter(said).collect()
}

fn move_difference(step: &Move, line: u32, reading: &Reading, machine: &Machine) -> Option<String> {
    let came = reading.program.moves.iter().rfind(|m| m.line == line);
    let Some(came) = came else { return Some(format!("the move of line {line} is not there")) };
    let slack = machine.resolution_mm() / 2.0 + 1e-9;
    let near = step.end.iter().zip(came.end).all(|(a, b)| (a - b).abs() <= slack);
    let same = near && step.kind == came.kind;
    (!same).then(|| format!("line {line} goes to {:?} instead of {:?} mm", came.end, step.end))
}

fn small_program(machine: &Machine) -> Program {
    let setup = SetupRecord {
        title: "trial".into(),
        wcs: machine.wcs.first().cloned().unwrap_or_default(),
        zero: "anywhere".into(),
        part_min: [0.0; 3],
        part_max: [1.0; 3],
        clearance: 1.0,
        notes: vec!["äöü (°) and so on".into()],
    };
    let tool = ToolRecord {
        name: "stylus".into(),
        number: 1,
        length_offset: 1,
        description: "ball D2".into(),
        reference: ToolReference::Center,
        reference_height: 1.0,
        diameter: 2.0,
    };
    let operations = vec![OperationRecord { id: "trial".into(), kind: "z-level".into(), tool: 0 }];
    Program { moves: moves(machine), events: events(machine), ..Program::empty(setup, vec![tool], operations) }
}

/// Across, down, along at feed, up: inside the machine's range.
fn moves(machine: &Machine) -> Vec<Move> {
    let limits = &machine.limits;
    let [(x, dx), (y, dy), (z, dz)] = [limits.x, limits.y, limits.z].map(middle);
    let shrink =
        |size: f64, axis: usize| limits.travel.and_then(|t| t.get(axis).copied()).map_or(size, |t| size.min(t / 4.0));
    let (dx, dy, dz) = (shrink(dx, 0), shrink(dy, 1), shrink(dz, 2));
    let z = z - 1.0; // the tip below its centre
    let feed = limits.max_feed.map_or(100.0, |f| f.min(100.0));
    let step = |kind, end, feed| Move { kind, end, arc: None, feed, operation: 0, line: 0 };
    vec![
        step(MoveKind::Rapid, [x, y, z + dz], 0.0),
        step(MoveKind::Rapid, [x + dx, y, z], 0.0),
        step(MoveKind::Feed, [x + dx, y, z - dz], feed),
        step(MoveKind::Feed, [x - dx, y + dy, z - dz], feed),
        step(MoveKind::Rapid, [x - dx, y + dy, z + dz], 0.0),
    ]
}

/// The middle of an axis's range and a size that fits around it, mm.
fn middle(range: Option<[f64; 2]>) -> (f64, f64) {
    range.map_or((0.0, 10.0), |[low, high]| (f64::midpoint(low, high), ((high - low) / 4.0).min(10.0)))
}

fn events(machine: &Machine) -> Vec<Event> {
    let at = |before, kind| Event { before, kind };
    let rpm = machine.limits.max_rpm.map_or(1000.0, |m| m.min(1000.0)).floor();
    let on = |direction| at(1, EventKind::SpindleOn { rpm, direction });
    let mut events = vec![at(0, EventKind::ToolChange { tool: 0 })];
    events.extend(machine.spindle.clockwise.as_ref().map(|_| on(SpindleDirection::Clockwise)));
    events.extend(machine.spindle.counterclockwise.as_ref().map(|_| on(SpindleDirection::Counterclockwise)));
    events.extend(machine.coolant.flood.as_ref().map(|_| at(1, EventKind::Flood { on: true })));
    events.extend(machine.dwell.as_ref().map(|_| at(2, EventKind::Dwell { seconds: 2.0 })));
    events.push(at(3, EventKind::Comment { text: "half way; [almost]".into() }));
    events.extend(machine.coolant.off.as_ref().map(|_| at(5, EventKind::Flood { on: false })));
    events.extend(machine.spindle.off.as_ref().map(|_| at(5, EventKind::SpindleOff)));
    events
}
