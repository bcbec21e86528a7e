//! Flank milling of ruled surfaces: positions along a strip, and what they leave of it.

use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use styluscam_geometry::{NurbsCurve, Vector};
use styluscam_toolpath::flank::{
    flank_pass as flank_pass_of, positions, positions_within, Flank, FlankError, FlankPose, FlankWays, Method,
    RuledStrip, Side, Stand,
};
use styluscam_verify::{clearance_of_tool, left_by_flank, FlankShape};

use crate::tool::Tool;
use crate::{arrays, errors};

/// A rail: degree, flat knots, poles (N, 3) in mm, weights (N,).
pub(crate) type RailArrays<'py> = (usize, Vec<f64>, PyReadonlyArray2<'py, f64>, PyReadonlyArray1<'py, f64>);

/// Pairs of points (N, 2, 3), twice.
type Pairs<'py> = (Bound<'py, PyArray3<f64>>, Bound<'py, PyArray3<f64>>);

/// Points and directions, each (N, 3).
type Rows<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>);

/// A strip between two rails, and a side of it: `"left"` or `"right"`.
#[pyclass(frozen, module = "styluscam._engine", name = "RuledStrip")]
#[derive(Debug)]
pub struct Strip {
    strip: RuledStrip,
}

#[pymethods]
impl Strip {
    #[new]
    #[allow(clippy::needless_pass_by_value)] // PyO3 hands arrays by value
    fn new(rail0: RailArrays<'_>, rail1: RailArrays<'_>, side: &str) -> PyResult<Self> {
        let side = match side {
            "left" => Side::Left,
            "right" => Side::Right,
            other => return Err(word("side", other, "left or right")),
        };
        let rails = [rail(&rail0)?, rail(&rail1)?];
        Ok(Self { strip: RuledStrip::new(rails, side).map_err(|error| of_flank(&error))? })
    }

    /// Points of the axis beside both rails (N, 2, 3), and contacts (N, 2, 3), mm, in `count` positions of a flank
    /// of this radius beside the first rail, mm, that widens by a half angle, rad.
    fn positions<'py>(
        &self,
        py: Python<'py>,
        radius: f64,
        half_angle: f64,
        count: usize,
        method: &str,
    ) -> PyResult<Pairs<'py>> {
        let (method, flank) = (method_of(method)?, flank_of(radius, half_angle)?);
        stands(py, &py.detach(|| positions(&self.strip, &flank, count, method)))
    }

    /// The same in as few positions as leave the continuous movement by no more than a tolerance, mm, in straight moves.
    fn positions_within<'py>(
        &self,
        py: Python<'py>,
        radius: f64,
        half_angle: f64,
        tolerance: f64,
        method: &str,
    ) -> PyResult<Pairs<'py>> {
        let (method, flank) = (method_of(method)?, flank_of(radius, half_angle)?);
        stands(py, &py.detach(|| positions_within(&self.strip, &flank, tolerance, method)))
    }

    /// Points (N, 3), mm, and unit normals (N, 3) towards the tool at shares (N, 2) of the way along the rails and the rulings.
    #[allow(clippy::needless_pass_by_value)] // PyO3 hands arrays by value
    fn points<'py>(&self, py: Python<'py>, shares: PyReadonlyArray2<'py, f64>) -> PyResult<Rows<'py>> {
        let shares = arrays::rows::<f64, 2>(&shares, "shares")?;
        let points: Vec<Vec<f64>> = shares.iter().map(|at| self.strip.point(*at).as_slice().to_vec()).collect();
        let normals: Vec<Vec<f64>> = shares.iter().map(|at| self.strip.normal(*at).as_slice().to_vec()).collect();
        Ok((PyArray2::from_vec2(py, &points)?, PyArray2::from_vec2(py, &normals)?))
    }

    /// What a flank leaves at shares (N, 2) of the strip when its axis, `from` and `to` (M, 3) in each position, has moved from
    /// the first to the last, mm along the normal (N,): below 0 where it is cut too deep, NaN where that is not decided between
    /// the first position and the last. `shape` is its radius across the axis at `from`, mm, and how much that grows for each mm from there.
    #[allow(clippy::needless_pass_by_value)] // PyO3 hands arrays by value
    fn left<'py>(
        &self,
        py: Python<'py>,
        from: PyReadonlyArray2<'py, f64>,
        to: PyReadonlyArray2<'py, f64>,
        shape: (f64, f64),
        shares: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (from, to) = (arrays::vectors(&from, "from")?, arrays::vectors(&to, "to")?);
        arrays::one_each("to", to.len(), "from", from.len())?;
        let axes = pairs_of(from, to);
        let shares = arrays::rows::<f64, 2>(&shares, "shares")?;
        let found = py.detach(|| {
            let points: Vec<_> = shares.iter().map(|at| (self.strip.point(*at), self.strip.normal(*at))).collect();
            left_by_flank(&axes, FlankShape { radius: shape.0, growth: shape.1 }, &points)
        });
        Ok(PyArray1::from_iter(py, found.into_iter().map(|left| left.unwrap_or(f64::NAN))))
    }
}

