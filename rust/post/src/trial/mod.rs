//! A trial of a machine file: programs that hold everything a program may hold go out and must come back as they were.

mod cases;
mod compare;
mod lean;
mod leaning;
mod slack;
mod words;

pub use compare::difference;

use thiserror::Error;

use crate::machine::{Machine, OptionValue};
use crate::post_error::PostError;
use crate::read_error::ReadError;
use crate::reader::read;
use crate::writer::post;
use cases::Case;

/// A machine file whose own text does not read back.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TrialError {
    /// A program could not be posted. Correct the key of the machine file that the error names.
    #[error("{error}")]
    Post {
        /// What is wrong.
        error: Box<PostError>,
    },
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
        /// The line, from 1; 0 when no line is at fault.
        line: u32,
        /// The text.
        text: String,
    },
    /// Something outside the machine's limits was posted. The limits in the file cannot be right.
    #[error("{what} was posted although the machine's file forbids it")]
    Allowed {
        /// What it was.
        what: &'static str,
    },
}

impl TrialError {
    /// A stable name for scripts.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Self::Post { error } => error.code(),
            Self::Read { .. } => "machine-trial-read",
            Self::Differs { .. } => "machine-trial-differs",
            Self::Allowed { .. } => "machine-trial-allowed",
        }
    }

    /// Where: a key of the machine file, or a line of the text.
    #[must_use]
    pub fn location(&self) -> String {
        match self {
            Self::Post { error } => error.location(),
            Self::Read { error, .. } => error.location(),
            Self::Differs { line, .. } if *line > 0 => format!("line {line}"),
            Self::Differs { .. } => "templates".into(),
            Self::Allowed { .. } => "limits".into(),
        }
    }

    /// The posted line at fault; empty where there is none.
    #[must_use]
    pub fn line(&self) -> &str {
        let (text, number) = match self {
            Self::Read { error, text } => (text, error.line),
            Self::Differs { line, text, .. } => (text, *line),
            _ => return "",
        };
        let index = number.checked_sub(1).and_then(|n| usize::try_from(n).ok());
        index.and_then(|index| text.lines().nth(index)).unwrap_or_default()
    }

    /// What to do, in a sentence.
    #[must_use]
    pub fn hint(&self) -> String {
        match self {
            Self::Post { error } => error.hint(),
            Self::Read { error, .. } => format!("make the templates and [reader] agree; {}", error.hint()),
            Self::Differs { .. } => {
                "templates must not move an axis, nor leave out or add a tool change or a unit".into()
            }
            Self::Allowed { .. } => "correct [limits]".into(),
        }
    }
}

/// One thing that was tried.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// What: `arcs in XY`.
    pub name: String,
    /// How it went.
    pub outcome: Outcome,
    /// What was posted; empty where nothing was.
    pub text: String,
}

/// How a trial went.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// The program came back as it was.
    Passed,
    /// The machine states in its file that it does not have this, and refuses it.
    Without {
        /// The refusal's message.
        reason: String,
    },
    /// The program did not come back.
    Failed(TrialError),
}

/// Posts a torture program piece by piece, reads the text back and compares: moves of every kind, values at the edges of
/// rounding, arcs, helices, remarks, tools, spindle, coolant, waits, stops, holes, probing, work offsets, both units, limits.
///
/// # Errors
/// [`PostError`] when the machine file itself is at fault.
pub fn check(machine: &Machine) -> Result<Vec<Trial>, PostError> {
    machine.check()?;
    let trial = |case: Case| {
        let (outcome, text) = tried(&case);
        Trial { name: case.name, outcome, text }
    };
    let mut trials: Vec<Trial> = all(machine).map(trial).collect();
    trials.extend(variants(machine).into_iter().map(|(name, machine)| in_all(name, &machine)));
    Ok(trials)
}

/// All that is tried on a machine.
fn all(machine: &Machine) -> impl Iterator<Item = Case> {
    cases::cases(machine).into_iter().chain(leaning::cases(machine))
}

/// The machine with each of its options set to each other thing that it can be.
fn variants(machine: &Machine) -> Vec<(String, Machine)> {
    let mut settings: Vec<(String, OptionValue)> = Vec::new();
    if machine.smoothing.on.is_some() && machine.smoothing.off.is_some() {
        settings.push(("smoothing_tolerance".into(), OptionValue::Number(0.0)));
    }
    for (name, rule) in &machine.options {
        let others: Vec<OptionValue> = match &rule.value {
            OptionValue::Switch(on) => vec![OptionValue::Switch(!on)],
            OptionValue::Number(_) => [rule.min, rule.max].into_iter().flatten().map(OptionValue::Number).collect(),
            OptionValue::Text(_) => Vec::new(),
        };
        settings.extend(others.into_iter().map(|value| (name.clone(), value)));
    }
    let varied = settings.into_iter().filter_map(|(name, value)| {
        let mut other = machine.clone();
        let shown = format!("option {name} = {value}");
        other.set_option(&name, value).ok().map(|()| (shown, other))
    });
    varied.collect()
}

/// All that is tried, as one trial: the first failure, or the first text.
fn in_all(name: String, machine: &Machine) -> Trial {
    let mut tried = all(machine).map(|case| tried(&case));
    let first = tried.next();
    let failed = first.iter().cloned().chain(tried).find(|(outcome, _)| matches!(outcome, Outcome::Failed(_)));
    let (outcome, text) = failed.or(first).unwrap_or((Outcome::Passed, String::new()));
    Trial { name, outcome, text }
}

/// The first failure of [`check`].
///
/// # Errors
/// [`TrialError`]: the machine file contradicts itself.
pub fn try_out(machine: &Machine) -> Result<(), TrialError> {
    let trials = check(machine).map_err(|error| TrialError::Post { error: error.into() })?;
    let failure = trials.into_iter().find_map(|trial| match trial.outcome {
        Outcome::Failed(error) => Some(error),
        _ => None,
    });
    failure.map_or(Ok(()), Err)
}

/// How a case goes, and what was posted.
fn tried(case: &Case) -> (Outcome, String) {
    let posted = match post(&case.program, &case.machine) {
        Ok(posted) if case.must_fail => {
            return (Outcome::Failed(TrialError::Allowed { what: "a position outside the limits" }), posted.text);
        }
        Ok(posted) => posted,
        Err(error) if case.must_fail || lacks(&error) => {
            return (Outcome::Without { reason: error.to_string() }, String::new());
        }
        Err(error) => return (Outcome::Failed(TrialError::Post { error: error.into() }), String::new()),
    };
    let failure = match read(&posted.text, &case.machine, case.tools()) {
        Ok(reading) => difference(&case.program, &posted, &reading, &case.machine)
            .map(|(line, what)| TrialError::Differs { what, line, text: posted.text.clone() }),
        Err(error) => Some(TrialError::Read { error: error.into(), text: posted.text.clone() }),
    };
    (failure.map_or(Outcome::Passed, Outcome::Failed), posted.text)
}

/// Whether the machine refuses what its file states that it does not have.
fn lacks(error: &PostError) -> bool {
    matches!(
        error,
        PostError::Unsupported { .. }
            | PostError::SpindleDirection { .. }
            | PostError::ToolChange { .. }
            | PostError::NoSuchAxis { .. }
    )
}
