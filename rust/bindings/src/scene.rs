//! The part as it lies on the machine.

use std::sync::Arc;

use numpy::{PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use styluscam_job::{Given, Text, Travel};

use crate::{
    arrays, earlier::Earlier, errors::of_job, job::Job, machine::Machine, part::Part, shapes, sheet::face_name,
    tool::Tool, walls,
};

/// The part as it lies on the machine of a channel.
#[pyclass(frozen, module = "styluscam._engine")]
pub struct Scene {
    pub(crate) scene: styluscam_job::Scene,
}

#[pymethods]
impl Scene {
    #[new]
    /// With the body of the stock, or what an earlier program left, where the job names either.
    #[pyo3(signature = (job, part, channel="main", stock=None, earlier=None))]
    fn new(
        py: Python<'_>,
        job: &Job,
        part: &Part,
        channel: &str,
        stock: Option<&Part>,
        earlier: Option<&Earlier>,
    ) -> PyResult<Self> {
        let channel = job.channel(channel)?;
        let given = match (stock, earlier) {
            (_, Some(earlier)) => Given::Program(&earlier.earlier),
            (Some(stock), None) => Given::Body(&stock.part.mesh),
            (None, None) => Given::Nothing,
        };
        let made = || styluscam_job::Scene::with_stock(&job.document, channel, &part.part, given);
        let scene = py.detach(made).map_err(of_job)?;
        Ok(Self { scene })
    }

    /// What the program of its job in a text leaves of its stock.
    fn left_by(&self, py: Python<'_>, job: &Job, machine: &Machine, text: &str) -> PyResult<Earlier> {
        let text = Text { scene: &self.scene, machine: &machine.machine, text };
        let earlier = py.detach(|| styluscam_job::earlier(&job.document, text)).map_err(of_job)?;
        Ok(Earlier { earlier: Arc::new(earlier) })
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

    /// Blank, formed sheet, what holds it and the die, for drawing: closed bodies whose points are at most `tolerance` mm off the
    /// part's; see `styluscam.drawing.shapes`. Empty without a sheet.
    fn shapes<'py>(&self, py: Python<'py>, job: &Job, tolerance: f64) -> PyResult<Vec<shapes::Columns<'py>>> {
        let found = py.detach(|| styluscam_job::shapes(&job.document, &self.scene, tolerance));
        found.iter().map(|shape| shapes::columns(py, shape)).collect()
    }

    /// How far every vertex of the formed sheet of `shapes` stands above its formed height, (K, V), mm, behind each of the K `moments`
    /// of a path through `tips` (N, 3); `tools` holds for each of them the number of one of the `cutters`, others press nothing.
    /// None without a sheet, and for a tool from below.
    #[pyo3(signature = (job, tolerance, tips, tools, cutters, moments))]
    #[allow(clippy::too_many_arguments, clippy::needless_pass_by_value)] // PyO3 hands arrays by value
    fn standing<'py>(
        &self,
        py: Python<'py>,
        job: &Job,
        tolerance: f64,
        tips: PyReadonlyArray2<'py, f64>,
        tools: PyReadonlyArray1<'py, i64>,
        cutters: Vec<PyRef<'py, Tool>>,
        moments: Vec<usize>,
    ) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let (tips, tools) = (arrays::rows::<f64, 3>(&tips, "tips")?, arrays::entries(&tools)?);
        let cutters: Vec<_> = cutters.iter().map(|tool| tool.tool.cutter()).collect();
        let tools: Vec<_> = tools.iter().map(|tool| usize::try_from(*tool).ok().and_then(|i| cutters.get(i))).collect();
        let travel = Travel { tips: &tips, tools: &tools, moments: &moments };
        let found = py.detach(|| styluscam_job::standing(&job.document, &self.scene, tolerance, &travel));
        found.map(|heights| Ok(PyArray2::from_vec2(py, &heights)?)).transpose()
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
