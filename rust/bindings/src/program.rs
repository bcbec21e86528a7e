//! Programs.

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use styluscam_motion::{MoveKind, Statistics, PROGRAM_SCHEMA};

use crate::{arrays, errors};

/// A machine-independent program; see `styluscam.Program`.
#[pyclass(frozen, module = "styluscam._engine")]
pub struct Program {
    pub(crate) program: styluscam_motion::Program,
}

/// Columns of the moves: kind, end, feed, operation, line.
type Columns<'py> = (
    Bound<'py, PyArray1<u8>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<u32>>,
    Bound<'py, PyArray1<u32>>,
);

#[pymethods]
impl Program {
    /// From a program document as JSON.
    #[staticmethod]
    fn from_json(text: &str) -> PyResult<Self> {
        let program: styluscam_motion::Program = serde_json::from_str(text)
            .map_err(|e| errors::raise("JobError", &format!("not a program: {e}"), "document", "", ""))?;
        if program.schema != PROGRAM_SCHEMA {
            let message = format!("a program of schema {}: this version reads {PROGRAM_SCHEMA}", program.schema);
            return Err(errors::raise("JobError", &message, "schema", "schema", "update StylusCAM"));
        }
        Ok(Self { program })
    }

    fn to_json(&self) -> PyResult<String> {
        serde_json::to_string(&self.program)
            .map_err(|e| errors::raise("StylusError", &e.to_string(), "internal", "", ""))
    }

    /// Columns of the moves: kind (0 rapid, 1 feed), end (N, 3), feed, operation, line.
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Columns<'py>> {
        let moves = &self.program.moves;
        let kind = moves.iter().map(|m| u8::from(m.kind == MoveKind::Feed)).collect();
        Ok((
            PyArray1::from_vec(py, kind),
            arrays::matrix(py, moves.iter().map(|m| m.end))?,
            PyArray1::from_vec(py, moves.iter().map(|m| m.feed).collect()),
            PyArray1::from_vec(py, moves.iter().map(|m| m.operation).collect()),
            PyArray1::from_vec(py, moves.iter().map(|m| m.line).collect()),
        ))
    }

    /// Events, tools, operations and set-up as JSON; moves are left to `columns`.
    fn records(&self) -> PyResult<String> {
        let p = &self.program;
        serde_json::to_string(&(&p.events, &p.tools, &p.operations, &p.setup))
            .map_err(|e| errors::raise("StylusError", &e.to_string(), "internal", "", ""))
    }

    /// The same program with these lines in its header.
    fn with_notes(&self, notes: Vec<String>) -> Self {
        let mut program = self.program.clone();
        program.setup.notes = notes;
        Self { program }
    }

    /// Whether both hold the same moves on the same lines.
    fn same_moves(&self, other: &Self) -> bool {
        self.program.moves == other.program.moves
    }

    /// Length at feed (mm) and duration (s), rapids at `rapid_rate` mm/min.
    #[pyo3(signature = (rapid_rate=3000.0))]
    fn statistics(&self, rapid_rate: f64) -> (f64, f64) {
        let statistics = Statistics::of(&self.program, rapid_rate);
        (statistics.feed_length, statistics.duration)
    }
}
