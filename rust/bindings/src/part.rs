//! Parts: triangles in the frame of their file.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock};

use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;
use styluscam_geometry::{Mesh, Soup, Vector};
use styluscam_job::Curves;
use styluscam_motion::{Cancelled, Watch};
use styluscam_toolpath::offset::Index;

use crate::flank::{rail, RailArrays};
use crate::{arrays, errors};

/// Vertices, triangles, faces and normals.
type MeshArrays<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<i64>>,
    Bound<'py, PyArray1<i64>>,
    Option<Bound<'py, PyArray3<f64>>>,
);

/// A part; see `styluscam.Part`.
#[pyclass(frozen, module = "styluscam._engine")]
pub struct Part {
    pub(crate) part: styluscam_job::Part,
    index: OnceLock<Index>,
    /// Held while the index is built: once is enough.
    building: Mutex<()>,
}

impl Part {
    /// Without its index.
    pub(crate) fn of(part: styluscam_job::Part) -> Self {
        Self { part, index: OnceLock::new(), building: Mutex::new(()) }
    }

    /// The triangles' index, built when it is first asked for.
    ///
    /// # Errors
    /// `Cancelled` when `watch` is cancelled; the next call builds it anew.
    pub(crate) fn index(&self, watch: &Watch) -> Result<&Index, Cancelled> {
        let _alone = self.building.lock();
        if self.index.get().is_none() {
            let _ = self.index.set(Index::watched(&self.part.mesh, watch)?);
        }
        self.index.get().ok_or(Cancelled)
    }
}

#[pymethods]
impl Part {
    /// `vertices` (V, 3) mm, `triangles` (T, 3), `face_ids` (T,) or None; checked deviations in mm; `normals` of the
    /// model at the triangles' corners (T, 3, 3) or None; curves of the edges from Edge1 on, and rails of ruled faces by their numbers.
    #[new]
    #[pyo3(signature = (vertices, triangles, face_ids=None, inward=0.0, outward=0.0, normals=None, edges=Vec::new(), ruled=None))]
    #[allow(clippy::too_many_arguments)] // Python names them
    fn new(
        py: Python<'_>,
        vertices: PyReadonlyArray2<'_, f64>,
        triangles: PyReadonlyArray2<'_, i64>,
        face_ids: Option<PyReadonlyArray1<'_, i64>>,
        inward: f64,
        outward: f64,
        normals: Option<PyReadonlyArray3<'_, f64>>,
        edges: Vec<Option<RailArrays<'_>>>,
        ruled: Option<BTreeMap<u32, [RailArrays<'_>; 2]>>,
    ) -> PyResult<Self> {
        let vertices = arrays::vectors(&vertices, "vertices")?;
        let triangles = arrays::rows::<i64, 3>(&triangles, "triangles")?;
        let faces = face_ids.map_or(Ok(Vec::new()), |ids| face_numbers(&ids))?;
        let normals = normals.map_or(Ok(Vec::new()), |normals| corner_normals(&normals))?;
        let mesh = py.detach(|| Mesh::with_normals(vertices, &triangles, &faces, &normals));
        let mesh = mesh.map_err(|e| errors::of_geometry(&e))?;
        for deviation in [inward, outward] {
            if !(0.0..=1.0).contains(&deviation) {
                let message = format!("a deviation of {deviation} mm: 0 to 1 expected");
                return Err(errors::raise("GeometryError", &message, "out-of-range", "deviation", ""));
            }
        }
        let edges = edges.iter().map(|edge| edge.as_ref().map(rail).transpose()).collect::<PyResult<_>>()?;
        let rails = |(face, [first, second]): (u32, [RailArrays<'_>; 2])| Ok((face, [rail(&first)?, rail(&second)?]));
        let ruled = ruled.unwrap_or_default().into_iter().map(rails).collect::<PyResult<_>>()?;
        let curves = Arc::new(Curves { edges, ruled });
        Ok(Self::of(styluscam_job::Part { mesh, inward, outward, shaped: None, curves }))
    }

    /// Where points (N, 3) of the shaped part lie on the part before; NaN where that is not unique.
    #[allow(clippy::needless_pass_by_value)] // PyO3 hands arrays by value
    fn target_points<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let points = arrays::vectors(&points, "points")?;
        let target = py.detach(|| self.part.target_points(&points));
        arrays::matrix(py, target.into_iter().map(|point| point.map_or([f64::NAN; 3], <[f64; 3]>::from)))
    }

    /// To what `target_points` is good, mm.
    #[getter]
    fn target_accuracy(&self) -> f64 {
        self.part.shaped.as_ref().map_or(0.0, |shaped| shaped.linear)
    }

    /// What was changed of the part before, in sentences.
    #[getter]
    fn changes(&self) -> Vec<String> {
        self.part.changes().iter().map(|change| change.words.clone()).collect()
    }

    /// Where the part is cut off after it is formed: the points (N, 3) of closed lines, in the file's frame, mm.
    #[getter]
    fn trim<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
        let lines = self.part.trim().iter();
        lines.map(|line| arrays::matrix(py, line.iter().map(|point| (*point).into()))).collect()
    }

    /// Lower and upper corner of the box.
    #[getter]
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let (low, high) = self.part.mesh.bounds();
        (low.into(), high.into())
    }

