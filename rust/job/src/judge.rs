//! Posted text, checked: read back, compared with the part, limits taken from the job. A text is one channel's, and a scene
//! states whose.

use std::f64::consts::FRAC_PI_2;
use std::ops::Range;

use serde::Serialize;
use styluscam_geometry::{ModelFace, Sheet, SheetLaw, Stock, Tool, Vector};
use styluscam_motion::{EventKind, Move, Program, ToolRecord, Watch};
use styluscam_post::machine::{Rapids, ToolChange};
use styluscam_post::{read, Machine};
use styluscam_verify::{
    cut_by, is_named, turned, Axes, Contact, Expectation, ExpectedOperation, FaceCoverage, Forming, Grid, Left, Limits,
    Need, Obstacle, Pairing, Partner, Passes, Reach, Report, Scallop, Simulation, Subject, TextFacts, TooLong,
    ToolCalls,
};

use crate::limits::{GOUGE, NO_ROOM};
use crate::numbers::shown;
use crate::operations::{LeadForm, LinkHeight};
use crate::resolve::{check_part, faces_of, heights_of, layers_of, passes_of, region_of, tools_in_order};
use crate::{
    clamp, forming, materials, model, plates, portion, spindle, Coolant, Earlier, JobDocument, JobError,
    OperationSection, Scene, SheetSection,
};

/// Most that may be left on a sheet's faces where the tool cannot get, mm, where the job does not state it: single-point forming
/// itself is good to half a millimetre or a whole one.
const BRIDGED: f64 = 1.0;

/// The verifier's report and the program that was read.
#[derive(Clone, Debug, Serialize)]
pub struct Judgement {
    /// The channel that the text is for.
    #[serde(skip)]
    pub channel: &'static str,
    /// The report.
    pub report: Report,
    /// The moves as they were read back.
    #[serde(skip)]
    pub program: Program,
    /// The same as the part sees them, where the spindle turns it.
    #[serde(skip)]
    turned: Option<Program>,
    /// Moves of what the part sees whose end is not known in all three axes, in runs.
    #[serde(skip)]
    unknown_positions: Vec<Range<usize>>,
    /// What was allowed.
    #[serde(skip)]
    limits: Limits,
}

impl Judgement {
    /// The moves as the part sees them: those of the axes, or the spirals that they are to a part that turns.
    #[must_use]
    pub fn seen(&self) -> &Program {
        self.turned.as_ref().unwrap_or(&self.program)
    }
}

/// What a channel's text is compared with.
struct Against<'a> {
    scene: &'a Scene,
    wcs: &'a str,
    tools: Vec<Tool>,
    records: Vec<ToolRecord>,
    expected: Vec<ExpectedOperation>,
}

impl<'a> Against<'a> {
    fn new(job: &'a JobDocument, scene: &'a Scene) -> Result<Self, JobError> {
        let (tools, records) = tools_in_order(job, scene.channel)?;
        let expected = expected(job, scene, &tools, &records)?;
        Ok(Self { scene, wcs: &job.setup.wcs, tools, records, expected })
    }

    /// What a program is checked against whose moves have `unknown_positions`; without its text and obstacles.
    fn subject<'s>(&'s self, unknown_positions: &'s [Range<usize>]) -> Subject<'s> {
        Subject {
            mesh: &self.scene.mesh,
            bvh: &self.scene.bvh,
            tools: &self.tools,
            sheet: self.scene.sheet,
            stock: self.scene.stock.as_ref(),
            stock_is_stated: self.scene.stock_words.is_some(),
            before: self.scene.earlier.as_deref().map(|earlier| &earlier.cut),
            deviation_inward: self.scene.inward,
            deviation_outward: self.scene.outward,
            wcs: self.wcs,
            unknown_positions,
            axes: None,
            text: None,
            expected: &self.expected,
            obstacles: &[],
            pairing: Pairing::Alone,
        }
    }
}

/// A text with the channel that it is for.
#[derive(Clone, Copy)]
pub struct Text<'a> {
    /// The part as it lies on the channel's machine.
    pub scene: &'a Scene,
    /// The machine.
    pub machine: &'a Machine,
    /// What it reads.
    pub text: &'a str,
}

