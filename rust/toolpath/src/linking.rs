//! From passes to moves: their order, their direction, and how the tool gets from one to the next.
//!
//! The strategy decides how: it calls [`link`] or [`join`] with rules of its own. Where they give no path, the tool goes
//! up, across at clearance height or as low as the rules have it, and down again at plunge feed. Derived in
//! docs/concepts/linking.md.

use rayon::prelude::*;
use styluscam_geometry::Vector;
use styluscam_motion::{Cancelled, Move, Role, Watch};

use crate::{fitting, fitting::Course, Arcs, Fitted, Pass, PathPoint, Planes, Segment, Surface};

/// Heights of rapids from run to run, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heights {
    /// Rapids cross here.
    pub clearance: f64,
    /// Rapids come down to here; from here on at plunge feed.
    pub retract: f64,
}

/// Feeds, mm/min.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates {
    /// Along passes and links that touch.
    pub cut: f64,
    /// Straight down.
    pub plunge: f64,
}

/// How the tool gets from pass to pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Links {
    /// Heights of links over clearance.
    pub heights: Heights,
    /// Feeds.
    pub rates: Rates,
    /// Index of the operation.
    pub operation: u32,
}

/// Whatever stands at a position of the tip.
pub trait Position {
    /// The tip, mm.
    fn tip(&self) -> Vector;
}

impl Position for Vector {
    fn tip(&self) -> Vector {
        *self
    }
}

impl Position for PathPoint {
    fn tip(&self) -> Vector {
        self.tip
    }
}

/// A strategy's rules for the gaps between its runs.
pub trait LinkRules<P>: Sync {
    /// The path at a feed from the end of one run to the start of the next, which is its last segment's end; none where the tool
    /// has to leave the material.
    fn path(&self, from: &P, to: &P) -> Option<Vec<Segment>>;

    /// Heights of the rapids to a run, by its number, where there is no such path; `from` is where the run before ends, none
    /// before the first. `ceiling` is as high as they go.
    fn heights(&self, _number: usize, _from: Option<Vector>, _to: Vector, ceiling: Heights) -> Heights {
        ceiling
    }

    /// The lead into a run, by its number, where the tool comes to it through the air; none where it comes straight down.
    fn lead_in(&self, _number: usize, _run: &Run<P>) -> Option<Lead> {
        None
    }

    /// The lead out of a run, where the tool leaves it into the air; none where it goes straight up.
    fn lead_out(&self, _number: usize, _run: &Run<P>) -> Option<Lead> {
        None
    }
}

/// A path into a run, or out of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Lead {
    /// Its end away from the run, mm.
    pub far: Vector,
    /// From there to the run, or from the run to there.
    pub segments: Vec<Segment>,
}

/// Every link goes over clearance.
#[derive(Clone, Copy, Debug)]
pub struct OverClearance;

impl<P> LinkRules<P> for OverClearance {
    fn path(&self, _from: &P, _to: &P) -> Option<Vec<Segment>> {
        None
    }
}

/// Short links follow the envelope, as long as they touch selected faces only.
pub struct AlongSurface<'a> {
    /// The envelope, and what of it is selected.
    pub surface: &'a Surface<'a>,
    /// Planes of layers: no link goes below the one under its ends.
    pub planes: Option<Planes>,
    /// Longest distance in plan, mm.
    pub longest: f64,
    /// How far a chord may be from the envelope, mm.
    pub deviation: f64,
    /// What is narrower may be missed, mm.
    pub narrow: f64,
    /// mm/min.
    pub feed: f64,
}

impl LinkRules<PathPoint> for AlongSurface<'_> {
    fn path(&self, from: &PathPoint, to: &PathPoint) -> Option<Vec<Segment>> {
        if (to.tip - from.tip).xy().norm() > self.longest {
            return None;
        }
        let floor = |planes: Planes| planes.under(from.tip.z.min(to.tip.z));
        let surface = self.surface.above(self.planes.map_or(f64::NEG_INFINITY, floor));
        let run = along_selected(&surface, &[*from, *to], self.deviation, self.narrow)?;
        Some(lines(&fitting::thinned(&run, self.deviation)[1..], self.feed))
    }
}

/// Witnesses of the envelope over the line through some points; none where it touches anything but selected faces.
pub(crate) fn along_selected(
    surface: &Surface<'_>,
    points: &[PathPoint],
    deviation: f64,
    narrow: f64,
) -> Option<Vec<PathPoint>> {
    let mut crossing = Crossing { surface, hint: None, is_selected: true };
    let runs = fitting::densified(points, deviation, narrow, &mut crossing);
    runs.into_iter().next().filter(|run| crossing.is_selected && surface.goes_on_along(run))
}

