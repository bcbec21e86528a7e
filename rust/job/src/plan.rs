//! From a resolved job to a program: one operation at a time.

use std::collections::BTreeMap;

use styluscam_geometry::{Tool, Vector};
use styluscam_motion::{Event, EventKind, Move, OperationRecord, Program, ToolRecord, Watch};
use styluscam_post::{Machine, OptionValue};
use styluscam_toolpath::{
    forming::{
        left_out, levels, raise_last, selected_range, with_levels_at, z_levels, z_levels_beside, zig_zag, Floors, Grid,
        LevelRange, Rows,
    },
    link,
    offset::{bridges, Bridges, Envelope, OffsetSurface, Stopped, SurfaceFlag},
    Heights, Links, Pass, PlanError, Rates, Surface,
};
use styluscam_verify::ToolReach;

use crate::faces::UP;
use crate::heights::TipHeights;
use crate::judge::GOUGE;
use crate::stopped::{stopped_places, StoppedTriangle};
use crate::{
    faces, scene, Coolant, Direction, JobDocument, JobError, OperationKind, OperationSection, Scene, Spindle, Step,
};

/// Triangles of a face whose offset is judged, at most: areas are right to a percent or two of the face's.
const OFFSET_SAMPLES: usize = 2000;
/// Points that refining it may add, where something stops the tool.
const OFFSET_POINTS: usize = 1 << 16;
/// Decimal places of coordinates that are tried where a machine's own are too few.
const MOST_DECIMALS: u32 = 6;
/// What is left for fitting must be at least this, mm, or paths would have millions of points.
const LEAST_DEVIATION: f64 = 2e-4;
/// Share of what is left that a chord may stray to either side. The planned surface lies in the middle; the rest is a
/// reserve on both sides.
const EACH_SIDE: f64 = 0.48;
/// Area of a face that is worth a word, mm^2: it is shown with one decimal.
const LEAST_AREA: f64 = 0.05;
/// Links are ridden up to so many steps or stepovers.
const RIDE: f64 = 4.0;

/// A planned program and what there is to say about it.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The program.
    pub program: Program,
    /// What each operation amounts to.
    pub operations: Vec<OperationSummary>,
}

/// What an operation amounts to.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct OperationSummary {
    /// Its id.
    pub id: String,
    /// Its kind.
    pub kind: &'static str,
    /// Levels or rows that hold a path.
    pub groups: usize,
    /// Loops or runs.
    pub passes: usize,
    /// Faces planned.
    pub faces: Vec<u32>,
    /// Largest wall angle of those faces, degrees.
    pub wall_angle_max_deg: f64,
    /// Smallest disc that a loop must hold to be sure of being found, mm; levels only.
    pub smallest_feature: f64,
    /// Where it ends though the tool could touch the faces farther down.
    pub ends: Option<End>,
    /// What becomes of the planned faces, in the order of their numbers.
    pub reached: Vec<ReachedFace>,
    /// How large the triangles are from which that is known where something stops the tool, mm, if larger than meant:
    /// there is more of it than is worth the time.
    pub reached_coarsely: Option<f64>,
    /// Faces with places that the tool cannot touch, worst first.
    pub bridged: Vec<BridgedFace>,
    /// Faces with area that looks down, mm^2: not reached.
    pub undercut: Vec<(u32, f64)>,
}

/// Where an operation ends though the tool could touch its faces farther down; mm.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct End {
    /// Lowest tip.
    pub z: f64,
    /// Whether that is the part's foot, and nothing that the job says.
    pub at_foot: bool,
    /// Most of the faces' lowest parts that is touched only from lower down.
    pub untouched: f64,
}

/// How much of a face the tool reaches, and what keeps it from the rest; areas, mm^2, from samples.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct ReachedFace {
    /// The face.
    pub face: u32,
    /// Touched by the tool.
    pub contact: f64,
    /// Kept from the tool by the same smooth patch of the part, which is more curved than the tool.
    pub bridged: f64,
    /// Kept from the tool by something beyond a crease: a wall, a step, an island.
    pub interferes: f64,
    /// Steeper than the tool's profile: touched by its rim.
    pub rim: f64,
    /// Looks down.
    pub undercut: f64,
}

/// A face that the tool bridges.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct BridgedFace {
    /// The face.
    pub face: u32,
    /// Most that is left between it and the tool, along the normal, mm.
    pub excess: f64,
    /// Where, work coordinates, mm.
    pub at: [f64; 3],
}

