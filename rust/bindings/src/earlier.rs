//! What an earlier program left of its stock.

use std::sync::Arc;

use pyo3::prelude::*;
use styluscam_job::Text;

use crate::{errors::of_job, job::Job, machine::Machine, scene::Scene};

/// What the program of a job in a text cuts of its stock, after all that was cut of it before.
#[pyclass(frozen, module = "styluscam._engine")]
pub struct Earlier {
    pub(crate) earlier: Arc<styluscam_job::Earlier>,
}

#[pymethods]
impl Earlier {
    #[new]
    fn new(py: Python<'_>, job: &Job, scene: &Scene, machine: &Machine, text: &str) -> PyResult<Self> {
        let text = Text { scene: &scene.scene, machine: &machine.machine, text };
        let earlier = py.detach(|| styluscam_job::earlier(&job.document, text)).map_err(of_job)?;
        Ok(Self { earlier: Arc::new(earlier) })
    }
}