/// How near a tool whose tip moves along `tips` (M, 3), its axis along `axes` (M, 3), comes to points (N, 3), mm (N,); below 0 it
/// enters.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)] // PyO3 hands arrays by value
pub fn clearance_of_tilted<'py>(
    py: Python<'py>,
    tool: &Tool,
    tips: PyReadonlyArray2<'py, f64>,
    axes: PyReadonlyArray2<'py, f64>,
    points: PyReadonlyArray2<'py, f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (tips, axes) = (arrays::vectors(&tips, "tips")?, arrays::vectors(&axes, "axes")?);
    arrays::one_each("axes", axes.len(), "tips", tips.len())?;
    let above = tips.iter().zip(axes).map(|(tip, axis)| tip + axis).collect();
    let (positions, points) = (pairs_of(tips, above), arrays::vectors(&points, "points")?);
    let found = py.detach(|| clearance_of_tool(&positions, &tool.cutter, &points));
    Ok(PyArray1::from_vec(py, found))
}

/// The moves, as JSON, of a pass along tips (N, 3), axes (N, 3) and points (N, 3) that are touched, mm; `ways` are the extension and the
/// lead beyond both ends, and how far up the axis it begins and ends, mm.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)] // PyO3 hands arrays by value
pub fn flank_pass(
    tips: PyReadonlyArray2<'_, f64>,
    axes: PyReadonlyArray2<'_, f64>,
    touched: PyReadonlyArray2<'_, f64>,
    ways: (f64, f64, f64),
    feed: f64,
) -> PyResult<String> {
    let (tips, axes) = (arrays::vectors(&tips, "tips")?, arrays::vectors(&axes, "axes")?);
    let touched = arrays::vectors(&touched, "touched")?;
    let (extension, lead, up) = ways;
    arrays::one_each("axes", axes.len(), "tips", tips.len())?;
    arrays::one_each("touched", touched.len(), "tips", tips.len())?;
    let poses = tips.into_iter().zip(axes).zip(touched);
    let poses: Vec<_> = poses.map(|((tip, axis), contact)| FlankPose { tip, axis, contact }).collect();
    let ways = FlankWays { extension, lead, cut: feed, plunge: feed, leads: [feed; 2] };
    let moves = flank_pass_of(&poses, &ways, &|_| up).map_err(|error| of_flank(&error))?;
    serde_json::to_string(&moves).map_err(|error| word("moves", &error.to_string(), "numbers"))
}

fn pairs_of(from: Vec<Vector>, to: Vec<Vector>) -> Vec<[Vector; 2]> {
    from.into_iter().zip(to).map(|(from, to)| [from, to]).collect()
}

pub(crate) fn rail((degree, knots, poles, weights): &RailArrays<'_>) -> PyResult<NurbsCurve> {
    let (poles, weights) = (arrays::rows::<f64, 3>(poles, "poles")?, arrays::entries(weights)?);
    arrays::one_each("weights", weights.len(), "poles", poles.len())?;
    let poles: Vec<[f64; 4]> = poles.iter().zip(weights).map(|([x, y, z], w)| [*x, *y, *z, w]).collect();
    NurbsCurve::new(*degree, knots.clone(), &poles).map_err(|error| errors::of_geometry(&error))
}

fn pairs<'py>(py: Python<'py>, of: impl Iterator<Item = [Vector; 2]>) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let numbers: Vec<f64> = of.flatten().flat_map(<[f64; 3]>::from).collect();
    let count = numbers.len() / 6;
    PyArray1::from_vec(py, numbers).reshape([count, 2, 3])
}

fn method_of(name: &str) -> PyResult<Method> {
    Ok(match name {
        "swept" => Method::Swept,
        "rails" => Method::Rails,
        "three-points" => Method::ThreePoints,
        "two-points" => Method::TwoPoints,
        "one-point" => Method::OnePoint,
        other => return Err(word("method", other, "swept, rails, three-points, two-points or one-point")),
    })
}

fn flank_of(radius: f64, half_angle: f64) -> PyResult<Flank> {
    Flank::new(radius, half_angle).map_err(|error| of_flank(&error))
}

fn stands<'py>(py: Python<'py>, found: &Result<Vec<Stand>, FlankError>) -> PyResult<Pairs<'py>> {
    let stands = found.as_ref().map_err(of_flank)?;
    Ok((pairs(py, stands.iter().map(|stand| stand.axis))?, pairs(py, stands.iter().map(|stand| stand.contacts))?))
}

fn of_flank(error: &FlankError) -> PyErr {
    errors::raise("GeometryError", &error.to_string(), error.code(), "", "")
}

fn word(name: &str, value: &str, allowed: &str) -> PyErr {
    errors::raise("GeometryError", &format!("{name} = {value:?}: {allowed} expected"), "argument", name, "")
}
