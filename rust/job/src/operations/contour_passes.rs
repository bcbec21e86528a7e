//! The path of a contour: parallels of its lines on each level, where the tool is free, and the ramps to them.

use std::collections::BTreeMap;

use styluscam_geometry::{Cutter, Stock, Vector};
use styluscam_motion::Role;
use styluscam_toolpath::budget::Budget;
use styluscam_toolpath::chamfer::{free_stretches, Stretch};
use styluscam_toolpath::contouring::{descent, Beside};
use styluscam_toolpath::offset::Envelope;
use styluscam_toolpath::plan::{apart, foot};
use styluscam_toolpath::{AlongSurface, Entered, Heights, Links, Pass, PathPoint, Rates, Seam, Sense, Surface};

use super::contour_work::{Level, Rule, Work};
use super::facts::{self, counted};
use super::in_order::in_order;
use super::room::Room;
use super::surface::sense;
use super::{budget, corners, links, Context, Fact, Fit, Planned};
use crate::JobError;

/// Heights that differ by less are the same, mm.
const SAME: f64 = 1e-5;
/// Air between a ramp's beginning and the material, mm.
const AIR: f64 = 0.2;
/// Positions of an edge are looked at so far apart at most, mm.
const APART: f64 = 0.1;
/// Of the path's deviation what parallels take for their chords, where arcs are fitted to them and where not: 1.3 times that is used.
const CHORDS: [f64; 2] = [0.35, 0.75];
/// And what arcs take.
const ARCS: f64 = 0.5;
/// What is between a level's path and that of the level above, at most, where the tool comes down through it, mm.
const BESIDE: f64 = 0.01;
/// Ways at depth from one level's path to the next are no longer than this, in tool radii.
const ACROSS: f64 = 1.0;

/// What paths are laid with.
struct Laying<'a> {
    rule: Rule,
    context: &'a Context<'a>,
    cutter: Cutter,
    room: Room<'a>,
    /// Of parallels' chords, mm.
    tolerance: f64,
    /// How far paths keep out of the part for its triangles and rounding, mm.
    margin: f64,
    sense: Sense,
}

/// A path on a level.
#[derive(Clone)]
struct Laid {
    path: Stretch,
    level: Level,
    /// Of the level in its work.
    number: usize,
    /// From the line, mm.
    distance: f64,
    /// Whether it goes against its line.
    is_turned: bool,
    /// Down to where stock is gone along it, mm.
    cleared: f64,
}

/// Paths one below the other.
type Stack = Vec<Laid>;

/// Plans a contour's moves.
pub(super) fn planned(rule: Rule, works: &[Work], context: &Context<'_>) -> Result<Planned, JobError> {
    if context.region.check.is_some() {
        let message = "part.check_faces are not kept away from by a contour";
        return Err(JobError::document("conflict", context.path.clone(), message, "remove part.check_faces"));
    }
    let budget = budget::of(context.common.tolerance, context.scene, context.machine);
    let budget = budget.map_err(|error| context.error(error))?;
    let laying = Laying::new(rule, context, &budget);
    let (mut lines, mut missed) = (Vec::new(), BTreeMap::new());
    for work in works {
        lines.push(laying.stacks(work)?);
        laying.missed(work, &mut missed);
    }
    lines.retain(|stacks| !stacks.is_empty());
    if lines.is_empty() {
        let message = "the tool can go along none of the edges without entering what is beside them";
        let hint = "take a smaller tool, set another edge_side, or raise z_bottom";
        return Err(JobError::document("no-room", format!("{}.tool", context.path), message, hint));
    }
    let begin = |stacks: &Vec<Stack>| {
        let first = stacks.first().and_then(|stack| stack.first()).and_then(|laid| laid.path.points.first());
        first.copied().unwrap_or_default()
    };
    // those of a line stay in their order, from the top down
    let (lines, across) = in_order(context, &lines, begin)?;
    let stacks: Vec<Stack> = lines.into_iter().flatten().collect();
    laying.moved(&stacks, (&budget, across), &missed, works.len())
}