/// Plans every operation of the job, in order.
///
/// # Errors
/// Anything of [`JobError`]; nothing is planned then.
pub fn plan(job: &JobDocument, scene: &Scene, machine: &Machine, watch: &Watch) -> Result<Plan, JobError> {
    let tools = scene::tools(job)?;
    let mut program = Program::empty(scene.record(job), Vec::new(), Vec::new());
    let mut summaries = Vec::new();
    for (index, section) in job.operations.iter().enumerate() {
        let Some((tool, record)) = tools.get(&section.tool) else { continue };
        let id = operation_id(section, index);
        let (moves, summary) = operation(job, scene, machine, section, tool, (index, &id), watch)?;
        let tool = tool_index(&mut program, record);
        program.events.extend(events_before(&program, section, tool, index));
        program.operations.push(OperationRecord { id, kind: section.kind.name().to_owned(), tool });
        program.moves.extend(moves);
        summaries.push(summary);
    }
    program.events.extend(events_at_end(&program, job.operations.last()));
    Ok(Plan { program, operations: summaries })
}

/// The name of an operation: its own, or one made of its kind and number.
pub(crate) fn operation_id(section: &OperationSection, index: usize) -> String {
    if section.id.is_empty() {
        format!("{}-{}", section.kind.name(), index + 1)
    } else {
        section.id.clone()
    }
}

fn tool_index(program: &mut Program, record: &ToolRecord) -> u32 {
    let known = program.tools.iter().position(|t| t.number == record.number);
    let index = known.unwrap_or_else(|| {
        program.tools.push(record.clone());
        program.tools.len() - 1
    });
    index as u32
}

/// Tool change, spindle and coolant as far as they differ from the operation before.
fn events_before(program: &Program, section: &OperationSection, tool: u32, index: usize) -> Vec<Event> {
    let before = program.moves.len();
    let changes_tool = program.operations.last().is_none_or(|last| last.tool != tool);
    let mut kinds = Vec::new();
    if changes_tool {
        kinds.push(EventKind::ToolChange { tool });
    }
    kinds.push(match section.spindle {
        Spindle::Off => EventKind::SpindleOff,
        Spindle::Fixed { rpm, direction } => EventKind::SpindleOn { rpm, direction },
    });
    if index > 0 || section.coolant == Coolant::Flood {
        kinds.push(EventKind::Flood { on: section.coolant == Coolant::Flood });
    }
    kinds.into_iter().map(|kind| Event { before, kind }).collect()
}

fn events_at_end(program: &Program, last: Option<&OperationSection>) -> Vec<Event> {
    let before = program.moves.len();
    let mut kinds = Vec::new();
    if let Some(section) = last {
        if section.spindle != Spindle::Off {
            kinds.push(EventKind::SpindleOff);
        }
        if section.coolant == Coolant::Flood {
            kinds.push(EventKind::Flood { on: false });
        }
    }
    kinds.into_iter().map(|kind| Event { before, kind }).collect()
}

/// What a machine's last decimal place takes: half a unit in each of three axes, mm.
fn rounding(machine: &Machine) -> f64 {
    0.5 * machine.resolution_mm() * 3.0_f64.sqrt()
}

/// The fewest decimal places with which a machine is good `enough`, if it can post so many.
fn fewest_decimals(machine: &Machine, enough: impl Fn(&Machine) -> bool) -> Option<u32> {
    (1..=MOST_DECIMALS).find(|places| {
        let mut finer = machine.clone();
        finer.set_option("decimals", OptionValue::Number(f64::from(*places))).is_ok() && enough(&finer)
    })
}

/// How the tolerance is spent: what tessellation and rounding leave goes to fitting, to either side.
struct Budget {
    /// Chords stray by at most this to either side of the planned surface, mm.
    deviation: f64,
    /// The planned surface lies this far outside the part's triangles, mm.
    margin: f64,
}

impl Budget {
    fn of(section: &OperationSection, scene: &Scene, machine: &Machine) -> Result<Self, PlanError> {
        let tolerance = section.tolerance;
        let tessellation = scene.inward + scene.outward;
        let rounding = rounding(machine);
        Self::left(tolerance, tessellation, rounding, scene.inward).ok_or_else(|| {
            let enough = |machine: &Machine| {
                Self::left(tolerance, tessellation, self::rounding(machine), scene.inward).is_some()
            };
            PlanError::Budget { tolerance, tessellation, rounding, decimals: fewest_decimals(machine, enough) }
        })
    }