/// Short links between points of one height go straight, where the ground between them is cleared.
pub struct AtDepth<F> {
    /// Longest distance, mm.
    pub longest: f64,
    /// Heights that differ by no more are one, mm.
    pub same_height: f64,
    /// Whether nothing is left to cut between two points.
    pub is_cleared: F,
    /// mm/min.
    pub feed: f64,
}

impl<P: Position, F: Fn(Vector, Vector) -> bool + Sync> LinkRules<P> for AtDepth<F> {
    fn path(&self, from: &P, to: &P) -> Option<Vec<Segment>> {
        let (from, to) = (from.tip(), to.tip());
        let across = (to - from).norm() <= self.longest && (to.z - from.z).abs() <= self.same_height;
        (across && (self.is_cleared)(from, to)).then(|| vec![Segment::line(to, self.feed)])
    }
}

/// A path that the tool follows without leaving it.
#[derive(Clone, Debug, PartialEq)]
pub struct Run<P> {
    /// Where it begins.
    pub from: P,
    /// Where it ends: the end of its last segment.
    pub to: P,
    /// In order.
    pub segments: Vec<Segment>,
}

/// A pass as it is followed, and how the tool gets to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Entered {
    /// The pass, in its direction, from where it begins.
    pub pass: Pass,
    /// The ramp down from the end of the pass before, or the turn from there, its ends included; empty where the rules decide.
    pub ramp: Vec<PathPoint>,
    /// What that is for; none where it touches as passes do.
    pub role: Option<Role>,
}

impl From<Pass> for Entered {
    fn from(pass: Pass) -> Self {
        Self { pass, ramp: Vec::new(), role: None }
    }
}

/// The moves along all passes, in their order, joined by their ramps and by the rules.
///
/// # Errors
/// `Cancelled`.
pub fn link(
    passes: &[Entered],
    rules: &impl LinkRules<PathPoint>,
    links: &Links,
    watch: &Watch,
) -> Result<Vec<Move>, Cancelled> {
    watch.begin("linking", passes.len());
    let along = |points: &[PathPoint]| lines(points.get(1..).unwrap_or_default(), links.rates.cut);
    moves(passes, along, rules, links, watch)
}

