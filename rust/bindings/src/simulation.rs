//! The material after a program.

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::{
    arrays, errors,
    scene::Scene,
    waiting::{watched, CancelToken},
};

type Triangles<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<i64>>);

/// Heights after a program; see `styluscam.judging.simulation.Simulation`.
#[pyclass(frozen, module = "styluscam._engine")]
pub struct Simulation {
    pub(crate) simulation: styluscam_verify::Simulation,
}

#[pymethods]
impl Simulation {
    /// From what the getters give: the first node, the step from one to the next, heights (rows, columns) and those before.
    #[new]
    #[pyo3(signature = (origin, step, heights, top, before=None))]
    #[allow(clippy::needless_pass_by_value)] // PyO3 hands arrays by value
    fn new(
        origin: [f64; 2],
        step: [f64; 2],
        heights: PyReadonlyArray2<'_, f64>,
        top: f64,
        before: Option<PyReadonlyArray2<'_, f64>>,
    ) -> PyResult<Self> {
        let dims = heights.dims();
        let grid = styluscam_verify::Grid { origin, step, nodes: [dims[1], dims[0]] };
        let before = before.map(|before| arrays::entries(&before)).transpose()?;
        let heights = arrays::entries(&heights)?;
        Ok(Self { simulation: styluscam_verify::Simulation { grid, heights, top, before } })
    }

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

    /// Heights before the first move (rows along Y, columns along X), mm; None where they are all `top`.
    #[getter]
    fn before<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let [columns, rows] = self.simulation.grid.nodes;
        let before = self.simulation.before.as_deref();
        before.map(|heights| PyArray1::from_slice(py, heights).reshape([rows, columns])).transpose()
    }

    /// The highest of all before the first move, mm.
    #[getter]
    fn top(&self) -> f64 {
        self.simulation.top
    }

    /// Vertices (V, 3) and triangles (T, 3) that are off no node by more than `tolerance` mm; closed down to a `floor`.
    #[pyo3(signature = (tolerance, floor=None))]
    fn mesh<'py>(&self, py: Python<'py>, tolerance: f64, floor: Option<f64>) -> PyResult<Triangles<'py>> {
        let skin = py.detach(|| self.simulation.skin(tolerance, floor));
        let vertices = arrays::matrix(py, skin.vertices.iter().map(|v| [v.x, v.y, v.z]))?;
        Ok((vertices, arrays::matrix(py, skin.triangles.iter().map(|t| t.map(i64::from)))?))
    }

    /// Signed distance of every node to the scene's part (rows along Y, columns along X), mm.
    #[pyo3(signature = (scene, progress=None, cancel=None))]
    fn distances<'py>(
        &self,
        py: Python<'py>,
        scene: &Scene,
        progress: Option<&Bound<'_, PyAny>>,
        cancel: Option<&CancelToken>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let work = |watch: &_| self.simulation.distances(&scene.scene.mesh, &scene.scene.bvh, watch);
        let distances = watched(py, progress, cancel, work)?.map_err(errors::cancelled)?;
        let [columns, rows] = self.simulation.grid.nodes;
        PyArray1::from_vec(py, distances).reshape([rows, columns])
    }
}
