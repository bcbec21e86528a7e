//! The texts that are posted for a machine.

use std::fs::File;

use pyo3::prelude::*;
use styluscam_post::PostError;

use crate::{errors::of_job, machine::Machine, program::Program};

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
