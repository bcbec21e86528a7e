//! From passes to moves: their order, their direction, and how the tool gets from one to the next.
//!
//! The strategy decides how: it calls [`link`] or [`join`] with rules of its own. Where they give no path, the tool goes
//! up, across at clearance height or as low as the rules have it, and down again at plunge feed. Derived in
//! docs/concepts/linking.md.

use rayon::prelude::*;
use styluscam_geometry::Vector;
use styluscam_motion::{Cancelled, Move, Role, Watch};

use crate::arcs::Neighbours;
use crate::{fitting, fitting::Course, Arcs, Fitted, Pass, PathPoint, Planes, Segment, Surface};

/// So many witnesses at an end show in which direction a path goes on from it.
const JOINT: usize = 64;

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
    fn lead_in(&self, _number: usize, _run: &Followed<'_, P>) -> Option<Lead> {
        None
    }

    /// The lead out of a run, where the tool leaves it into the air; none where it goes straight up.
    fn lead_out(&self, _number: usize, _run: &Followed<'_, P>) -> Option<Lead> {
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

/// Short links follow the envelope, as long as they touch selected faces only and do not go down beside both of their ends, into what no
/// pass has cut yet, by more than a link may be long.
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
    /// Largest angle between two chords where the envelope is smooth, rad.
    pub corner: f64,
    /// mm/min.
    pub feed: f64,
}

impl LinkRules<PathPoint> for AlongSurface<'_> {
    fn path(&self, from: &PathPoint, to: &PathPoint) -> Option<Vec<Segment>> {
        if (to.tip - from.tip).xy().norm() > self.longest {
            return None;
        }
        let lower_end = from.tip.z.min(to.tip.z);
        let floor = |planes: Planes| planes.under(lower_end);
        let surface = self.surface.above(self.planes.map_or(f64::NEG_INFINITY, floor));
        let run = along_selected(&surface, &[*from, *to], self.deviation, self.narrow)?;
        if run.iter().any(|point| point.tip.z < lower_end - self.longest) {
            return None;
        }
        if self.corner < f64::INFINITY {
            return Some(Arcs::none(self.corner).along(&run, Neighbours::default(), self.deviation, self.feed));
        }
        Some(lines(&fitting::thinned(&run, self.deviation)[1..], self.feed).collect())
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

impl<P> Run<P> {
    fn followed(&self) -> Followed<'_, P> {
        Followed { from: &self.from, to: &self.to, along: Along::Segments(&self.segments) }
    }
}

/// A run, whatever it is kept as.
#[derive(Clone, Copy, Debug)]
pub struct Followed<'a, P> {
    /// Where it begins.
    pub from: &'a P,
    /// Where it ends.
    pub to: &'a P,
    along: Along<'a>,
}

