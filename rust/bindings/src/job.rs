//! Jobs: documents, scenes, plans, posted text and its judgement.

use std::cell::RefCell;
use std::collections::BTreeMap;

use numpy::{PyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use styluscam_job::{JobDocument, JobError, StarterFace, StarterPart, Summary};
use styluscam_verify::Need;

use crate::{
    arrays, errors,
    machine::Machine,
    part::Part,
    program::Program,
    simulation::{face_name, sheet_face, Simulation},
    waiting::{watched, CancelToken},
};

fn json<T: serde::Serialize>(value: &T) -> PyResult<String> {
    serde_json::to_string(value).map_err(|e| errors::raise("StylusError", &e.to_string(), "internal", "", ""))
}

#[allow(clippy::needless_pass_by_value)] // for map_err
fn of_job(error: JobError) -> PyErr {
    errors::of_job(&error)
}

/// A checked job document; see `styluscam.Job`.
#[pyclass(frozen, module = "styluscam._engine")]
pub struct Job {
    document: JobDocument,
}

#[pymethods]
impl Job {
    #[staticmethod]
    fn from_toml(text: &str) -> PyResult<Self> {
        Ok(Self { document: styluscam_job::from_toml(text).map_err(of_job)? })
    }

    #[staticmethod]
    fn from_json(text: &str) -> PyResult<Self> {
        Ok(Self { document: styluscam_job::from_json(text).map_err(of_job)? })
    }

    /// The document with all defaults, as JSON.
    fn to_json(&self) -> PyResult<String> {
        json(&self.document)
    }

    /// The names of its operations.
    fn operation_ids(&self) -> Vec<String> {
        self.document.operations.iter().enumerate().map(|(index, section)| section.id(index)).collect()
    }

    /// How far the passes of an operation lie apart, as JSON: in height, or in plan across straight rows; None where they do
    /// not lie in step.
    fn spacing(&self, index: usize) -> PyResult<Option<String>> {
        let section = self.document.operations.get(index);
        section.and_then(|section| section.kind().spacing()).map(|spacing| json(&spacing.described())).transpose()
    }

    /// Whether its process forms a sheet; else it cuts.
    #[getter]
    fn forms(&self) -> bool {
        self.document.process.process.as_kind().forms()
    }

    /// What planning each operation will take, as JSON.
    fn estimates(&self, py: Python<'_>, part: &Part) -> PyResult<String> {
        json(&py.detach(|| styluscam_job::estimates(&self.document, &part.part)))
    }
}

/// Name, corners of the opening, heights of the lower and the upper face.
type Plate = (&'static str, Vec<[f64; 2]>, [f64; 2]);

/// The part as it lies on the machine.
#[pyclass(frozen, module = "styluscam._engine")]
pub struct Scene {
    pub(crate) scene: styluscam_job::Scene,
}

#[pymethods]
impl Scene {
    #[new]
    fn new(py: Python<'_>, job: &Job, part: &Part) -> PyResult<Self> {
        let scene = py.detach(|| styluscam_job::Scene::new(&job.document, &part.part)).map_err(of_job)?;
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
    fn fixture(&self, job: &Job) -> Vec<Plate> {
        let plates = styluscam_job::plates(&job.document, &self.scene);
        plates.into_iter().map(|plate| (plate.holder.name(), plate.opening, plate.heights)).collect()
    }

    /// Radius (mm) up to which a tool from above fits nearly all concave places; None where nothing bounds it.
    #[getter]
    fn fitting_radius(&self, py: Python<'_>) -> Option<f64> {
        py.detach(|| styluscam_job::fitting_radius(&self.scene.mesh, &self.scene.bvh))
    }

    /// The sheet's face that the part is, where there is a sheet.
    #[getter]
    fn model_face(&self) -> Option<&'static str> {
        self.scene.sheet.map(|sheet| face_name(sheet.model_face))
    }
}

/// A planned program.
#[pyclass(frozen, module = "styluscam._engine")]
pub struct Plan {
    plan: styluscam_job::Plan,
}

#[pymethods]
impl Plan {
    /// The programs by channel; "main" is always there.
    #[getter]
    fn programs(&self) -> BTreeMap<&'static str, Program> {
        let programs = self.plan.channels.iter();
        programs.map(|(name, channel)| (*name, Program { program: channel.program.clone() })).collect()
    }

    /// The summary of a channel as JSON and the lines for its header; with the judgement of its text where there is one.
    #[pyo3(signature = (channel, scene, machine, judgement=None))]
    fn summary(
        &self,
        channel: &str,
        scene: &Scene,
        machine: &Machine,
        judgement: Option<&Judgement>,
    ) -> PyResult<(String, Vec<String>)> {
        let planned = self.plan.channels.get(channel).ok_or_else(|| {
            let known: Vec<&str> = self.plan.channels.keys().copied().collect();
            let message = format!("no channel is called {channel:?}");
            errors::raise("StylusError", &message, "argument", "channel", &format!("the plan has {}", known.join(", ")))
        })?;
        let summary = Summary::new(planned, &scene.scene, &machine.machine, judgement.map(|j| &j.judgement));
        Ok((json(&summary)?, summary.notes()))
    }
}

/// Plans every operation of a job.
#[pyfunction]
#[pyo3(signature = (job, scene, machine, progress=None, cancel=None))]
pub fn plan(
    py: Python<'_>,
    job: &Job,
    scene: &Scene,
    machine: &Machine,
    progress: Option<&Bound<'_, PyAny>>,
    cancel: Option<&CancelToken>,
) -> PyResult<Plan> {
    let work = |watch: &_| styluscam_job::plan(&job.document, &scene.scene, &machine.machine, watch);
    let plan = watched(py, progress, cancel, work)?.map_err(of_job)?;
    Ok(Plan { plan })
}

/// The program that a text of the RS-274NGC language makes, and in words what is not shown of it.
///
/// `find` gives the text of a subroutine's file by its name, or None; what it raises is passed on.
#[pyfunction]
#[pyo3(signature = (text, find, progress=None, cancel=None))]
pub fn trace_gcode(
    py: Python<'_>,
    text: &str,
    find: Py<PyAny>,
    progress: Option<&Bound<'_, PyAny>>,
    cancel: Option<&CancelToken>,
) -> PyResult<(Program, Vec<String>)> {
    let (traced, raised) = watched(py, progress, cancel, move |watch| {
        let raised = RefCell::new(None);
        let found = |name: &str| {
            Python::attach(|py| find.call1(py, (name,))?.extract::<Option<String>>(py)).unwrap_or_else(|error| {
                raised.borrow_mut().get_or_insert(error);
                watch.cancel();
                None
            })
        };
        let traced = styluscam_post::trace(text, &found, watch);
        (traced, raised.into_inner())
    })?;
    if let Some(error) = raised {
        return Err(error);
    }
    let trace = traced.map_err(|error| errors::of_trace(&error))?;
    let notes = trace.notes.iter().map(ToString::to_string).collect();
    Ok((Program { program: trace.program }, notes))
}

/// The moves of a text as a machine would read it for this job.
#[pyfunction]
pub fn read_back(py: Python<'_>, job: &Job, machine: &Machine, text: &str) -> PyResult<Program> {
    let program = py.detach(|| styluscam_job::read_back(&job.document, &machine.machine, text));
    Ok(Program { program: program.map_err(of_job)? })
}

/// A judged text.
#[pyclass(frozen, module = "styluscam._engine")]
pub struct Judgement {
    judgement: styluscam_job::Judgement,
}

#[pymethods]
impl Judgement {
    /// The report as JSON.
    fn report(&self) -> PyResult<String> {
        json(&self.judgement.report)
    }

    /// What is left on the job's faces, as JSON.
    #[pyo3(signature = (job, scene, progress=None, cancel=None))]
    fn coverage(
        &self,
        py: Python<'_>,
        job: &Job,
        scene: &Scene,
        progress: Option<&Bound<'_, PyAny>>,
        cancel: Option<&CancelToken>,
    ) -> PyResult<String> {
        let work = |watch: &_| styluscam_job::coverage(&job.document, &scene.scene, &self.judgement, watch);
        json(&watched(py, progress, cancel, work)?.map_err(of_job)?)
    }

    /// What is left at points (N, 3) in work coordinates, (N,), mm.
    #[pyo3(signature = (job, scene, points, progress=None, cancel=None))]
    #[allow(clippy::needless_pass_by_value)] // PyO3 hands arrays by value
    fn left<'py>(
        &self,
        py: Python<'py>,
        job: &Job,
        scene: &Scene,
        points: PyReadonlyArray2<'py, f64>,
        progress: Option<&Bound<'py, PyAny>>,
        cancel: Option<&CancelToken>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let points = arrays::vectors(&points, "points")?;
        let work = |watch: &_| styluscam_job::left(&job.document, &scene.scene, &self.judgement, &points, watch);
        Ok(PyArray1::from_vec(py, watched(py, progress, cancel, work)?.map_err(of_job)?))
    }

    /// What points (N, 3) of the part in work coordinates ask for, with their unit normals (N, 3), (N,): 0 forming; 1
    /// nothing, the blank lies there; 2 nothing, they go down flat with the passes around them.
    #[pyo3(signature = (job, scene, points, normals, progress=None, cancel=None))]
    #[allow(clippy::needless_pass_by_value, clippy::too_many_arguments)] // PyO3 hands arrays by value; Python's keywords
    fn needs<'py>(
        &self,
        py: Python<'py>,
        job: &Job,
        scene: &Scene,
        points: PyReadonlyArray2<'py, f64>,
        normals: PyReadonlyArray2<'py, f64>,
        progress: Option<&Bound<'_, PyAny>>,
        cancel: Option<&CancelToken>,
    ) -> PyResult<Bound<'py, PyArray1<u8>>> {
        let (points, normals) = (arrays::vectors(&points, "points")?, arrays::vectors(&normals, "normals")?);
        let pairs: Vec<_> = points.into_iter().zip(normals).collect();
        let work = |watch: &_| styluscam_job::needs(&job.document, &scene.scene, &self.judgement, &pairs, watch);
        let number = |need| match need {
            Need::Forming => 0,
            Need::Flat => 1,
            Need::Carried => 2,
        };
        let needs = watched(py, progress, cancel, work)?.map_err(of_job)?;
        Ok(PyArray1::from_vec(py, needs.into_iter().map(number).collect()))
    }

    /// The material after the program; `face` of the sheet is "tool", "mid" or "back".
    #[pyo3(signature = (job, scene, spacing, face=None, progress=None, cancel=None))]
    #[allow(clippy::too_many_arguments)] // Python's keywords
    fn simulate(
        &self,
        py: Python<'_>,
        job: &Job,
        scene: &Scene,
        spacing: f64,
        face: Option<&str>,
        progress: Option<&Bound<'_, PyAny>>,
        cancel: Option<&CancelToken>,
    ) -> PyResult<Simulation> {
        let face = face.map(sheet_face).transpose()?;
        let work =
            |watch: &_| styluscam_job::simulate(&job.document, &scene.scene, &self.judgement, spacing, face, watch);
        Ok(Simulation { simulation: watched(py, progress, cancel, work)?.map_err(of_job)? })
    }

    /// The moves as they were read back.
    #[getter]
    fn program(&self) -> Program {
        Program { program: self.judgement.program.clone() }
    }
}

