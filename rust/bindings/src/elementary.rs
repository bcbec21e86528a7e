//! Elementary surfaces of a model, and triangles of its faces.

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use styluscam_geometry::{mesh_trimmed, Axes, EdgeUse, ElementaryKind, ElementarySurface, Vector, GUIDES};

use crate::{arrays, errors};

/// An edge as Python hands it over: points (N, 3), fractions, parameters of the face at even fractions.
type EdgeArrays<'py> = (PyReadonlyArray2<'py, f64>, Vec<f64>, [[f64; 2]; GUIDES]);

/// Nodes (N, 3) and triangles (T, 3).
type Triangles<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<i64>>);

/// A plane, cylinder, cone, sphere or torus: origin, axis, two directions across, sizes of its kind, side of the material.
#[pyclass(frozen, module = "styluscam._engine", name = "ElementarySurface")]
#[derive(Debug)]
pub struct Elementary {
    surface: ElementarySurface,
}

#[pymethods]
impl Elementary {
    #[new]
    fn new(
        kind: &str,
        origin: [f64; 3],
        axis: [f64; 3],
        across: [[f64; 3]; 2],
        sizes: Vec<f64>,
        sign: f64,
    ) -> PyResult<Self> {
        let kind = match (kind, &*sizes) {
            ("plane", []) => ElementaryKind::Plane,
            ("cylinder", [radius]) => ElementaryKind::Cylinder { radius: *radius },
            ("cone", [radius, semi_angle]) => ElementaryKind::Cone { radius: *radius, semi_angle: *semi_angle },
            ("sphere", [radius]) => ElementaryKind::Sphere { radius: *radius },
            ("torus", [major, minor]) => ElementaryKind::Torus { major: *major, minor: *minor },
            _ => {
                let message = format!("no surface {kind:?} has {} sizes", sizes.len());
                return Err(errors::raise("GeometryError", &message, "kind", "kind", ""));
            }
        };
        let axes = Axes::new(origin.into(), axis.into(), across.map(Vector::from));
        let surface = axes.and_then(|axes| ElementarySurface::new(kind, axes, sign));
        Ok(Self { surface: surface.map_err(|e| errors::of_geometry(&e))? })
    }

    /// Signed distances (N,) of points (N, 3), mm; above 0 outside the material.
    fn distance<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let points = arrays::vectors(&points, "points")?;
        Ok(PyArray1::from_vec(py, points.iter().map(|point| self.surface.distance(*point)).collect()))
    }

    /// Signed distances (T, S) of the points of triangles (T, 3) between nodes (N, 3) at barycentric weights (S, 3).
    fn distance_between<'py>(
        &self,
        py: Python<'py>,
        nodes: PyReadonlyArray2<'py, f64>,
        triangles: PyReadonlyArray2<'py, i64>,
        weights: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let nodes = arrays::vectors(&nodes, "nodes")?;
        let triangles = arrays::rows::<i64, 3>(&triangles, "triangles")?;
        let weights = arrays::rows::<f64, 3>(&weights, "weights")?;
        let shape = [triangles.len(), weights.len()];
        let found = py.detach(|| self.surface.distances_between(&nodes, &triangles, &weights));
        PyArray1::from_vec(py, found.map_err(|e| errors::of_geometry(&e))?).reshape(shape)
    }

    /// Unit normals (N, 3) out of the material, at the surface's points nearest to points (N, 3).
    fn normal<'py>(&self, py: Python<'py>, points: PyReadonlyArray2<'py, f64>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let points = arrays::vectors(&points, "points")?;
        arrays::matrix(py, points.iter().map(|point| self.surface.normal(*point).into()))
    }

    /// Triangles of the part within edges, which leave the surface by about `deviation` mm; None where the edges do not
    /// close, or would need too many.
    fn mesh<'py>(
        &self,
        py: Python<'py>,
        edges: Vec<EdgeArrays<'py>>,
        deviation: f64,
    ) -> PyResult<Option<Triangles<'py>>> {
        let points = edges.iter().map(|(points, ..)| arrays::vectors(points, "edges"));
        let points = points.collect::<PyResult<Vec<Vec<Vector>>>>()?;
        let uses = points.iter().zip(&edges).map(|(points, (_, fractions, guides))| EdgeUse {
            points,
            fractions,
            guides: *guides,
        });
        let uses: Vec<EdgeUse<'_>> = uses.collect();
        let Ok(mesh) = py.detach(|| mesh_trimmed(&self.surface, &uses, deviation)) else { return Ok(None) };
        let nodes = arrays::matrix(py, mesh.nodes.iter().map(|node| (*node).into()))?;
        let triangles = arrays::matrix(py, mesh.triangles.iter().map(|corners| corners.map(i64::from)))?;
        Ok(Some((nodes, triangles)))
    }
}
