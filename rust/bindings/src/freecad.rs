//! Programs of FreeCAD's path commands.

use pyo3::prelude::*;
use styluscam_motion::EventKind;

use crate::{errors::raise, program::Program};

/// A section of FreeCAD's path commands: label, an operation's kind or None, "Flood", "Mist" or "None", what toGCode() gives.
type PathSection = (String, Option<String>, String, String);

/// A program of FreeCAD's path commands, the set-up and the tools as JSON.
#[pyfunction]
pub fn program_of_path(py: Python<'_>, sections: Vec<PathSection>, tools: &str, setup: &str) -> PyResult<Program> {
    let document = |e: serde_json::Error| raise("JobError", &e.to_string(), "document", "", "");
    let tools: Vec<styluscam_motion::ToolRecord> = serde_json::from_str(tools).map_err(document)?;
    let setup: styluscam_motion::SetupRecord = serde_json::from_str(setup).map_err(document)?;
    let sections: Vec<_> = sections.into_iter().map(path_section).collect::<PyResult<_>>()?;
    let program = py.detach(|| styluscam_post::read_path(&sections, &tools, setup));
    let program = program.map_err(|e| {
        let (message, hint) = (e.to_string(), e.error.hint());
        raise("JobError", &message, e.error.code(), &e.label, &hint)
    })?;
    Ok(Program { program })
}

/// A program's moves as the text of FreeCAD's path commands.
#[pyfunction]
pub fn path_text(py: Python<'_>, program: &Program) -> PyResult<String> {
    py.detach(|| styluscam_post::path_text(&program.program))
        .map_err(|e| raise("JobError", &e.to_string(), e.code(), "", &e.hint()))
}

fn path_section((label, kind, coolant, text): PathSection) -> PyResult<styluscam_post::PathSection> {
    let coolant = match coolant.as_str() {
        "None" => None,
        "Flood" => Some(EventKind::Flood { on: true }),
        "Mist" => Some(EventKind::Mist { on: true }),
        unknown => {
            let message = format!("{label}: coolant {unknown:?} is not known");
            return Err(raise("JobError", &message, "unknown-coolant", &label, "choose None, Flood or Mist"));
        }
    };
    Ok(styluscam_post::PathSection { label, kind, text, coolant })
}