/// Reads a text as its machine would and checks it against the part; together with the text `beside` it, where the process
/// has a channel that works with its own.
///
/// # Errors
/// Text that the machine would not take, tools that do not build, `Cancelled`.
pub fn judge(
    job: &JobDocument,
    text: Text<'_>,
    beside: Option<Text<'_>>,
    watch: &Watch,
) -> Result<Judgement, JobError> {
    let prepared = Prepared::new(job, text)?;
    let partner = job.partner_of(text.scene.channel);
    let other = partner.and(beside).map(|other| Prepared::new(job, other)).transpose()?;
    let other = other.as_ref().map(|other| (other, other.subject(Pairing::Alone)));
    let with = other.as_ref().map(|(other, subject)| Partner {
        program: &other.reading.program,
        subject,
        limits: &other.limits,
        follows: other.against.scene.opposite.is_some(),
        left: left_between(other.against.scene, text.scene),
    });
    let pairing = match (&with, partner) {
        (Some(partner), _) => Pairing::With(partner),
        (None, Some(channel)) => Pairing::Missing { channel },
        (None, None) => Pairing::Alone,
    };
    let report =
        styluscam_verify::judge(&prepared.reading.program, &prepared.subject(pairing), &prepared.limits, watch)?;
    let report = with_stages(job, text.scene, text.machine, &prepared.reading, report, watch)?;
    let Prepared { reading: Reading { program, unknown_positions, axes, .. }, limits, .. } = prepared;
    // rotary axes lead back to the moves in the part, a spindle does not
    let (program, turned) = match axes.filter(|_| job.process.process.as_kind().turns_part()) {
        Some((of_axes, _)) => (of_axes, Some(program)),
        None => (program, None),
    };
    Ok(Judgement { channel: text.scene.channel, report, program, turned, unknown_positions, limits })
}

/// What the program of a job, as it reads in a text, cuts of its stock, after all that was cut of it before.
///
/// # Errors
/// Text that the machine would not take, or that is not the job's; a part that turns; a job without stock.
pub fn earlier(job: &JobDocument, text: Text<'_>) -> Result<Earlier, JobError> {
    let refused = |code, message: String, hint| Err(JobError::document(code, "setup.stock.job", message, hint));
    let scene = text.scene;
    let Some(stock) = &scene.stock else {
        let message = "the earlier job forms a sheet, and has no stock".to_owned();
        return refused("conflict", message, "name a job that mills");
    };
    let prepared = Prepared::new(job, text)?;
    let Reading { program, axes, .. } = &prepared.reading;
    let missing = |expected: &&ExpectedOperation| !program.operations.iter().any(|own| is_named(&expected.id, &own.id));
    if let Some(expected) = prepared.against.expected.iter().find(missing) {
        let message = format!("the earlier program has no operation {:?}: it is not that of its job", expected.id);
        return refused("another-program", message, "post the earlier job again, or name its file by file");
    }
    if axes.is_some() {
        let message = "the earlier program turns the part, and what it cuts of the stock is not known".to_owned();
        return refused("conflict", message, "name a job for a machine of three axes");
    }
    let mut upcoming = program.upcoming();
    let mut tool = 0;
    let with_tool = |(index, step): (usize, &Move)| {
        for event in upcoming.before(index) {
            if let EventKind::ToolChange { tool: called } = event {
                tool = *called;
            }
        }
        Move { operation: tool, ..*step }
    };
    let moves = program.moves.iter().enumerate().map(with_tool).collect();
    let words = scene.stock_words.clone().unwrap_or_else(|| "the part's box".to_owned());
    let own = Earlier {
        stock: stock.clone(),
        words,
        frame: scene.frame,
        part: scene.mesh.bounds(),
        deviation: scene.inward.max(scene.outward),
        moves,
        tools: prepared.against.tools.clone(),
        cut: cut_by(program, &prepared.subject(Pairing::Alone), &prepared.limits),
    };
    Ok(match &scene.earlier {
        Some(before) => own.after(before),
        None => own,
    })
}

