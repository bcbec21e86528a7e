//! What a moving tool leaves of a ruled surface: over each of its points, along the normal, the lowest that any position cuts.

use rayon::prelude::*;
use styluscam_geometry::{Tool, Vector};
use styluscam_motion::{Cancelled, MoveKind, Watch};

use super::found::Judged;
use super::moves::{LeaningMove, Pose};
use super::report::FlankFaceError;
use super::surface::{samples, POINTS};
use crate::body::Body;
use crate::expectation::{FlankFace, FlankPasses};
use crate::faults::{self, Fault};
use crate::place::Place;
use crate::sections::least_between;
use crate::tolerances::SLACK;

/// Positions of the whole movement, at least, among which the lowest is looked for; every end of a move is one of them.
const LOOKED_AT: usize = 256;
/// Parts of the golden section around it: to 1e-5 of the interval.
const SECTIONS: usize = 24;
/// Steps to the tool along a normal; five are usual.
const STEPS: usize = 40;
/// A tool that comes so near to the end of a normal, mm, cuts there: rims end on rails, and coordinates are rounded.
const TOUCH: f64 = 3e-3;

/// Checks all surfaces of an operation; `high` is how high up the tool the part may reach, mm.
///
/// # Errors
/// `Cancelled`.
pub(super) fn judge(
    moves: &[&LeaningMove],
    passes: &FlankPasses,
    (tool, high): (&Tool, f64),
    watch: &Watch,
    judged: &mut Judged,
) -> Result<Vec<FlankFaceError>, Cancelled> {
    let body = Body::new(tool, None);
    let feeds: Vec<Feed> = moves.iter().filter_map(|step| Feed::of(step, high)).collect();
    let parts = LOOKED_AT.div_ceil(feeds.len().max(1));
    watch.begin("measuring ruled surfaces", passes.faces.len());
    let mut errors = Vec::new();
    for face in &passes.faces {
        errors.push(of_face(face, &feeds, parts, &body, passes, judged));
        watch.advance(1)?;
    }
    Ok(errors)
}

/// A feed move with its start.
struct Feed<'a> {
    step: &'a LeaningMove,
    from: Pose,
    /// How far any point of the tool that is beside the surface goes on it, mm at most.
    reach: f64,
}

impl<'a> Feed<'a> {
    /// `high` is how high up the tool the part may reach, mm.
    fn of(step: &'a LeaningMove, high: f64) -> Option<Self> {
        let from = step.from.filter(|_| step.kind == MoveKind::Feed)?;
        Some(Self { step, from, reach: from.apart(&step.to, high) })
    }

    fn at(&self, share: f64) -> Pose {
        self.from.towards(&self.step.to, share)
    }
}

fn of_face(
    face: &FlankFace,
    feeds: &[Feed<'_>],
    parts: usize,
    body: &Body,
    passes: &FlankPasses,
    judged: &mut Judged,
) -> FlankFaceError {
    let points = samples(face);
    // where the tool is not to come nothing is owed
    let owed: Vec<bool> = points
        .iter()
        .enumerate()
        .map(|(i, (point, _))| {
            let foot = points.get(i - i % POINTS).map_or(0.0, |(foot, _)| (point - foot).norm());
            passes.foot <= 0.0 || foot > FOOT * passes.foot + BESIDE_FOOT
        })
        .collect();
    let left: Vec<(f64, Option<(usize, f64)>)> =
        points.par_iter().with_min_len(8).map(|(point, normal)| lowest(*point, *normal, feeds, parts, body)).collect();
    judged.samples += points.len();
    let place = |at: Option<(usize, f64)>| {
        at.and_then(|(number, share)| feeds.get(number).map(|feed| (feed, feed.at(share).tip)))
            .map(|(feed, tip)| (feed.step, Place { line: feed.step.line, position: tip.into() }))
    };
    let beyond = |value: f64| value - passes.left;
    let deepest = left.iter().min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(value, _)| value.is_finite());
    let reached = left.iter().zip(&owed).filter(|((value, _), owed)| **owed && value.is_finite());
    let highest = reached.map(|(found, _)| found).max_by(|a, b| a.0.total_cmp(&b.0));
    let is_missed = |(value, owed): (f64, bool)| owed && !value.is_finite();
    let found = || left.iter().map(|(value, _)| *value).zip(owed.iter().copied());
    let missed = found().filter(|one| is_missed(*one)).count();
    let over = deepest.map_or(0.0, |(value, _)| (-beyond(*value)).max(0.0));
    let under = highest.map_or(0.0, |(value, _)| beyond(*value).max(0.0));
    let over_at = deepest.filter(|_| over > 0.0).and_then(|(_, at)| place(*at));
    let under_at = highest.filter(|_| under > 0.0).and_then(|(_, at)| place(*at));
    for (kind, value, at) in [(&faults::FLANK_ENTERS, over, over_at), (&faults::FLANK_LEAVES, under, under_at)] {
        let Some((step, at)) = at.filter(|_| value > passes.max_error + SLACK) else { continue };
        let fault = Fault::new(kind, step.index, step.line, at.position);
        judged.faults.push(fault.measured(value, passes.max_error));
    }
    if missed > 0 {
        let number = found().position(is_missed).unwrap_or(0);
        let (index, line) = feeds.first().map_or((0, 0), |feed| (feed.step.index, feed.step.line));
        let at = points.get(number).map_or([0.0; 3], |(point, _)| <[f64; 3]>::from(*point));
        let share = 100.0 * missed as f64 / left.len() as f64;
        judged.faults.push(Fault::new(&faults::FLANK_MISSES, index, line, at).measured(share, 0.0));
    }
    for (worst, value, at) in [(&mut judged.gouge, over, over_at), (&mut judged.excess, under, under_at)] {
        at.into_iter().for_each(|(_, at)| worst.take(value, at));
    }
    FlankFaceError {
        name: face.name.clone(),
        over,
        over_at: over_at.map(|(_, at)| at),
        under,
        under_at: under_at.map(|(_, at)| at),
        missed: missed as f64 / left.len().max(1) as f64,
        left: left.chunks(POINTS).map(|row| row.iter().map(|(value, _)| beyond(*value)).collect()).collect(),
        points: points.chunks(POINTS).map(|row| row.iter().map(|(point, _)| (*point).into()).collect()).collect(),
    }
}

