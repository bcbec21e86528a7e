//! What a starter job cuts between roughing and finishing: where roughing leaves more than a finishing tool is wide, that would cut it all
//! at once. Rows with wider balls take it over slopes.

use styluscam_geometry::Tool;

use super::allowances::Allowances;
use super::drilling::Drilled;
use super::operations::NAMES;
use super::roughing::{to_leave, WIDEST};
use super::sizes::{self, measured, round, Cutter, Shape};
use super::stock_nodes::{Front, Standing, StockNodes};
use super::work::Work;
use crate::body::Body;
use crate::operations::{Serves, StarterPasses};

/// Nodes along the longer side of the stock in plan: they are nearer than the narrowest tool's radius, a hundredth of the part's size.
const NODES: f64 = 160.0;
/// Tools cut no deeper through the stock at once than this, in diameters, but for so many nodes.
const DEEPEST: f64 = 1.0;
const FEW: usize = 2;
/// Stock counts up to so far from the tool's axis, as a share of its radius, as for the verifier: what is farther off is a skin.
const MIDDLE: f64 = 0.5;
/// A node counts as swept where it is beside a tool's rim by this share of the distance between nodes.
const BESIDE: f64 = 0.5;
/// Distance between rows, in diameters: what stands between them is about what is left for finishing.
const ROWS: f64 = 0.2;
/// Operations between roughing and finishing at most.
const STEPS: usize = 3;
/// Floors as level as this stop the levels over them: the cosine of their slope.
const LEVEL_FLOOR: f64 = 1.0 - 1e-9;

/// Heights of the stock at the nodes, mm.
type Heights = Vec<f64>;

/// The operations that are needed before some others finish a part, after roughing where there is any, or why they cut so deep without; `on_floors`: where flat tools
/// cut too deep too, over level floors: what stands there stands in narrow spaces, mostly, and is better roughed with a narrower tool.
///
/// # Errors
/// No tools in between take enough: a sentence.
pub fn preparing(
    body: &Body<'_>,
    allowances: Allowances,
    drilled: &[Drilled],
    (rougher, finishing): (Option<&Work>, &[Work]),
    on_floors: bool,
) -> Result<Vec<Work>, String> {
    let part = Part { nodes: StockNodes::new(body.mesh(), allowances, drilled, NODES), floors: level_floors(body) };
    let roughed = part.roughed(rougher);
    let walls = part.beside_walls(finishing);
    let passes: Vec<Passes> = finishing.iter().filter_map(|work| part.passes(work, &walls)).collect();
    let deep = || passes.iter().filter(|passes| passes.is_deep(&roughed, &part.nodes));
    let Some(worst) = deep().max_by(|a, b| a.depth(&roughed, &part.nodes).total_cmp(&b.depth(&roughed, &part.nodes)))
    else {
        return Ok(Vec::new());
    };
    let depth = measured(worst.depth(&roughed, &part.nodes));
    let narrowest = passes.iter().map(|passes| passes.cutter.diameter).fold(f64::INFINITY, f64::min);
    let words = format!(
        "the finishing tool of {} mm would cut up to {depth:.1} mm deep at once through what stands then, more than it is wide",
        worst.cutter.diameter
    );
    let is_on_floors = deep().any(|passes| passes.cutter.shape == Shape::Flat);
    let steps = if is_on_floors && !on_floors { Vec::new() } else { part.steps(narrowest, rougher) };
    let is_done = |heights: &Heights| !passes.iter().any(|passes| passes.is_deep(heights, &part.nodes));
    let Some(chosen) = chosen(&steps, (&roughed, &part), &is_done) else {
        return Err(format!("{words}, and no wider ball gets to enough of it: take that with another tool first"));
    };
    Ok(chosen.iter().enumerate().map(|(number, step)| step.work(number, finishing, &words)).collect())
}