impl<'a> Laying<'a> {
    fn new(rule: Rule, context: &'a Context<'a>, budget: &Budget) -> Self {
        let share = if context.common.fit == Fit::Arcs { CHORDS[0] } else { CHORDS[1] };
        let margin = budget.margin - budget.deviation;
        let material_on_right = rule.side.beside() != Some(Beside::Right);
        Self {
            rule,
            context,
            cutter: context.tool.cutter(),
            room: Room::new(context, (&context.scene.mesh, &context.scene.index), margin).standing(margin),
            tolerance: share * budget.deviation,
            margin: budget.margin,
            sense: sense(context.common, material_on_right),
        }
    }

    /// The paths along a line, from the top down.
    fn stacks(&self, work: &Work) -> Result<Vec<Stack>, JobError> {
        let line = work.plan_line();
        let mut parallels: BTreeMap<u64, Vec<Stretch>> = BTreeMap::new();
        let mut stacks: Vec<Stack> = Vec::new();
        for (number, level) in work.levels.iter().enumerate() {
            let distance = work.distance(&self.cutter, self.rule.side, *level);
            let all = parallels.entry(distance.to_bits()).or_insert_with(|| match self.rule.side.beside() {
                Some(side) => line.parallels(side, distance + self.margin, self.tolerance),
                None => vec![line.path()],
            });
            for whole in all.iter() {
                let is_free = |[x, y]: [f64; 2]| self.room.is_free([x, y, level.tip]);
                for mut path in free_stretches(whole, is_free, self.context.watch)? {
                    let is_turned = self.sense.turns(number);
                    if is_turned {
                        path.points.reverse();
                    }
                    let laid = Laid { path, level: *level, number, distance, is_turned, cleared: work.begins };
                    self.put(laid, &mut stacks);
                }
            }
        }
        Ok(stacks)
    }

    /// Puts a path under the one that it goes on from.
    fn put(&self, laid: Laid, stacks: &mut Vec<Stack>) {
        for stack in stacks.iter_mut() {
            let Some(above) = stack.last().filter(|above| above.number + 1 == laid.number) else { continue };
            let is_below = (laid.distance - above.distance).abs() <= BESIDE
                && laid.path.points.iter().all(|point| beside(&above.path.points, *point) <= BESIDE);
            let end = above.path.points.last().copied().unwrap_or_default();
            if is_below || self.going_on(&laid, (end, above.level.tip)).is_some() {
                let cleared = if is_below { above.level.tip } else { laid.cleared };
                stack.push(Laid { cleared, ..laid });
                return;
            }
        }
        stacks.push(vec![laid]);
    }

    /// A path as it goes on from a point of the one above, at that one's height (mm): a closed one begins beside it. None where it is too
    /// far, or something is between.
    fn going_on(&self, laid: &Laid, (end, tip): ([f64; 2], f64)) -> Option<Stretch> {
        let mut path = laid.path.clone();
        if path.closed {
            begin_near(&mut path.points, end);
        }
        let begin = path.points.first().copied()?;
        let is_short = apart(begin, end) <= ACROSS * self.cutter.max_radius();
        (is_short && self.is_free_between([end, begin], tip)).then_some(path)
    }

