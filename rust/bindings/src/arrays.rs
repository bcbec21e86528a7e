//! Between numpy arrays and the engine's vectors.

use numpy::ndarray::Dimension;
use numpy::{
    PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use styluscam_geometry::Vector;

use crate::errors::raise;

/// An array as Rust may read it: a copy where its entries do not lie at multiples of their size, as those of `numpy.frombuffer` with an offset
/// and fields of packed records.
pub fn aligned<'py, T: numpy::Element, D: Dimension>(
    array: &PyReadonlyArray<'py, T, D>,
) -> PyResult<PyReadonlyArray<'py, T, D>> {
    if array.is_aligned() {
        return Ok(array.clone());
    }
    array.call_method0("copy")?.extract()
}

/// The entries of an array, row by row.
pub fn entries<T: numpy::Element + Copy, D: Dimension>(array: &PyReadonlyArray<'_, T, D>) -> PyResult<Vec<T>> {
    Ok(aligned(array)?.as_array().iter().copied().collect())
}

/// Rows of an (N, 3) array.
pub fn vectors(array: &PyReadonlyArray2<'_, f64>, name: &str) -> PyResult<Vec<Vector>> {
    Ok(rows::<f64, 3>(array, name)?.into_iter().map(Vector::from).collect())
}

/// Rows of an (N, K) array.
pub fn rows<T: numpy::Element + Copy + Default, const K: usize>(
    array: &PyReadonlyArray2<'_, T>,
    name: &str,
) -> PyResult<Vec<[T; K]>> {
    let array = aligned(array)?;
    let view = array.as_array();
    if view.ncols() != K {
        let message = format!("{name} has shape ({}, {}): (N, {K}) expected", view.nrows(), view.ncols());
        return Err(raise("GeometryError", &message, "shape", name, ""));
    }
    let row = |row: numpy::ndarray::ArrayView1<'_, T>| {
        let mut out = [T::default(); K];
        out.iter_mut().zip(row).for_each(|(o, v)| *o = *v);
        out
    };
    Ok(view.rows().into_iter().map(row).collect())
}

/// No tool stands farther out than this, mm.
const FARTHEST: f64 = 1e9;

/// Positions (N, 2) in plan.
pub fn places(array: &PyReadonlyArray2<'_, f64>, name: &str) -> PyResult<Vec<[f64; 2]>> {
    let positions = rows::<f64, 2>(array, name)?;
    match positions.iter().position(|position| !position.iter().copied().all(is_in_range)) {
        Some(i) => {
            let message = format!("{name}[{i}] = {:?}: coordinates must lie within +/-{FARTHEST:e} mm", positions[i]);
            Err(raise("GeometryError", &message, "out-of-range", name, "lengths are in mm"))
        }
        None => Ok(positions),
    }
}

/// A height at which a tool may stand.
pub fn height(z: f64, name: &str) -> PyResult<f64> {
    if is_in_range(z) {
        return Ok(z);
    }
    let message = format!("{name} = {z:e}: a height within +/-{FARTHEST:e} mm expected");
    Err(raise("GeometryError", &message, "out-of-range", name, "lengths are in mm"))
}

fn is_in_range(coordinate: f64) -> bool {
    coordinate.abs() <= FARTHEST
}

/// An (N, K) array: of points, of corner numbers.
pub fn matrix<'py, T: numpy::Element, const K: usize>(
    py: Python<'py>,
    rows: impl ExactSizeIterator<Item = [T; K]>,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let count = rows.len();
    PyArray1::from_vec(py, rows.flatten().collect::<Vec<T>>()).reshape([count, K])
}

/// A function applied to each entry.
pub fn mapped<'py>(
    array: &PyReadonlyArray1<'py, f64>,
    py: Python<'py>,
    f: impl Fn(f64) -> f64,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    Ok(PyArray1::from_vec(py, aligned(array)?.as_array().iter().map(|x| f(*x)).collect()))
}

/// Checks that there are as many of the one as of the other.
///
/// # Errors
/// `GeometryError` at `what` where there are not.
pub fn one_each(what: &str, count: usize, of: &str, expected: usize) -> PyResult<()> {
    if count == expected {
        return Ok(());
    }
    Err(raise("GeometryError", &format!("{count} {what} for {expected} {of}"), "length", what, ""))
}