/// The rows after which a part can be finished that are shortest together; none where no three narrowing balls do.
fn chosen<'s>(
    steps: &'s [Step],
    (roughed, part): (&Heights, &Part<'_>),
    is_done: &impl Fn(&Heights) -> bool,
) -> Option<Vec<&'s Step>> {
    let mut best: Option<(f64, Vec<&Step>)> = None;
    let mut open = vec![(0.0, Vec::new(), roughed.clone())];
    while let Some((length, taken, heights)) = open.pop() {
        if best.as_ref().is_some_and(|(shortest, _)| length >= *shortest) {
            continue;
        }
        if is_done(&heights) {
            best = Some((length, taken));
            continue;
        }
        let widest = taken.last().map_or(f64::INFINITY, |last: &&Step| last.cutter.diameter);
        let follows = |step: &&Step| step.cutter.diameter < widest;
        for step in steps.iter().filter(|_| taken.len() < STEPS).filter(follows) {
            let Some((more, after)) = step.taken(&heights, part) else { continue };
            open.push((length + more, taken.iter().copied().chain([step]).collect(), after));
        }
    }
    best.map(|(_, taken)| taken)
}

/// A part with what is known of it.
struct Part<'a> {
    nodes: StockNodes<'a>,
    /// Heights of level floors, ascending, mm.
    floors: Vec<f64>,
}

impl Part<'_> {
    /// What roughing leaves, where there is any.
    fn roughed(&self, rougher: Option<&Work>) -> Heights {
        let uncut = self.nodes.uncut();
        let Some((work, tool)) = rougher.and_then(|work| Some((work, work.cutter.made()?))) else { return uncut };
        let front = self.nodes.front(&tool, BESIDE);
        let mut tips = self.nodes.tips(&tool, (work.leave, front.reach()));
        for tip in &mut tips {
            *tip = self.level_at(*tip, (work.passes.pitch, work.leave));
        }
        lower(&uncut, &self.nodes.swept(&tips, &front).collect())
    }

    /// The lowest level that is no lower than a tip, mm.
    fn level_at(&self, tip: f64, (pitch, leave): (f64, f64)) -> f64 {
        let by_steps = self.nodes.top - ((self.nodes.top - tip) / pitch + 1e-6).floor() * pitch;
        let over = self.floors.partition_point(|floor| floor + leave < tip - 1e-6 * pitch);
        self.floors.get(over).map_or(by_steps, |floor| by_steps.min(floor + leave))
    }

    /// What levels along upright walls leave, bit by bit, before rows come, mm.
    fn beside_walls(&self, finishing: &[Work]) -> Heights {
        let mut heights = self.nodes.uncut();
        for work in finishing.iter().filter(|work| work.serves == Serves::Walls) {
            let (Some(tool), Some(faces)) = (work.cutter.made(), &work.faces) else { continue };
            let beside = self.nodes.beside(faces, tool.diameter());
            for ((height, at), is_beside) in heights.iter_mut().zip(self.nodes.standing(&tool, 0.0)).zip(beside) {
                *height = at.filter(|_| is_beside).map_or(*height, |at| height.min(at.tip));
            }
        }
        heights
    }

    /// Where an operation goes that finishes faces, after levels along walls where it has rows.
    fn passes(&self, work: &Work, walls: &Heights) -> Option<Passes> {
        let tool = work.cutter.made()?;
        let before = if work.serves == Serves::Walls { self.nodes.uncut() } else { walls.clone() };
        let mut standing = self.nodes.standing(&tool, 0.0);
        let is_cut = |at: &Standing| work.faces.as_ref().is_none_or(|faces| faces.contains(&at.face));
        standing.iter_mut().for_each(|at| *at = at.filter(is_cut));
        Some(Passes { cutter: work.cutter, standing, middle: self.middle(&tool), before })
    }

    /// The rows that there may be, with the widest ball first.
    fn steps(&self, narrowest: f64, rougher: Option<&Work>) -> Vec<Step> {
        let by_size = WIDEST * self.nodes.size[0].min(self.nodes.size[1]);
        let widest = rougher.map_or(by_size, |work| work.cutter.diameter);
        let wider = sizes::between([narrowest, widest]).filter(|diameter| *diameter > narrowest);
        wider.filter_map(|diameter| self.rows(diameter)).collect()
    }

    /// Rows with a ball.
    fn rows(&self, diameter: f64) -> Option<Step> {
        let cutter = Cutter { shape: Shape::Ball, diameter };
        let (tool, leave) = (cutter.made()?, to_leave(diameter));
        let front = self.nodes.front(&tool, BESIDE);
        let tips = self.nodes.tips(&tool, (leave, front.reach()));
        let leaves = self.nodes.swept(&tips, &front).collect();
        let standing = self.nodes.standing(&tool, leave);
        Some(Step {
            cutter,
            pitch: round(ROWS * diameter),
            leaves,
            rows: Passes { cutter, standing, middle: self.middle(&tool), before: self.nodes.uncut() },
        })
    }

    /// The part of a tool's front about its axis in which stock counts as cut at once.
    fn middle(&self, tool: &Tool) -> Front {
        self.nodes.middle(tool, MIDDLE * 0.5 * tool.diameter())
    }
}

