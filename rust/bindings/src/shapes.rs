//! The shapes of a job's sheet as arrays.

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use styluscam_job::Shape;

use crate::arrays;

/// Key, words, vertices (V, 3) mm, unit normals (V, 3), triangles (T, 3) and edges (E, 2) of vertices.
pub type Columns<'py> = (
    &'static str,
    &'static str,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<i64>>,
    Bound<'py, PyArray2<i64>>,
);

pub fn columns<'py>(py: Python<'py>, shape: &Shape) -> PyResult<Columns<'py>> {
    let drawn = &shape.drawn;
    let edges: Vec<i64> = drawn.edges.iter().flatten().map(|vertex| i64::from(*vertex)).collect();
    Ok((
        shape.kind.key(),
        shape.kind.words(),
        arrays::matrix(py, drawn.vertices.iter().map(|v| [v.x, v.y, v.z]))?,
        arrays::matrix(py, drawn.normals.iter().map(|n| [n.x, n.y, n.z]))?,
        arrays::matrix(py, drawn.triangles.iter().map(|t| t.map(i64::from)))?,
        PyArray1::from_vec(py, edges).reshape([drawn.edges.len(), 2])?,
    ))
}
