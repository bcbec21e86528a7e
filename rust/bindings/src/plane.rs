//! Plane paths and outlines: paths that clear pockets, and the engagement along them.

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use styluscam_toolpath::pocket::{self, Cleared, Contour, EntryRule, Pocket, PocketError, PocketRunKind, Shape};
use styluscam_verify::{EngagementError, Ground, PlaneRun, PlaneRunKind, Swept, CHIP};

use crate::{
    arrays, errors,
    waiting::{watched, CancelToken},
};

/// Points (N, 3) of a run, each with the bulge of what begins there, and its kind.
type RunArrays<'py> = (PyReadonlyArray2<'py, f64>, String);

/// Points (N, 3) of a path that an earlier tool has cleared, and its radius.
type ClearedArrays<'py> = (PyReadonlyArray2<'py, f64>, f64);

/// The names of the kinds of runs.
const KINDS: [(&str, PlaneRunKind); 4] = [
    ("cut", PlaneRunKind::Cut),
    ("entry", PlaneRunKind::Entry),
    ("link", PlaneRunKind::Link),
    ("rapid", PlaneRunKind::Rapid),
];

/// The engagement at every measured position of each run: rows of x, y, length travelled, angle (rad), clearance, stepover (N, 6).
#[pyfunction]
#[pyo3(signature = (runs, tool_radius, stock, boundary, cleared, progress=None, cancel=None))]
#[allow(clippy::needless_pass_by_value, clippy::too_many_arguments)] // PyO3 hands arrays by value; one for each argument of Python's
pub fn engagement<'py>(
    py: Python<'py>,
    runs: Vec<RunArrays<'py>>,
    tool_radius: f64,
    stock: Vec<PyReadonlyArray2<'py, f64>>,
    boundary: Vec<PyReadonlyArray2<'py, f64>>,
    cleared: Vec<ClearedArrays<'py>>,
    progress: Option<&Bound<'py, PyAny>>,
    cancel: Option<&CancelToken>,
) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
    let runs = runs.iter().enumerate().map(|(number, run)| plane_run(number, run)).collect::<PyResult<Vec<_>>>()?;
    let stock = outlines(&stock, "stock")?;
    let pocket = outlines(&boundary, "boundary")?;
    let cleared = cleared_paths(&cleared)?;
    let cleared: Vec<Swept> = cleared.into_iter().map(|(points, radius)| Swept { points, radius }).collect();
    let ground = Ground { radius: tool_radius, stock: &stock, pocket: &pocket, cleared: &cleared, chip: CHIP };
    let found = watched(py, progress, cancel, |watch| styluscam_verify::engagement(&runs, &ground, watch))?;
    let found = found.map_err(|error| of_engagement(&error))?;
    let rows = found.into_iter().map(|run| {
        let row = |m: styluscam_verify::Engaged| [m.at[0], m.at[1], m.travelled, m.angle, m.clearance, m.width];
        let rows: Vec<f64> = run.measures.into_iter().flat_map(row).collect();
        let count = rows.len() / 6;
        PyArray1::from_vec(py, rows).reshape([count, 6])
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

fn cleared_paths(paths: &[ClearedArrays<'_>]) -> PyResult<Vec<(Vec<[f64; 3]>, f64)>> {
    let rows = |(number, (points, radius)): (usize, &ClearedArrays<'_>)| {
        Ok((arrays::rows::<f64, 3>(points, &format!("cleared[{number}]"))?, *radius))
    };
    paths.iter().enumerate().map(rows).collect()
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

/// Runs as Python gets them, the area that can be cleared and what of it is left, mm^2.
type PathArrays<'py> = (Vec<(Bound<'py, PyArray2<f64>>, &'static str)>, [f64; 2]);

/// A path that clears a pocket: points (N, 3) with bulges and kind of each run; the area that can be cleared and what of it is left, mm^2.
#[pyfunction]
#[pyo3(signature = (boundary, islands, open_edges, stock, cleared, tool_radius, angle, smoothing, direction, progress=None, cancel=None))]
#[allow(clippy::needless_pass_by_value, clippy::too_many_arguments)] // PyO3 hands arrays by value; one for each argument of Python's
pub fn pocket_path<'py>(
    py: Python<'py>,
    boundary: PyReadonlyArray2<'py, f64>,
    islands: Vec<PyReadonlyArray2<'py, f64>>,
    open_edges: Vec<usize>,
    stock: Option<Vec<PyReadonlyArray2<'py, f64>>>,
    cleared: Vec<ClearedArrays<'py>>,
    tool_radius: f64,
    angle: f64,
    smoothing: f64,
    direction: &str,
    progress: Option<&Bound<'py, PyAny>>,
    cancel: Option<&CancelToken>,
) -> PyResult<PathArrays<'py>> {
    let boundary = arrays::rows::<f64, 3>(&boundary, "boundary")?;
    let islands = outlines(&islands, "islands")?;
    let stock = stock.map(|stock| outlines(&stock, "stock")).transpose()?;
    let shape =
        Shape::Walls { boundary: &boundary, islands: &islands, open_edges: &open_edges, stock: stock.as_deref() };
    let cleared = cleared_paths(&cleared)?;
    let cleared: Vec<Cleared> = cleared.into_iter().map(|(points, radius)| Cleared { points, radius }).collect();
    let asked = Pocket {
        shape,
        radius: tool_radius,
        angle,
        smoothing,
        leave: 0.0,
        finish: 0.0,
        cleared: &cleared,
        climb: direction != "conventional",
        two_way: direction == "either",
        entry: EntryRule::default(),
        stepovers: false,
    };
    let path = watched(py, progress, cancel, |watch| pocket::pocket_path(&asked, watch))?;
    let path = path.map_err(|error| of_pocket(&error))?;
    let runs = path.runs.into_iter().map(|run| {
        let kind = match run.kind {
            PocketRunKind::Cut => "cut",
            PocketRunKind::Entry => "entry",
            PocketRunKind::Link => "link",
            PocketRunKind::Rapid => "rapid",
        };
        Ok((arrays::matrix(py, run.points.into_iter())?, kind))
    });
    Ok((runs.collect::<PyResult<_>>()?, [path.goal, path.left]))
}

/// Outline of where the tool may be beside a profile, outlines in it where it may not be, outlines of what is cleared: points (N, 3) each.
type StripArrays<'py> = (Bound<'py, PyArray2<f64>>, Vec<Bound<'py, PyArray2<f64>>>, Vec<Bound<'py, PyArray2<f64>>>);

/// The strip beside a profile as a pocket.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)] // PyO3 hands arrays by value
pub fn contour_strip<'py>(
    py: Python<'py>,
    profile: PyReadonlyArray2<'py, f64>,
    closed: bool,
    left: bool,
    width: f64,
    tool_radius: f64,
    stock: Option<Vec<PyReadonlyArray2<'py, f64>>>,
) -> PyResult<StripArrays<'py>> {
    let profile = arrays::rows::<f64, 3>(&profile, "profile")?;
    let stock = stock.map(|stock| outlines(&stock, "stock")).transpose()?;
    let contour = Contour {
        profile: &profile,
        is_closed: closed,
        is_left: left,
        width,
        radius: tool_radius,
        stock: stock.as_deref(),
    };
    let strip = contour.strip().map_err(|error| of_pocket(&error))?;
    let all = |outlines: Vec<Vec<[f64; 3]>>| -> PyResult<Vec<_>> {
        outlines.into_iter().map(|outline| arrays::matrix(py, outline.into_iter())).collect()
    };
    Ok((arrays::matrix(py, strip.boundary.into_iter())?, all(strip.islands)?, all(strip.stock)?))
}

fn of_pocket(error: &PocketError) -> PyErr {
    let class = match error {
        PocketError::Cancelled => return errors::cancelled(styluscam_motion::Cancelled),
        PocketError::Number { .. }
        | PocketError::Outline { .. }
        | PocketError::Edge { .. }
        | PocketError::Profile { .. }
        | PocketError::Line { .. } => "GeometryError",
        PocketError::TooSmall { .. } | PocketError::NoEntry { .. } | PocketError::Empty => "PlanError",
    };
    errors::raise(class, &error.to_string(), error.code(), error.key(), "")
}
