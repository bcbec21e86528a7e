//! Parts: triangles in the frame of their file.

use std::sync::OnceLock;

use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use styluscam_geometry::Mesh;
use styluscam_toolpath::offset::Index;

use crate::{arrays, errors};

/// A part; see `styluscam.Part`.
#[pyclass(frozen, module = "styluscam._engine")]
pub struct Part {
    pub(crate) part: styluscam_job::Part,
    index: OnceLock<Index>,
}

impl Part {
    /// The triangles' index, built when it is first asked for.
    pub(crate) fn index(&self) -> &Index {
        self.index.get_or_init(|| Index::new(&self.part.mesh))
    }
}

#[pymethods]
impl Part {
    /// `vertices` (V, 3) mm, `triangles` (T, 3), `face_ids` (T,) or None; checked deviations in mm.
    #[new]
    #[pyo3(signature = (vertices, triangles, face_ids=None, inward=0.0, outward=0.0))]
    fn new(
        py: Python<'_>,
        vertices: PyReadonlyArray2<'_, f64>,
        triangles: PyReadonlyArray2<'_, i64>,
        face_ids: Option<PyReadonlyArray1<'_, i64>>,
        inward: f64,
        outward: f64,
    ) -> PyResult<Self> {
        let vertices = arrays::vectors(&vertices, "vertices")?;
        let triangles = arrays::rows::<i64, 3>(&triangles, "triangles")?;
        let faces = face_ids.map_or(Ok(Vec::new()), |ids| face_numbers(&ids))?;
        let mesh = py.detach(|| Mesh::new(vertices, &triangles, &faces)).map_err(|e| errors::of_geometry(&e))?;
        for deviation in [inward, outward] {
            if !(0.0..=1.0).contains(&deviation) {
                let message = format!("a deviation of {deviation} mm: 0 to 1 expected");
                return Err(errors::raise("GeometryError", &message, "out-of-range", "deviation", ""));
            }
        }
        Ok(Self { part: styluscam_job::Part { mesh, inward, outward }, index: OnceLock::new() })
    }

    /// Lower and upper corner of the box.
    #[getter]
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let (low, high) = self.part.mesh.bounds();
        (low.into(), high.into())
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

fn face_numbers(ids: &PyReadonlyArray1<'_, i64>) -> PyResult<Vec<u32>> {
    let number = |(i, id): (usize, &i64)| {
        u32::try_from(*id).map_err(|_| {
            let message = format!("face id {id} of triangle {i}: a number from 0 expected");
            errors::raise("GeometryError", &message, "out-of-range", "face_ids", "")
        })
    };
    ids.as_array().iter().enumerate().map(number).collect()
}
