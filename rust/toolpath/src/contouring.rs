//! Along lines in plan at a distance: where the axis of a tool goes beside edges, and how it comes down along that path.
//!
//! The positions nearer to a line than the distance are an area; the part of its border on the tool's side is the path. So the path
//! crosses itself nowhere, ends in corners that lie back where it first meets another piece of the line, and goes about corners that
//! stand out in arcs.
//!
//! The method: `docs/concepts/contours.md`.

use styluscam_geometry::Vector;

use crate::chamfer::{straightened, Stretch};
use crate::plan::apart;
use crate::pocket::polygons::{sides, signed_area, Kernel, Point, Polygons};

/// Shorter distances are none, mm.
const NONE: f64 = 1e-6;
/// What lies so far beyond a line's end is beside its end, mm.
const BEYOND: f64 = 1e-6;
/// Pieces of a path shorter than this are none, mm.
const LEAST: f64 = 0.05;
/// By how much farther than the line's own corners coordinates may be, in distances.
const AROUND: f64 = 4.0;

/// On which side of a line the tool is, seen along it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beside {
    /// On its left: inside of a line that closes counterclockwise.
    Left,
    /// On its right: outside of it.
    Right,
}

/// Straight pieces one after the other, in plan, mm.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanLine {
    /// Its corners; of a closed one the first is not repeated, and they go counterclockwise.
    pub corners: Vec<Point>,
    /// Whether it closes.
    pub closed: bool,
}

impl PlanLine {
    /// Itself as a path.
    #[must_use]
    pub fn path(&self) -> Stretch {
        let mut points = self.corners.clone();
        if self.closed {
            points.extend(self.corners.first());
        }
        Stretch { points, closed: self.closed }
    }

    /// The area within a closed line, mm^2: below 0 where it goes clockwise.
    #[must_use]
    pub fn area(&self) -> f64 {
        signed_area(&self.corners)
    }

    /// The same in the other direction.
    #[must_use]
    pub fn reversed(mut self) -> Self {
        self.corners.reverse();
        self
    }

    /// The paths beside it at a distance, mm, in its direction; arcs are chords that are at most `tolerance` (mm) nearer to it.
    #[must_use]
    pub fn parallels(&self, side: Beside, distance: f64, tolerance: f64) -> Vec<Stretch> {
        if distance < NONE {
            return vec![self.path()];
        }
        let farthest = self.corners.iter().flatten().fold(1.0, |most: f64, x| most.max(x.abs()));
        let kernel = Kernel::new(farthest + AROUND * distance);
        let mut found = if self.closed {
            let area = Polygons { contours: vec![self.corners.clone()] };
            let signed = if side == Beside::Right { distance } else { -distance };
            let contours = kernel.offset(&area, signed, tolerance).contours;
            contours.into_iter().map(closed).collect()
        } else {
            let band = kernel.sweep(&self.corners, distance, tolerance);
            band.contours.iter().flat_map(|contour| self.runs(contour, side)).collect::<Vec<_>>()
        };
        found.retain(|path| path.length() >= LEAST);
        found
    }

    /// The parts of a border of the band around an open line that lie on one of its sides, in its direction.
    fn runs(&self, contour: &[Point], side: Beside) -> Vec<Stretch> {
        let edges: Vec<(Point, Point)> = sides(contour).collect();
        let is_beside = |(a, b): &(Point, Point)| self.side_of(middle(*a, *b)) == Some(side);
        let kept: Vec<bool> = edges.iter().map(is_beside).collect();
        let mut found: Vec<Stretch> = Vec::new();
        match kept.iter().position(|kept| !kept) {
            None => found.push(closed(contour.to_vec())),
            Some(first) => {
                let from_first = edges.iter().zip(&kept).cycle().skip(first).take(edges.len());
                let mut goes_on = false;
                for ((a, b), kept) in from_first {
                    match found.last_mut().filter(|_| *kept && goes_on) {
                        Some(run) => run.points.push(*b),
                        None if *kept => found.push(Stretch { points: vec![*a, *b], closed: false }),
                        None => {}
                    }
                    goes_on = *kept;
                }
            }
        }
        if side == Beside::Left {
            // the band is on the left of its border
            found.iter_mut().for_each(|run| run.points.reverse());
        }
        found
    }