/// Adds to the report of a whole text what its intermediate stages are found to do to their own shapes.
///
/// # Errors
/// Tools that do not build, `Cancelled`.
fn with_stages(
    job: &JobDocument,
    scene: &Scene,
    machine: &Machine,
    reading: &Reading,
    mut whole: Report,
    watch: &Watch,
) -> Result<Report, JobError> {
    for stage in &scene.stages {
        let against = Against::new(job, stage)?;
        let ids: Vec<&str> = against.expected.iter().map(|operation| operation.id.as_str()).collect();
        let (program, unknown) = portion::own(&reading.program, &ids, |index| {
            reading.unknown_positions.iter().any(|run| run.contains(&index))
        });
        let of_job = limits(job, stage, &against, machine);
        let excess_by_operation = excess(job, stage, &program);
        let found = forming::thin(job, stage)?;
        let limits = Limits { excess_by_operation, found, shape_only: true, ..of_job };
        let subject = Subject { pairing: Pairing::Alone, ..against.subject(&unknown) };
        let report = styluscam_verify::judge(&program, &subject, &limits, watch)?;
        whole = whole.with_stage(report, &format!("stage of {} degrees", shown(stage.stage_angle_deg)));
    }
    Ok(whole)
}

/// The sheet that two channels leave between their tools, by its law.
fn left_between(one: &Scene, other: &Scene) -> Left {
    let opposite = if one.opposite.is_some() { one } else { other };
    let left = opposite.opposite.unwrap_or_default();
    match opposite.sheet.map(|sheet| sheet.law) {
        Some(SheetLaw::Sine) => Left { normal: 0.0, vertical: left },
        Some(SheetLaw::Constant) | None => Left { normal: left, vertical: 0.0 },
    }
}

/// A text that was read, and what it is checked against.
struct Prepared<'a> {
    against: Against<'a>,
    reading: Reading,
    obstacles: Vec<Obstacle>,
    limits: Limits,
}

impl<'a> Prepared<'a> {
    fn new(job: &'a JobDocument, Text { scene, machine, text }: Text<'a>) -> Result<Self, JobError> {
        let against = Against::new(job, scene)?;
        let reading = reading(text, machine, &against.records)?;
        let reading = if job.process.process.as_kind().turns_part() { reading.turned()? } else { reading };
        let mut found = Vec::new();
        if scene.opposite.is_none() {
            found.extend(model::mismatches(job, scene));
            found.extend(forming::warnings(job, scene, machine)?);
            if !scene.stages.is_empty() {
                found.extend(forming::thin(job, scene)?);
            }
        }
        let of_job = limits(job, scene, &against, machine);
        let limits = Limits { excess_by_operation: excess(job, scene, &reading.program), found, ..of_job };
        Ok(Self { obstacles: plates::obstacles(scene)?, against, reading, limits })
    }

    fn subject<'s>(&'s self, pairing: Pairing<'s>) -> Subject<'s> {
        let Reading { unknown_positions, facts, axes, .. } = &self.reading;
        let axes = axes.as_ref().map(|(program, unknown_positions)| Axes { program, unknown_positions });
        let plain = self.against.subject(unknown_positions);
        Subject { text: Some(facts), axes, obstacles: &self.obstacles, pairing, ..plain }
    }
}

/// A text as it was read.
struct Reading {
    program: Program,
    unknown_positions: Vec<Range<usize>>,
    facts: TextFacts,
    /// The moves of the axes, with those of unknown positions, where the others are what these are to a part that turns, by a spindle or
    /// by rotary axes.
    axes: Option<(Program, Vec<Range<usize>>)>,
}

impl Reading {
    /// The same as a part sees it that the spindle turns.
    fn turned(self) -> Result<Self, JobError> {
        let turned = turned(&self.program).map_err(|TooLong { line, chords, most }| {
            let message = format!(
                "line {line}: the part makes so many turns until there that its path takes {chords:.0} chords, and {most:.0} are \
                 looked at"
            );
            JobError::document("too-long", "operations", message, "raise feed_per_rev, or the feed F of that line")
        })?;
        Ok(Self {
            unknown_positions: turned.runs(&self.unknown_positions),
            facts: turned.facts(self.facts),
            program: turned.program,
            axes: Some((self.program, self.unknown_positions)),
        })
    }
}

