//! Machines, and the text that is posted for them.

use std::fs::File;
use std::path::Path;

use pyo3::prelude::*;
use styluscam_job::JobError;
use styluscam_motion::EventKind;
use styluscam_post::{Outcome, PostError, Trial};

use crate::{errors, program::Program};

/// A controller; see `styluscam.Machine`.
#[pyclass(frozen, module = "styluscam._engine")]
pub struct Machine {
    pub(crate) machine: styluscam_post::Machine,
}

/// Name, outcome ("passed", "without", "failed"), what is said about it, code, place, the posted line, what to do, the text.
type Tried = (String, &'static str, String, &'static str, String, String, String, String);

fn of_job<E: Into<JobError>>(error: E) -> PyErr {
    errors::of_job(&error.into())
}

#[pymethods]
impl Machine {
    /// A shipped machine.
    #[staticmethod]
    fn shipped(name: &str) -> PyResult<Self> {
        let machine = styluscam_post::Machine::shipped(name).map_err(of_job)?;
        Ok(Self { machine })
    }

    /// From the text of a machine file; files that it extends are looked for in `folder`.
    #[staticmethod]
    #[pyo3(signature = (text, folder=None))]
    fn from_toml(text: &str, folder: Option<&str>) -> PyResult<Self> {
        let file = |name: &str| std::fs::read_to_string(Path::new(folder?).join(name)).ok();
        let machine = styluscam_post::Machine::from_toml_beside(text, &file).map_err(of_job)?;
        Ok(Self { machine })
    }

    /// From what a machine file holds, as a JSON object without nulls; files that it extends are looked for in `folder`.
    #[staticmethod]
    fn from_json(text: &str, folder: &str) -> PyResult<Self> {
        let file = |name: &str| std::fs::read_to_string(Path::new(folder).join(name)).ok();
        let values = &mut serde_json::Deserializer::from_str(text);
        let machine = styluscam_post::Machine::from_values(values, &file).map_err(of_job)?;
        Ok(Self { machine })
    }

    /// The whole of it as a machine file that extends nothing.
    fn to_toml(&self) -> PyResult<String> {
        self.machine.to_toml().map_err(of_job)
    }

    /// The same machine with values for the options that it declares, as a JSON object.
    fn with_options(&self, options: &str) -> PyResult<Self> {
        let options: std::collections::BTreeMap<String, styluscam_post::OptionValue> = serde_json::from_str(options)
            .map_err(|e| errors::raise("MachineError", &e.to_string(), "document", "machine.options", ""))?;
        let mut machine = self.machine.clone();
        // decimals are those of the unit that is posted
        let (units, others): (Vec<_>, Vec<_>) = options.into_iter().partition(|(name, _)| name == "units");
        for (name, value) in units.into_iter().chain(others) {
            machine.set_option(&name, value).map_err(of_job)?;
        }
        Ok(Self { machine })
    }

    #[getter]
    fn name(&self) -> &str {
        &self.machine.name
    }

    #[getter]
    fn description(&self) -> &str {
        &self.machine.description
    }

    /// One unit of the last posted place, mm.
    #[getter]
    fn resolution_mm(&self) -> f64 {
        self.machine.resolution_mm()
    }

    /// Everything in it as JSON.
    fn to_json(&self) -> PyResult<String> {
        serde_json::to_string(&self.machine)
            .map_err(|e| errors::raise("StylusError", &e.to_string(), "internal", "", ""))
    }

    /// Posts a torture program, reads it back and compares; one entry for everything that was tried.
    fn check(&self, py: Python<'_>) -> PyResult<Vec<Tried>> {
        let trials = py.detach(|| styluscam_post::check(&self.machine)).map_err(of_job)?;
        Ok(trials.into_iter().map(tried).collect())
    }
}

fn tried(trial: Trial) -> Tried {
    let Trial { name, outcome, text } = trial;
    let none = String::new;
    match outcome {
        Outcome::Passed => {
            let said = format!("{} lines", text.lines().count());
            (name, "passed", said, "", none(), none(), none(), text)
        }
        Outcome::Without { reason } => (name, "without", reason, "", none(), none(), none(), text),
        Outcome::Failed(error) => {
            let (message, line, hint) = (error.to_string(), error.line().to_owned(), error.hint());
            (name, "failed", message, error.code(), error.place(), line, hint, text)
        }
    }
}

/// Names of the shipped machines.
#[pyfunction]
pub fn shipped_machines() -> Vec<&'static str> {
    styluscam_post::shipped()
}