    /// What tessellation and rounding leave, if that is enough to fit a path with.
    fn left(tolerance: f64, tessellation: f64, rounding: f64, inward: f64) -> Option<Self> {
        // rounding may also go inwards: beyond what a gouge is allowed, that takes room too
        let inwards = (rounding - 0.9 * GOUGE).max(0.0);
        let left = tolerance - tessellation - rounding - inwards;
        let deviation = EACH_SIDE * left;
        (deviation >= LEAST_DEVIATION).then_some(Self { deviation, margin: inward + inwards + 0.5 * left })
    }
}

/// Plans one operation: its moves, and what they amount to.
///
/// # Errors
/// As [`plan`].
pub fn operation(
    job: &JobDocument,
    scene: &Scene,
    machine: &Machine,
    section: &OperationSection,
    tool: &Tool,
    (index, id): (usize, &str),
    watch: &Watch,
) -> Result<(Vec<Move>, OperationSummary), JobError> {
    let place = format!("operations[{index}]");
    let faces = faces::of_operation(job, scene, section, index)?;
    let selected = scene.looking_up(&faces);
    let budget = Budget::of(section, scene, machine).map_err(JobError::planning(&place))?;
    watch.begin("preparing", 1);
    let envelope = Envelope::new(&scene.mesh, &scene.index, tool, scene.sheet.as_ref(), budget.margin);
    let heights = TipHeights::of(job, scene, section);
    let surface = Surface::new(&envelope, &selected).between_heights(bounds(section, heights));
    let surface = if scene.sheet.is_some() { surface.from_above() } else { surface };
    let task = Task { job, scene, machine, section, index, heights, budget: &budget };
    let (passes, smallest_feature) = task.passes(&surface, watch).map_err(JobError::planning(&place))?;
    let offset = offset_of(scene, tool, &envelope, &faces, section.tolerance, watch)?;
    let bridges = bridges_of(scene, tool, &envelope, &offset, section.tolerance, watch)?;
    let summary = OperationSummary {
        id: id.to_owned(),
        kind: section.kind.name(),
        groups: count_groups(&passes),
        passes: passes.len(),
        wall_angle_max_deg: steepest(scene, &selected).to_degrees(),
        smallest_feature,
        ends: ends(scene, tool, &passes, (section, heights), &selected),
        reached: reached(scene, &offset, &bridges),
        reached_coarsely: offset.is_coarse.then_some(offset.fine),
        bridged: bridged(&bridges),
        undercut: undercut(scene, &faces),
        faces,
    };
    Ok((link(&surface, &passes, &task.links(), watch)?, summary))
}

/// The end that the heights are to an operation, if the tool would go on below.
fn ends(
    scene: &Scene,
    tool: &Tool,
    passes: &[Pass],
    (section, heights): (&OperationSection, TipHeights),
    selected: &[bool],
) -> Option<End> {
    let lowest = passes.iter().flat_map(|pass| &pass.points).map(|point| point.tip.z).fold(f64::INFINITY, f64::min);
    let stopped = lowest - heights.bottom <= section.step.map_or(0.0, |Step::Height(step)| step);
    let untouched = heights.untouched(scene, tool, selected, section.tolerance).filter(|_| stopped)?;
    Some(End { z: lowest, at_foot: section.z_bottom.is_none(), untouched })
}

/// Faces of which a part looks down, with its area.
fn undercut(scene: &Scene, faces: &[u32]) -> Vec<(u32, f64)> {
    let area = |face: &u32| scene.views.get(face).map(|view| view.down).filter(|area| *area >= LEAST_AREA);
    faces.iter().filter_map(|face| Some((*face, area(face)?))).collect()
}

/// Heights between which the tip stays on the surface: levels choose their own.
fn bounds(section: &OperationSection, heights: TipHeights) -> [f64; 2] {
    match section.kind {
        OperationKind::ZLevel => [f64::NEG_INFINITY, f64::INFINITY],
        // what lies at the top is formed within the tolerance above it
        OperationKind::ZigZag => [heights.bottom, heights.top.map_or(f64::INFINITY, |z| z + section.tolerance)],
    }
}

fn steepest(scene: &Scene, selected: &[bool]) -> f64 {
    // facets lean by their deviation: where the model's normals are known, those tell
    let slope = |t: usize| {
        let normals = scene.mesh.corner_normals(t);
        normals.map(|n| libm::acos(n.z.clamp(-1.0, 1.0))).into_iter().fold(0.0, f64::max)
    };
    (0..selected.len()).filter(|t| selected[*t]).map(slope).fold(0.0, f64::max)
}

fn count_groups(passes: &[Pass]) -> usize {
    let mut groups: Vec<usize> = passes.iter().map(|p| p.group).collect();
    groups.dedup();
    groups.len()
}

