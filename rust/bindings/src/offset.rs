//! Offsets and envelopes point by point.

use numpy::{PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use styluscam_geometry::{Mesh, Sheet};
use styluscam_toolpath::{
    budget::LoopBudget,
    forming,
    offset::{Envelope, Line, OffsetPoint, OffsetSurface, Region},
};

use crate::{
    arrays, errors,
    part::Part,
    tool::Tool,
    waiting::{watched, CancelToken},
};

fn sheet(document: Option<&str>) -> PyResult<Option<Sheet>> {
    let Some(text) = document else { return Ok(None) };
    let sheet: Sheet = serde_json::from_str(text)
        .map_err(|e| errors::raise("GeometryError", &e.to_string(), "document", "sheet", ""))?;
    sheet.checked().map(Some).map_err(|e| errors::of_geometry(&e))
}

/// How far a sheet lifts the tool over a horizontal face of the model, mm.
#[pyfunction]
pub fn sheet_raise(sheet: &str) -> PyResult<f64> {
    Ok(self::sheet(Some(sheet))?.map_or(0.0, |sheet| sheet.raise()))
}

/// CL points and flags.
type Offsets<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<u8>>);

/// CL points (N, 3) and flags (N,) of contacts with unit normals.
#[pyfunction]
#[pyo3(signature = (tool, points, normals, sheet=None))]
#[allow(clippy::needless_pass_by_value)] // PyO3 hands arrays by value
pub fn slope_matched_offset<'py>(
    py: Python<'py>,
    tool: &Tool,
    points: PyReadonlyArray2<'py, f64>,
    normals: PyReadonlyArray2<'py, f64>,
    sheet: Option<&str>,
) -> PyResult<Offsets<'py>> {
    let sheet = self::sheet(sheet)?;
    let points = arrays::vectors(&points, "points")?;
    let normals = arrays::vectors(&normals, "normals")?;
    arrays::one_each("normals", normals.len(), "points", points.len())?;
    let results: Vec<_> = py.detach(|| {
        let pairs = points.iter().zip(&normals);
        pairs
            .map(|(p, n)| {
                let (tip, flag) =
                    styluscam_toolpath::offset::slope_matched_offset(&tool.tool, sheet.as_ref(), *p, n.normalize());
                (<[f64; 3]>::from(tip), flag as u8)
            })
            .collect()
    });
    let flags = PyArray1::from_vec(py, results.iter().map(|r| r.1).collect());
    Ok((arrays::matrix(py, results.into_iter().map(|r| r.0))?, flags))
}

/// Tip heights (N,) at places (N, 2): never into the part, its checked inward deviation included.
#[pyfunction]
#[pyo3(signature = (part, tool, xy, sheet=None, floor=None, progress=None, cancel=None))]
#[allow(clippy::too_many_arguments, clippy::needless_pass_by_value)]
pub fn drop_cutter<'py>(
    py: Python<'py>,
    part: &Part,
    tool: &Tool,
    xy: PyReadonlyArray2<'py, f64>,
    sheet: Option<&str>,
    floor: Option<f64>,
    progress: Option<&Bound<'py, PyAny>>,
    cancel: Option<&CancelToken>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let sheet = self::sheet(sheet)?;
    let places = arrays::places(&xy, "xy")?;
    let (whole, part) = (part, &part.part);
    let tips = watched(py, progress, cancel, |watch| {
        let envelope = Envelope::new(&part.mesh, whole.index(watch)?, &tool.tool, sheet.as_ref(), part.inward);
        watch.begin("drop-cutter", places.len());
        envelope.tips(&places, watch)
    })?;
    let tips = tips.map_err(errors::cancelled)?;
    let floored = |z: f64| floor.map_or(z, |f| if z.is_nan() { f } else { z.max(f) });
    Ok(PyArray1::from_vec(py, tips.into_iter().map(floored).collect()))
}

