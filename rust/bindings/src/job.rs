//! Job documents.

use pyo3::prelude::*;
use styluscam_job::{JobDocument, MachineLimits};

use crate::channel::channel_of;
use crate::cutting::table_of;
use crate::errors::{of_job, raise};
use crate::{json::json, part::Part};

/// A checked job document; see `styluscam.Job`.
#[pyclass(frozen, module = "styluscam._engine")]
pub struct Job {
    pub(crate) document: JobDocument,
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

    /// The job with the feeds and spindles that its document as it was written (JSON) leaves out, and what they follow from, as JSON:
    /// `own` is a shop's table (TOML), `limits` the machine's (JSON).
    fn with_cutting_data(&self, written: &str, own: Option<&str>, limits: &str) -> PyResult<(Self, String)> {
        let wrong = |error: serde_json::Error| raise("JobError", &error.to_string(), "argument", "", "");
        let written: serde_json::Value = serde_json::from_str(written).map_err(wrong)?;
        let limits: MachineLimits = serde_json::from_str(limits).map_err(wrong)?;
        let (document, filled) =
            styluscam_job::with_cutting_data(&self.document, &written, &table_of(own)?, limits).map_err(of_job)?;
        Ok((Self { document }, json(&filled)?))
    }

    /// The names of its operations.
    fn operation_ids(&self) -> Vec<String> {
        self.document.operations.iter().enumerate().map(|(index, section)| section.id(index)).collect()
    }

    /// The channels of its process: programs that run side by side; "main" first.
    #[getter]
    fn channels(&self) -> Vec<&'static str> {
        self.document.channels().to_vec()
    }

    /// The machine of a channel as JSON: its section of the document.
    fn machine_of(&self, channel: &str) -> PyResult<String> {
        json(&self.document.machine_of(self.channel(channel)?))
    }

    /// The channel that works together with another, move by move; None where there is none.
    fn partner_of(&self, channel: &str) -> PyResult<Option<&'static str>> {
        Ok(self.document.partner_of(self.channel(channel)?))
    }

    /// How far the passes of an operation lie apart, as JSON: in height, or in plan across straight rows; None where they do
    /// not lie in step.
    fn spacing(&self, index: usize) -> PyResult<Option<String>> {
        let section = self.document.operations.get(index);
        section.and_then(|section| section.kind().spacing()).map(|spacing| json(&spacing.described())).transpose()
    }

    /// Whether it changes its part before it is planned: against springback.
    #[getter]
    fn shapes(&self) -> bool {
        styluscam_job::is_shaped(&self.document)
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

impl Job {
    /// The name of a channel, if the job has it.
    pub(crate) fn channel(&self, name: &str) -> PyResult<&'static str> {
        channel_of(name, self.document.channels().iter().map(|channel| (*channel, *channel)), "JobError")
    }
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
