//! Posted text, judged: read back, put against the part, limits taken from the job.

use serde::Serialize;
use styluscam_geometry::Tool;
use styluscam_motion::{Program, ToolRecord, Watch};
use styluscam_post::{read, Machine};
use styluscam_verify::{FaceCoverage, Limits, Report, Subject};

use crate::{faces, scene, JobDocument, JobError, Scene};

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
    /// Index of the first move whose end is known in all three axes.
    #[serde(skip)]
    first_placed_move: usize,
    /// What was allowed.
    #[serde(skip)]
    limits: Limits,
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
    let subject = subject(job, scene, &tools, reading.first_placed_move);
    let limits = limits(job, scene, machine);
    let report = styluscam_verify::judge(&reading.program, &subject, &limits, watch)?;
    Ok(Judgement { report, program: reading.program, first_placed_move: reading.first_placed_move, limits })
}

/// What a judged program leaves on the faces that the job's operations are for, face by face.
///
/// # Errors
/// Tools that do not build, `Cancelled`.
pub fn coverage(
    job: &JobDocument,
    scene: &Scene,
    judgement: &Judgement,
    watch: &Watch,
) -> Result<Vec<FaceCoverage>, JobError> {
    let (tools, _) = tools_in_order(job)?;
    let mut faces = Vec::new();
    for (index, section) in job.operations.iter().enumerate() {
        faces.extend(faces::of_operation(job, scene, section, index)?);
    }
    let subject = subject(job, scene, &tools, judgement.first_placed_move);
    let wanted = scene.looking_up(&faces);
    Ok(styluscam_verify::coverage(&judgement.program, &subject, &judgement.limits, &wanted, watch)?)
}

fn subject<'a>(job: &'a JobDocument, scene: &'a Scene, tools: &'a [Tool], first_placed_move: usize) -> Subject<'a> {
    Subject {
        mesh: &scene.mesh,
        bvh: &scene.bvh,
        tools,
        sheet: scene.sheet,
        deviation_inward: scene.inward,
        deviation_outward: scene.outward,
        wcs: &job.setup.wcs,
        first_placed_move,
    }
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
///
/// Text is rounded: what stands at the clearance height may be half a unit of the machine below it.
fn limits(job: &JobDocument, scene: &Scene, machine: &Machine) -> Limits {
    let clearance = scene.clearance(job) - 0.5 * machine.resolution_mm();
    let excess = job.operations.iter().map(|operation| operation.tolerance);
    Limits { gouge: GOUGE, excess: excess.reduce(f64::max), ..Limits::new(clearance) }
}