    /// On which side of an open line a point lies; none beyond its ends.
    fn side_of(&self, point: Point) -> Option<Beside> {
        let last = self.corners.len().checked_sub(2)?;
        let pieces = self.corners.windows(2).map(|pair| Foot::of(point, [pair[0], pair[1]]));
        let (number, foot) = pieces.enumerate().min_by(|a, b| a.1.apart.total_cmp(&b.1.apart))?;
        let Foot { share, before, beyond, .. } = foot;
        if (number == 0 && before > BEYOND) || (number == last && beyond > BEYOND) {
            return None;
        }
        // beside a corner both pieces count
        let neighbour = match share {
            0.0 => number.checked_sub(1),
            1.0 => Some(number + 1).filter(|next| *next <= last),
            _ => None,
        };
        let left = |number: usize| {
            let (Some(a), Some(b)) = (self.corners.get(number), self.corners.get(number + 1)) else { return 0.0 };
            let length = apart(*a, *b).max(f64::MIN_POSITIVE);
            ((b[0] - a[0]) * (point[1] - foot.at[1]) - (b[1] - a[1]) * (point[0] - foot.at[0])) / length
        };
        let sum = left(number) + neighbour.map_or(0.0, left);
        Some(if sum > 0.0 { Beside::Left } else { Beside::Right })
    }
}

/// The point of a piece that is nearest to another.
struct Foot {
    at: Point,
    share: f64,
    apart: f64,
    /// How far the other lies before the piece's beginning and beyond its end, mm.
    before: f64,
    beyond: f64,
}

impl Foot {
    fn of(point: Point, [a, b]: [Point; 2]) -> Self {
        let along = [b[0] - a[0], b[1] - a[1]];
        let length = apart(a, b).max(f64::MIN_POSITIVE);
        let gone = ((point[0] - a[0]) * along[0] + (point[1] - a[1]) * along[1]) / length;
        let share = (gone / length).clamp(0.0, 1.0);
        let at = between(a, b, share);
        Self { at, share, apart: apart(at, point), before: -gone, beyond: gone - length }
    }
}

fn closed(mut points: Vec<Point>) -> Stretch {
    points.extend(points.first().copied());
    Stretch { points, closed: true }
}

fn middle(a: Point, b: Point) -> Point {
    between(a, b, 0.5)
}

fn between(a: Point, b: Point, share: f64) -> Point {
    [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])]
}

/// How a tool comes down to a path along it.
#[derive(Clone, Debug, PartialEq)]
pub struct Descent {
    /// The tips on the ramp, from the path's beginning on.
    pub ramp: Vec<Vector>,
    /// The path from where that ends on.
    pub path: Stretch,
}

/// The ramp along a path from one height to another, mm, with a slope of height over length: on closed paths round them, which then
/// begin where it ends; on open ones to and fro.
#[must_use]
pub fn descent(path: &Stretch, [from, to]: [f64; 2], slope: f64) -> Descent {
    let (length, run) = (path.length(), (from - to) / slope);
    let (route, path) = if path.closed {
        let turns = (run / length.max(LEAST)).floor();
        let (first, rest) = parted(&path.points, run - turns * length);
        let mut route: Vec<Point> = Vec::new();
        for _ in 0..turns as usize {
            route.extend(path.points.iter().take(path.points.len().saturating_sub(1)));
        }
        route.extend(first.iter());
        let mut points = rest.into_iter().chain(first.into_iter().skip(1)).collect();
        straightened(&mut points);
        (route, Stretch { points, closed: true })
    } else {
        let trips = (0.5 * run / length.max(LEAST)).ceil().max(1.0);
        let (ahead, _) = parted(&path.points, 0.5 * run / trips);
        let back: Vec<Point> = ahead.iter().rev().skip(1).copied().collect();
        let mut route: Vec<Point> = ahead.first().copied().into_iter().collect();
        for _ in 0..trips as usize {
            route.extend(ahead.iter().skip(1).chain(&back));
        }
        (route, path.clone())
    };
    Descent { ramp: falling(&route, [from, to]), path }
}