/// Reads a text, and what there is to know of it beside its moves.
fn reading(text: &str, machine: &Machine, records: &[ToolRecord]) -> Result<Reading, JobError> {
    let read = read(text, machine, records)?;
    let tool_calls = match machine.tool.change {
        ToolChange::M6 | ToolChange::T | ToolChange::ToolCall => ToolCalls::Load,
        ToolChange::Pause | ToolChange::LoadBeforeStart => ToolCalls::Name,
        ToolChange::Unsaid => ToolCalls::NotStated,
    };
    let facts = TextFacts {
        unknown_heights: read.unknown_heights,
        machine_moves: read.machine_moves,
        optional_lines: read.optional_lines,
        not_stated: read.not_stated,
        planes_not_needed: read.planes_not_needed,
        stops: read.stops,
        lines: read.lines,
        ended: read.ended || machine.end.is_empty(), // some controllers have no word for it
        tool_calls,
        frame_levels: clamp::stated(&read.program),
    };
    let axes = read.axes.map(|axes| (axes, read.unknown_positions.clone()));
    Ok(Reading { program: read.program, unknown_positions: read.unknown_positions, facts, axes })
}

/// What a checked program leaves on the faces that its operations are for, face by face.
///
/// # Errors
/// Tools that do not build, `Cancelled`.
pub fn coverage(
    job: &JobDocument,
    scene: &Scene,
    judgement: &Judgement,
    watch: &Watch,
) -> Result<Vec<FaceCoverage>, JobError> {
    let against = Against::new(job, scene)?;
    let mut faces = Vec::new();
    // what leaning tools and drills leave is measured by itself
    for (index, section) in job.operations_of(scene.channel).filter(|(_, section)| section.kind().owes_faces()) {
        faces.extend(faces_of(job, scene, section, index)?);
    }
    let subject = against.subject(&judgement.unknown_positions);
    let selected = scene.facing_up(&faces);
    Ok(styluscam_verify::coverage(judgement.seen(), &subject, &judgement.limits, &selected, watch)?)
}

/// What a checked program leaves at points in work coordinates, mm: their distance from all that tool and sheet sweep.
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
    let against = Against::new(job, scene)?;
    let subject = against.subject(&judgement.unknown_positions);
    Ok(styluscam_verify::left(judgement.seen(), &subject, &judgement.limits, points, watch)?)
}

/// The scallops that a checked program leaves, operation by operation: at about `count` points of the faces of each.
///
/// # Errors
/// Tools that do not build, `Cancelled`.
pub fn scallops(
    job: &JobDocument,
    scene: &Scene,
    judgement: &Judgement,
    count: usize,
    watch: &Watch,
) -> Result<Vec<(String, Vec<Scallop>)>, JobError> {
    let against = Against::new(job, scene)?;
    let subject = against.subject(&judgement.unknown_positions);
    let of_operation = |operation: &ExpectedOperation| {
        let (program, limits) = (judgement.seen(), &judgement.limits);
        let found = styluscam_verify::scallops(program, &subject, limits, operation, count, watch)?;
        Ok((operation.id.clone(), found))
    };
    // those of stages are for no face of the part
    let own = against.expected.iter().filter(|operation| operation.expectation.selected.contains(&true));
    own.map(of_operation).collect()
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
    let against = Against::new(job, scene)?;
    let subject = against.subject(&judgement.unknown_positions);
    Ok(styluscam_verify::needs(judgement.seen(), &subject, &judgement.limits, points, watch)?)
}