/// Where a tool goes along the part.
struct Passes {
    cutter: Cutter,
    standing: Vec<Option<Standing>>,
    middle: Front,
    /// What other passes of the finishing leave of a whole stock before.
    before: Heights,
}

impl Passes {
    /// How deep it cuts at once at each node, mm.
    fn depths(&self, heights: &Heights, nodes: &StockNodes<'_>) -> Vec<f64> {
        nodes.over(&lower(heights, &self.before), (&self.standing, &self.middle)).collect()
    }

    /// The largest depth, mm.
    fn depth(&self, heights: &Heights, nodes: &StockNodes<'_>) -> f64 {
        self.depths(heights, nodes).into_iter().fold(0.0, f64::max)
    }

    /// Whether it cuts deeper than it may.
    fn is_deep(&self, heights: &Heights, nodes: &StockNodes<'_>) -> bool {
        self.depths(heights, nodes).into_iter().filter(|depth| *depth > DEEPEST * self.cutter.diameter).count() > FEW
    }
}

/// Rows with a ball that may come in between.
struct Step {
    cutter: Cutter,
    /// Between rows, mm.
    pitch: f64,
    /// What they leave of a whole stock.
    leaves: Heights,
    /// Where they go.
    rows: Passes,
}

impl Step {
    /// The length of the path, mm, about, and what is left after it; none where it cuts too deep itself.
    fn taken(&self, heights: &Heights, part: &Part<'_>) -> Option<(f64, Heights)> {
        let length = part.nodes.area(self.rows.standing.iter().flatten().count()) / self.pitch;
        (!self.rows.is_deep(heights, &part.nodes)).then(|| (length, lower(heights, &self.leaves)))
    }

    /// The operation, by its number among those in between; `words`: why.
    fn work(&self, number: usize, finishing: &[Work], words: &str) -> Work {
        let Self { cutter, pitch, .. } = *self;
        let diameter = cutter.diameter;
        let suffix = if number == 0 { String::new() } else { format!("-{}", number + 1) };
        let angle_deg = finishing.first().map_or(0.0, |work| work.passes.angle_deg);
        let why = match number {
            0 => format!("{words}: rows with a wider ball, {diameter} mm, take most of that first"),
            _ => format!("and what that ball leaves is taken by one of {diameter} mm"),
        };
        Work {
            id: format!("semi-finishing{suffix}"),
            serves: Serves::Floors,
            tool: format!("semi-finisher{suffix}"),
            cutter,
            faces: named(finishing),
            passes: StarterPasses { pitch, angle_deg, ..StarterPasses::default() },
            leave: to_leave(diameter),
            why: vec![why],
        }
    }
}

/// The lower of two heights at each node, mm.
fn lower(heights: &Heights, others: &Heights) -> Heights {
    heights.iter().zip(others).map(|(height, other)| height.min(*other)).collect()
}

/// The faces of some operations; none: the part's.
fn named(works: &[Work]) -> Option<Vec<u32>> {
    let each: Option<Vec<&Vec<u32>>> = works.iter().map(|work| work.faces.as_ref()).collect();
    let mut faces: Vec<u32> = each?.into_iter().flatten().copied().collect();
    faces.sort_unstable();
    faces.dedup();
    Some(faces).filter(|faces| faces.len() <= NAMES)
}

/// Heights of the level floors of a part, ascending, mm.
fn level_floors(body: &Body<'_>) -> Vec<f64> {
    let mesh = body.mesh();
    let is_level = |triangle: &usize| mesh.normal(*triangle).z >= LEVEL_FLOOR;
    let heights = (0..mesh.triangles().len()).filter(is_level).map(|triangle| mesh.corners(triangle)[0].z);
    let mut heights: Vec<f64> = heights.collect();
    heights.sort_unstable_by(f64::total_cmp);
    heights.dedup();
    heights
}
