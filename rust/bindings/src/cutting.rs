//! Feeds and speeds from tables of cutting data.

use pyo3::prelude::*;
use serde::Deserialize;
use styluscam_geometry::CutterMaterial;
use styluscam_job::{Cut, CuttingTable, CuttingWork, Engagement, MachineLimits};

use crate::{errors, errors::of_job, json::json, tool::Tool};

/// What is asked; see `styluscam.cutting_data`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Request {
    material: String,
    work: String,
    cutter_material: CutterMaterial,
    flutes: Option<u32>,
    pitch: Option<f64>,
    engagement: Engagement,
    limits: MachineLimits,
}

/// The shipped table, behind a shop's own (TOML) where one is given.
pub(crate) fn table_of(own: Option<&str>) -> PyResult<CuttingTable> {
    let shipped = CuttingTable::shipped();
    own.map_or_else(|| Ok(shipped.clone()), |text| Ok(CuttingTable::from_toml(text).map_err(of_job)?.before(shipped)))
}

/// Speed of the spindle and feeds for a cut, asked and answered in JSON.
#[pyfunction]
#[pyo3(signature = (tool, request, table=None))]
pub fn cutting_data(tool: &Tool, request: &str, table: Option<&str>) -> PyResult<String> {
    let wrong = |error: serde_json::Error| errors::raise("JobError", &error.to_string(), "argument", "", "");
    let asked: Request = serde_json::from_str(request).map_err(wrong)?;
    let cut = Cut {
        cutter: &tool.cutter,
        cutter_material: asked.cutter_material,
        flutes: asked.flutes,
        material: &asked.material,
        work: CuttingWork::named(&asked.work).map_err(of_job)?,
        engagement: asked.engagement,
        pitch: asked.pitch,
        limits: asked.limits,
    };
    json(&styluscam_job::cutting_data(&cut, &table_of(table)?).map_err(of_job)?)
}

/// The shipped table, behind a shop's own (TOML) where one is given, as JSON.
#[pyfunction]
#[pyo3(signature = (own=None))]
pub fn cutting_table(own: Option<&str>) -> PyResult<String> {
    json(&table_of(own)?.listed())
}

/// The shipped tables as their files have them: TOML.
#[pyfunction]
pub fn shipped_cutting_tables() -> Vec<&'static str> {
    styluscam_job::shipped_texts().to_vec()
}
