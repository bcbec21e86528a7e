//! Machines.

use std::path::Path;

use pyo3::prelude::*;
use styluscam_post::{MachineError, Outcome, Trial};

use crate::{
    errors::{of_job, raise},
    json::json,
};

/// A controller; see `styluscam.Machine`.
#[pyclass(frozen, module = "styluscam._engine")]
pub struct Machine {
    pub(crate) machine: styluscam_post::Machine,
}

/// A machine's error where a section names it and sets its options: keys of the section begin with its path.
fn of_section(error: &MachineError, section: &str) -> PyErr {
    if !error.is_of_section() {
        return of_job(error.clone());
    }
    let path = within(section, &error.location());
    raise("MachineError", &format!("{path}: {error}"), error.code(), &path, &error.hint())
}

/// A key of a section: its path from the document on.
fn within(section: &str, key: &str) -> String {
    if section.is_empty() {
        key.to_owned()
    } else {
        format!("{section}.{key}")
    }
}

/// Name, outcome ("passed", "without", "failed"), what is reported about it, code, position, the posted line, what to do, the text.
type Tried = (String, &'static str, String, &'static str, String, String, String, String);

#[pymethods]
impl Machine {
    /// A shipped machine; `section` is the path of what names it.
    #[staticmethod]
    #[pyo3(signature = (name, section=""))]
    fn shipped(name: &str, section: &str) -> PyResult<Self> {
        let machine = styluscam_post::Machine::shipped(name).map_err(|error| of_section(&error, section))?;
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

    /// The same machine with values for the options that it declares, as a JSON object; `section` is the path of what sets them.
    #[pyo3(signature = (options, section=""))]
    fn with_options(&self, options: &str, section: &str) -> PyResult<Self> {
        let options: std::collections::BTreeMap<String, styluscam_post::OptionValue> = serde_json::from_str(options)
            .map_err(|e| raise("MachineError", &e.to_string(), "document", &within(section, "options"), ""))?;
        let mut machine = self.machine.clone();
        machine.set_options(options).map_err(|error| of_section(&error, section))?;
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

    /// One unit of the last posted decimal, mm.
    #[getter]
    fn resolution_mm(&self) -> f64 {
        self.machine.resolution_mm()
    }

    /// Everything in it as JSON.
    fn to_json(&self) -> PyResult<String> {
        json(&self.machine)
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
            let report = format!("{} lines", text.lines().count());
            (name, "passed", report, "", none(), none(), none(), text)
        }
        Outcome::Without { reason } => (name, "without", reason, "", none(), none(), none(), text),
        Outcome::Failed(error) => {
            let (message, line, hint) = (error.to_string(), error.line().to_owned(), error.hint());
            (name, "failed", message, error.code(), error.location(), line, hint, text)
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
    json(&styluscam_post::Machine::schema())
}