/// Names with what they are: those of every template, and those of one only, its key first.
type Vocabulary = (Vec<(&'static str, &'static str)>, Vec<(&'static str, &'static str, &'static str)>);

/// What templates may use.
#[pyfunction]
pub fn template_names() -> Vocabulary {
    let all = styluscam_post::NAMES.into_iter().chain(styluscam_post::FUNCTIONS);
    (all.collect(), styluscam_post::OWN_NAMES.to_vec())
}

/// Options that every machine has, and what they take.
#[pyfunction]
pub fn machine_options() -> Vec<(&'static str, &'static str)> {
    styluscam_post::BUILT_IN_OPTIONS.to_vec()
}

/// The JSON Schema of machine files.
#[pyfunction]
pub fn machine_schema() -> PyResult<String> {
    serde_json::to_string(&styluscam_post::Machine::schema())
        .map_err(|e| errors::raise("StylusError", &e.to_string(), "internal", "", ""))
}

/// The text of a program for a machine.
#[pyfunction]
pub fn post(py: Python<'_>, program: &Program, machine: &Machine) -> PyResult<String> {
    let posted = py.detach(|| styluscam_post::post(&program.program, &machine.machine));
    Ok(posted.map_err(of_job)?.text)
}

/// Writes the text of a program for a machine to a new file, piece by piece.
#[pyfunction]
pub fn post_to(py: Python<'_>, program: &Program, machine: &Machine, path: &str) -> PyResult<()> {
    py.detach(|| {
        let failure = |e: std::io::Error| PostError::Output { message: format!("{path}: {e}") };
        let mut file = File::create(path).map_err(failure)?;
        styluscam_post::post_to(&program.program, &machine.machine, &mut file)?;
        file.sync_all().map_err(failure)
    })
    .map_err(of_job)
}

/// The cutter location text (APT) of a program.
#[pyfunction]
pub fn cl_text(py: Python<'_>, program: &Program) -> PyResult<String> {
    py.detach(|| styluscam_post::cl_text(&program.program)).map_err(of_job)
}

/// For every move the line of the posted text, from 1, with which the machine arrives at its end.
#[pyfunction]
pub fn lines_of_moves(py: Python<'_>, program: &Program, machine: &Machine) -> PyResult<Vec<u32>> {
    let posted = py.detach(|| styluscam_post::post(&program.program, &machine.machine));
    Ok(posted.map_err(of_job)?.line_of_move)
}

/// A section of FreeCAD's path commands: label, an operation's kind or None, "Flood", "Mist" or "None", what toGCode() gives.
type PathSection = (String, Option<String>, String, String);

/// A program of FreeCAD's path commands, the set-up and the tools as JSON.
#[pyfunction]
pub fn program_of_path(py: Python<'_>, sections: Vec<PathSection>, tools: &str, setup: &str) -> PyResult<Program> {
    let document = |e: serde_json::Error| errors::raise("JobError", &e.to_string(), "document", "", "");
    let tools: Vec<styluscam_motion::ToolRecord> = serde_json::from_str(tools).map_err(document)?;
    let setup: styluscam_motion::SetupRecord = serde_json::from_str(setup).map_err(document)?;
    let sections: Vec<_> = sections.into_iter().map(path_section).collect();
    let program = py.detach(|| styluscam_post::read_path(&sections, &tools, setup));
    let program = program.map_err(|e| {
        let (message, hint) = (e.to_string(), e.error.hint());
        errors::raise("JobError", &message, e.error.code(), &e.label, &hint)
    })?;
    Ok(Program { program })
}

fn path_section((label, kind, coolant, text): PathSection) -> styluscam_post::PathSection {
    let coolant = match coolant.as_str() {
        "Flood" => Some(EventKind::Flood { on: true }),
        "Mist" => Some(EventKind::Mist { on: true }),
        _ => None,
    };
    styluscam_post::PathSection { label, kind, text, coolant }
}

/// The same for posting it again: a text of which something would be lost is refused.
#[pyfunction]
pub fn read_to_post(py: Python<'_>, text: &str, machine: &Machine, target: &Machine) -> PyResult<Program> {
    let reading = py.detach(|| styluscam_post::read(text, &machine.machine, &[])).map_err(of_job)?;
    let refuse = |line: u32, what: &str| {
        let message = format!("line {line}: {what}");
        errors::raise(
            "VerifyError",
            &message,
            "post-lost",
            &format!("line {line}"),
            "post it by the machine that it is for",
        )
    };
    let mut program = reading.program;
    program.forget_old_header();
    let takes_lengths = target.machine.tool.length.is_some();
    if let Some(line) = reading.bare_line.filter(|_| takes_lengths) {
        return Err(refuse(line, "a move without the tool's length offset, which the other machine's text would have"));
    }
    let changes = |before: usize| {
        program.events.iter().any(|e| e.before == before && matches!(e.kind, EventKind::ToolChange { .. }))
    };
    let count = program.moves.len();
    if let Some(step) = reading.machine_moves.iter().find(|m| m.before > 0 && m.before < count && !changes(m.before)) {
        return Err(refuse(step.line, "a move in the machine's own coordinates means nothing on another machine"));
    }
    // after a tool change the post goes away first and then across
    let lost = |run: &&std::ops::Range<usize>| run.start > 0 && run.start < count && !changes(run.start);
    if let Some(run) = reading.unknown_heights.iter().chain(&reading.unknown_positions).find(lost) {
        let line = program.moves.get(run.start).map_or(0, |step| step.line);
        return Err(refuse(line, "a move while the position of an axis is not known, as after a probe"));
    }
    if let Some(line) = reading.optional_lines.first() {
        return Err(refuse(*line, "a line that runs or not by a switch of the machine cannot be posted"));
    }
    program.name_tools();
    Ok(Program { program })
}

/// The program that a machine would read from a text; positions are those of the words.
#[pyfunction]
pub fn read_gcode(py: Python<'_>, text: &str, machine: &Machine) -> PyResult<Program> {
    let reading = py.detach(|| styluscam_post::read(text, &machine.machine, &[]));
    Ok(Program { program: reading.map_err(of_job)?.program })
}
