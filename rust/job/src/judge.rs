//! Posted text, judged: read back, put against the part, limits taken from the job.

use std::ops::Range;

use serde::Serialize;
use styluscam_geometry::{ModelFace, Sheet, Tool, Vector};
use styluscam_motion::{Program, ToolRecord, Watch};
use styluscam_post::machine::ToolChange;
use styluscam_post::{read, Machine, Reading};
use styluscam_verify::{
    Expectation, ExpectedOperation, FaceCoverage, Forming, Grid, Limits, Need, Reach, Report, Simulation, Subject,
    TextFacts, ToolCalls,
};

use crate::heights::TipHeights;
use crate::limits::{GOUGE, NO_ROOM};
use crate::{
    faces, fixture, materials, model, scene, Coolant, JobDocument, JobError, OperationSection, Scene, SheetSection,
    Spindle,
};

/// Most that may be left on a sheet's faces where the tool cannot get, mm, where the job does not say: single-point forming
/// itself is good to half a millimetre or a whole one.
const BRIDGED: f64 = 1.0;
/// The judge's report and the program that was read.
#[derive(Clone, Debug, Serialize)]
pub struct Judgement {
    /// The report.
    pub report: Report,
    /// The moves as they were read back.
    #[serde(skip)]
    pub program: Program,
    /// Moves whose end is not known in all three axes, in runs.
    #[serde(skip)]
    unplaced: Vec<Range<usize>>,
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
    let Reading {
        program,
        unknown_positions: unplaced,
        unknown_heights,
        machine_moves,
        optional_lines,
        not_stated,
        planes_not_needed,
        stops,
        lines,
        ended,
        ..
    } = reading;
    let tool_calls = match machine.tool.change {
        ToolChange::M6 | ToolChange::T | ToolChange::ToolCall => ToolCalls::Load,
        ToolChange::Pause | ToolChange::LoadBeforeStart => ToolCalls::Name,
        ToolChange::Unsaid => ToolCalls::NotStated,
    };
    let ended = ended || machine.end.is_empty(); // some controllers have no word for it
    let text = TextFacts {
        unknown_heights,
        machine_moves,
        optional_lines,
        not_stated,
        planes_not_needed,
        stops,
        lines,
        ended,
        tool_calls,
    };
    let expected = expected(job, scene, &records)?;
    let obstacles = fixture::obstacles(job, scene)?;
    let plain = subject(job, scene, &tools, &unplaced);
    let subject = Subject { text: Some(&text), expected: &expected, obstacles: &obstacles, ..plain };
    let found = model::mismatches(job, scene);
    let limits = Limits { excess_by_operation: excess(job, &program), found, ..limits(job, scene, &tools, machine) };
    let report = styluscam_verify::judge(&program, &subject, &limits, watch)?;
    Ok(Judgement { report, program, unplaced, limits })
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
    let subject = subject(job, scene, &tools, &judgement.unplaced);
    let wanted = scene.looking_up(&faces);
    Ok(styluscam_verify::coverage(&judgement.program, &subject, &judgement.limits, &wanted, watch)?)
}

/// What a judged program leaves at points in work coordinates, mm: their distance from all that tool and sheet sweep.
///
/// # Errors
/// Tools that do not build, `Cancelled`.
pub fn left(
    job: &JobDocument,
    scene: &Scene,
    judgement: &Judgement,
    points: &[Vector],
    watch: &Watch,
) -> Result<Vec<f64>, JobError> {
    let (tools, _) = tools_in_order(job)?;
    let subject = subject(job, scene, &tools, &judgement.unplaced);
    Ok(styluscam_verify::left(&judgement.program, &subject, &judgement.limits, points, watch)?)
}

/// What each of some points of the part, with its unit normal, asks for: forming, or nothing for it stays flat.
///
/// # Errors
/// Tools that do not build, `Cancelled`.
pub fn needs(
    job: &JobDocument,
    scene: &Scene,
    judgement: &Judgement,
    points: &[(Vector, Vector)],
    watch: &Watch,
) -> Result<Vec<Need>, JobError> {
    let (tools, _) = tools_in_order(job)?;
    let subject = subject(job, scene, &tools, &judgement.unplaced);
    Ok(styluscam_verify::needs(&judgement.program, &subject, &judgement.limits, points, watch)?)
}

/// What a judged program makes of the stock: the part's box, or the sheet's blank, of which `face` is followed.
///
/// # Errors
/// A spacing that asks for too many nodes, tools that do not build, `Cancelled`.
pub fn simulate(
    job: &JobDocument,
    scene: &Scene,
    judgement: &Judgement,
    spacing: f64,
    face: Option<ModelFace>,
    watch: &Watch,
) -> Result<Simulation, JobError> {
    let (tools, _) = tools_in_order(job)?;
    let sheet = scene.sheet.map(|sheet| Sheet { model_face: face.unwrap_or(sheet.model_face), ..sheet });
    let subject = Subject { sheet, ..subject(job, scene, &tools, &judgement.unplaced) };
    let (low, high) = scene.mesh.bounds();
    let under = sheet.map_or(0.0, |sheet| sheet.raise());
    let grid = Grid::over([low.x, low.y], [high.x, high.y], spacing).map_err(JobError::geometry("spacing"))?;
    let top = scene.top - under;
    Ok(styluscam_verify::simulate(&judgement.program, &subject, &judgement.limits, grid, top, watch)?)
}