/// Distances (N,), mm, travelled from positions (N, 2) in directions (N, 2), the tip at `z`, until the tool touches; infinite
/// where it touches nothing, NaN where it begins within the part.
#[pyfunction]
#[pyo3(signature = (part, tool, xy, directions, z, sheet=None, progress=None, cancel=None))]
#[allow(clippy::too_many_arguments, clippy::needless_pass_by_value)]
pub fn push_cutter<'py>(
    py: Python<'py>,
    part: &Part,
    tool: &Tool,
    xy: PyReadonlyArray2<'py, f64>,
    directions: PyReadonlyArray2<'py, f64>,
    z: f64,
    sheet: Option<&str>,
    progress: Option<&Bound<'py, PyAny>>,
    cancel: Option<&CancelToken>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let sheet = self::sheet(sheet)?;
    let (z, starts, directions) =
        (arrays::height(z, "z")?, arrays::places(&xy, "xy")?, arrays::rows::<f64, 2>(&directions, "directions")?);
    arrays::one_each("directions", directions.len(), "points xy", starts.len())?;
    let mut lines = Vec::with_capacity(starts.len());
    for (i, (from, direction)) in starts.into_iter().zip(directions).enumerate() {
        lines.push(Line::new(from, direction).ok_or_else(|| {
            let message = format!("a push from {from:?} towards {direction:?}: a direction in plan expected");
            errors::raise("GeometryError", &message, "not-finite", &format!("directions[{i}]"), "")
        })?);
    }
    let (whole, part) = (part, &part.part);
    let found = watched(py, progress, cancel, |watch| {
        let envelope = Envelope::new(&part.mesh, whole.index(watch)?, &tool.tool, sheet.as_ref(), part.inward);
        watch.begin("push-cutter", lines.len());
        envelope.pushes(&lines, z, watch)
    })?;
    Ok(PyArray1::from_vec(py, found.map_err(errors::cancelled)?))
}

/// Loops of one height: arrays (M, 3).
type Loops<'py> = Vec<Bound<'py, PyArray2<f64>>>;

/// Loops at each of the `heights`.
#[pyfunction]
#[pyo3(signature = (part, tool, heights, sheet=None, tolerance=0.005, progress=None, cancel=None))]
#[allow(clippy::too_many_arguments, clippy::needless_pass_by_value)]
pub fn waterlines<'py>(
    py: Python<'py>,
    part: &Part,
    tool: &Tool,
    heights: Vec<f64>,
    sheet: Option<&str>,
    tolerance: f64,
    progress: Option<&Bound<'py, PyAny>>,
    cancel: Option<&CancelToken>,
) -> PyResult<Vec<Loops<'py>>> {
    let sheet = self::sheet(sheet)?;
    let (whole, part) = (part, &part.part);
    for (i, z) in heights.iter().enumerate() {
        arrays::height(*z, &format!("heights[{i}]"))?;
    }
    let budget = LoopBudget::new(tolerance, [part.inward, part.outward], tool.tool.diameter())
        .map_err(|e| errors::raise("PlanError", &e.to_string(), e.code(), "tolerance", "0.005 mm is usual"))?;
    let passes = watched(py, progress, cancel, |watch| {
        let index = whole.index(watch)?;
        let envelope = Envelope::new(&part.mesh, index, &tool.tool, sheet.as_ref(), budget.shares.margin);
        forming::waterlines(&envelope, &heights, &budget, watch)
    })?;
    let passes = passes.map_err(|e| errors::raise("PlanError", &e.to_string(), e.code(), "", ""))?;
    let mut loops: Vec<Loops<'py>> = heights.iter().map(|_| Vec::new()).collect();
    for pass in passes {
        loops[pass.group].push(arrays::matrix(py, pass.points.into_iter().map(|p| p.tip.into()))?);
    }
    Ok(loops)
}