/// What a checked program makes of the stock, or of the sheet's blank, of which `face` is followed.
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
    let against = Against::new(job, scene)?;
    let sheet = scene.sheet.map(|sheet| Sheet { model_face: face.unwrap_or(sheet.model_face), ..sheet });
    let subject = Subject { sheet, ..against.subject(&judgement.unknown_positions) };
    let (low, high) = scene.stock.as_ref().map_or(scene.mesh.bounds(), Stock::bounds);
    let under = sheet.map_or(0.0, |sheet| sheet.raise());
    let grid = Grid::over([low.x, low.y], [high.x, high.y], spacing).map_err(JobError::geometry("spacing"))?;
    let top = scene.top - under;
    Ok(styluscam_verify::simulate(judgement.seen(), &subject, &judgement.limits, grid, top, watch)?)
}

/// What the job states for each operation of the scene's channel.
fn expected(
    job: &JobDocument,
    scene: &Scene,
    tools: &[Tool],
    records: &[ToolRecord],
) -> Result<Vec<ExpectedOperation>, JobError> {
    let operation = |(index, section): (usize, &OperationSection)| {
        let (common, name) = (&section.common, job.tool_of(scene.channel, section));
        let named = records.iter().position(|record| record.name == name);
        let number = named.ok_or_else(|| {
            let message = format!("operations[{index}].tool: the channel has no tool {name:?}");
            JobError::document("unknown", format!("operations[{index}].tool"), message, "name one of [tools]")
        })?;
        let tool = &tools[number];
        let turns = spindle::turns(job, scene, tool, section, index)?;
        Ok::<_, JobError>(ExpectedOperation {
            id: scene.operation_id(section.id(index)),
            tool: number,
            cut: section.kind().cut_feed(common),
            plunge: section.kind().plunge_feed(common, turns.map(|(rpm, _)| rpm)),
            highest: section.kind().highest_feed(common),
            leads: (common.lead != LeadForm::None).then(|| [common.feeds.approaching(), common.feeds.leaving()]),
            low_links: (common.links == LinkHeight::Low).then_some(common.link_margin),
            slows_at_corners: common.slow_corners,
            keeps_pace: scene.opposite.is_some(),
            spindle: turns,
            max_corner: common.max_corner_deg.map(f64::to_radians),
            flood: common.coolant == Coolant::Flood,
            expectation: expectation(job, scene, tool, section, index)?,
        })
    };
    let mut expected = Vec::new();
    for stage in &scene.stages {
        let of_stage = self::expected(job, stage, tools, records)?;
        expected.extend(of_stage.into_iter().map(|operation| for_no_face(operation, scene)));
    }
    for own in job.operations_of(scene.channel) {
        expected.push(operation(own)?);
    }
    Ok(expected)
}

/// An operation of a stage as it is expected of the whole text: what it does to the stage's own shape is checked with that.
fn for_no_face(operation: ExpectedOperation, scene: &Scene) -> ExpectedOperation {
    let selected = vec![false; scene.mesh.triangles().len()];
    ExpectedOperation {
        expectation: Expectation { contact: Contact::Clear, selected, ..operation.expectation },
        ..operation
    }
}

/// What an operation's moves and passes must do.
fn expectation(
    job: &JobDocument,
    scene: &Scene,
    tool: &Tool,
    section: &OperationSection,
    index: usize,
) -> Result<Expectation, JobError> {
    let heights = heights_of(job, scene, section);
    let faces = faces_of(job, scene, section, index)?;
    check_part(job, (scene, &faces), tool, section, index)?;
    Ok(Expectation {
        contact: section.kind().contact(),
        // what leaning tools and drills owe their faces is measured by itself
        selected: scene.facing_up(if section.kind().owes_faces() { &faces } else { &[] }),
        region: region_of(job, scene, section, index, &faces)?.expected(),
        to_leave: match section.kind().contact() {
            Contact::Touch => section.common.stock_to_leave(),
            Contact::Clear => [0.0; 2], // they keep away from what is to stay
        },
        heights: [heights.bottom, heights.top.unwrap_or(f64::INFINITY)],
        passes: if scene.opposite.is_some() {
            Passes::Unordered { reason: "they are opposite to the main tool's, whose program is checked for them" }
        } else {
            passes_of(job, (scene, &faces), tool, section)
        },
        forms: job.process.process.as_kind().forms() && scene.opposite.is_none(),
        layers: layers_of(job, scene, tool, section),
        tabs: section.kind().tabs().map(|tabs| tabs.expected()),
    })
}

