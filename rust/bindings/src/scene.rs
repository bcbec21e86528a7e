//! The part as it lies on the machine.

use pyo3::prelude::*;

use crate::{errors::of_job, job::Job, part::Part, sheet::face_name, walls};

/// Name, corners of the opening, heights of the lower and the upper face.
type Plate = (&'static str, Vec<[f64; 2]>, [f64; 2]);

/// The part as it lies on the machine of a channel.
#[pyclass(frozen, module = "styluscam._engine")]
pub struct Scene {
    pub(crate) scene: styluscam_job::Scene,
}

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(signature = (job, part, channel="main"))]
    fn new(py: Python<'_>, job: &Job, part: &Part, channel: &str) -> PyResult<Self> {
        let channel = job.channel(channel)?;
        let scene = py.detach(|| styluscam_job::Scene::new(&job.document, channel, &part.part)).map_err(of_job)?;
        Ok(Self { scene })
    }

    /// Rows of the matrix from the file's frame to work coordinates.
    #[getter]
    fn frame(&self) -> [[f64; 4]; 3] {
        self.scene.frame.rows()
    }

    /// Lower and upper corner of the part's box, work coordinates.
    #[getter]
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let (low, high) = self.scene.mesh.bounds();
        (low.into(), high.into())
    }

    /// What holds the sheet: name, corners of the opening, heights of the lower and the upper face; work coordinates.
    fn fixture(&self) -> Vec<Plate> {
        let plates = styluscam_job::plates(&self.scene);
        plates.into_iter().map(|plate| (plate.holder.name(), plate.opening, plate.heights)).collect()
    }

    /// Radius (mm) up to which a tool from above fits nearly all concave regions; None where nothing bounds it.
    #[getter]
    fn fitting_radius(&self, py: Python<'_>) -> Option<f64> {
        py.detach(|| styluscam_job::fitting_radius(&self.scene.mesh, &self.scene.bvh))
    }

    /// The walls of the faces that an operation selects, and their concave corners.
    fn walls<'py>(&self, py: Python<'py>, job: &Job, index: usize) -> PyResult<walls::Columns<'py>> {
        let found = py.detach(|| styluscam_job::walls(&job.document, &self.scene, index)).map_err(of_job)?;
        walls::columns(py, &found)
    }

    /// Radius (mm) of the ball by which the sheet rounds the tool; 0 without a sheet.
    #[getter]
    fn sheet_ball(&self) -> f64 {
        self.scene.sheet.map_or(0.0, |sheet| sheet.along_normal())
    }

    /// The sheet's face that the part is, where there is a sheet.
    #[getter]
    fn model_face(&self) -> Option<&'static str> {
        self.scene.sheet.map(|sheet| face_name(sheet.model_face))
    }
}
