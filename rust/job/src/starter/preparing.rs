//! What a starter job cuts between roughing and finishing: where roughing leaves more than a finishing tool is wide, that would cut it all
//! at once. Rows with wider balls take it over slopes.

use styluscam_geometry::Tool;
use styluscam_toolpath::forming::Floors;

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

/// Heights of the stock at the nodes, mm.
type Heights = Vec<f64>;

/// A part whose stock is looked at.
pub struct Part<'a> {
    nodes: StockNodes<'a>,
}

/// How a part is cut.
pub struct Cuts {
    /// What the roughing leaves.
    roughed: Heights,
    /// What levels along upright walls leave, bit by bit, before rows come.
    walls: Heights,
    finishing: Vec<Passes>,
}

impl<'a> Part<'a> {
    pub fn new(body: &Body<'a>, allowances: Allowances, drilled: &'a [Drilled]) -> Self {
        Self { nodes: StockNodes::new(body.mesh(), allowances, drilled, NODES) }
    }

    /// How it is cut by a roughing, where there is any, and by operations that finish it.
    pub fn cuts(&self, rougher: Option<&Work>, finishing: &[Work]) -> Cuts {
        let mut walls = self.nodes.uncut();
        let passes = |work: &Work| {
            let tool = work.cutter.made()?;
            let mut standing = self.nodes.standing(&self.nodes.envelope(&tool, 0.0));
            if let (Serves::Walls, Some(faces)) = (work.serves, &work.faces) {
                self.lower_beside(faces, &tool, &standing, &mut walls);
            }
            let is_cut = |at: &Standing| work.faces.is_none() || work.names(at.face);
            standing.iter_mut().for_each(|at| *at = at.filter(is_cut));
            let middle = self.middle(&tool);
            Some(Passes { cutter: work.cutter, standing, middle, is_after_walls: work.serves != Serves::Walls })
        };
        let finishing = finishing.iter().filter_map(passes).collect();
        Cuts { roughed: self.roughed(rougher), walls, finishing }
    }

    /// The operations that are needed before some others finish the part, or why they cut so deep without; `on_floors`: where flat tools
    /// cut too deep, over level floors, too: what stands there stands in narrow spaces, mostly, and is better roughed with a narrower tool.
    ///
    /// # Errors
    /// No tools in between take enough: a sentence.
    pub fn between(
        &self,
        cuts: &Cuts,
        (rougher, finishing): (Option<&Work>, &[Work]),
        on_floors: bool,
    ) -> Result<Vec<Work>, String> {
        let deep = cuts.too_deep(&cuts.roughed, self);
        let Some((worst, depth)) = deep.iter().max_by(|(_, a), (_, b)| a.total_cmp(b)) else { return Ok(Vec::new()) };
        let words = format!(
            "the finishing tool of {} mm would cut up to {:.1} mm deep at once through what stands then, more than it is wide",
            worst.cutter.diameter,
            measured(*depth)
        );
        let is_on_floors = deep.iter().any(|(passes, _)| passes.cutter.shape == Shape::Flat);
        let steps = if is_on_floors && !on_floors { Vec::new() } else { self.steps(cuts, rougher) };
        let Some(chosen) = chosen(&steps, cuts, self) else {
            return Err(format!("{words}, and no wider ball gets to enough of it: take that with another tool first"));
        };
        Ok(chosen.iter().enumerate().map(|(number, step)| step.work(number, finishing, &words)).collect())
    }
}

/// The rows after which a part can be finished that are shortest together; none where no three narrowing balls do.
fn chosen<'s>(steps: &'s [Step], cuts: &Cuts, part: &Part<'_>) -> Option<Vec<&'s Step>> {
    let mut best: Option<(f64, Vec<&Step>)> = None;
    let mut open = vec![(0.0, Vec::new(), cuts.roughed.clone())];
    while let Some((length, taken, heights)) = open.pop() {
        if best.as_ref().is_some_and(|(shortest, _)| length >= *shortest) {
            continue;
        }
        if cuts.too_deep(&heights, part).is_empty() {
            best = Some((length, taken));
            continue;
        }
        let widest = taken.last().map_or(f64::INFINITY, |last: &&Step| last.rows.cutter.diameter);
        let follows = |step: &&Step| step.rows.cutter.diameter < widest;
        for step in steps.iter().filter(|_| taken.len() < STEPS).filter(follows) {
            let Some((more, after)) = step.taken(&heights, cuts, part) else { continue };
            open.push((length + more, taken.iter().copied().chain([step]).collect(), after));
        }
    }
    best.map(|(_, taken)| taken)
}

