//! Posted texts, checked against a job's part.

use std::collections::BTreeMap;

use numpy::{PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use styluscam_job::Text;
use styluscam_verify::{
    AxisTurning, ClearingKind, FindingKind, FlankFaceError, Need, OperationEngagement, OperationFlank, Scallop,
};

use crate::{
    arrays,
    errors::of_job,
    job::Job,
    json::json,
    machine::Machine,
    program::Program,
    scene::Scene,
    sheet::sheet_face,
    simulation::Simulation,
    waiting::{watched, CancelToken},
};

/// An operation's id; heights, points, steps and lengths of its scallops.
type OperationScallops<'py> = (
    String,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
);

/// An operation's id, its largest engagement angle and its length; arrays of its layers, of its moves (numbers and codes) and of positions.
type EngagementArrays<'py> = (
    String,
    f64,
    f64,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<u32>>,
    Bound<'py, PyArray2<f64>>,
);

/// A surface's name, what the tool enters of it, leaves on it (mm) and misses (share); how many points it was measured at along the rails
/// and along the rulings; what is left there (N,) and where they are (N, 3).
type FlankFace<'py> = (String, f64, f64, f64, [usize; 2], Bound<'py, PyArray1<f64>>, Bound<'py, PyArray2<f64>>);

/// An operation's id, its tool's axis' greatest speed (deg/s), acceleration (deg/s^2) and unevenness, and its surfaces.
type FlankArrays<'py> = (String, f64, f64, f64, Vec<FlankFace<'py>>);

/// A text that was checked.
#[pyclass(frozen, module = "styluscam._engine")]
pub struct Judgement {
    pub(crate) judgement: styluscam_job::Judgement,
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

    /// The scallops of each operation at about `count` points of its faces: its id, their heights (N,), where they are (N, 3),
    /// the distances of the passes beside them in their order (N,), and the length of ridge that each stands for (N,); mm.
    #[pyo3(signature = (job, scene, count, progress=None, cancel=None))]
    fn scallops<'py>(
        &self,
        py: Python<'py>,
        job: &Job,
        scene: &Scene,
        count: usize,
        progress: Option<&Bound<'py, PyAny>>,
        cancel: Option<&CancelToken>,
    ) -> PyResult<Vec<OperationScallops<'py>>> {
        let work = |watch: &_| styluscam_job::scallops(&job.document, &scene.scene, &self.judgement, count, watch);
        let found = watched(py, progress, cancel, work)?.map_err(of_job)?;
        let of_operation = |(id, scallops): (String, Vec<Scallop>)| {
            let values = |value: fn(&Scallop) -> f64| PyArray1::from_iter(py, scallops.iter().map(value));
            let points = arrays::matrix(py, scallops.iter().map(|scallop| scallop.at.into()))?;
            Ok((id, values(|s| s.height), points, values(|s| s.step), values(|s| s.length)))
        };
        found.into_iter().map(of_operation).collect()
    }

    /// What each operation that clears stock engages and removes: its id, the largest engagement angle (rad), the length of its feed
    /// moves; its layers (L, 4): top, floor, radius, reference of the removal rate (mm^3/min); its moves (M, 4): length up to start
    /// and end, feed (mm/min, nan where none is known), what rounding may have added to the stepover; and (M, 4): line, layer,
    /// 0 where it cuts, 1 on a link, 2 on an entry, number of positions; positions (N, 6): length up to there, tip, engagement
    /// angle (rad), stepover. Lengths mm.
    fn engagement<'py>(&self, py: Python<'py>) -> PyResult<Vec<EngagementArrays<'py>>> {
        self.judgement.report.engagement.iter().map(|found| engagement_arrays(py, found)).collect()
    }

    /// What each operation that mills with the side of a leaning tool leaves of its surfaces: its id; how its tool's axis turns (at most
    /// deg/s and deg/s^2, and unevenness); each surface's name, over, under (mm), the share that is missed, (U, V), what is left
    /// at evenly spaced shares of rails and rulings (U V,), and these points in work coordinates (U V, 3).
    fn flanks<'py>(&self, py: Python<'py>) -> PyResult<Vec<FlankArrays<'py>>> {
        let of_operation = |found: &OperationFlank| {
            let AxisTurning { speed_max, acceleration_max, unevenness } = found.turning;
            let faces = found.faces.iter().map(|face| flank_face(py, face)).collect::<PyResult<_>>()?;
            Ok((found.operation.clone(), speed_max, acceleration_max, unevenness, faces))
        };
        self.judgement.report.flanks.iter().map(of_operation).collect()
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

    /// The moves as the part sees them: the same, or the spirals that they are to a part that turns.
    #[getter]
    fn seen(&self) -> Program {
        Program { program: self.judgement.seen().clone() }
    }
}