    fn is_free_between(&self, [a, b]: [[f64; 2]; 2], z: f64) -> bool {
        let count = (apart(a, b) / APART).ceil().max(1.0) as usize;
        (0..=count).all(|i| {
            let share = i as f64 / count as f64;
            self.room.is_free([a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), z])
        })
    }

    /// Adds the length of each edge beside which the tool is not free on the lowest level, by its name, mm.
    fn missed(&self, work: &Work, missed: &mut BTreeMap<String, f64>) {
        let Some(level) = work.levels.last() else { return };
        let side = match self.rule.side.beside() {
            Some(Beside::Left) => 1.0,
            Some(Beside::Right) => -1.0,
            None => 0.0,
        };
        let distance = side * (work.distance(&self.cutter, self.rule.side, *level) + self.margin);
        for piece in &work.line.pieces {
            let (from, way) = (piece.ends[0], piece.ends[1] - piece.ends[0]);
            let length = way.norm();
            let count = (length / APART).ceil().max(1.0);
            let stopped = (0..count as usize).filter(|i| {
                let at = from + way * ((*i as f64 + 0.5) / count);
                !self.room.is_free([at.x - distance * way.y / length, at.y + distance * way.x / length, level.tip])
            });
            let stopped = stopped.count();
            if stopped > 0 {
                *missed.entry(piece.name.clone()).or_insert(0.0) += length * stopped as f64 / count;
            }
        }
    }

    /// Paths with what leads to each.
    fn entered(&self, stacks: &[Stack]) -> Vec<Entered> {
        let mut entered = Vec::new();
        for stack in stacks {
            let mut end: Option<PathPoint> = None;
            for laid in stack {
                let is_beside = laid.path.points.iter().all(|point| self.is_beside_stock(*point));
                let Some(slope) = self.rule.slope.filter(|_| !is_beside) else {
                    let pass = self.pass(&laid.path, laid);
                    end = pass.points.last().copied();
                    entered.push(Entered::from(pass));
                    continue;
                };
                let goes_on =
                    end.and_then(|end| Some((end, self.going_on(laid, ([end.tip.x, end.tip.y], end.tip.z))?)));
                let from = goes_on.as_ref().map_or(laid.cleared + AIR, |(end, _)| end.tip.z);
                let path = goes_on.as_ref().map_or(&laid.path, |(_, path)| path);
                let down = descent(path, [from, laid.level.tip], slope);
                let tips = self.points(&down.ramp, laid.is_turned);
                let pass = self.pass(&down.path, laid);
                let ramp = match goes_on {
                    Some((end, _)) => std::iter::once(end).chain(tips).collect(),
                    None => {
                        // the tool comes to the ramp's beginning through the air
                        let points = tips.first().copied().into_iter().collect();
                        entered.push(Entered::from(Pass { points, closed: false, group: laid.number }));
                        tips
                    }
                };
                end = pass.points.last().copied();
                entered.push(Entered { pass, ramp, role: Some(Role::Ramp) });
            }
        }
        entered
    }

    /// Whether the tool comes down beside the stock there.
    fn is_beside_stock(&self, [x, y]: [f64; 2]) -> bool {
        let radius = self.cutter.max_radius();
        self.context.scene.stock.as_ref().is_none_or(|stock: &Stock| {
            let (low, high) = stock.bounds();
            let out = [(low.x - x).max(x - high.x).max(0.0), (low.y - y).max(y - high.y).max(0.0)];
            libm::hypot(out[0], out[1]) >= radius - SAME
        })
    }

    fn pass(&self, path: &Stretch, laid: &Laid) -> Pass {
        let tips: Vec<Vector> = path.points.iter().map(|[x, y]| Vector::new(*x, *y, laid.level.tip)).collect();
        Pass { points: self.points(&tips, laid.is_turned), closed: path.closed, group: laid.number }
    }

    /// Tips with the direction away from the edge.
    fn points(&self, tips: &[Vector], is_turned: bool) -> Vec<PathPoint> {
        let side = match self.rule.side.beside() {
            Some(Beside::Left) => 1.0,
            Some(Beside::Right) => -1.0,
            None => 0.0,
        };
        let side = if is_turned { -side } else { side };
        let point = |(number, tip): (usize, &Vector)| {
            let (from, to) = (tips.get(number.saturating_sub(1)), tips.get(number + 1));
            let along = to.unwrap_or(tip) - from.filter(|_| number + 1 == tips.len()).unwrap_or(tip);
            let normal = Vector::new(-side * along.y, side * along.x, 0.0).try_normalize(0.0);
            PathPoint { tip: *tip, normal: normal.unwrap_or(Vector::z()), selected: true, triangle: 0 }
        };
        tips.iter().enumerate().map(point).collect()
    }

    /// The moves along paths.
    fn moved(
        &self,
        stacks: &[Stack],
        (budget, across): (&Budget, f64),
        missed: &BTreeMap<String, f64>,
        lines: usize,
    ) -> Result<Planned, JobError> {
        let context = self.context;
        let (scene, common) = (context.scene, context.common);
        // level floors are stood on as they are
        let envelope = Envelope::new(&scene.mesh, &scene.index, context.tool, None, scene.inward);
        let surface = Surface::whole(&envelope);
        let along = AlongSurface {
            surface: &surface,
            planes: None,
            longest: -1.0, // paths that are not joined are linked over clearance
            deviation: budget.deviation,
            narrow: context.node_spacing(),
            corner: f64::INFINITY,
            feed: common.feeds.cut,
        };
        let rules = Links {
            heights: Heights { clearance: scene.clearance, retract: scene.retract },
            rates: Rates { cut: common.feeds.cut, plunge: common.feeds.plunge },
            operation: context.operation,
        };
        let entered = self.entered(stacks);
        let passes: Vec<Pass> = entered.iter().map(|entered| entered.pass.clone()).collect();
        let tabs = self.rule.tabs.map(|tabs| tabs.planned(context, &passes)).transpose()?;
        let (moves, linked) =
            links::linked(context, (entered, Seam::Nearest, ARCS * budget.deviation), (along, false), &rules)?;
        let mut facts = self.facts(stacks, across);
        facts.extend(linked);
        facts.extend(tabs.as_ref().map(|tabs| tabs.fact()));
        facts.extend(facts::not_reached(missed));
        let mut moves = match &tabs {
            Some(tabs) => tabs.lifted(context, &moves),
            None => moves,
        };
        if common.slow_corners {
            let (slowed, slow) = corners::slowed_down(context, &moves)?;
            facts.push(slow);
            moves = slowed;
        }
        let count: usize = stacks.iter().map(Vec::len).sum();
        let words = counted(count, "pass", "passes") + " along " + &counted(lines, "line of edges", "lines of edges");
        let (events, cycles) = (Vec::new(), Vec::new());
        Ok(Planned { moves, events, cycles, note: words.clone(), words, facts, surface: None })
    }

    fn facts(&self, stacks: &[Stack], across: f64) -> Vec<Fact> {
        let laid = || stacks.iter().flatten();
        let levels = laid().map(|laid| laid.number + 1).max().unwrap_or_default();
        let length: f64 = laid().map(|laid| laid.path.length()).sum();
        let lowest = laid().map(|laid| laid.level.tip).fold(f64::INFINITY, f64::min);
        let mut facts = vec![
            Fact::count(laid().count(), "pass", "passes"),
            Fact::count(levels, "level", "levels"),
            Fact::length("contoured", length, "along edges, all levels together,"),
            Fact { fact: "lowest", value: lowest, unit: "mm", words: format!("the lowest level at Z{lowest:.3}") },
        ];
        if across > 0.0 {
            facts.push(Fact::length("across", across, "across from line to line"));
        }
        facts
    }
}

/// Has a closed path begin at its point that is nearest to another.
fn begin_near(points: &mut Vec<[f64; 2]>, at: [f64; 2]) {
    let nearest = points.windows(2).enumerate().map(|(number, pair)| (number, foot(at, [pair[0], pair[1]])));
    let Some((number, begin)) = nearest.min_by(|a, b| apart(a.1, at).total_cmp(&apart(b.1, at))) else { return };
    points.pop();
    let count = points.len().max(1);
    points.rotate_left((number + 1) % count);
    let is_corner = |point: Option<&[f64; 2]>| point.is_some_and(|point| apart(*point, begin) <= SAME);
    if is_corner(points.last()) {
        points.pop();
    } else if is_corner(points.first()) {
        points.remove(0);
    }
    points.insert(0, begin);
    points.push(begin);
}

/// How far a point is from a path in plan, mm.
fn beside(points: &[[f64; 2]], point: [f64; 2]) -> f64 {
    points.windows(2).map(|pair| apart(foot(point, [pair[0], pair[1]]), point)).fold(f64::INFINITY, f64::min)
}