    /// How far the triangles lie inside and outside the material at most, mm.
    #[getter]
    fn deviation(&self) -> (f64, f64) {
        (self.part.inward, self.part.outward)
    }

    /// Vertices (V, 3) mm, triangles (T, 3), face by triangle (T,), and the model's normals at their corners (T, 3, 3), or None:
    /// what builds the same part.
    fn arrays<'py>(&self, py: Python<'py>) -> PyResult<MeshArrays<'py>> {
        let mesh = &self.part.mesh;
        let count = mesh.triangles().len();
        let normals = if mesh.has_corner_normals() {
            let flat = (0..count).flat_map(|t| mesh.corner_normals(t)).flat_map(|n| [n.x, n.y, n.z]).collect();
            Some(PyArray1::from_vec(py, flat).reshape([count, 3, 3])?)
        } else {
            None
        };
        Ok((
            arrays::matrix(py, mesh.vertices().iter().map(|v| [v.x, v.y, v.z]))?,
            arrays::matrix(py, mesh.triangles().iter().map(|t| t.map(i64::from)))?,
            PyArray1::from_vec(py, mesh.faces().iter().map(|face| i64::from(*face)).collect()),
            normals,
        ))
    }

    #[getter]
    fn triangle_count(&self) -> usize {
        self.part.mesh.triangles().len()
    }

    /// Triangles without area that were left out.
    #[getter]
    fn dropped(&self) -> usize {
        self.part.mesh.dropped()
    }
}

/// What [`mended`] returns.
type Mended<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<i64>>, Bound<'py, PyArray1<i64>>, String);

/// Triangles of a file made a part: `points` (N, 3) mm and `triangles` (T, 3) of their numbers; returns vertices,
/// triangles, the face of each from 1, and as JSON what was done and the shape of each face.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub fn mended<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    triangles: PyReadonlyArray2<'py, i64>,
) -> PyResult<Mended<'py>> {
    let points = arrays::vectors(&points, "points")?;
    let corners = arrays::rows::<i64, 3>(&triangles, "triangles")?;
    let (soup, faces, shapes) = py
        .detach(|| {
            let soup = Soup::new(&points, &corners)?;
            let (faces, shapes) = soup.faces();
            Ok((soup, faces, shapes))
        })
        .map_err(|e| errors::of_geometry(&e))?;
    let done = serde_json::json!({ "mending": soup.mending, "shapes": shapes }).to_string();
    Ok((
        arrays::matrix(py, soup.vertices.iter().map(|p| (*p).into()))?,
        arrays::matrix(py, soup.triangles.iter().map(|t| t.map(i64::from)))?,
        PyArray1::from_vec(py, faces.into_iter().map(i64::from).collect()),
        done,
    ))
}

fn face_numbers(ids: &PyReadonlyArray1<'_, i64>) -> PyResult<Vec<u32>> {
    let number = |(i, id): (usize, &i64)| {
        u32::try_from(*id).map_err(|_| {
            let message = format!("face id {id} of triangle {i}: a number from 0 expected");
            errors::raise("GeometryError", &message, "out-of-range", "face_ids", "")
        })
    };
    arrays::aligned(ids)?.as_array().iter().enumerate().map(number).collect()
}

fn corner_normals(normals: &PyReadonlyArray3<'_, f64>) -> PyResult<Vec<[Vector; 3]>> {
    let normals = arrays::aligned(normals)?;
    let view = normals.as_array();
    let (_, corners, axes) = view.dim();
    if (corners, axes) != (3, 3) {
        let message = format!("normals has shape {:?}: (T, 3, 3) expected", view.shape());
        return Err(errors::raise("GeometryError", &message, "shape", "normals", ""));
    }
    let corner = |t: usize, k: usize| Vector::new(view[[t, k, 0]], view[[t, k, 1]], view[[t, k, 2]]);
    Ok((0..view.dim().0).map(|t| std::array::from_fn(|k| corner(t, k))).collect())
}
