//! Planned programs and their summaries.

use std::collections::BTreeMap;

use pyo3::prelude::*;
use styluscam_job::{Setting, Summary};

use crate::{
    channel::channel_of,
    errors::{of_job, raise},
    job::Job,
    json::json,
    machine::Machine,
    program::Program,
    scene::Scene,
    verification::Judgement,
    waiting::{watched, CancelToken},
};

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

    /// The summary of a channel as JSON and the lines for its header; with the verification of its text where there is one.
    #[pyo3(signature = (channel, scene, machine, judgement=None))]
    fn summary(
        &self,
        channel: &str,
        scene: &Scene,
        machine: &Machine,
        judgement: Option<&Judgement>,
    ) -> PyResult<(String, Vec<String>)> {
        let planned =
            channel_of(channel, self.plan.channels.iter().map(|(name, planned)| (*name, planned)), "PlanError")?;
        if let Some(other) = judgement.map(|j| j.judgement.channel).filter(|other| *other != channel) {
            let message = format!("judgement: the verification is of channel {other:?}, the summary of {channel:?}");
            return Err(raise(
                "StylusError",
                &message,
                "argument",
                "judgement",
                "give the verification of the same channel",
            ));
        }
        let summary = Summary::new(planned, &scene.scene, &machine.machine, judgement.map(|j| &j.judgement));
        Ok((json(&summary)?, summary.notes()))
    }
}

/// Plans every operation of a job, each for the scene and the machine of its channel.
#[pyfunction]
#[pyo3(signature = (job, settings, progress=None, cancel=None))]
#[allow(clippy::needless_pass_by_value)] // PyO3 hands lists by value
pub fn plan(
    py: Python<'_>,
    job: &Job,
    settings: Vec<(Py<Scene>, Py<Machine>)>,
    progress: Option<&Bound<'_, PyAny>>,
    cancel: Option<&CancelToken>,
) -> PyResult<Plan> {
    let work = |watch: &_| {
        let settings: Vec<Setting<'_>> = settings
            .iter()
            .map(|(scene, machine)| Setting { scene: &scene.get().scene, machine: &machine.get().machine })
            .collect();
        styluscam_job::plan(&job.document, &settings, watch)
    };
    let plan = watched(py, progress, cancel, work)?.map_err(of_job)?;
    Ok(Plan { plan })
}