/// The slope-matched offset of faces: of all their triangles, or of up to [`OFFSET_SAMPLES`] of each.
fn offset_of(
    scene: &Scene,
    tool: &Tool,
    envelope: &Envelope<'_>,
    faces: &[u32],
    tolerance: f64,
    watch: &Watch,
) -> Result<OffsetSurface, JobError> {
    let mut by_face: BTreeMap<u32, Vec<u32>> = faces.iter().map(|face| (*face, Vec::new())).collect();
    for (t, face) in scene.mesh.faces().iter().enumerate() {
        if let Some(triangles) = by_face.get_mut(face) {
            triangles.push(t as u32);
        }
    }
    let sampled: Vec<u32> = by_face.values().flat_map(|all| spread(all, OFFSET_SAMPLES)).collect();
    Ok(OffsetSurface::new(envelope, tool, scene.sheet.as_ref(), &sampled, tolerance, OFFSET_POINTS, watch)?)
}

/// Up to `most` of some things, spread evenly over them.
fn spread<T: Copy>(all: &[T], most: usize) -> impl Iterator<Item = T> + '_ {
    all.iter().step_by(all.len().div_ceil(most).max(1)).copied()
}

/// What becomes of each face; what was sampled stands for all of it.
fn reached(scene: &Scene, offset: &OffsetSurface, bridges: &[Bridges]) -> Vec<ReachedFace> {
    let regions = offset.regions(&scene.mesh);
    let faces = regions.chunk_by(|a, b| a.face == b.face).filter_map(|regions| {
        let face = regions.first()?.face;
        let sampled: f64 = regions.iter().map(|region| region.area).sum();
        let scale = scene.views.get(&face)?.area / sampled;
        let area = |flag| regions.iter().find(|r| r.flag == flag).map_or(0.0, |region| region.area * scale);
        let left = bridges.iter().find(|bridges| bridges.face == face).map_or(1.0, |bridges| bridges.share_left);
        let interferes = area(SurfaceFlag::Interferes);
        Some(ReachedFace {
            face,
            contact: area(SurfaceFlag::Contact) + (1.0 - left) * interferes,
            bridged: area(SurfaceFlag::Bridged),
            interferes: left * interferes,
            rim: area(SurfaceFlag::Rim),
            undercut: area(SurfaceFlag::Undercut),
        })
    });
    faces.collect()
}

/// What the tool leaves of each face by more than the tolerance: looked for from [`stopped_places`] among the points of
/// each face that the offset says are kept from the tool. A flat tool may touch with its edge what it cannot stand on.
fn bridges_of(
    scene: &Scene,
    tool: &Tool,
    envelope: &Envelope<'_>,
    offset: &OffsetSurface,
    tolerance: f64,
    watch: &Watch,
) -> Result<Vec<Bridges>, JobError> {
    let mut by_face: BTreeMap<u32, Vec<StoppedTriangle>> = BTreeMap::new();
    for (corners, triangle) in offset.triangles.iter().zip(&offset.numbers) {
        let corners = corners.map(|i| &offset.points[i as usize]);
        let stopped = corners.map(|corner| corner.flag.is_stopped());
        if scene.mesh.normal(*triangle as usize).z > UP && stopped.contains(&true) {
            let is_smooth = corners.iter().find(|corner| corner.flag.is_stopped()).map(|corner| corner.flag);
            let found = StoppedTriangle {
                triangle: *triangle,
                corners: corners.map(|corner| corner.contact),
                stopped,
                is_smooth: is_smooth == Some(SurfaceFlag::Bridged),
            };
            by_face.entry(scene.mesh.faces()[*triangle as usize]).or_default().push(found);
        }
    }
    let sampled: Vec<Stopped> = by_face.values().flat_map(|all| stopped_places(all)).collect();
    let reach = ToolReach::new(tool, scene.sheet.as_ref(), &scene.mesh, &scene.bvh);
    let left = |triangle: u32, point: Vector, enough: f64| reach.left(triangle as usize, point, enough);
    Ok(bridges(envelope, tool, scene.sheet.as_ref(), &sampled, tolerance, &left, watch)?)
}

/// The worst place of each face that the tool bridges, worst first.
fn bridged(bridges: &[Bridges]) -> Vec<BridgedFace> {
    let worst = bridges.iter().filter_map(|face| face.worst);
    let worst = worst.map(|b| BridgedFace { face: b.face, excess: b.excess, at: b.point.into() });
    let mut worst: Vec<BridgedFace> = worst.collect();
    worst.sort_by(|a, b| b.excess.total_cmp(&a.excess).then(a.face.cmp(&b.face)));
    worst
}

