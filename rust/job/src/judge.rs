//! Posted text, judged: read back, put against the part, limits taken from the job.

use serde::Serialize;
use styluscam_geometry::Tool;
use styluscam_motion::{Program, ToolRecord, Watch};
use styluscam_post::{read, Machine};
use styluscam_verify::{Limits, Report, Subject};

use crate::{scene, JobDocument, JobError, Scene};

/// Deepest gouge allowed, mm: the posted path may lie this far inside the exact envelope, and not more.
const GOUGE: f64 = 0.001;

/// The judge's report and the program that was read.
#[derive(Clone, Debug, Serialize)]
pub struct Judgement {
    /// The report.
    pub report: Report,
    /// The moves as they were read back.
    #[serde(skip)]
    pub program: Program,
}

/// Reads `text` as `machine` would and judges it against the part.
///
/// # Errors
/// Text that the machine would not take, tools that do not build, `Cancelled`.
pub fn judge(
    job: &JobDocument,
    scene: &Scene,
    machine: &Machine,
    text: &str,
    watch: &Watch,
) -> Result<Judgement, JobError> {
    let (tools, records) = tools_in_order(job)?;
    let reading = read(text, machine, &records)?;
    let subject = Subject {
        mesh: &scene.mesh,
        bvh: &scene.bvh,
        tools: &tools,
        sheet: scene.sheet,
        deviation_inward: scene.inward,
        deviation_outward: scene.outward,
        wcs: &job.setup.wcs,
        first_placed_move: reading.first_placed_move,
    };
    let report = styluscam_verify::judge(&reading.program, &subject, &limits(job, scene), watch)?;
    Ok(Judgement { report, program: reading.program })
}

/// The moves of a text as `machine` would read it for this job.
///
/// # Errors
/// Text that the machine would not take, tools that do not build.
pub fn read_back(job: &JobDocument, machine: &Machine, text: &str) -> Result<Program, JobError> {
    let (_, records) = tools_in_order(job)?;
    Ok(read(text, machine, &records)?.program)
}

/// The job's tools in the order of their first use: the order in which planning lists them.
fn tools_in_order(job: &JobDocument) -> Result<(Vec<Tool>, Vec<ToolRecord>), JobError> {
    let mut known = scene::tools(job)?;
    Ok(job.operations.iter().filter_map(|operation| known.remove(&operation.tool)).unzip())
}

/// Text does not say which operation a move belongs to: the widest tolerance of the job holds for all of it.
fn limits(job: &JobDocument, scene: &Scene) -> Limits {
    let excess = job.operations.iter().map(|operation| operation.tolerance);
    Limits { gouge: GOUGE, excess: excess.reduce(f64::max), ..Limits::new(scene.clearance(job)) }
}
