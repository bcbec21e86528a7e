//! What a starter job cuts between roughing and finishing: where roughing leaves more than a finishing tool is wide, that would cut it all
//! at once. Rows with wider balls take it over slopes.

use styluscam_geometry::Tool;
use styluscam_toolpath::forming::Floors;
use styluscam_verify::{CUT_BY_MIDDLE, DEEPEST_AT_ONCE};

use super::allowances::Allowances;
use super::cutter::{Cutter, Shape};
use super::drilling::Drilled;
use super::operations::NAMES;
use super::roughing::{to_leave, WIDEST};
use super::shop::Shop;
use super::sizes::{measured, round};
use super::stock_nodes::{Front, Standing, StockNodes};
use super::work::Work;
use crate::body::Body;
use crate::operations::{Serves, StarterPasses};

/// Nodes along the longer side of the stock in plan: they are nearer than the narrowest tool's radius, a hundredth of the part's size.
const NODES: f64 = 160.0;
/// Nodes in finishing, which is there anyhow, on which tools may cut deeper through the stock at once than the verifier lets them
/// ([`DEEPEST_AT_ONCE`]): so few are no reason for more operations.
const FEW: usize = 2;
/// A node counts as swept where it is beside a tool's rim by this share of the distance between nodes.
const BESIDE: f64 = 0.5;
/// Distance between rows, in diameters: what stands between them is about what is left for finishing.
const ROWS: f64 = 0.2;
/// Rows are over slopes on more than this share of the nodes where they stand on the part.
const SLOPES: f64 = 0.1;
/// Operations between roughing and finishing at most.
const STEPS: usize = 3;

/// Heights of the stock at the nodes, mm.
type Heights = Vec<f64>;

/// The stock that some operations leave.
#[derive(Clone)]
struct Left {
    /// About.
    about: Heights,
    /// At most: in narrow spaces, what nodes do not resolve stands as well.
    most: Heights,
}

impl Left {
    /// What is left after others as well.
    fn after(&self, others: &Self) -> Self {
        Self { about: lower(&self.about, &others.about), most: lower(&self.most, &others.most) }
    }

    /// What is left after levels along walls, which are known about only.
    fn after_walls(&self, walls: &Heights) -> Self {
        Self { about: lower(&self.about, walls), most: lower(&self.most, walls) }
    }
}

/// A part whose stock is looked at.
pub struct Part<'a> {
    nodes: StockNodes<'a>,
    pub shop: &'a Shop,
}

/// Operations between roughing and finishing.
pub struct Between {
    pub works: Vec<Work>,
    /// Whether they come after the levels along upright walls, since the balls would go deep down beside those.
    pub are_after_walls: bool,
}

impl Between {
    const NOTHING: Self = Self { works: Vec::new(), are_after_walls: false };

    /// With the finishing, in order.
    pub fn before(self, finishing: Vec<Work>) -> impl Iterator<Item = Work> {
        let is_before = |work: &Work| self.are_after_walls && work.serves == Serves::Walls;
        let (walls, rest): (Vec<Work>, Vec<Work>) = finishing.into_iter().partition(is_before);
        walls.into_iter().chain(self.works).chain(rest)
    }
}

/// How a part is cut.
pub struct Cuts {
    /// What the roughing leaves.
    roughed: Left,
    /// What levels along upright walls leave, bit by bit, before rows come.
    walls: Heights,
    finishing: Vec<Passes>,
}

