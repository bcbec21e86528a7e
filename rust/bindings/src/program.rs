//! Programs.

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use styluscam_motion::{Dynamics, FeedMode, Move, MoveKind, Role, Statistics, PROGRAM_SCHEMA};

use crate::{arrays, errors, json::json, machine::Machine};

/// A machine-independent program; see `styluscam.Program`.
#[pyclass(frozen, module = "styluscam._engine")]
pub struct Program {
    pub(crate) program: styluscam_motion::Program,
}

/// Columns of the moves: kind, end, axis, centre; plane, turns, feed, feed mode, role, operation, tool, line.
type Columns<'py> = (
    Bound<'py, PyArray1<u8>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<u8>>,
    Bound<'py, PyArray1<u32>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<u8>>,
    Bound<'py, PyArray1<u8>>,
    Bound<'py, PyArray1<u32>>,
    Bound<'py, PyArray1<u32>>,
    Bound<'py, PyArray1<u32>>,
);

/// Positions and the moves that they belong to.
type Polyline<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<u32>>);

fn kind_of(step: &Move) -> u8 {
    match (step.kind, step.arc) {
        (MoveKind::Rapid, _) => 0,
        (MoveKind::Feed, None) => 1,
        (MoveKind::Feed, Some(arc)) => 3 - u8::from(arc.clockwise),
    }
}

fn feed_mode_of(step: &Move) -> u8 {
    match step.feed_mode {
        FeedMode::InverseTime => 93,
        FeedMode::PerMinute => 94,
        FeedMode::PerRevolution => 95,
    }
}

fn role_of(step: &Move) -> u8 {
    match step.role {
        None => 0,
        Some(Role::Cut) => 1,
        Some(Role::Lead) => 2,
        Some(Role::Ramp) => 3,
        Some(Role::Link) => 4,
    }
}

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
        json(&self.program)
    }

    /// Columns of the moves: kind (0 rapid, 1 line, 2 clockwise arc, 3 counterclockwise arc), end (N, 3), the tool's axis
    /// there (N, 3), an arc's centre (N, 3; else NaN), plane (17, 18, 19) and turns beyond the first, feed and its mode
    /// (93, 94, 95, as in G94), role (0 none, 1 cut, 2 lead, 3 ramp, 4 link), operation, its tool, line.
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Columns<'py>> {
        let moves = &self.program.moves;
        let kind = moves.iter().map(kind_of).collect();
        let centre = |m: &Move| m.arc.map_or([f64::NAN; 3], |arc| arc.centre);
        let plane = |m: &Move| m.arc.map_or(17, |arc| 17 + arc.plane as u8);
        let tool = |m: &Move| self.program.operations.get(m.operation as usize).map_or(u32::MAX, |one| one.tool);
        Ok((
            PyArray1::from_vec(py, kind),
            arrays::matrix(py, moves.iter().map(|m| m.end.tip))?,
            arrays::matrix(py, moves.iter().map(|m| m.end.axis.vector()))?,
            arrays::matrix(py, moves.iter().map(centre))?,
            PyArray1::from_vec(py, moves.iter().map(plane).collect()),
            PyArray1::from_vec(py, moves.iter().map(|m| m.arc.map_or(0, |arc| arc.turns)).collect()),
            PyArray1::from_vec(py, moves.iter().map(|m| m.feed).collect()),
            PyArray1::from_vec(py, moves.iter().map(feed_mode_of).collect()),
            PyArray1::from_vec(py, moves.iter().map(role_of).collect()),
            PyArray1::from_vec(py, moves.iter().map(|m| m.operation).collect()),
            PyArray1::from_vec(py, moves.iter().map(tool).collect()),
            PyArray1::from_vec(py, moves.iter().map(|m| m.line).collect()),
        ))
    }

    #[getter]
    fn move_count(&self) -> usize {
        self.program.moves.len()
    }

    /// Positions along the program (M, 3) and the move that each belongs to (M,); no chord is farther than `sag` mm from its arc.
    fn polyline<'py>(&self, py: Python<'py>, sag: f64) -> PyResult<Polyline<'py>> {
        if sag.is_nan() || sag <= 0.0 {
            return Err(errors::raise(
                "JobError",
                &format!("sag = {sag}"),
                "value",
                "sag",
                "give a length above 0, in mm",
            ));
        }
        let (positions, moves): (Vec<_>, Vec<_>) = self.program.polyline(sag).map(|(p, i)| (p, i as u32)).unzip();
        Ok((arrays::matrix(py, positions.into_iter())?, PyArray1::from_vec(py, moves)))
    }

    /// The time at the end of every move (N,), s, and of the whole program, on a machine.
    fn times<'py>(&self, py: Python<'py>, machine: &Machine) -> (Bound<'py, PyArray1<f64>>, f64) {
        let (times, whole) = machine.machine.dynamics().times(&self.program);
        (PyArray1::from_vec(py, times), whole)
    }

    /// Events, tools, operations and set-up as JSON; moves are left to `columns`.
    fn records(&self) -> PyResult<String> {
        let p = &self.program;
        json(&(&p.events, &p.tools, &p.operations, &p.setup))
    }

    /// The same program with these lines in its header.
    fn with_notes(&self, notes: Vec<String>) -> Self {
        let mut program = self.program.clone();
        program.setup.notes = notes;
        Self { program }
    }

    /// From a move on, with the state that the machine is in there; None where that cannot be.
    fn restarted(&self, first: usize) -> Option<Self> {
        Some(Self { program: self.program.restarted(first)? })
    }

    /// The first move of a level of an operation, both counted as in the program (levels from 1), or None.
    fn level_start(&self, operation: u32, level: usize) -> Option<usize> {
        self.program.level_start(operation, level)
    }

    /// The same program so many mm higher.
    fn raised(&self, by: f64) -> Self {
        Self { program: self.program.raised(by) }
    }

    /// The same program with an optional stop before every operation but the first.
    fn with_optional_stops(&self) -> Self {
        Self { program: self.program.with_optional_stops() }
    }

    /// This program and another one that wait for one another before every operation; None where they have not equally many.
    fn paired(&self, other: &Self) -> Option<(Self, Self)> {
        let [program, support] = self.program.paired(&other.program)?;
        Some((Self { program }, Self { program: support }))
    }

    /// Whether both hold the same moves on the same lines.
    fn same_moves(&self, other: &Self) -> bool {
        self.program.moves == other.program.moves
    }

    /// Length at feed (mm) and duration (s), rapids at `rapid_rate` mm/min.
    #[pyo3(signature = (rapid_rate=3000.0))]
    fn statistics(&self, rapid_rate: f64) -> (f64, f64) {
        let statistics = Statistics::of(&self.program, &Dynamics::at_once(rapid_rate));
        (statistics.feed_length, statistics.duration)
    }
}