fn subject<'a>(job: &'a JobDocument, scene: &'a Scene, tools: &'a [Tool], unplaced: &'a [Range<usize>]) -> Subject<'a> {
    Subject {
        mesh: &scene.mesh,
        bvh: &scene.bvh,
        tools,
        sheet: scene.sheet,
        deviation_inward: scene.inward,
        deviation_outward: scene.outward,
        wcs: &job.setup.wcs,
        unknown_positions: unplaced,
        text: None,
        expected: &[],
        obstacles: &[],
    }
}

/// What the job states for each of its operations.
fn expected(job: &JobDocument, scene: &Scene, records: &[ToolRecord]) -> Result<Vec<ExpectedOperation>, JobError> {
    let operation = |(index, section): (usize, &OperationSection)| {
        let common = &section.common;
        Ok(ExpectedOperation {
            id: section.id(index),
            tool: records.iter().position(|record| record.name == common.tool).unwrap_or(usize::MAX),
            cut: common.feeds.cut,
            plunge: common.feeds.plunge,
            spindle: match common.spindle {
                Spindle::Off => None,
                Spindle::Fixed { rpm, direction } => Some((rpm, direction)),
            },
            flood: common.coolant == Coolant::Flood,
            expectation: expectation(job, scene, section, index)?,
        })
    };
    job.operations.iter().enumerate().map(operation).collect()
}

/// What an operation's moves and passes must do.
fn expectation(
    job: &JobDocument,
    scene: &Scene,
    section: &OperationSection,
    index: usize,
) -> Result<Expectation, JobError> {
    let heights = TipHeights::of(job, scene, section);
    Ok(Expectation {
        contact: section.kind().contact(),
        selected: scene.looking_up(&faces::of_operation(job, scene, section, index)?),
        heights: [heights.bottom, heights.top.unwrap_or(f64::INFINITY)],
        passes: section.kind().passes(section.common.smallest_feature),
        forms: job.process.process.as_kind().forms(),
    })
}

/// The tolerance of each of the text's operations, by the ids in its remarks; the widest of the job where it names none.
fn excess(job: &JobDocument, program: &Program) -> Vec<Option<f64>> {
    let tolerance = |id: &str| {
        let mut sections = job.operations.iter().enumerate();
        sections.find(|(index, section)| section.id(*index) == id).map(|(_, section)| section.common.tolerance)
    };
    let widest = job.operations.iter().map(|operation| operation.common.tolerance).reduce(f64::max);
    program.operations.iter().map(|operation| tolerance(&operation.id).or(widest)).collect()
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
    Ok(job.operations.iter().filter_map(|operation| known.remove(&operation.common.tool)).unzip())
}

/// Text is rounded: what stands at the clearance height may be half a unit of the machine below it.
fn limits(job: &JobDocument, scene: &Scene, tools: &[Tool], machine: &Machine) -> Limits {
    let clearance = scene.clearance(job) - 0.5 * machine.resolution_mm();
    let excess = job.operations.iter().map(|operation| operation.common.tolerance);
    let sheet_bridged = job.setup.sheet.map_or(f64::INFINITY, |_| BRIDGED);
    let bridged = job.process.common.max_bridged.unwrap_or(sheet_bridged);
    let narrowest = tools.iter().map(|tool| 0.5 * tool.diameter()).fold(f64::INFINITY, f64::min);
    Limits {
        gouge: GOUGE,
        excess: excess.reduce(f64::max),
        retract: scene.top + job.setup.retract - 0.5 * machine.resolution_mm(),
        feed_unit: machine.feed_resolution_mm(),
        reach: reach(machine),
        forming: job.setup.sheet.map(|sheet| forming(job, &sheet, scene.top)),
        bridged,
        unreached: job.process.common.max_unreached,
        unreached_from: if bridged.is_finite() { bridged } else { NO_ROOM * narrowest },
        accepted: job.accept.iter().map(|risk| risk.finding()).collect(),
        ..Limits::new(clearance)
    }
}

/// What the sheet bears.
fn forming(job: &JobDocument, sheet: &SheetSection, top: f64) -> Forming {
    let wall = materials::wall_angle(job, sheet);
    Forming {
        thickness: sheet.thickness,
        top,
        min_thickness: sheet.min_thickness.unwrap_or(0.0),
        max_wall_angle: wall.most_deg.to_radians(),
        sure_wall_angle: wall.sure_deg.to_radians(),
        source: wall.source,
    }
}

/// What the machine can do.
fn reach(machine: &Machine) -> Reach {
    let limits = &machine.limits;
    let rpm = (limits.min_rpm, limits.max_rpm);
    Reach {
        axes: [limits.x, limits.y, limits.z],
        travel: limits.travel,
        feed: limits.max_feed,
        rpm: (rpm != (None, None)).then(|| [rpm.0.unwrap_or(0.0), rpm.1.unwrap_or(f64::INFINITY)]),
    }
}
