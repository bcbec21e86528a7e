//! Along edges with the cone of a tool: where its axis goes, where nothing else is in the way, and how it comes in and out.
//!
//! The axis keeps a distance from the edge on its free side: on lines beside straight pieces, about corners that stand out on chords
//! that touch the circle from outside, so that the part is never entered for them. In corners that lie back lines end where they meet.
//!
//! The method: `docs/concepts/chamfers.md`.

use styluscam_geometry::Vector;
use styluscam_motion::{Cancelled, Watch};

use crate::plan::apart;

/// Ends of neighbouring pieces that lie nearer belong together, mm.
const JOINED: f64 = 2e-3;
/// Positions are looked at so far apart at most, mm.
const APART: f64 = 0.05;
/// Where a free stretch ends is found to this, mm.
const EXACT: f64 = 1e-5;
/// Shorter stretches are none, mm.
const LEAST: f64 = 0.05;
/// Corners that lie so little beside the line between their neighbours are none, mm.
const ASIDE: f64 = 1e-7;
/// Lines beside corners that turn by more are not followed to where they meet, rad.
const MOST_MITER: f64 = 2.4;
/// Turns by less are none, rad.
const STRAIGHT: f64 = 1e-9;

/// Straight pieces of an edge, work coordinates, mm.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    /// Its corners; of a closed one the first is not repeated.
    pub corners: Vec<[f64; 2]>,
    /// Whether it closes.
    pub closed: bool,
    /// Whether the tool is on its left.
    pub left: bool,
    /// Whether the axis goes about corners that stand out in arcs, else to where the lines beside them meet: of walls that lean, the
    /// corner between two comes out farther than they do.
    pub rounds: bool,
}

/// A stretch of the axis' path, mm.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    /// Its corners; of a closed one the last is the first.
    pub points: Vec<[f64; 2]>,
    /// Whether it closes.
    pub closed: bool,
}

impl Stretch {
    /// Its length, mm.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.points.windows(2).map(|pair| apart(pair[0], pair[1])).sum()
    }
}

/// A straight piece of the path.
#[derive(Clone, Copy, Debug)]
struct Line {
    ends: [[f64; 2]; 2],
}

impl Line {
    fn at(&self, share: f64) -> [f64; 2] {
        let [a, b] = self.ends;
        [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])]
    }

    fn length(&self) -> f64 {
        apart(self.ends[0], self.ends[1])
    }
}

/// The stretches of an edge along which a tool is free whose axis keeps a `distance` (mm) from it; chords about corners are at most
/// `deviation` mm farther off.
///
/// # Errors
/// `Cancelled` when the watch is cancelled.
pub fn stretches(
    edge: &Edge,
    distance: f64,
    deviation: f64,
    mut is_free: impl FnMut([f64; 2]) -> bool,
    watch: &Watch,
) -> Result<Vec<Stretch>, Cancelled> {
    free_lines(lines(edge, distance, deviation), edge.closed, &mut is_free, watch)
}

/// The stretches of a line along which a tool is free.
///
/// # Errors
/// `Cancelled` when the watch is cancelled.
pub fn free_stretches(
    whole: &Stretch,
    mut is_free: impl FnMut([f64; 2]) -> bool,
    watch: &Watch,
) -> Result<Vec<Stretch>, Cancelled> {
    let lines = whole.points.windows(2).map(|pair| Line { ends: [pair[0], pair[1]] });
    free_lines(lines, whole.closed, &mut is_free, watch)
}

fn free_lines(
    lines: impl IntoIterator<Item = Line>,
    closed: bool,
    is_free: &mut impl FnMut([f64; 2]) -> bool,
    watch: &Watch,
) -> Result<Vec<Stretch>, Cancelled> {
    let mut found: Vec<Stretch> = Vec::new();
    for line in lines {
        watch.advance(0)?;
        for ends in free(&line, is_free) {
            match found.last_mut().and_then(|last| Some((*last.points.last()?, last))) {
                Some((end, last)) if apart(end, ends[0]) <= JOINED => last.points.push(ends[1]),
                _ => found.push(Stretch { points: ends.to_vec(), closed: false }),
            }
        }
    }
    if closed {
        close(&mut found);
    }
    found.retain(|stretch| stretch.length() >= LEAST);
    found.iter_mut().for_each(|stretch| straightened(&mut stretch.points));
    Ok(found)
}

