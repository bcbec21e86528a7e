//! The material after a program.

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use styluscam_geometry::ModelFace;

use crate::errors;

/// Heights after a program; see `styluscam.simulation.Simulation`.
#[pyclass(frozen, module = "styluscam._engine")]
pub struct Simulation {
    pub(crate) simulation: styluscam_verify::Simulation,
}

#[pymethods]
impl Simulation {
    /// The first node in plan.
    #[getter]
    fn origin(&self) -> [f64; 2] {
        self.simulation.grid.origin
    }

    /// From one node to the next along X and Y, mm.
    #[getter]
    fn step(&self) -> [f64; 2] {
        self.simulation.grid.step
    }

    /// Heights (rows along Y, columns along X), mm.
    #[getter]
    fn heights<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let [columns, rows] = self.simulation.grid.nodes;
        PyArray1::from_slice(py, &self.simulation.heights).reshape([rows, columns])
    }
}

/// A face of the sheet by its name.
pub fn sheet_face(name: &str) -> PyResult<ModelFace> {
    match name {
        "tool" => Ok(ModelFace::Tool),
        "mid" => Ok(ModelFace::Mid),
        "back" => Ok(ModelFace::Back),
        other => {
            let message = format!("face = {other:?}: \"tool\", \"mid\" or \"back\" expected");
            Err(errors::raise("GeometryError", &message, "out-of-range", "face", ""))
        }
    }
}
