//! Arcs and lines instead of chords: as few blocks as the tolerance allows.
//!
//! The path is known by its witnesses ([`crate::fitting`]), and between them proven to keep near the chord. From the end of
//! one piece on, the longest line and the longest arc are looked for that keep near the polyline through the witnesses, everywhere;
//! the one that goes farther is taken. An arc passes through the end of the piece before; its own end is free to lie beside
//! the witness, so that what is jagged by facets is passed in the middle. Where the angle between pieces is limited, no piece begins or
//! ends farther than half of it from the direction that the path has there. Derived in docs/concepts/fitting.md.

mod circle;
mod course;
mod directions;
mod figures;
#[cfg(test)]
mod tests;

use styluscam_geometry::Vector;
use styluscam_motion::{Arc, Plane};

use crate::{fitting, Curve, PathPoint, Segment};
use circle::Position;
use course::Candidate;
pub use directions::Neighbours;
use directions::{of_segment, Directions};
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
    /// Largest angle between a piece and the next where the witnesses allow it, rad.
    pub corner: f64,
}

/// A line or an arc from one witness, or beside it, to another.
struct Piece {
    /// Number of the witness at which it ends.
    to: usize,
    segment: Segment,
}

impl Arcs<'_> {
    /// Lines that turn by no more than `corner` rad where the witnesses allow it, and no arcs.
    #[must_use]
    pub fn none(corner: f64) -> Self {
        Self { planes: &[], unit: 1.0, height: 0.0, takes: &|_, _| false, corner }
    }

    /// A path through witnesses as lines and arcs at a feed, mm/min, which deviate from it by at most `deviation` mm. Both ends are
    /// kept; `neighbours` are what it goes on from and to.
    #[must_use]
    pub fn along(
        &self,
        witnesses: &[PathPoint],
        neighbours: Neighbours<'_>,
        deviation: f64,
        feed: f64,
    ) -> Vec<Segment> {
        let Some(first) = witnesses.first() else { return Vec::new() };
        let plane = plane_of(witnesses).filter(|plane| self.planes.contains(plane));
        let directions =
            (self.corner < f64::INFINITY).then_some(Directions { witnesses, neighbours, corner: self.corner });
        let path = Path { witnesses, arcs: self, plane, deviation, feed, directions };
        let (mut segments, mut start, mut from, mut entering) = (Vec::new(), first.tip, 0, None);
        while from + 1 < witnesses.len() {
            let Piece { to, segment } = path.longest(start, from, entering);
            entering = Some(of_segment(&segment, start)[1]);
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
    /// Of the path, where pieces are to turn little.
    directions: Option<Directions<'a>>,
}

impl Path<'_> {
    /// The longest piece from a point at or beside a witness, to which a piece comes that ends in the direction `entering`.
    fn longest(&self, start: Vector, from: usize, entering: Option<Vector>) -> Piece {
        let count = self.witnesses.len();
        let line = self.line_end(start, from, entering);
        let by_line = Piece { to: line, segment: Segment::line(self.witnesses[line].tip, self.feed) };
        let Some(plane) = self.plane else { return by_line };
        let mut best = None;
        // short arcs are no better than lines: where one fits, far more than a line passes is tried first
        fitting::farthest(line, count, line - from, |to| {
            let found = self.arc(plane, start, from, to).filter(|Piece { to, segment }| {
                self.may_follow((from, entering), (*to, segment.end), of_segment(segment, start))
            });
            let passes = found.is_some();
            best = found.or(best.take());
            passes
        });
        best.unwrap_or(by_line)
    }

    /// The number of the witness to which the longest line goes.
    fn line_end(&self, start: Vector, from: usize, entering: Option<Vector>) -> usize {
        let most = fitting::chord_end(self.witnesses, from, start, self.deviation);
        let Some(directions) = &self.directions else { return most };
        let line = |to: usize| [self.witnesses[to].tip - start; 2];
        let least = self.shortest_line(start, from, entering, most).unwrap_or_else(|| {
            let turns = |to: &usize| directions.turns((from, *to), entering, line(*to));
            let long = (from + 1..=most).filter(|to| line(*to)[0].norm() > fitting::EDGE);
            long.min_by(|a, b| turns(a).total_cmp(&turns(b))).unwrap_or(most)
        });
        fitting::farthest(least, most + 1, 1, |to| {
            self.may_follow((from, entering), (to, self.witnesses[to].tip), line(to))
        })
    }

    /// The number of the nearest witness up to `most` to which a line may go: the piece before may have ended beside its witness, and what
    /// is shorter than some length shows no direction.
    fn shortest_line(&self, start: Vector, from: usize, entering: Option<Vector>, most: usize) -> Option<usize> {
        let directions = self.directions.as_ref()?;
        let line = |to: usize| self.witnesses[to].tip - start;
        let mut long = (from + 1..=most).filter(|to| line(*to).norm() > fitting::EDGE);
        long.find(|to| directions.turns((from, *to), entering, [line(*to); 2]) <= 1.0)
    }

    /// Whether a piece to a witness, or beside it, which begins and ends in some directions, turns as little as asked for, and a line may
    /// follow that does.
    fn may_follow(
        &self,
        (from, entering): (usize, Option<Vector>),
        (to, end): (usize, Vector),
        ends: [Vector; 2],
    ) -> bool {
        let Some(directions) = &self.directions else { return true };
        let goes_on = || {
            let most = fitting::chord_end(self.witnesses, to, end, self.deviation);
            self.shortest_line(end, to, Some(ends[1]), most).is_some()
        };
        directions.turns((from, to), entering, ends) <= 1.0 && (to + 1 == self.witnesses.len() || goes_on())
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