/// Judges a text against a job's part.
#[pyfunction]
#[pyo3(signature = (job, scene, machine, text, progress=None, cancel=None))]
pub fn judge(
    py: Python<'_>,
    job: &Job,
    scene: &Scene,
    machine: &Machine,
    text: &str,
    progress: Option<&Bound<'_, PyAny>>,
    cancel: Option<&CancelToken>,
) -> PyResult<Judgement> {
    let work = |watch: &_| styluscam_job::judge(&job.document, &scene.scene, &machine.machine, text, watch);
    let judgement = watched(py, progress, cancel, work)?.map_err(of_job)?;
    Ok(Judgement { judgement })
}

/// The JSON Schema of the job document.
#[pyfunction]
pub fn job_schema() -> PyResult<String> {
    json(&styluscam_job::schema())
}

/// The materials of sheets that are known, as JSON: names, wall angles in degrees by thickness in mm, sources.
#[pyfunction]
pub fn materials() -> PyResult<String> {
    json(&styluscam_job::materials())
}

/// A face for a starter job: name, kind, area (mm^2), smallest and largest slope (degrees).
type ListedFace = (String, String, f64, [f64; 2]);

/// A commented job for a part that has none yet, and the sentences that say why it is so.
#[pyfunction]
#[pyo3(signature = (part, file, faces, units=None, edge_gap=0.0))]
pub fn starter(
    py: Python<'_>,
    part: &Part,
    file: &str,
    faces: Vec<ListedFace>,
    units: Option<&str>,
    edge_gap: f64,
) -> (String, Vec<String>) {
    let faces: Vec<StarterFace> =
        faces.into_iter().map(|(name, kind, area, slope_deg)| StarterFace { name, kind, area, slope_deg }).collect();
    let mesh = &part.part.mesh;
    let made = py.detach(|| styluscam_job::starter(&StarterPart { file, units, mesh, faces: &faces, edge_gap }));
    (made.text, made.reasons)
}
