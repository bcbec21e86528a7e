//! The walls of an operation as columns.

use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use styluscam_job::{Corner, Wall, Walls};

use crate::arrays;

/// Slopes, azimuths (rad), areas (mm^2), curvatures (1/mm: up, twist, level) and faces of the walls.
type WallColumns<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<i64>>,
);
/// Normals of the sides (K, 2, 3), radii and lengths (mm) of the corners.
type CornerColumns<'py> = (Bound<'py, PyArray3<f64>>, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>);

/// Walls and corners.
pub type Columns<'py> = (WallColumns<'py>, CornerColumns<'py>);

pub fn columns<'py>(py: Python<'py>, found: &Walls) -> PyResult<Columns<'py>> {
    let wall = |f: fn(&Wall) -> f64| PyArray1::from_vec(py, found.walls.iter().map(f).collect());
    let corner = |f: fn(&Corner) -> f64| PyArray1::from_vec(py, found.corners.iter().map(f).collect());
    let bends = found.walls.iter().map(|wall| [wall.bend.up, wall.bend.twist, wall.bend.level]);
    let sides: Vec<f64> = found.corners.iter().flat_map(|corner| corner.sides).flat_map(<[f64; 3]>::from).collect();
    let walls = (
        wall(|wall| wall.slope),
        wall(|wall| wall.azimuth),
        wall(|wall| wall.area),
        arrays::matrix(py, bends)?,
        PyArray1::from_vec(py, found.walls.iter().map(|wall| i64::from(wall.face)).collect()),
    );
    let sides = PyArray1::from_vec(py, sides).reshape([found.corners.len(), 2, 3])?;
    Ok((walls, (sides, corner(|corner| corner.radius), corner(|corner| corner.length))))
}