impl<'a> Part<'a> {
    pub fn new((body, shop): (&Body<'a>, &'a Shop), allowances: Allowances, drilled: &'a [Drilled]) -> Self {
        Self { nodes: StockNodes::new(body.mesh(), allowances, drilled, NODES), shop }
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
    ) -> Result<Between, String> {
        let deep = cuts.too_deep(&cuts.roughed.about, self);
        let Some((worst, depth)) = deep.iter().max_by(|(_, a), (_, b)| a.total_cmp(b)) else {
            return Ok(Between::NOTHING);
        };
        let words = format!(
            "the finishing tool of {} mm would cut up to {:.1} mm deep at once through what stands then, more than it is wide",
            worst.cutter.diameter,
            measured(*depth)
        );
        let is_on_floors = deep.iter().any(|(passes, _)| passes.cutter.shape == Shape::Flat);
        let are_possible = (on_floors || !is_on_floors) && cuts.are_over_slopes();
        let steps = if are_possible { self.steps(cuts, rougher) } else { Vec::new() };
        let works = |chosen: Vec<&Step>| -> Vec<Work> {
            chosen.iter().enumerate().map(|(number, step)| step.work(number, finishing, &words)).collect()
        };
        if let Some(chosen) = chosen(&steps, cuts, self, &cuts.roughed) {
            return Ok(Between { works: works(chosen), are_after_walls: false });
        }
        // levels along walls are finished first where they may cut all that is there
        let has_walls = cuts.finishing.iter().any(|passes| !passes.is_after_walls);
        let are_walls_deep = deep.iter().any(|(passes, _)| !passes.is_after_walls);
        let after_walls = (has_walls && !are_walls_deep).then(|| cuts.roughed.after_walls(&cuts.walls));
        let Some(chosen) = after_walls.and_then(|left| chosen(&steps, cuts, self, &left)) else {
            return Err(format!("{words}, and no wider ball gets to enough of it without cutting as deep: take that with another tool first"));
        };
        let mut works = works(chosen);
        if let Some(first) = works.first_mut() {
            first.why.push("after the levels along the walls: beside them it would cut deep down before".to_owned());
        }
        Ok(Between { works, are_after_walls: true })
    }
}

/// The rows after which a part can be finished that are shortest together, through what stands before them; none where no three
/// narrowing balls do.
fn chosen<'s>(steps: &'s [Step], cuts: &Cuts, part: &Part<'_>, before: &Left) -> Option<Vec<&'s Step>> {
    let mut best: Option<(f64, Vec<&Step>)> = None;
    let mut open = vec![(0.0, Vec::new(), before.clone())];
    while let Some((length, taken, left)) = open.pop() {
        if best.as_ref().is_some_and(|(shortest, _)| length >= *shortest) {
            continue;
        }
        if cuts.too_deep(&left.about, part).is_empty() {
            best = Some((length, taken));
            continue;
        }
        let widest = taken.last().map_or(f64::INFINITY, |last: &&Step| last.rows.cutter.diameter);
        let follows = |step: &&Step| step.rows.cutter.diameter < widest;
        for step in steps.iter().filter(|_| taken.len() < STEPS).filter(follows) {
            let Some((more, after)) = step.taken(&left, part) else { continue };
            open.push((length + more, taken.iter().copied().chain([step]).collect(), after));
        }
    }
    best.map(|(_, taken)| taken)
}

impl Part<'_> {
    /// What roughing leaves, where there is any.
    fn roughed(&self, rougher: Option<&Work>) -> Left {
        let uncut = self.nodes.uncut();
        let Some((work, tool)) = rougher.and_then(|work| Some((work, work.cutter.made()?))) else {
            return Left { about: uncut.clone(), most: uncut };
        };
        let (front, envelope) = (self.nodes.front(&tool, BESIDE), self.nodes.envelope(&tool, work.leave));
        let floors: Vec<f64> = Floors::of(&envelope).bands().into_iter().map(|(tip, _)| tip).collect();
        let mut tips = self.nodes.tips(&envelope, front.reach());
        for tip in &mut tips {
            *tip = level_at(*tip, (self.nodes.top, work.passes.pitch), &floors);
        }
        let cut = self.left(&tips, &front);
        Left { about: uncut.clone(), most: uncut }.after(&cut)
    }

    /// What the front of a tool leaves of a stock without end, at some tips.
    fn left(&self, tips: &[f64], front: &Front) -> Left {
        let left = |front: &Front| self.nodes.swept(tips, front).collect();
        Left { about: left(front), most: left(&front.without_rim(1)) }
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
        let [smaller, _] = self.nodes.stock_sides();
        let by_size = WIDEST * smaller;
        let widest = rougher.map_or(by_size, |work| work.cutter.diameter);
        let wider = self.shop.between([narrowest, widest], Shape::Ball);
        let wider = wider.filter(|diameter| *diameter > narrowest);
        wider.filter_map(|diameter| self.rows(diameter)).collect()
    }

    /// Rows with a ball.
    fn rows(&self, diameter: f64) -> Option<Step> {
        let cutter = Cutter { shape: Shape::Ball, diameter };
        let tool = cutter.made()?;
        let (front, envelope) = (self.nodes.front(&tool, BESIDE), self.nodes.envelope(&tool, to_leave(diameter)));
        let tips = self.nodes.tips(&envelope, front.reach());
        let leaves = self.left(&tips, &front);
        let (standing, middle) = (self.nodes.standing(&envelope), self.middle(&tool));
        let rows = Passes { cutter, standing, middle, is_after_walls: false };
        Some(Step { pitch: round(ROWS * diameter), leaves, rows })
    }

    /// The part of a tool's front about its axis in which stock counts as cut at once.
    fn middle(&self, tool: &Tool) -> Front {
        self.nodes.middle(tool, CUT_BY_MIDDLE * 0.5 * tool.diameter())
    }
}

