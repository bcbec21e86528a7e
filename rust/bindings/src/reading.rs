//! Programs read from texts.

use std::cell::RefCell;

use pyo3::prelude::*;
use styluscam_post::RepostError;

use crate::{
    errors::{of_job, of_trace, raise},
    job::Job,
    machine::Machine,
    program::Program,
    waiting::{watched, CancelToken},
};

/// The program that a machine would read from a text; positions are those of the words.
#[pyfunction]
pub fn read_gcode(py: Python<'_>, text: &str, machine: &Machine) -> PyResult<Program> {
    let reading = py.detach(|| styluscam_post::read(text, &machine.machine, &[]));
    Ok(Program { program: reading.map_err(of_job)?.program })
}

/// The same for posting it on another machine: a text of which something would be lost is refused.
#[pyfunction]
pub fn read_to_post(py: Python<'_>, text: &str, machine: &Machine, target: &Machine) -> PyResult<Program> {
    let program = py.detach(|| styluscam_post::read_to_post(text, &machine.machine, &target.machine));
    let program = program.map_err(|error| match error {
        RepostError::Read(error) => of_job(error),
        RepostError::Lost { line, .. } => {
            raise("VerifyError", &error.to_string(), "post-lost", &format!("line {line}"), RepostError::HINT)
        }
    })?;
    Ok(Program { program })
}

/// The moves of a channel's text as a machine would read it for this job.
#[pyfunction]
#[pyo3(signature = (job, machine, text, channel="main"))]
pub fn read_back(py: Python<'_>, job: &Job, machine: &Machine, text: &str, channel: &str) -> PyResult<Program> {
    let channel = job.channel(channel)?;
    let program = py.detach(|| styluscam_job::read_back(&job.document, channel, &machine.machine, text));
    Ok(Program { program: program.map_err(of_job)? })
}

/// The program that a text of the RS-274NGC language makes, and in words what is not shown of it.
///
/// `find` gives the text of a subroutine's file by its name, or None; what it raises is passed on.
#[pyfunction]
#[pyo3(signature = (text, find, progress=None, cancel=None))]
pub fn trace_gcode(
    py: Python<'_>,
    text: &str,
    find: Py<PyAny>,
    progress: Option<&Bound<'_, PyAny>>,
    cancel: Option<&CancelToken>,
) -> PyResult<(Program, Vec<String>)> {
    let (traced, raised) = watched(py, progress, cancel, move |watch| {
        let raised = RefCell::new(None);
        let found = |name: &str| {
            Python::attach(|py| find.call1(py, (name,))?.extract::<Option<String>>(py)).unwrap_or_else(|error| {
                raised.borrow_mut().get_or_insert(error);
                watch.cancel();
                None
            })
        };
        let traced = styluscam_post::trace(text, &found, watch);
        (traced, raised.into_inner())
    })?;
    if let Some(error) = raised {
        return Err(error);
    }
    let trace = traced.map_err(|error| of_trace(&error))?;
    let notes = trace.notes.iter().map(ToString::to_string).collect();
    Ok((Program { program: trace.program }, notes))
}