/// Drops corners at which a line goes on straight.
pub(crate) fn straightened(points: &mut Vec<[f64; 2]>) {
    let mut kept: Vec<[f64; 2]> = Vec::with_capacity(points.len());
    for point in points.drain(..) {
        while let [.., a, b] = kept.as_slice() {
            let (u, v) = ([b[0] - a[0], b[1] - a[1]], [point[0] - a[0], point[1] - a[1]]);
            let aside = (u[0] * v[1] - u[1] * v[0]).abs() / libm::hypot(v[0], v[1]).max(EXACT);
            let goes_on = u[0] * (point[0] - b[0]) + u[1] * (point[1] - b[1]) >= 0.0;
            if aside > ASIDE || !goes_on {
                break;
            }
            kept.pop();
        }
        kept.push(point);
    }
    *points = kept;
}

/// Joins the last stretch to the first, where one goes on in the other.
fn close(found: &mut Vec<Stretch>) {
    let begin = found.first().and_then(|first| first.points.first().copied());
    let end = found.last().and_then(|last| last.points.last().copied());
    let (Some(begin), Some(end)) = (begin, end) else { return };
    if apart(begin, end) > JOINED {
        return;
    }
    if let [only] = found.as_mut_slice() {
        only.points.push(begin);
        only.closed = true;
        *only = from_middle(only);
    } else if let Some(mut last) = found.pop() {
        if let Some(first) = found.first_mut() {
            last.points.append(&mut first.points);
            first.points = last.points;
        }
    }
}

/// A closed stretch from the middle of its longest piece on.
fn from_middle(stretch: &Stretch) -> Stretch {
    let pieces: Vec<[[f64; 2]; 2]> = stretch.points.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    let longest = pieces.iter().enumerate().max_by(|a, b| {
        let length = |piece: &[[f64; 2]; 2]| apart(piece[0], piece[1]);
        length(a.1).total_cmp(&length(b.1)).then(b.0.cmp(&a.0))
    });
    let Some((number, [a, b])) = longest else { return stretch.clone() };
    let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
    let rest = pieces.iter().cycle().skip(number).take(pieces.len()).map(|piece| piece[1]);
    let points = std::iter::once(middle).chain(rest).chain([middle]).collect();
    Stretch { points, closed: true }
}

/// An edge, and how far the axis is beside it.
struct Beside<'a> {
    edge: &'a Edge,
    distance: f64,
}

/// How the path goes on at the end of a piece.
#[derive(Clone, Default)]
struct Joint {
    /// By how much it and the next are shorter, mm.
    trim: f64,
    /// Corners of the way about it.
    about: Vec<[f64; 2]>,
}

impl Beside<'_> {
    fn pieces(&self) -> usize {
        let count = self.edge.corners.len();
        if self.edge.closed {
            count
        } else {
            count.saturating_sub(1)
        }
    }

    fn side(&self) -> f64 {
        if self.edge.left {
            1.0
        } else {
            -1.0
        }
    }

    fn corner(&self, i: usize) -> [f64; 2] {
        self.edge.corners.get(i % self.edge.corners.len().max(1)).copied().unwrap_or_default()
    }

    fn length(&self, i: usize) -> f64 {
        apart(self.corner(i), self.corner(i + 1))
    }

    fn along(&self, i: usize) -> [f64; 2] {
        let ([ax, ay], [bx, by], length) = (self.corner(i), self.corner(i + 1), self.length(i));
        [(bx - ax) / length, (by - ay) / length]
    }

    /// From a point of a piece to the axis.
    fn arm(&self, [dx, dy]: [f64; 2]) -> [f64; 2] {
        let by = self.side() * self.distance;
        [-by * dy, by * dx]
    }

    /// At the end of a piece.
    fn joint(&self, i: usize, deviation: f64) -> Joint {
        let next = (i + 1) % self.pieces();
        if next == 0 && !self.edge.closed {
            return Joint::default();
        }
        let (u, v) = (self.along(i), self.along(next));
        let angle = libm::atan2(u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]);
        let towards_tool = self.side() * angle;
        if towards_tool < -STRAIGHT {
            let meet = !self.edge.rounds && angle.abs() < MOST_MITER;
            let deviation = if meet { f64::INFINITY } else { deviation };
            return Joint { trim: 0.0, about: around(self.corner(i + 1), self.arm(u), angle, deviation) };
        }
        let trim = self.distance * libm::tan(0.5 * towards_tool.max(0.0));
        let fits = trim <= 0.5 * self.length(i).min(self.length(next));
        Joint { trim: if fits { trim } else { 0.0 }, about: Vec::new() }
    }
}