fn engagement_arrays<'py>(py: Python<'py>, found: &OperationEngagement) -> PyResult<EngagementArrays<'py>> {
    let layers = found.layers.iter().map(|layer| [layer.top, layer.floor, layer.radius, layer.reference]);
    let numbers = found.moves.iter().map(|step| {
        let [start, end] = step.travelled;
        [start, end, step.feed.unwrap_or(f64::NAN), step.rounding]
    });
    let codes = found.moves.iter().map(|step| {
        let kind = match step.kind {
            ClearingKind::Cut => 0,
            ClearingKind::Link => 1,
            ClearingKind::Entry => 2,
        };
        [step.line, step.layer as u32, kind, step.positions.len() as u32]
    });
    let positions: Vec<[f64; 6]> = found
        .moves
        .iter()
        .flat_map(|step| &step.positions)
        .map(|at| {
            let [x, y, z] = at.tip;
            [at.travelled, x, y, z, at.angle, at.stepover]
        })
        .collect();
    Ok((
        found.operation.clone(),
        found.angle,
        found.length,
        arrays::matrix(py, layers)?,
        arrays::matrix(py, numbers)?,
        arrays::matrix(py, codes)?,
        arrays::matrix(py, positions.into_iter())?,
    ))
}

fn flank_face<'py>(py: Python<'py>, face: &FlankFaceError) -> PyResult<FlankFace<'py>> {
    let shape = [face.left.len(), face.left.first().map_or(0, Vec::len)];
    let left = PyArray1::from_iter(py, face.left.iter().flatten().copied());
    let points: Vec<[f64; 3]> = face.points.iter().flatten().copied().collect();
    let points = arrays::matrix(py, points.into_iter())?;
    Ok((face.name.clone(), face.over, face.under, face.missed, shape, left, points))
}

/// The kinds of findings, as JSON: their words for people by their codes, in the order in which a report lists them.
#[pyfunction]
pub fn finding_kinds() -> PyResult<String> {
    json(&FindingKind::all().map(|kind| (kind, kind.words())).collect::<BTreeMap<_, _>>())
}

/// Checks a text against a job's part; with the scene, the machine and the text of the channel that works together with its
/// own, where there is one.
#[pyfunction]
#[pyo3(signature = (job, scene, machine, text, beside=None, progress=None, cancel=None))]
#[allow(clippy::needless_pass_by_value, clippy::too_many_arguments)] // Python's keywords
pub fn judge(
    py: Python<'_>,
    job: &Job,
    scene: &Scene,
    machine: &Machine,
    text: &str,
    beside: Option<(Py<Scene>, Py<Machine>, String)>,
    progress: Option<&Bound<'_, PyAny>>,
    cancel: Option<&CancelToken>,
) -> PyResult<Judgement> {
    let text = Text { scene: &scene.scene, machine: &machine.machine, text };
    let beside = beside.as_ref().map(|(scene, machine, text)| Text {
        scene: &scene.get().scene,
        machine: &machine.get().machine,
        text,
    });
    let work = |watch: &_| styluscam_job::judge(&job.document, text, beside, watch);
    let judgement = watched(py, progress, cancel, work)?.map_err(of_job)?;
    Ok(Judgement { judgement })
}
