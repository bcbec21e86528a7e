//! Arcs and lines instead of chords: as few blocks as the tolerance allows.
//!
//! The path is known by its witnesses ([`crate::fitting`]), and between them proven to keep near the chord. From the end of
//! one piece on, the longest line and the longest arc are looked for that keep near the polyline through the witnesses, everywhere;
//! the one that goes farther is taken. An arc passes through the end of the piece before; its own end is free to lie beside
//! the witness, so that what is jagged by facets is passed in the middle. Derived in docs/concepts/fitting.md.

mod circle;
mod course;
mod figures;
#[cfg(test)]
mod tests;

use styluscam_geometry::Vector;
use styluscam_motion::{Arc, Plane};

use crate::{fitting, Curve, PathPoint, Segment};
use circle::Position;
use course::Candidate;
pub use figures::Fitted;

/// Rows lie in a plane that they leave by no more, mm: rounding.
const LEVEL: f64 = 1e-9;

/// The arcs that a machine takes.
pub struct Arcs<'a> {
    /// Planes that have arcs.
    pub planes: &'a [Plane],
    /// Centres stand in whole units of this, mm: rounded ones would move an arc's middle.
    pub unit: f64,
    /// So far below, mm, a posted Z's zero lies.
    pub height: f64,
    /// Whether an arc between two points is posted as it is.
    pub takes: &'a (dyn Fn([[f64; 3]; 2], &Arc) -> bool + Sync),
}

/// A line or an arc from one witness, or beside it, to another.
struct Piece {
    /// Number of the witness at which it ends.
    to: usize,
    segment: Segment,
}

impl Arcs<'_> {
    /// A path through witnesses as lines and arcs at a feed, mm/min, which deviate from it by at most `deviation` mm. Both ends are
    /// kept.
    #[must_use]
    pub fn along(&self, witnesses: &[PathPoint], deviation: f64, feed: f64) -> Vec<Segment> {
        let Some(first) = witnesses.first() else { return Vec::new() };
        let plane = plane_of(witnesses).filter(|plane| self.planes.contains(plane));
        let path = Path { witnesses, arcs: self, plane, deviation, feed };
        let (mut segments, mut start, mut from) = (Vec::new(), first.tip, 0);
        while from + 1 < witnesses.len() {
            let Piece { to, segment } = path.longest(start, from);
            (start, from) = (segment.end, to);
            segments.push(segment);
        }
        segments
    }

    /// The position of whole units that is nearest to one in a plane, and its neighbours round about.
    fn rounded(&self, plane: Plane, position: Position) -> [Position; 4] {
        let [first, second, _] = plane.axes();
        let zero = |axis: usize| if axis == 2 { -self.height } else { 0.0 };
        let near = |mm: f64, axis: usize| {
            let count = (mm - zero(axis)) / self.unit;
            let other = if count.round() > count { -1.0 } else { 1.0 };
            [0.0, other].map(|more| zero(axis) + (count.round() + more) * self.unit)
        };
        let ([u, v], [s, t]) = (near(position[0], first), near(position[1], second));
        [[u, s], [v, s], [u, t], [v, t]]
    }
}

/// The plane in which arcs are looked for: the vertical one that a row lies in, else the horizontal one.
fn plane_of(witnesses: &[PathPoint]) -> Option<Plane> {
    let first = witnesses.first()?.tip;
    let is_at = |axis: usize| witnesses.iter().all(|point| (point.tip[axis] - first[axis]).abs() <= LEVEL);
    Some(if is_at(0) {
        Plane::Yz
    } else if is_at(1) {
        Plane::Zx
    } else {
        Plane::Xy
    })
}

struct Path<'a> {
    witnesses: &'a [PathPoint],
    arcs: &'a Arcs<'a>,
    plane: Option<Plane>,
    deviation: f64,
    feed: f64,
}

impl Path<'_> {
    /// The longest piece from a point at or beside a witness.
    fn longest(&self, start: Vector, from: usize) -> Piece {
        let count = self.witnesses.len();
        let line = fitting::chord_end(self.witnesses, from, start, self.deviation);
        let by_line = Piece { to: line, segment: Segment::line(self.witnesses[line].tip, self.feed) };
        let Some(plane) = self.plane else { return by_line };
        let mut best = None;
        // short arcs are no better than lines: where one fits, far more than a line passes is tried first
        fitting::farthest(line, count, line - from, |to| {
            let found = self.arc(plane, start, from, to);
            let passes = found.is_some();
            best = found.or(best.take());
            passes
        });
        best.unwrap_or(by_line)
    }

    /// An arc from a point at or beside a witness to, or beside, another.
    fn arc(&self, plane: Plane, start: Vector, from: usize, to: usize) -> Option<Piece> {
        let [first, second, _] = plane.axes();
        let in_plane = |point: Vector| [point[first], point[second]];
        let passed = &self.witnesses[from..=to];
        let polyline = passed.iter().map(|point| in_plane(point.tip));
        let last = self.witnesses[to].tip;
        let is_end = to + 1 == self.witnesses.len();
        let begin = in_plane(start);
        let arm = if is_end && last != start {
            circle::between(begin, in_plane(last), polyline)
        } else {
            circle::through(begin, polyline)
        }?;
        let centre = [begin[0] + arm[0], begin[1] + arm[1]];
        let clockwise = turns_clockwise(plane, passed, centre);
        let kept = self.arcs.rounded(plane, centre).into_iter().find_map(|centre| {
            let end = if is_end { last } else { beside(plane, last, centre, start)? };
            let candidate = Candidate { plane, centre, clockwise, start, end };
            candidate.keeps_to(passed, fitting::AT_WITNESSES * self.deviation).then_some(candidate)
        })?;
        let curve = Curve::Arc { plane, centre: kept.centre, clockwise };
        let segment = Segment { curve, ..Segment::line(kept.end, self.feed) };
        let arc = segment.turning()?;
        (self.arcs.takes)([start.into(), kept.end.into()], &arc).then_some(Piece { to, segment })
    }
}

/// In which sense most of a polyline turns about a centre.
fn turns_clockwise(plane: Plane, passed: &[PathPoint], centre: Position) -> bool {
    let [first, second, _] = plane.axes();
    let arm = |point: &PathPoint| [point.tip[first] - centre[0], point.tip[second] - centre[1]];
    let areas = passed.windows(2).map(|pair| {
        let (a, b) = (arm(&pair[0]), arm(&pair[1]));
        a[0] * b[1] - a[1] * b[0]
    });
    areas.sum::<f64>() < 0.0
}

/// The point beside another on the circle about a centre through `start`.
fn beside(plane: Plane, point: Vector, centre: Position, start: Vector) -> Option<Vector> {
    let [first, second, _] = plane.axes();
    let arm = |point: Vector| [point[first] - centre[0], point[second] - centre[1]];
    let [[x, y], [u, v]] = [arm(point), arm(start)];
    let share = libm::hypot(u, v) / libm::hypot(x, y);
    let mut end = point;
    (end[first], end[second]) = (centre[0] + share * x, centre[1] + share * y);
    share.is_finite().then_some(end)
}