/// The path of the axis where nothing is in its way, piece by piece.
fn lines(edge: &Edge, distance: f64, deviation: f64) -> Vec<Line> {
    let beside = Beside { edge, distance };
    let joints: Vec<Joint> = (0..beside.pieces()).map(|i| beside.joint(i, deviation)).collect();
    let before = joints.last().into_iter().chain(&joints);
    let mut lines: Vec<Line> = Vec::with_capacity(2 * joints.len());
    for (i, (before, joint)) in before.zip(&joints).enumerate() {
        let ([dx, dy], [ax, ay]) = (beside.along(i), beside.arm(beside.along(i)));
        let at = |[x, y]: [f64; 2], by: f64| [x + ax + by * dx, y + ay + by * dy];
        let mut ends = [at(beside.corner(i), before.trim), at(beside.corner(i + 1), -joint.trim)];
        lines.push(Line { ends });
        for to in &joint.about {
            ends = [ends[1], *to];
            lines.push(Line { ends });
        }
    }
    lines
}

/// Corners of a line that goes about a corner by an angle from an arm on, without coming nearer than the arm is long.
fn around([x, y]: [f64; 2], [ax, ay]: [f64; 2], angle: f64, deviation: f64) -> Vec<[f64; 2]> {
    let radius = libm::hypot(ax, ay);
    let step = 2.0 * libm::acos((radius / (radius + deviation)).clamp(0.0, 1.0));
    let count = if deviation.is_infinite() { 1.0 } else { (angle.abs() / step).ceil().clamp(1.0, 1000.0) };
    let far = 1.0 / libm::cos(0.5 * angle / count);
    let turned = |by: f64, scale: f64| {
        let (sin, cos) = libm::sincos(by);
        [x + scale * (ax * cos - ay * sin), y + scale * (ax * sin + ay * cos)]
    };
    let middles = (0..count as usize).map(|i| turned(angle * (i as f64 + 0.5) / count, far));
    middles.chain([turned(angle, 1.0)]).collect()
}

/// The parts of a line on which a tool is free.
fn free(line: &Line, is_free: &mut impl FnMut([f64; 2]) -> bool) -> Vec<[[f64; 2]; 2]> {
    let length = line.length();
    let count = (length / APART).ceil().max(4.0) as usize;
    let shares: Vec<f64> = (0..=count).map(|i| i as f64 / count as f64).collect();
    let at: Vec<(f64, bool)> = shares.into_iter().map(|share| (share, is_free(line.at(share)))).collect();
    let mut found = Vec::new();
    let mut begin = at.first().and_then(|(share, free)| free.then_some(*share));
    for pair in at.windows(2) {
        let [(from, was), (to, is)] = [pair[0], pair[1]];
        if was != is {
            let (mut inside, mut outside) = if was { (from, to) } else { (to, from) };
            while (inside - outside).abs() * length > EXACT {
                let middle = 0.5 * (inside + outside);
                *(if is_free(line.at(middle)) { &mut inside } else { &mut outside }) = middle;
            }
            match begin.take() {
                Some(begin) => found.push([line.at(begin), line.at(inside)]),
                None => begin = Some(inside),
            }
        }
    }
    found.extend(begin.map(|begin| [line.at(begin), line.ends[1]]));
    found
}