/// The tolerance of each of the text's operations, by the ids in its remarks; the widest of the channel where it names none.
fn excess(job: &JobDocument, scene: &Scene, program: &Program) -> Vec<Option<f64>> {
    let tolerance = |id: &str| {
        let mut sections = job.operations_of(scene.channel);
        let found = sections.find(|(index, section)| scene.operation_id(section.id(*index)) == id);
        found.map(|(_, section)| section.common.tolerance)
    };
    let widest = widest_tolerance(job, scene.channel);
    program.operations.iter().map(|operation| tolerance(&operation.id).or(widest)).collect()
}

fn widest_tolerance(job: &JobDocument, channel: &str) -> Option<f64> {
    job.operations_of(channel).map(|(_, operation)| operation.common.tolerance).reduce(f64::max)
}

/// The moves of a channel's text as `machine` would read it for this job.
///
/// # Errors
/// Text that the machine would not take, tools that do not build.
pub fn read_back(job: &JobDocument, channel: &str, machine: &Machine, text: &str) -> Result<Program, JobError> {
    let (_, records) = tools_in_order(job, channel)?;
    Ok(read(text, machine, &records)?.program)
}

/// Text is rounded: a coordinate at the clearance height may be half a unit of the machine below it.
fn limits(job: &JobDocument, scene: &Scene, against: &Against<'_>, machine: &Machine) -> Limits {
    let clearance = scene.clearance - 0.5 * machine.resolution_mm();
    let sheet_bridged = job.setup.sheet.map_or(f64::INFINITY, |_| BRIDGED);
    let bridged = job.process.common.max_bridged.unwrap_or(sheet_bridged);
    let narrowest = against.tools.iter().map(|tool| 0.5 * tool.diameter()).fold(f64::INFINITY, f64::min);
    // what is formed, and where no tool gets, is asked of the main tool: the one opposite to it is held to its contacts
    let is_main = scene.opposite.is_none();
    let [bridged, unreached] = if is_main { [bridged, job.process.common.max_unreached] } else { [f64::INFINITY, 1.0] };
    Limits {
        gouge: GOUGE,
        excess: widest_tolerance(job, scene.channel),
        retract: scene.retract - 0.5 * machine.resolution_mm(),
        feed_rounding: machine.feed_rounding(fastest(&against.expected)),
        unit: machine.resolution_mm(),
        reach: reach(machine),
        straight_rapids: machine.motion.rapids == Rapids::Straight,
        forming: job.setup.sheet.filter(|_| is_main).map(|sheet| forming_of(job, &sheet, scene)),
        bridged,
        unreached,
        unreached_from: if bridged.is_finite() { bridged } else { NO_ROOM * narrowest },
        accepted: job.accept.iter().map(|risk| risk.finding()).collect(),
        ..Limits::new(clearance)
    }
}

/// The highest speed of some operations, rev/min; 0 where none turns.
fn fastest(expected: &[ExpectedOperation]) -> f64 {
    expected.iter().filter_map(|operation| operation.spindle).map(|(rpm, _)| rpm).fold(0.0, f64::max)
}

/// What the sheet withstands.
fn forming_of(job: &JobDocument, sheet: &SheetSection, scene: &Scene) -> Forming {
    let wall = materials::wall_angle(job, sheet);
    let forming = Forming {
        thickness: sheet.thickness,
        top: scene.top,
        support: job.process.process.as_kind().support(),
        min_thickness: sheet.min_thickness.unwrap_or(0.0),
        max_wall_angle: wall.most_deg.to_radians(),
        sure_wall_angle: wall.sure_deg.to_radians(),
        source: wall.source,
    };
    // limits of walls and the sine law are those of one pass over flat sheet: of the first stage
    let is_first = scene.stage.map_or(scene.stages.is_empty(), |stage| stage == 1);
    if is_first {
        forming
    } else {
        Forming { min_thickness: 0.0, max_wall_angle: FRAC_PI_2, sure_wall_angle: f64::INFINITY, ..forming }
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
        cornering: machine.cornering(),
    }
}