impl Cuts {
    /// Whether enough of what is finished is sloped or level for rows to go there before: beside upright walls they cut nothing.
    fn are_over_slopes(&self) -> bool {
        let standing = || self.finishing.iter().flat_map(|passes| passes.standing.iter().flatten());
        let on_slopes = standing().filter(|at| !at.is_beside_wall).count();
        on_slopes as f64 > SLOPES * standing().count() as f64
    }

    /// The operations that cut too deep at once through some stock, each with its largest depth, mm.
    fn too_deep(&self, heights: &Heights, part: &Part<'_>) -> Vec<(&Passes, f64)> {
        let after_walls = lower(heights, &self.walls);
        let too_deep = |passes: &Passes| {
            passes.too_deep(if passes.is_after_walls { &after_walls } else { heights }, &part.nodes, FEW)
        };
        self.finishing.iter().filter_map(|passes| Some((passes, too_deep(passes)?))).collect()
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
    /// The largest depth that it cuts at once, mm, where that is more than it may at more than a `few` nodes.
    fn too_deep(&self, heights: &Heights, nodes: &StockNodes<'_>, few: usize) -> Option<f64> {
        let (mut count, mut largest) = (0, 0.0);
        for depth in nodes.over(heights, (&self.standing, &self.middle)) {
            count += usize::from(depth > DEEPEST_AT_ONCE * self.cutter.diameter);
            largest = f64::max(largest, depth);
        }
        (count > few).then_some(largest)
    }
}

/// Rows with a ball that may come in between.
struct Step {
    /// Between rows, mm.
    pitch: f64,
    /// What they leave of a whole stock.
    leaves: Left,
    /// Where they go.
    rows: Passes,
}

impl Step {
    /// The length of the path, mm, about, and what is left after it; none where it cuts too deep itself.
    fn taken(&self, left: &Left, part: &Part<'_>) -> Option<(f64, Left)> {
        let length = part.nodes.area(self.rows.standing.iter().flatten().count()) / self.pitch;
        let is_deep = self.rows.too_deep(&left.most, &part.nodes, 0).is_some();
        (!is_deep).then(|| (length, left.after(&self.leaves)))
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

#[cfg(test)]
mod tests {
    use super::*;

    fn work(id: &str, serves: Serves) -> Work {
        Work {
            id: id.to_owned(),
            serves,
            tool: "cutter".to_owned(),
            cutter: Cutter { shape: Shape::Ball, diameter: 4.0 },
            faces: None,
            passes: StarterPasses::default(),
            leave: 0.0,
            why: Vec::new(),
        }
    }

    #[test]
    fn rows_come_before_finishing_or_after_the_walls() {
        let finishing = || vec![work("floors", Serves::Floors), work("walls", Serves::Walls)];
        let order = |are_after_walls: bool| -> Vec<String> {
            let between = Between { works: vec![work("rows", Serves::Floors)], are_after_walls };
            between.before(finishing()).map(|work| work.id).collect()
        };
        assert_eq!(order(false), ["rows", "floors", "walls"]);
        assert_eq!(order(true), ["walls", "rows", "floors"]);
    }

    #[test]
    fn what_is_left_at_most_is_lowered_by_what_others_leave_at_most() {
        let others = Left { about: vec![2.0, 2.0], most: vec![2.5, 6.0] };
        let left = Left { about: vec![1.0, 5.0], most: vec![3.0, 5.0] }.after(&others);
        assert_eq!((left.about, left.most), (vec![1.0, 2.0], vec![2.5, 5.0]));
    }
}