impl Part<'_> {
    /// What roughing leaves, where there is any.
    fn roughed(&self, rougher: Option<&Work>) -> Heights {
        let uncut = self.nodes.uncut();
        let Some((work, tool)) = rougher.and_then(|work| Some((work, work.cutter.made()?))) else { return uncut };
        let (front, envelope) = (self.nodes.front(&tool, BESIDE), self.nodes.envelope(&tool, work.leave));
        let floors: Vec<f64> = Floors::of(&envelope).bands().into_iter().map(|(tip, _)| tip).collect();
        let mut tips = self.nodes.tips(&envelope, front.reach());
        for tip in &mut tips {
            *tip = level_at(*tip, (self.nodes.top, work.passes.pitch), &floors);
        }
        lower(&uncut, &self.nodes.swept(&tips, &front).collect())
    }

    /// Lowers heights to where a tool stands beside upright walls of some faces, mm.
    fn lower_beside(&self, faces: &[u32], tool: &Tool, standing: &[Option<Standing>], heights: &mut Heights) {
        for ((height, at), is_beside) in heights.iter_mut().zip(standing).zip(self.nodes.beside(faces, tool.diameter()))
        {
            *height = at.filter(|_| is_beside).map_or(*height, |at| height.min(at.tip));
        }
    }

    /// The rows that there may be, with the widest ball first.
    fn steps(&self, cuts: &Cuts, rougher: Option<&Work>) -> Vec<Step> {
        let narrowest = cuts.finishing.iter().map(|passes| passes.cutter.diameter).fold(f64::INFINITY, f64::min);
        let by_size = WIDEST * self.nodes.size[0].min(self.nodes.size[1]);
        let widest = rougher.map_or(by_size, |work| work.cutter.diameter);
        let wider = sizes::between([narrowest, widest]).filter(|diameter| *diameter > narrowest);
        wider.filter_map(|diameter| self.rows(diameter)).collect()
    }

    /// Rows with a ball.
    fn rows(&self, diameter: f64) -> Option<Step> {
        let cutter = Cutter { shape: Shape::Ball, diameter };
        let tool = cutter.made()?;
        let (front, envelope) = (self.nodes.front(&tool, BESIDE), self.nodes.envelope(&tool, to_leave(diameter)));
        let leaves = self.nodes.swept(&self.nodes.tips(&envelope, front.reach()), &front).collect();
        let (standing, middle) = (self.nodes.standing(&envelope), self.middle(&tool));
        let rows = Passes { cutter, standing, middle, is_after_walls: false };
        Some(Step { pitch: round(ROWS * diameter), leaves, rows })
    }

    /// The part of a tool's front about its axis in which stock counts as cut at once.
    fn middle(&self, tool: &Tool) -> Front {
        self.nodes.middle(tool, MIDDLE * 0.5 * tool.diameter())
    }
}

impl Cuts {
    /// The operations that cut too deep at once through some stock, each with its largest depth, mm.
    fn too_deep(&self, heights: &Heights, part: &Part<'_>) -> Vec<(&Passes, f64)> {
        let each = self.finishing.iter();
        each.filter_map(|passes| Some((passes, passes.too_deep(heights, (&self.walls, &part.nodes))?))).collect()
    }
}

/// Where a tool goes along the part.
struct Passes {
    cutter: Cutter,
    standing: Vec<Option<Standing>>,
    middle: Front,
    /// Whether levels along walls come before.
    is_after_walls: bool,
}

impl Passes {
    /// The largest depth that it cuts at once, mm, where that is more than it may; `walls`: what levels along walls leave.
    fn too_deep(&self, heights: &Heights, (walls, nodes): (&Heights, &StockNodes<'_>)) -> Option<f64> {
        let lowered = self.is_after_walls.then(|| lower(heights, walls));
        let (mut count, mut largest) = (0, 0.0);
        for depth in nodes.over(lowered.as_ref().unwrap_or(heights), (&self.standing, &self.middle)) {
            count += usize::from(depth > DEEPEST * self.cutter.diameter);
            largest = f64::max(largest, depth);
        }
        (count > FEW).then_some(largest)
    }
}

/// Rows with a ball that may come in between.
struct Step {
    /// Between rows, mm.
    pitch: f64,
    /// What they leave of a whole stock.
    leaves: Heights,
    /// Where they go.
    rows: Passes,
}

impl Step {
    /// The length of the path, mm, about, and what is left after it; none where it cuts too deep itself.
    fn taken(&self, heights: &Heights, cuts: &Cuts, part: &Part<'_>) -> Option<(f64, Heights)> {
        let length = part.nodes.area(self.rows.standing.iter().flatten().count()) / self.pitch;
        let is_deep = self.rows.too_deep(heights, (&cuts.walls, &part.nodes)).is_some();
        (!is_deep).then(|| (length, lower(heights, &self.leaves)))
    }

    /// The operation, by its number among those in between; `words`: why.
    fn work(&self, number: usize, finishing: &[Work], words: &str) -> Work {
        let (cutter, pitch) = (self.rows.cutter, self.pitch);
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

/// The lowest level that is no lower than a tip, below the stock's top in equal steps or on a floor, mm.
fn level_at(tip: f64, (top, pitch): (f64, f64), floors: &[f64]) -> f64 {
    let by_steps = top - ((top - tip) / pitch + 1e-6).floor() * pitch;
    let over = floors.partition_point(|floor| *floor < tip - 1e-6 * pitch);
    floors.get(over).map_or(by_steps, |floor| by_steps.min(*floor))
}