/// As [`link`], with arcs and lines along the passes and their ramps, whose points are all witnesses
/// ([`Surface::keeping_witnesses`]); they deviate by at most `deviation` mm along the normal.
///
/// # Errors
/// `Cancelled`.
pub fn link_with_arcs(
    passes: &[Entered],
    (arcs, deviation): (&Arcs<'_>, f64),
    rules: &impl LinkRules<PathPoint>,
    links: &Links,
    watch: &Watch,
) -> Result<(Vec<Move>, Fitted), Cancelled> {
    watch.begin("fitting arcs", passes.len());
    let fitted = |entered: &Entered| {
        watch.advance(1)?;
        let along = |points: &[PathPoint]| {
            let segments = arcs.along(points, deviation, links.rates.cut);
            let figures = Fitted::of(points, &segments, deviation);
            (segments, figures)
        };
        Ok([along(&entered.pass.points), along(&entered.ramp)])
    };
    let fitted: Result<Vec<_>, Cancelled> = passes.par_iter().map(fitted).collect();
    watch.begin("linking", passes.len());
    let fitted = fitted?.into_iter().flatten();
    let figures = fitted.clone().fold(Fitted::default(), |all, (_, figures)| all.and(figures));
    let mut fitted = fitted.map(|(segments, _)| segments);
    let moves = moves(passes, |_| fitted.next().unwrap_or_default(), rules, links, watch)?;
    Ok((moves, figures))
}

/// The moves along all passes, each of which and its ramp are followed as `along` has it, in this order.
fn moves(
    passes: &[Entered],
    mut along: impl FnMut(&[PathPoint]) -> Vec<Segment>,
    rules: &impl LinkRules<PathPoint>,
    links: &Links,
    watch: &Watch,
) -> Result<Vec<Move>, Cancelled> {
    let (mut runs, mut ramps) = (Vec::with_capacity(passes.len()), Vec::with_capacity(passes.len()));
    for Entered { pass, ramp, role } in passes {
        let (segments, down) = (along(&pass.points), along(ramp));
        if let (Some(first), Some(last)) = (pass.points.first(), pass.points.last()) {
            runs.push(Run { from: *first, to: *last, segments });
            let down = down.into_iter().map(|segment| Segment { role: *role, ..segment });
            ramps.push((!ramp.is_empty()).then(|| down.collect()));
        }
    }
    let segments = joined(&runs, &ramps, rules, links, watch)?;
    Ok(segments.iter().map(|segment| segment.to_move(links.operation)).collect())
}

/// All runs in their order, joined by the rules: from clearance height to clearance height.
///
/// Advances the watch by the number of runs.
///
/// # Errors
/// `Cancelled`.
pub fn join<P: Position + Sync>(
    runs: &[Run<P>],
    rules: &impl LinkRules<P>,
    links: &Links,
    watch: &Watch,
) -> Result<Vec<Segment>, Cancelled> {
    joined(runs, &[], rules, links, watch)
}

/// As [`join`], where some of the paths to the runs are known.
fn joined<P: Position + Sync>(
    runs: &[Run<P>],
    known: &[Option<Vec<Segment>>],
    rules: &impl LinkRules<P>,
    links: &Links,
    watch: &Watch,
) -> Result<Vec<Segment>, Cancelled> {
    let gap = |number: usize| {
        watch.advance(1)?;
        if let Some(Some(path)) = known.get(number) {
            return Ok(path.clone());
        }
        let run = &runs[number];
        let before = number.checked_sub(1).map(|before| (before, &runs[before]));
        let path = before.and_then(|(_, before)| rules.path(&before.to, &run.from));
        Ok(path.unwrap_or_else(|| {
            let (out, into) = (before.map(|(number, run)| out_of(number, run, rules)), rules.lead_in(number, run));
            let (from, to) = (out.as_ref().map(|out| out.far), into.as_ref().map_or(run.from.tip(), |into| into.far));
            let heights = rules.heights(number, from, to, links.heights);
            let leaving = out.into_iter().flat_map(|out| out.segments);
            let through_air = from.map(|from| up(from, heights.clearance));
            let through_air = through_air.into_iter().chain(down(to, heights, links.rates.plunge));
            leaving.chain(through_air).chain(into.into_iter().flat_map(|into| into.segments)).collect()
        }))
    };
    let paths: Result<Vec<Vec<Segment>>, Cancelled> = (0..runs.len()).into_par_iter().map(gap).collect();
    let mut joined = Vec::new();
    for (run, path) in runs.iter().zip(paths?) {
        joined.extend(path);
        joined.extend_from_slice(&run.segments);
    }
    if let Some(last) = runs.last() {
        let out = out_of(runs.len() - 1, last, rules);
        joined.extend(out.segments);
        joined.push(up(out.far, links.heights.clearance));
    }
    Ok(joined)
}

/// The lead out of a run; of no length where there is none.
fn out_of<P: Position>(number: usize, run: &Run<P>, rules: &impl LinkRules<P>) -> Lead {
    rules.lead_out(number, run).unwrap_or_else(|| Lead { far: run.to.tip(), segments: Vec::new() })
}

fn lines(points: &[PathPoint], feed: f64) -> Vec<Segment> {
    points.iter().map(|point| Segment::line(point.tip, feed)).collect()
}

/// Straight up to a height.
fn up(from: Vector, height: f64) -> Segment {
    Segment::rapid(at_height(from, height))
}

/// From where rapids cross down to a point: at rapid to the retract height, then at plunge feed.
fn down(to: Vector, Heights { clearance, retract }: Heights, plunge: f64) -> impl Iterator<Item = Segment> {
    let come_down = (retract < clearance).then(|| Segment::rapid(at_height(to, retract)));
    let across = Segment::rapid(at_height(to, clearance));
    std::iter::once(across).chain(come_down).chain([Segment::line(to, plunge)])
}

/// The envelope between two passes.
struct Crossing<'a> {
    surface: &'a Surface<'a>,
    hint: Option<u32>,
    /// Whether only selected faces have been touched so far.
    is_selected: bool,
}

impl Course for Crossing<'_> {
    fn between(&mut self, a: &PathPoint, b: &PathPoint) -> Option<PathPoint> {
        let middle = self.surface.between(a, b, &mut self.hint);
        self.is_selected &= middle.is_some_and(|m| m.selected);
        middle.filter(|_| self.is_selected)
    }

    fn keeps_to(&self, a: &PathPoint, b: &PathPoint, most: f64) -> bool {
        self.surface.keeps_to_selected(a, b, most)
    }

    fn may_rise(&self, a: &PathPoint, b: &PathPoint, most: f64) -> bool {
        self.surface.may_rise(a, b, most)
    }
}

fn at_height(p: Vector, z: f64) -> Vector {
    Vector::new(p.x, p.y, z)
}
