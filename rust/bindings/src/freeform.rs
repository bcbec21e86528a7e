//! Freeform surfaces of a model, and the feet of points on them.

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;
use styluscam_geometry::{FootSearch, NurbsSurface, Pole, SurfacePoint};

use crate::{arrays, errors};

/// Points and both derivatives, each (N, 3).
type Points<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>);

/// A pole as Python knows it: the fixed parameter, its value, how near it is meant, values of the other one, ways (K, 3).
type PoleArrays<'py> = (usize, f64, f64, PyReadonlyArray1<'py, f64>, PyReadonlyArray2<'py, f64>);

/// A B-spline surface: degrees, flat knots, poles (U, V, 3) in mm and weights (U, V).
#[pyclass(frozen, module = "styluscam._engine")]
#[derive(Debug)]
pub struct Nurbs {
    surface: NurbsSurface,
}

#[pymethods]
impl Nurbs {
    #[new]
    fn new(
        degrees: [usize; 2],
        knots_u: Vec<f64>,
        knots_v: Vec<f64>,
        poles: PyReadonlyArray3<'_, f64>,
        weights: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Self> {
        let (poles, weights) = (arrays::aligned(&poles)?, arrays::aligned(&weights)?);
        let (poles, weights) = (poles.as_array(), weights.as_array());
        if poles.dim() != (weights.nrows(), weights.ncols(), 3) {
            let message =
                format!("poles {:?} for weights {:?}: (U, V, 3) and (U, V) expected", poles.dim(), weights.dim());
            return Err(errors::raise("GeometryError", &message, "shape", "poles", ""));
        }
        let poles: Vec<[f64; 4]> = weights
            .indexed_iter()
            .map(|((i, j), weight)| [poles[[i, j, 0]], poles[[i, j, 1]], poles[[i, j, 2]], *weight])
            .collect();
        let surface = NurbsSurface::new(degrees, [knots_u, knots_v], &poles).map_err(|e| errors::of_geometry(&e))?;
        Ok(Self { surface })
    }

    /// Points and derivatives along u and v, each (N, 3), at parameters (N, 2).
    fn __call__<'py>(&self, py: Python<'py>, parameters: PyReadonlyArray2<'py, f64>) -> PyResult<Points<'py>> {
        let parameters = arrays::rows::<f64, 2>(&parameters, "parameters")?;
        let found = py.detach(|| self.surface.points(&parameters));
        points_of(py, &found)
    }
}

/// How feet are sought: parameters stay between the two rows of `limits`, or come in again where they close after
/// `periods`; a search ends when a step is below `step` mm.
#[pyclass(frozen, module = "styluscam._engine", name = "FootSearch")]
#[derive(Debug)]
pub struct Search {
    search: FootSearch,
}

#[pymethods]
impl Search {
    #[new]
    fn new(limits: [[f64; 2]; 2], periods: [Option<f64>; 2], poles: Vec<PoleArrays<'_>>, step: f64) -> PyResult<Self> {
        let poles = poles.iter().map(pole).collect::<PyResult<_>>()?;
        Ok(Self { search: FootSearch { limits, periods, poles, step } })
    }

    /// The feet of points (N, 3) on a surface, sought from parameters (N, 2) near them: parameters (N, 2), points and
    /// derivatives, each (N, 3). The surface is a `Nurbs`, or a callable that answers like one.
    fn feet<'py>(
        &self,
        py: Python<'py>,
        surface: &Bound<'py, PyAny>,
        points: PyReadonlyArray2<'py, f64>,
        near: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, Points<'py>)> {
        let (points, near) = (arrays::vectors(&points, "points")?, arrays::rows::<f64, 2>(&near, "near")?);
        if points.len() != near.len() {
            let message = format!("{} parameters for {} points", near.len(), points.len());
            return Err(errors::raise("GeometryError", &message, "length", "near", ""));
        }
        let found = match surface.cast::<Nurbs>() {
            Ok(nurbs) => {
                let surface = &nurbs.get().surface;
                py.detach(|| surface.feet(&self.search, &points, &near))
            }
            Err(_) => self.search.feet(|parameters| called(surface, parameters), &points, &near)?,
        };
        let parameters = PyArray1::from_vec(py, found.iter().flat_map(|foot| foot.parameters).collect::<Vec<f64>>());
        let at: Vec<SurfacePoint> = found.iter().map(|foot| foot.surface).collect();
        Ok((parameters.reshape([found.len(), 2])?, points_of(py, &at)?))
    }
}

/// What a callable answers.
fn called(surface: &Bound<'_, PyAny>, parameters: &[[f64; 2]]) -> PyResult<Vec<SurfacePoint>> {
    let flat = PyArray1::from_vec(surface.py(), parameters.iter().flatten().copied().collect::<Vec<f64>>());
    let answer = surface.call1((flat.reshape([parameters.len(), 2])?,))?;
    let answer: [PyReadonlyArray2<'_, f64>; 3] = answer.extract::<(_, _, _)>().map(|(a, b, c)| [a, b, c])?;
    let [points, along_u, along_v] = [0, 1, 2].map(|i| arrays::vectors(&answer[i], "surface"));
    let (points, along_u, along_v) = (points?, along_u?, along_v?);
    if [points.len(), along_u.len(), along_v.len()] != [parameters.len(); 3] {
        let message = format!("{} points for {} parameters", points.len(), parameters.len());
        return Err(errors::raise("GeometryError", &message, "length", "surface", ""));
    }
    let along = along_u.into_iter().zip(along_v).map(|(u, v)| [u, v]);
    Ok(points.into_iter().zip(along).map(|(point, along)| SurfacePoint { point, along }).collect())
}

fn pole((fixed, value, near, values, ways): &PoleArrays<'_>) -> PyResult<Pole> {
    let ways = arrays::entries(values)?.into_iter().zip(arrays::vectors(ways, "ways")?).collect();
    Ok(Pole { fixed: usize::from(*fixed > 0), value: *value, near: *near, ways })
}

fn points_of<'py>(py: Python<'py>, found: &[SurfacePoint]) -> PyResult<Points<'py>> {
    Ok((
        arrays::matrix(py, found.iter().map(|at| at.point.into()))?,
        arrays::matrix(py, found.iter().map(|at| at.along[0].into()))?,
        arrays::matrix(py, found.iter().map(|at| at.along[1].into()))?,
    ))
}
