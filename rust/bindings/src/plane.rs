//! Plane paths and outlines: the engagement along them.

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use styluscam_verify::{EngagementError, Ground, PlaneRun, PlaneRunKind};

use crate::{
    arrays, errors,
    waiting::{watched, CancelToken},
};

/// Points (N, 3) of a run, each with the bulge of what begins there, and its kind.
type RunArrays<'py> = (PyReadonlyArray2<'py, f64>, String);

/// The names of the kinds of runs.
const KINDS: [(&str, PlaneRunKind); 4] = [
    ("cut", PlaneRunKind::Cut),
    ("entry", PlaneRunKind::Entry),
    ("link", PlaneRunKind::Link),
    ("rapid", PlaneRunKind::Rapid),
];

/// The engagement at every measured position of each run: rows of x, y, length travelled, angle (rad), clearance (N, 5).
#[pyfunction]
#[pyo3(signature = (runs, tool_radius, stock, boundary, progress=None, cancel=None))]
#[allow(clippy::needless_pass_by_value)] // PyO3 hands arrays by value
pub fn engagement<'py>(
    py: Python<'py>,
    runs: Vec<RunArrays<'py>>,
    tool_radius: f64,
    stock: Vec<PyReadonlyArray2<'py, f64>>,
    boundary: Vec<PyReadonlyArray2<'py, f64>>,
    progress: Option<&Bound<'py, PyAny>>,
    cancel: Option<&CancelToken>,
) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
    let runs = runs.iter().enumerate().map(|(number, run)| plane_run(number, run)).collect::<PyResult<Vec<_>>>()?;
    let stock = outlines(&stock, "stock")?;
    let pocket = outlines(&boundary, "boundary")?;
    let ground = Ground { radius: tool_radius, stock: &stock, pocket: &pocket };
    let found = watched(py, progress, cancel, |watch| styluscam_verify::engagement(&runs, &ground, watch))?;
    let found = found.map_err(|error| of_engagement(&error))?;
    let rows = found.into_iter().map(|run| {
        let row = |m: styluscam_verify::Engaged| [m.at[0], m.at[1], m.travelled, m.angle, m.clearance];
        let rows: Vec<f64> = run.measures.into_iter().flat_map(row).collect();
        let count = rows.len() / 5;
        PyArray1::from_vec(py, rows).reshape([count, 5])
    });
    rows.collect()
}

fn plane_run(number: usize, (points, kind): &RunArrays<'_>) -> PyResult<PlaneRun> {
    let name = format!("runs[{number}]");
    let Some((_, found)) = KINDS.iter().find(|(name, _)| name == kind) else {
        let message = format!("{name}: kind = {kind:?}: expected cut, entry, link or rapid");
        return Err(errors::raise("GeometryError", &message, "kind", &name, ""));
    };
    Ok(PlaneRun { points: arrays::rows::<f64, 3>(points, &name)?, kind: *found })
}

/// Points (N, 3) of outlines.
fn outlines(arrays: &[PyReadonlyArray2<'_, f64>], name: &str) -> PyResult<Vec<Vec<[f64; 3]>>> {
    let rows = |(number, array)| arrays::rows::<f64, 3>(array, &format!("{name}[{number}]"));
    arrays.iter().enumerate().map(rows).collect()
}

fn of_engagement(error: &EngagementError) -> PyErr {
    if *error == EngagementError::Cancelled {
        return errors::cancelled(styluscam_motion::Cancelled);
    }
    errors::raise("GeometryError", &error.to_string(), error.code(), error.key(), "")
}