struct Task<'a> {
    job: &'a JobDocument,
    scene: &'a Scene,
    machine: &'a Machine,
    section: &'a OperationSection,
    index: usize,
    heights: TipHeights,
    budget: &'a Budget,
}

/// What rows and links look for, as a share of the distance between the grid's nodes: the tool's rim and its tip meet
/// ridges that are narrower than any feature.
const NARROW: f64 = 0.2;

impl Task<'_> {
    fn passes(&self, surface: &Surface<'_>, watch: &Watch) -> Result<(Vec<Pass>, f64), PlanError> {
        match self.section.kind {
            OperationKind::ZLevel => self.levels(surface, watch),
            OperationKind::ZigZag => self.rows(surface, watch),
        }
    }

    /// Distance between the grid's nodes that finds every feature asked for.
    fn spacing(&self) -> f64 {
        self.section.smallest_feature / std::f64::consts::SQRT_2
    }

    fn levels(&self, surface: &Surface<'_>, watch: &Watch) -> Result<(Vec<Pass>, f64), PlanError> {
        let nothing = || PlanError::NothingReached(self.why_nothing());
        let grid = Grid::sample(surface, self.spacing(), watch)?.ok_or_else(nothing)?;
        let Some(Step::Height(step)) = self.section.step else {
            return Err(PlanError::NothingReached(String::new()));
        };
        let resolution = self.machine.resolution_mm();
        let (lowest, highest) = selected_range(surface, &grid, resolution, watch)?.ok_or_else(nothing)?;
        // the flat top lies margin below what the envelope shows
        let top = self.heights.top.unwrap_or_else(|| self.round(highest - self.budget.margin));
        let bottom = self.heights.bottom;
        let range = LevelRange { top, bottom, reachable: lowest, step, resolution };
        let floors = Floors::of(surface.envelope());
        let heights = levels(&range, &floors)?;
        let mut passes = z_levels(surface, &grid, &heights, self.budget.deviation, watch)?;
        let bands = left_out(surface, (&heights, &passes), grid.spacing(), watch)?;
        let mut more = with_levels_at(&heights, &bands, &range, &floors).unwrap_or_else(|| heights.clone());
        let is_at =
            |z: f64| passes.iter().flat_map(|pass| pass.points.first()).any(|p| (p.tip.z - z).abs() < resolution);
        // rims that rise and fall leave stretches of it that are too short
        if heights.last().is_some_and(|z| more.last() == Some(z) && !is_at(*z)) {
            raise_last(&mut more, &range, &floors);
        }
        if more != heights {
            let known = (&*heights, passes);
            passes = z_levels_beside(known, surface, &grid, &more, self.budget.deviation, watch)?;
        }
        if passes.is_empty() {
            return Err(PlanError::Empty { top, bottom: bottom.max(lowest) });
        }
        Ok((passes, grid.smallest_feature()))
    }

    fn rows(&self, surface: &Surface<'_>, watch: &Watch) -> Result<(Vec<Pass>, f64), PlanError> {
        let stepover = self.section.stepover.unwrap_or(f64::INFINITY);
        let rows = Rows {
            angle: self.section.angle_deg.to_radians(),
            stepover,
            spacing: self.spacing(),
            narrow: NARROW * self.spacing(),
        };
        let passes = zig_zag(surface, &rows, self.budget.deviation, watch)?;
        if passes.is_empty() {
            return Err(PlanError::NothingReached(self.why_nothing()));
        }
        Ok((passes, self.section.smallest_feature))
    }

    fn round(&self, z: f64) -> f64 {
        let unit = self.machine.resolution_mm();
        (z / unit).round() * unit
    }

    fn why_nothing(&self) -> String {
        let (low, high) = self.scene.mesh.bounds();
        let size = high - low;
        format!(
            " (part {:.3} x {:.3} x {:.3} mm): check its units, the tool's size and the selection",
            size.x, size.y, size.z
        )
    }

    fn links(&self) -> Links {
        let clearance = self.scene.clearance(self.job);
        let pitch = match self.section.kind {
            OperationKind::ZLevel => self.section.step.map_or(0.0, |Step::Height(h)| h),
            OperationKind::ZigZag => self.section.stepover.unwrap_or(0.0),
        };
        Links {
            alternate: self.section.direction == Direction::Alternate,
            ride: RIDE * pitch,
            deviation: self.budget.deviation,
            narrow: NARROW * self.spacing(),
            heights: Heights { clearance, retract: self.scene.top + self.job.setup.retract },
            rates: Rates { cut: self.section.feeds.cut, plunge: self.section.feeds.plunge },
            operation: self.index as u32,
        }
    }
}