/// The points of a route at heights that fall evenly along it.
fn falling(route: &[Point], [from, to]: [f64; 2]) -> Vec<Vector> {
    let whole: f64 = route.windows(2).map(|pair| apart(pair[0], pair[1])).sum();
    let mut gone = 0.0;
    let mut tips: Vec<Vector> = route.first().map(|[x, y]| Vector::new(*x, *y, from)).into_iter().collect();
    for pair in route.windows(2) {
        gone += apart(pair[0], pair[1]);
        tips.push(Vector::new(pair[1][0], pair[1][1], from + (to - from) * (gone / whole).min(1.0)));
    }
    tips
}

/// The first `length` (mm) of a path, and what follows: the point between is in both.
fn parted(points: &[Point], length: f64) -> (Vec<Point>, Vec<Point>) {
    let mut left = length;
    let mut first: Vec<Point> = points.first().copied().into_iter().collect();
    for (number, pair) in points.windows(2).enumerate() {
        let step = apart(pair[0], pair[1]);
        if step >= left {
            let share = if step > 0.0 { left / step } else { 0.0 };
            let at = between(pair[0], pair[1], share);
            first.push(at);
            let rest = std::iter::once(at).chain(points.iter().skip(number + 1).copied()).collect();
            return (first, rest);
        }
        left -= step;
        first.push(pair[1]);
    }
    (first, points.last().copied().into_iter().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> PlanLine {
        PlanLine { corners: vec![[0.0, 0.0], [10.0, 0.0], [10.0, 8.0], [0.0, 8.0]], closed: true }
    }

    #[test]
    fn outside_of_a_rectangle_lines_are_joined_by_arcs_and_inside_they_meet() {
        let outside = square().parallels(Beside::Right, 3.0, 1e-3);
        let [only] = outside.as_slice() else { panic!("{outside:?}") };
        assert!(only.closed && (only.length() - (36.0 + std::f64::consts::TAU * 3.0)).abs() < 0.02);
        let inside = square().parallels(Beside::Left, 3.0, 1e-3);
        let [only] = inside.as_slice() else { panic!("{inside:?}") };
        assert!(only.closed && (only.length() - 2.0 * (4.0 + 2.0)).abs() < 1e-6);
        assert!(square().parallels(Beside::Left, 4.1, 1e-3).is_empty());
    }

    #[test]
    fn beside_an_open_line_the_path_ends_where_it_does() {
        let line = PlanLine { corners: vec![[0.0, 0.0], [10.0, 0.0], [10.0, 8.0]], closed: false };
        let left = line.parallels(Beside::Left, 2.0, 1e-3);
        let [only] = left.as_slice() else { panic!("{left:?}") };
        let close = |a: Point, b: Point| apart(a, b) < 1e-5;
        let [first, corner, last] = only.points.as_slice() else { panic!("{only:?}") };
        assert!(close(*first, [0.0, 2.0]) && close(*corner, [8.0, 2.0]) && close(*last, [8.0, 8.0]), "{only:?}");
        let right = line.parallels(Beside::Right, 2.0, 1e-3);
        let [only] = right.as_slice() else { panic!("{right:?}") };
        assert!((only.length() - (18.0 + std::f64::consts::PI)).abs() < 0.01);
        assert!(close(only.points[0], [0.0, -2.0]) && close(*only.points.last().unwrap(), [12.0, 8.0]));
    }

    #[test]
    fn a_tool_comes_down_round_a_loop_and_to_and_fro_along_a_line() {
        let round = square().path();
        let Descent { ramp, path } = descent(&round, [1.0, -1.0], 0.05);
        assert!((ramp.last().unwrap() - Vector::new(4.0, 0.0, -1.0)).norm() < 1e-9 && (ramp[0].z - 1.0).abs() < 1e-9);
        assert!(path.closed && apart(path.points[0], [4.0, 0.0]) < 1e-9 && path.points.last() == path.points.first());
        assert!((path.length() - 36.0).abs() < 1e-9);
        let open = Stretch { points: vec![[0.0, 0.0], [2.0, 0.0]], closed: false };
        let Descent { ramp, path } = descent(&open, [0.0, -1.0], 0.2);
        assert_eq!(ramp.len(), 5);
        assert!((ramp[2] - Vector::new(0.0, 0.0, -0.5)).norm() < 1e-9, "{ramp:?}");
        assert!((ramp[4] - Vector::new(0.0, 0.0, -1.0)).norm() < 1e-9 && path == open);
    }
}