/// What leads from a run's beginning to its end.
#[derive(Clone, Copy, Debug)]
enum Along<'a> {
    Segments(&'a [Segment]),
    /// Straight lines at a feed, mm/min, to the points after the first.
    Lines(&'a [PathPoint], f64),
}

impl<'a> Followed<'a, PathPoint> {
    /// Lines along a pass, at a feed in mm/min; none where it has no points.
    fn along_pass(entered: &'a Entered, feed: f64) -> Option<Self> {
        let points = &entered.pass.points;
        Some(Self { from: points.first()?, to: points.last()?, along: Along::Lines(points, feed) })
    }
}

impl<P: Position> Followed<'_, P> {
    /// Its first segment.
    #[must_use]
    pub fn first(&self) -> Option<Segment> {
        match self.along {
            Along::Segments(segments) => segments.first().copied(),
            Along::Lines(points, feed) => points.get(1).map(|point| Segment::line(point.tip, feed)),
        }
    }

    /// Where its last segment begins, and that.
    #[must_use]
    pub fn last(&self) -> Option<(Vector, Segment)> {
        match self.along {
            Along::Segments(segments) => {
                let (last, before) = segments.split_last()?;
                Some((before.last().map_or(self.from.tip(), |before| before.end), *last))
            }
            Along::Lines(points, feed) => {
                let [.., start, end] = points else { return None };
                Some((start.tip, Segment::line(end.tip, feed)))
            }
        }
    }
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
/// The passes are given up one by one as their moves are made: of long paths there is room for one of both.
///
/// # Errors
/// `Cancelled`.
pub fn link(
    mut passes: Vec<Entered>,
    rules: &impl LinkRules<PathPoint>,
    links: &Links,
    watch: &Watch,
) -> Result<Vec<Move>, Cancelled> {
    passes.retain(|entered| !entered.pass.points.is_empty());
    watch.begin("linking", passes.len());
    let cut = links.rates.cut;
    let of_pass = |entered| Followed::along_pass(entered, cut);
    let runs: Vec<Followed<'_, PathPoint>> = passes.iter().filter_map(of_pass).collect();
    let known = |number: usize| {
        let Entered { ramp, role, .. } = &passes[number];
        ramp.get(1..).map(|points| lines(points, cut).map(|segment| Segment { role: *role, ..segment }).collect())
    };
    let gaps = gaps(&runs, known, rules, links, watch)?;
    let count = passes.iter().map(|entered| entered.pass.points.len()).sum::<usize>()
        + gaps.iter().map(Vec::len).sum::<usize>();
    let mut moves = Vec::with_capacity(count);
    let mut passes = passes.into_iter();
    for gap in gaps {
        moves.extend(gap.iter().map(|segment| segment.to_move(links.operation)));
        let points = passes.next().map_or_else(Vec::new, |entered| entered.pass.points);
        moves.extend(lines(points.get(1..).unwrap_or_default(), cut).map(|line| line.to_move(links.operation)));
    }
    Ok(moves)
}

/// As [`link`], with arcs and lines along the passes and their ramps, whose points are all witnesses
/// ([`Surface::keeping_witnesses`]); they deviate by at most `deviation` mm along the normal.
///
/// # Errors
/// `Cancelled`.
pub fn link_with_arcs(
    mut passes: Vec<Entered>,
    (arcs, deviation): (&Arcs<'_>, f64),
    rules: &impl LinkRules<PathPoint>,
    links: &Links,
    watch: &Watch,
) -> Result<(Vec<Move>, Fitted), Cancelled> {
    passes.retain(|entered| !entered.pass.points.is_empty());
    watch.begin("fitting arcs", passes.len());
    let joints = if arcs.corner < f64::INFINITY { joints(&passes) } else { Vec::new() };
    let joint = |number: usize| joints.get(number).map_or([&[][..]; 2], |[end, start]| [&end[..], &start[..]]);
    let fitted = |(number, Entered { pass: Pass { points, .. }, ramp, role }): (usize, Entered)| {
        watch.advance(1)?;
        let along = |points: &[PathPoint], neighbours: Neighbours<'_>| {
            let segments = arcs.along(points, neighbours, deviation, links.rates.cut);
            let figures = Fitted::of(points, &segments, deviation);
            (segments, figures)
        };
        let ([_, after], [before, _]) = (joint(number + 1), joint(number));
        let (segments, of_pass) = along(&points, Neighbours { before: &ramp, after });
        let (down, of_ramp) = along(&ramp, Neighbours { before, after: &points });
        let run = Run { from: points[0], to: points[points.len() - 1], segments };
        let down: Vec<Segment> = down.into_iter().map(|segment| Segment { role, ..segment }).collect();
        Ok((run, (!ramp.is_empty()).then_some(down), of_pass.and(of_ramp)))
    };
    let fitted: Result<Vec<_>, Cancelled> = passes.into_par_iter().enumerate().map(fitted).collect();
    let fitted = fitted?;
    watch.begin("linking", fitted.len());
    let (mut runs, mut ramps, mut figures) = (Vec::new(), Vec::new(), Fitted::default());
    for (run, ramp, of_run) in fitted {
        runs.push(run);
        ramps.push(ramp);
        figures = figures.and(of_run);
    }
    let segments = joined(runs, |number| ramps[number].clone(), rules, links, watch)?;
    Ok((segments.iter().map(|segment| segment.to_move(links.operation)).collect(), figures))
}

/// By pass, where a ramp leads to it: how the pass before ends, and how the ramp begins.
fn joints(passes: &[Entered]) -> Vec<[Vec<PathPoint>; 2]> {
    let joint = |number: usize| {
        let Entered { ramp, .. } = &passes[number];
        let before = number.checked_sub(1).filter(|_| !ramp.is_empty()).map(|before| &passes[before].pass.points);
        let end = before.map_or(&[][..], |points| &points[points.len().saturating_sub(JOINT)..]);
        [end.to_vec(), ramp[..ramp.len().min(JOINT)].to_vec()]
    };
    (0..passes.len()).map(joint).collect()
}

/// All runs in their order, joined by the rules: from clearance height to clearance height.
///
/// Advances the watch by the number of runs.
///
/// # Errors
/// `Cancelled`.
pub fn join<P: Position + Sync>(
    runs: Vec<Run<P>>,
    rules: &impl LinkRules<P>,
    links: &Links,
    watch: &Watch,
) -> Result<Vec<Segment>, Cancelled> {
    joined(runs, |_| None, rules, links, watch)
}

/// As [`join`], where some of the paths to the runs are known.
fn joined<P: Position + Sync>(
    runs: Vec<Run<P>>,
    known: impl Fn(usize) -> Option<Vec<Segment>> + Sync,
    rules: &impl LinkRules<P>,
    links: &Links,
    watch: &Watch,
) -> Result<Vec<Segment>, Cancelled> {
    let followed: Vec<Followed<'_, P>> = runs.iter().map(Run::followed).collect();
    let gaps = gaps(&followed, known, rules, links, watch)?;
    let mut joined = Vec::new();
    let mut runs = runs.into_iter();
    for gap in gaps {
        joined.extend(gap);
        joined.extend(runs.next().into_iter().flat_map(|run| run.segments));
    }
    Ok(joined)
}

/// The path to each run, and that up from the last: known, by the rules, or over clearance.
fn gaps<P: Position + Sync>(
    runs: &[Followed<'_, P>],
    known: impl Fn(usize) -> Option<Vec<Segment>> + Sync,
    rules: &impl LinkRules<P>,
    links: &Links,
    watch: &Watch,
) -> Result<Vec<Vec<Segment>>, Cancelled> {
    let gap = |number: usize| {
        watch.advance(1)?;
        let run = &runs[number];
        let before = number.checked_sub(1).map(|before| (before, &runs[before]));
        let path = known(number).or_else(|| before.and_then(|(_, before)| rules.path(before.to, run.from)));
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
    let gaps: Result<Vec<Vec<Segment>>, Cancelled> = (0..runs.len()).into_par_iter().map(gap).collect();
    let mut gaps = gaps?;
    if let Some(last) = runs.last() {
        let mut out = out_of(runs.len() - 1, last, rules);
        out.segments.push(up(out.far, links.heights.clearance));
        gaps.push(out.segments);
    }
    Ok(gaps)
}

/// The lead out of a run; of no length where there is none.
fn out_of<P: Position>(number: usize, run: &Followed<'_, P>, rules: &impl LinkRules<P>) -> Lead {
    rules.lead_out(number, run).unwrap_or_else(|| Lead { far: run.to.tip(), segments: Vec::new() })
}

fn lines(points: &[PathPoint], feed: f64) -> impl Iterator<Item = Segment> + '_ {
    points.iter().map(move |point| Segment::line(point.tip, feed))
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
        self.surface.keeps_to_selected(None, a, b, most)
    }

    fn bend(&self) -> f64 {
        self.surface.bend()
    }

    fn may_rise(&self, a: &PathPoint, b: &PathPoint, most: f64) -> bool {
        self.surface.may_rise(None, a, b, most)
    }
}

fn at_height(p: Vector, z: f64) -> Vector {
    Vector::new(p.x, p.y, z)
}