/// The lowest that any position cuts over a point, and in which move and where on it; infinite where none comes there.
///
/// A tool is no lower over a point than it is near: moves that stay farther off than the lowest found so far are passed over.
fn lowest(point: Vector, normal: Vector, feeds: &[Feed<'_>], parts: usize, body: &Body) -> (f64, Option<(usize, f64)>) {
    let near = |number: usize| feeds[number].nearest(point, body.radius());
    let mut best = (f64::INFINITY, None);
    let Some(first) = (0..feeds.len()).min_by(|a, b| near(*a).total_cmp(&near(*b))) else { return best };
    let mut looked_at = Vec::new();
    for number in std::iter::once(first).chain((0..feeds.len()).filter(|number| *number != first)) {
        if near(number) < best.0 {
            let found = feeds[number].lowest_of_parts(point, normal, parts, body);
            looked_at.push((number, found));
            if found.0 < best.0 {
                best = (found.0, Some((number, found.1)));
            }
        }
    }
    // between the positions that were looked at a round tool is lower by no more than its bend over their distance
    let bend = |number: usize| {
        let apart = feeds[number].reach / parts as f64;
        BENDS * apart * apart / body.radius() + SPARE
    };
    for (number, found) in looked_at {
        if found.0 - bend(number) < best.0 {
            let found = feeds[number].lowest_about(found, (point, normal), parts, body);
            if found.0 < best.0 {
                best = (found.0, Some((number, found.1)));
            }
        }
    }
    best
}

impl Feed<'_> {
    /// The tool is nowhere on the move nearer to a point than this, mm.
    fn nearest(&self, point: Vector, radius: f64) -> f64 {
        let from = point - self.from.tip;
        let along = from.dot(&self.from.axis);
        let aside = (from - self.from.axis * along).norm();
        (aside - radius).max(-along) - self.reach
    }

    /// The lowest that it cuts over a point at the ends of its parts, and at which share of the move.
    fn lowest_of_parts(&self, point: Vector, normal: Vector, parts: usize, body: &Body) -> (f64, f64) {
        let share = |part: usize| part as f64 / parts as f64;
        let positions = (0..=parts).map(|part| (over(point, normal, &self.at(share(part)), body), share(part)));
        positions.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, 0.0))
    }

    /// The lowest about there.
    fn lowest_about(
        &self,
        known: (f64, f64),
        (point, normal): (Vector, Vector),
        parts: usize,
        body: &Body,
    ) -> (f64, f64) {
        if !known.0.is_finite() {
            return known;
        }
        let wide = 1.0 / parts as f64;
        let about = [(known.1 - wide).max(0.0), (known.1 + wide).min(1.0)];
        least_between(known, about, SECTIONS, |share| over(point, normal, &self.at(share), body))
    }
}

/// How far over a point, along its normal, a tool begins, mm; infinite where the normal passes beside it. Below 0 how deep the point is in
/// the tool.
///
/// Along a line the distance from a convex body is convex: Newton's steps from outside never pass the first place where it is 0.
fn over(point: Vector, normal: Vector, pose: &Pose, body: &Body) -> f64 {
    let frame = pose.frame();
    let (from, way) = (frame.turned(point - pose.tip), frame.turned(normal));
    let mut along = 0.0;
    for _ in 0..STEPS {
        let found = body.distance(from + way * along);
        if along <= 0.0 && found.value <= 0.0 {
            return found.value;
        }
        let (gap, slope) = (found.value - TOUCH, found.away.dot(&way));
        if gap <= SETTLED {
            return along + TOUCH.min(found.value);
        }
        if slope >= 0.0 || along > FAR {
            return f64::INFINITY;
        }
        along -= gap / slope;
    }
    along + TOUCH
}

/// Of a bend by the tool's radius, for axes that turn on the way, and what is added to it, mm.
const BENDS: f64 = 0.5;
const SPARE: f64 = 1e-4;
/// Where the tool is not to come: so many times as high as asked, for it leans to the rulings, and so much more, mm.
const FOOT: f64 = 1.05;
const BESIDE_FOOT: f64 = 0.05;
/// What is left of a gap to the tool is none, mm.
const SETTLED: f64 = 1e-9;
/// Farther off nothing is left of a surface, mm.
const FAR: f64 = 1e4;
