//! Feeds and spindles that a job leaves out, where it states what is milled.

use serde::Serialize;
use serde_json::Value;
use styluscam_geometry::Tool;
use styluscam_motion::SpindleDirection;

use super::rules::{cutting_data, Cut, CuttingData, MachineLimits};
use super::table::CuttingTable;
use crate::operations::{Machining, OperationSection, Spindle};
use crate::{check, resolve, JobDocument, JobError};

/// What an operation got.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Filled {
    /// The operation's name.
    pub id: String,
    /// What was worked out for it; what the job states goes before that.
    pub data: CuttingData,
}

/// What the job states of an operation.
#[derive(Clone, Copy)]
struct Stated {
    cut: bool,
    plunge: bool,
    spindle: bool,
}

impl Stated {
    /// Of operation `index` in the document as its author wrote it.
    fn of(written: &Value, index: usize) -> Self {
        let has =
            |key: &str| written.pointer(&format!("/operations/{index}/{key}")).is_some_and(|value| !value.is_null());
        Self { cut: has("feeds/cut"), plunge: has("feeds/plunge"), spindle: has("spindle") }
    }
}

/// Refuses an operation that cuts, where `written`, the document as its author wrote it, neither states its spindle nor what it follows from:
/// what is left out is a spindle that stands, and a cutter that stands breaks.
///
/// # Errors
/// An operation without a spindle in a job that cuts, and that names no material.
pub(crate) fn spindles_stated(job: &JobDocument, written: &Value) -> Result<(), JobError> {
    if job.process.process.as_kind().forms() || job.process.cut_material().is_some() {
        return Ok(());
    }
    let is_missing = |index: &usize| !Stated::of(written, *index).spindle;
    let Some(index) = (0..job.operations.len()).find(is_missing) else { return Ok(()) };
    let message = "the spindle is not stated, and a cutter must turn";
    let hint = "add process.material, which speeds and feeds follow from, or spindle = { mode = \"fixed\", rpm = 8000 } with the tool's speed; \
                spindle = { mode = \"off\" } for a run that does not cut";
    Err(JobError::document("missing", format!("operations[{index}].spindle"), message, hint))
}

/// The job with the feeds and spindles that `written`, the document as its author wrote it, leaves out; as it is where it does not state
/// what is milled.
///
/// # Errors
/// A material, cutter or size that the table does not have; a tool that does not state its flutes or what it is made of.
pub fn with_cutting_data(
    job: &JobDocument,
    written: &Value,
    table: &CuttingTable,
    limits: MachineLimits,
) -> Result<(JobDocument, Vec<Filled>), JobError> {
    let (mut job, mut filled) = (job.clone(), Vec::new());
    let Some(material) = job.process.cut_material().map(str::to_owned) else { return Ok((job, filled)) };
    table.material(&material).map_err(|error| error.at("process.material"))?;
    let tools = resolve::tools(&job)?;
    for (index, section) in job.operations.iter_mut().enumerate() {
        let stated = Stated::of(written, index);
        let turns = !stated.spindle || matches!(section.common.spindle, Spindle::Fixed { .. });
        let Some((tool, _)) = tools.get(&section.common.tool).filter(|_| turns) else { continue };
        if stated.cut && stated.plunge && stated.spindle {
            continue;
        }
        let limits = if stated.spindle { at_speed(section, limits) } else { limits };
        let data = data_of(section, index, (tool, &material), table, limits)?;
        take(section, stated, &data);
        filled.push(Filled { id: section.id(index), data });
    }
    check::document(&job)?;
    Ok((job, filled))
}

/// The machine's limits with the spindle at the speed that the job states.
fn at_speed(section: &OperationSection, limits: MachineLimits) -> MachineLimits {
    let rpm = section.common.spindle.rpm();
    MachineLimits { min_rpm: rpm.or(limits.min_rpm), max_rpm: rpm.or(limits.max_rpm), ..limits }
}

/// What the table states for an operation with its tool and material.
///
/// # Errors
/// As those of [`with_cutting_data`].
pub fn data_of(
    section: &OperationSection,
    index: usize,
    (tool, material): (&Tool, &str),
    table: &CuttingTable,
    limits: MachineLimits,
) -> Result<CuttingData, JobError> {
    let name = &section.common.tool;
    let missing = |key: &str, example: &str| {
        let message = format!("feeds of operations[{index}] follow from the tool, and {key} is missing");
        let hint = format!("add {key} = {example} to [tools.{name}], or feeds and spindle to the operation");
        JobError::document("missing", format!("tools.{name}.{key}"), message, hint)
    };
    let document = tool.document();
    let Machining { work, engagement, pitch } = section.kind().cutting();
    let cut = Cut {
        cutter: &tool.cutter(),
        cutter_material: document.cutter_material.ok_or_else(|| missing("cutter_material", "\"carbide\""))?,
        flutes: Some(document.flutes.ok_or_else(|| missing("flutes", "2"))?),
        material,
        work,
        engagement,
        pitch,
        limits,
    };
    cutting_data(&cut, table).map_err(|error| match error.location().as_str() {
        "material" => error.at("process.material"),
        "diameter" => error.at(&format!("tools.{name}.profile.diameter")),
        _ => error.at(&format!("operations[{index}]")),
    })
}

/// Puts in what is not stated, in whole numbers.
fn take(section: &mut OperationSection, stated: Stated, data: &CuttingData) {
    let whole = |value: f64| if value >= 1.0 { value.floor() } else { value };
    if !stated.cut {
        section.common.feeds.cut = whole(data.feed);
    }
    if !stated.plunge {
        section.common.feeds.plunge = whole(data.plunge).min(section.common.feeds.cut);
    }
    if !stated.spindle {
        section.common.spindle = Spindle::Fixed { rpm: whole(data.rpm), direction: SpindleDirection::Clockwise };
    }
}