/// The tips of a tool that comes down onto a stretch along it, at its depth all along it, and up again: down and up by `rise` mm in
/// `length` mm, on open stretches to and fro.
#[must_use]
pub fn followed(stretch: &Stretch, depth: f64, [rise, length]: [f64; 2]) -> [Vec<Vector>; 3] {
    let ahead: Vec<[f64; 2]> = stretch.points.clone();
    let back: Vec<[f64; 2]> = ahead.iter().rev().copied().collect();
    let at = |[x, y]: [f64; 2], z: f64| Vector::new(x, y, z);
    let rising = |first: &[[f64; 2]], second: &[[f64; 2]]| -> Vec<Vector> {
        let mut way: Vec<Vector> = Vec::new();
        let mut gone = 0.0;
        let turns = [first, second];
        let mut points = turns.iter().cycle().flat_map(|points| points.iter().copied());
        let Some(mut last) = points.next() else { return way };
        way.push(at(last, depth));
        for next in points {
            let step = apart(last, next);
            let share = if step > 0.0 { ((length - gone) / step).min(1.0) } else { 1.0 };
            gone += step * share;
            let to = [last[0] + share * (next[0] - last[0]), last[1] + share * (next[1] - last[1])];
            if step > 0.0 {
                way.push(at(to, depth + rise * (gone / length).min(1.0)));
            }
            last = to;
            if gone >= length - EXACT {
                break;
            }
        }
        way
    };
    // a closed one comes down in its own direction and goes on in it
    let (down, up) = if stretch.closed {
        (rising(&back, &back), rising(&ahead, &ahead))
    } else {
        (rising(&ahead, &back), rising(&back, &ahead))
    };
    let down = down.into_iter().rev().collect();
    let along = ahead.iter().map(|point| at(*point, depth)).collect();
    [down, along, up]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(left: bool) -> Edge {
        Edge { corners: vec![[0.0, 0.0], [10.0, 0.0], [10.0, 8.0], [0.0, 8.0]], closed: true, left, rounds: true }
    }

    fn off([x, y]: [f64; 2]) -> f64 {
        libm::hypot((x - 5.0).abs().max(5.0) - 5.0, (y - 4.0).abs().max(4.0) - 4.0)
    }

    #[test]
    fn around_a_square_the_axis_keeps_its_distance_on_lines_and_arcs() {
        let found = stretches(&square(false), 1.5, 0.002, |_| true, &Watch::default()).unwrap();
        let [only] = found.as_slice() else { panic!("{found:?}") };
        assert!(only.closed && only.points.first() == only.points.last());
        for pair in only.points.windows(2) {
            for share in [0.0, 0.25, 0.5, 0.75] {
                let line = Line { ends: [pair[0], pair[1]] };
                let distance = off(line.at(share));
                assert!((1.5 - 1e-9..=1.502 + 1e-9).contains(&distance), "{distance}");
            }
        }
        let exact = 36.0 + std::f64::consts::TAU * 1.5;
        assert!((only.length() - exact).abs() < 0.02, "{} {exact}", only.length());
    }

    #[test]
    fn where_walls_lean_lines_go_on_to_where_they_meet() {
        let edge = Edge { rounds: false, ..square(false) };
        let found = stretches(&edge, 1.5, 0.002, |_| true, &Watch::default()).unwrap();
        let [only] = found.as_slice() else { panic!("{found:?}") };
        assert!(only.closed && only.points.len() == 6 && (only.length() - 2.0 * (13.0 + 11.0)).abs() < 1e-9);
    }

    #[test]
    fn inside_a_square_lines_end_where_they_meet() {
        let found = stretches(&square(true), 1.5, 0.002, |_| true, &Watch::default()).unwrap();
        let [only] = found.as_slice() else { panic!("{found:?}") };
        assert!(only.closed && (only.length() - 2.0 * (7.0 + 5.0)).abs() < 1e-9);
    }

    #[test]
    fn where_something_is_in_the_way_stretches_end() {
        let is_free = |[x, y]: [f64; 2]| x < 3.0 || y > 4.0;
        let found = stretches(&square(false), 1.5, 0.002, is_free, &Watch::default()).unwrap();
        let [only] = found.as_slice() else { panic!("{found:?}") };
        let [first, last] = [only.points.first(), only.points.last()].map(|point| *point.unwrap());
        assert!(!only.closed && (first[1] - 4.0).abs() < 2e-5 && (last[0] - 3.0).abs() < 2e-5, "{first:?} {last:?}");
    }

    #[test]
    fn a_tool_comes_down_and_goes_up_along_its_stretch() {
        let open = Stretch { points: vec![[0.0, 0.0], [2.0, 0.0]], closed: false };
        let [down, along, up] = followed(&open, -1.0, [1.0, 5.0]);
        let xz = |points: &[Vector]| points.iter().map(|p| (p.x, (p.z * 1e6).round() / 1e6)).collect::<Vec<_>>();
        assert_eq!(xz(&down), [(1.0, 0.0), (0.0, -0.2), (2.0, -0.6), (0.0, -1.0)]);
        assert_eq!(xz(&along), [(0.0, -1.0), (2.0, -1.0)]);
        assert_eq!(xz(&up), [(2.0, -1.0), (0.0, -0.6), (2.0, -0.2), (1.0, 0.0)]);
        let ring = Stretch { points: vec![[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 0.0]], closed: true };
        let [down, ..] = followed(&ring, -1.0, [1.0, 2.0]);
        assert_eq!(down.len(), 2);
        assert!((down[0] - Vector::new(2.0_f64.sqrt(), 2.0_f64.sqrt(), 0.0)).norm() < 1e-9, "{down:?}");
    }
}