/// Points by column: tips, contacts, normals, slopes, flags, depths, places, faces of the places.
type Columns<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<u8>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<i64>>,
);
/// Triangles (T, 3), their faces (T,), and how long sides are at most where something stops the tool.
type Connection<'py> = (Bound<'py, PyArray2<i64>>, Bound<'py, PyArray1<i64>>, f64);
/// Face, flag's name, area, depth, contact, place.
type RegionRow = (u32, &'static str, f64, f64, [f64; 3], [f64; 3]);

/// Points that refining an offset surface may add at most: some hundred megabytes.
const OFFSET_POINTS: usize = 1 << 21;

/// The slope-matched offset of the part's `faces` (all if None) as columns, its triangles and its regions.
#[pyfunction]
#[pyo3(signature = (part, tool, sheet=None, tolerance=0.005, faces=None, progress=None, cancel=None))]
#[allow(clippy::too_many_arguments, clippy::needless_pass_by_value)]
pub fn offset_surface<'py>(
    py: Python<'py>,
    part: &Part,
    tool: &Tool,
    sheet: Option<&str>,
    tolerance: f64,
    faces: Option<Vec<u32>>,
    progress: Option<&Bound<'py, PyAny>>,
    cancel: Option<&CancelToken>,
) -> PyResult<(Columns<'py>, Connection<'py>, Vec<RegionRow>)> {
    let sheet = self::sheet(sheet)?;
    let (whole, part) = (part, &part.part);
    if !(tolerance > part.outward && tolerance.is_finite()) {
        let message = format!("tolerance = {tolerance}: it must exceed the part's checked deviation, {}", part.outward);
        return Err(errors::raise("GeometryError", &message, "out-of-range", "tolerance", "raise tolerance"));
    }
    let triangles = triangles_of(&part.mesh, faces.as_deref())?;
    let made = watched(py, progress, cancel, |watch| {
        let envelope = Envelope::new(&part.mesh, whole.index(watch)?, &tool.tool, sheet.as_ref(), 0.0);
        let surface =
            OffsetSurface::new(&envelope, &tool.tool, sheet.as_ref(), &triangles, tolerance, OFFSET_POINTS, watch)?;
        let regions = surface.regions(&part.mesh);
        Ok((surface, regions))
    })?;
    let (surface, regions) = made.map_err(errors::cancelled)?;
    let face_of = |triangle: u32| i64::from(part.mesh.faces()[triangle as usize]);
    let connection = (
        arrays::matrix(py, surface.triangles.iter().map(|corners| corners.map(i64::from)))?,
        PyArray1::from_vec(py, surface.numbers.iter().map(|t| face_of(*t)).collect()),
        surface.fine,
    );
    let columns = columns(py, &surface.points, face_of)?;
    Ok((columns, connection, regions.iter().map(region_row).collect()))
}

fn columns<'py>(py: Python<'py>, points: &[OffsetPoint], face_of: impl Fn(u32) -> i64) -> PyResult<Columns<'py>> {
    let column = |f: fn(&OffsetPoint) -> f64| PyArray1::from_vec(py, points.iter().map(f).collect());
    Ok((
        arrays::matrix(py, points.iter().map(|p| p.tip.into()))?,
        arrays::matrix(py, points.iter().map(|p| p.contact.into()))?,
        arrays::matrix(py, points.iter().map(|p| p.normal.into()))?,
        column(|p| p.slope),
        PyArray1::from_vec(py, points.iter().map(|p| p.flag as u8).collect()),
        column(|p| p.depth),
        arrays::matrix(py, points.iter().map(|p| p.place.into()))?,
        PyArray1::from_vec(py, points.iter().map(|p| face_of(p.place_triangle)).collect()),
    ))
}

fn region_row(region: &Region) -> RegionRow {
    let worst = &region.worst;
    (region.face, region.flag.name(), region.area, worst.depth, worst.contact.into(), worst.place.into())
}

/// The triangles of some faces, each of which the mesh must have.
fn triangles_of(mesh: &Mesh, faces: Option<&[u32]>) -> PyResult<Vec<u32>> {
    let all = 0..mesh.triangles().len() as u32;
    let Some(faces) = faces else { return Ok(all.collect()) };
    if let Some(face) = faces.iter().find(|face| !mesh.faces().contains(face)) {
        let message = format!("the part has no face {face}");
        return Err(errors::raise("GeometryError", &message, "no-such-face", "faces", ""));
    }
    Ok(all.filter(|t| faces.contains(&mesh.faces()[*t as usize])).collect())
}
