//! Curves at a distance from contours, of which the booleans make areas (polygons.rs).
//!
//! Where a contour is curved more than the distance its curve folds over, and the loops cross each other over and over. An edge whose middle
//! is nearer to the contours than the distance, by more than half its length, is nowhere part of the area's boundary: such stretches
//! are cut short by a line that is as near all along, or by the contour itself. Winding numbers change only inside by that: a hole that
//! they leave there is none. Where that is not possible the curve stays as it is, and a coarse one, led through every hollow corner,
//! fills (or empties) what lies behind the folds, where the boundary never is.

use super::boxes::Boxes;
use super::contours::{arc_step, bounds, circle, sides, signed_area, Point};

/// Cosine of the turns up to which a hollow corner is the chord of an arc: through each of those, curves would cross all others.
const GENTLE: f64 = 0.99;
/// How far coarse chords are off, as a share of the offset.
const COARSE: f64 = 0.01;
/// Turns up to this get one corner, rad; larger ones get their arc from tangent to tangent, for its ends are the path's headings.
const SMOOTH: f64 = 0.01;
/// Turns with a smaller sine are straight on.
const STRAIGHT: f64 = 1e-9;
/// Lines that cut folds short are halved so often to see that they are inside.
const HALVINGS: u32 = 9;
/// And edges of curves.
const FEW_HALVINGS: u32 = 3;
/// Corners of a contour that are looked at to see whether it bounds the area.
const LOOKED: usize = 64;

/// Curves without folds.
pub struct Unfolded {
    pub curves: Vec<Vec<Point>>,
    distance: f64,
    tolerance: f64,
    sides: Vec<(Point, Point)>,
    boxes: Boxes,
}

/// The curves of contours with all folds cut short; None where one cannot be.
pub fn unfolded(contours: &[&[Point]], distance: f64, tolerance: f64) -> Option<Unfolded> {
    let sides: Vec<(Point, Point)> = contours.iter().flat_map(|contour| sides(contour)).collect();
    let boxes = Boxes::new(&sides);
    let mut found = Unfolded { curves: Vec::new(), distance, tolerance, sides, boxes };
    for contour in contours {
        let curve = curve(contour, distance, tolerance, GENTLE);
        if curve.is_folded {
            let alone = || is_alone(contour, contours);
            found.curves.extend(found.cut_short(&curve, signed_area(contour) * distance < 0.0 && alone())?);
        } else {
            found.curves.push(curve.points);
        }
    }
    Some(found)
}

/// The curves of contours with their folds, and coarse ones that fill them.
pub fn folded(contours: &[&[Point]], distance: f64, tolerance: f64) -> (Vec<Vec<Point>>, Vec<Vec<Point>>) {
    let fine = contours.iter().map(|contour| curve(contour, distance, tolerance, GENTLE).points);
    let sag = COARSE * distance.abs();
    let behind = distance - (2.0 * sag).copysign(distance);
    let coarse = contours.iter().map(|contour| curve(&coarsened(contour, sag, false), behind, sag, 2.0).points);
    (fine.collect(), coarse.collect())
}

impl Unfolded {
    /// Whether a contour of the area made of the curves bounds it, and is no hole between lines that cut folds short; None where it is
    /// both, as where such a hole has grown together with one of the area.
    pub fn bounds(&self, contour: &[Point]) -> Option<bool> {
        if signed_area(contour) * self.distance > 0.0 {
            return Some(true);
        }
        let step = contour.len().div_ceil(LOOKED).max(1);
        let near = self.distance.abs() - 8.0 * self.tolerance;
        let mut looked = contour.iter().step_by(step).map(|point| self.is_nearer(*point, near));
        let first = looked.next().unwrap_or(false);
        looked.all(|is_near| is_near == first).then_some(!first)
    }

    /// A folded curve with the stretches left out that are inside; none of it where all of it is and `may_vanish`.
    fn cut_short(&self, curve: &Curve, may_vanish: bool) -> Option<Option<Vec<Point>>> {
        let count = curve.points.len();
        let gone: Vec<bool> = (0..count).map(|i| self.is_gone(curve, i)).collect();
        let is_gone = |i: usize| gone.get(i % count).copied().unwrap_or(false);
        let Some(first) = (0..count).find(|i| !is_gone(*i)) else { return may_vanish.then_some(None) };
        let mut kept = Vec::with_capacity(count);
        let mut begun: Option<usize> = None;
        for i in first..=first + count {
            if is_gone(i) {
                begun.get_or_insert(i);
                continue;
            }
            if let Some(from) = begun.take() {
                self.short_cut(&mut kept, curve, from, i)?;
            }
            let is_far = |near: f64| !self.is_nearer(curve.middle(i), near);
            if curve.kind(i) == Kind::Inverted && !is_far((1.0 - 2.0 * COARSE) * self.distance.abs()) {
                return None;
            }
            if i < first + count {
                kept.push(curve.at(i));
            }
        }
        Some(Some(kept))
    }

    /// Whether the edge of a curve that begins with a point is inside all along.
    fn is_gone(&self, curve: &Curve, i: usize) -> bool {
        let reach = self.distance.abs() - self.tolerance;
        match (curve.kind(i), curve.kind(i + 1)) {
            // to or from the corner of a fold: nearer than its outer end is at most
            (Kind::Corner, _) => self.is_nearer(curve.at(i + 1), reach),
            (_, Kind::Corner) => self.is_nearer(curve.at(i), reach),
            _ => self.is_nearer(curve.middle(i), reach) && self.is_inside(curve.at(i), curve.at(i + 1), FEW_HALVINGS),
        }
    }

    /// From where a stretch that is inside begins to where it ends: straight, if that is inside; else back along the contour.
    fn short_cut(&self, kept: &mut Vec<Point>, curve: &Curve, from: usize, to: usize) -> Option<()> {
        let (a, b) = (curve.at(from), curve.at(to));
        kept.push(a);
        if self.is_inside(a, b, HALVINGS) {
            return Some(());
        }
        let (mut corner, last) = (curve.corner(from), curve.corner(to));
        if corner == last && 2 * (to - from) > curve.points.len() {
            return None;
        }
        kept.extend(curve.corners.get(corner));
        while corner != last {
            corner = (corner + 1) % curve.corners.len();
            kept.extend(curve.corners.get(corner));
        }
        Some(())
    }

    /// Whether all of a line is nearer to the contours than the distance.
    fn is_inside(&self, a: Point, b: Point, halvings: u32) -> bool {
        let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        let half = 0.5 * libm::hypot(b[0] - a[0], b[1] - a[1]);
        self.is_nearer(middle, self.distance.abs() - self.tolerance - half)
            || (halvings > 0 && self.is_inside(a, middle, halvings - 1) && self.is_inside(middle, b, halvings - 1))
    }

    /// Whether a point is nearer to the contours than a distance, mm.
    fn is_nearer(&self, point: Point, distance: f64) -> bool {
        distance > 0.0 && self.boxes.is_one_within(&self.sides, point, distance * distance)
    }
}

/// Whether no other contour begins in the box of one.
fn is_alone(contour: &[Point], contours: &[&[Point]]) -> bool {
    let Some([low, high]) = bounds(contour.iter()) else { return true };
    let inside = |p: &Point| (0..2).all(|i| low[i] <= p[i] && p[i] <= high[i]);
    contours.iter().filter(|other| other.first().is_some_and(inside)).count() == 1
}

/// What a point of a curve is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// At the distance from a corner.
    Away,
    /// The same, and the edge that begins there goes against the side that it belongs to.
    Inverted,
    /// The corner itself, at a fold.
    Corner,
}

/// The curve at a distance from one contour.
struct Curve {
    /// The corners of the contour.
    corners: Vec<Point>,
    points: Vec<Point>,
    kinds: Vec<Kind>,
    /// Of each point the number of its corner.
    of: Vec<usize>,
    is_folded: bool,
}

impl Curve {
    fn kind(&self, i: usize) -> Kind {
        self.kinds.get(i % self.kinds.len().max(1)).copied().unwrap_or(Kind::Away)
    }

    fn at(&self, i: usize) -> Point {
        self.points.get(i % self.points.len().max(1)).copied().unwrap_or_default()
    }

    fn corner(&self, i: usize) -> usize {
        self.of.get(i % self.of.len().max(1)).copied().unwrap_or(0)
    }

    fn middle(&self, i: usize) -> Point {
        let (a, b) = (self.at(i), self.at(i + 1));
        [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
    }
}

/// Whether nothing is left of a hole that is offset inwards, or of an outline: the disc does not fit between two sides of its box.
pub fn vanishes(contour: &[Point], distance: f64) -> bool {
    if signed_area(contour) * distance > 0.0 {
        return false;
    }
    let [low, high] = bounds(contour.iter()).unwrap_or_default();
    (high[0] - low[0]).min(high[1] - low[1]) < 2.0 * distance.abs()
}

/// A contour with the chords of its arcs joined to longer ones, at most `sag` off it; of hollow arcs only, if so wished.
pub fn coarsened(contour: &[Point], sag: f64, only_hollow: bool) -> Vec<Point> {
    let count = contour.len();
    let mut kept: Vec<Point> = Vec::with_capacity(count / 4 + 4);
    let (mut turned, mut travelled): (f64, f64) = (0.0, 0.0);
    for (i, corner) in contour.iter().enumerate() {
        let (Some(before), Some(after)) = (contour.get((i + count - 1) % count), contour.get((i + 1) % count)) else {
            continue;
        };
        let (u, v) = ([corner[0] - before[0], corner[1] - before[1]], [after[0] - corner[0], after[1] - corner[1]]);
        let turn = libm::atan2(u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]);
        turned += turn.abs();
        travelled += libm::hypot(u[0], u[1]);
        // a chain of chords that turns by t over a length l is off its chord by less than l t / 4
        if (only_hollow && turn > 0.0)
            || turn.abs() > 0.1
            || turned > 0.25
            || turned * (travelled + libm::hypot(v[0], v[1])) > 4.0 * sag
        {
            kept.push(*corner);
            (turned, travelled) = (0.0, 0.0);
        }
    }
    if kept.len() < 3 {
        return contour.to_vec();
    }
    kept
}

/// The curve at a distance to the right of a closed contour, with loops where it folds: the points around which it turns
/// more often to the left than to the right are the offset area (A. Johnson, Clipper2's method).
fn curve(contour: &[Point], distance: f64, tolerance: f64, gentle: f64) -> Curve {
    let mut corners: Vec<Point> = contour.to_vec();
    corners.dedup();
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    let step = arc_step(distance.abs(), tolerance);
    if let ([centre], true) = (corners.as_slice(), distance > 0.0) {
        let points = circle(*centre, distance, tolerance);
        let count = points.len();
        return Curve { corners, points, kinds: vec![Kind::Away; count], of: vec![0; count], is_folded: false };
    }
    let count = corners.len();
    let normals: Vec<Point> = sides(&corners)
        .map(|(a, b)| {
            let along = [b[0] - a[0], b[1] - a[1]];
            let length = libm::hypot(along[0], along[1]);
            [along[1] / length, -along[0] / length]
        })
        .collect();
    let mut points: Vec<Point> = Vec::with_capacity(2 * count);
    let mut kinds: Vec<Kind> = Vec::with_capacity(2 * count);
    let mut of: Vec<usize> = Vec::with_capacity(2 * count);
    let against =
        |from: Point, to: Point, normal: Point| (to[0] - from[0]) * -normal[1] + (to[1] - from[1]) * normal[0] < 0.0;
    for (i, corner) in corners.iter().enumerate() {
        let (Some(before), Some(after)) = (normals.get((i + count - 1) % count), normals.get(i)) else { continue };
        let begin = points.len();
        join(&mut points, *corner, [*before, *after], distance, step, gentle);
        let is_fold = points.len() == begin + 3 && points.get(begin + 1) == Some(corner);
        kinds.resize(points.len(), Kind::Away);
        of.resize(points.len(), i);
        if let (true, Some(kind)) = (is_fold, kinds.get_mut(begin + 1)) {
            *kind = Kind::Corner;
        }
        if let (Some(last), Some(to)) = (begin.checked_sub(1), points.get(begin)) {
            if let (Some(from), Some(kind)) = (points.get(last), kinds.get_mut(last)) {
                if against(*from, *to, *before) {
                    *kind = Kind::Inverted;
                }
            }
        }
    }
    if let (Some(from), Some(to), Some(kind), Some(normal)) =
        (points.last(), points.first(), kinds.last_mut(), normals.last())
    {
        if against(*from, *to, *normal) {
            *kind = Kind::Inverted;
        }
    }
    let is_folded = kinds.iter().any(|kind| *kind != Kind::Away);
    Curve { corners, points, kinds, of, is_folded }
}

/// The curve around one corner, between the normals of the sides that meet there.
fn join(curve: &mut Vec<Point>, corner: Point, [before, after]: [Point; 2], distance: f64, step: f64, gentle: f64) {
    let sin = before[0] * after[1] - before[1] * after[0];
    let cos = before[0] * after[0] + before[1] * after[1];
    let at = |normal: Point| [corner[0] + distance * normal[0], corner[1] + distance * normal[1]];
    let is_reversal = cos < 0.0 && sin.abs() < STRAIGHT;
    let is_hollow = sin * distance < 0.0 && !is_reversal;
    if (cos > 0.0 && sin.abs() < STRAIGHT)
        || (is_hollow && cos > gentle)
        || (!is_hollow && cos > 0.0 && sin.abs() < step.min(SMOOTH))
    {
        // where the two sides' lines meet
        let scale = distance / (1.0 + cos);
        curve.push([0, 1].map(|i| corner[i] + scale * (before[i] + after[i])));
    } else if is_hollow {
        // through the corner itself: what folds over is turned around once to the right
        curve.extend([at(before), corner, at(after)]);
    } else {
        let turn = if is_reversal { std::f64::consts::PI.copysign(distance) } else { libm::atan2(sin, cos) };
        let from = libm::atan2(before[1], before[0]);
        let chords = libm::ceil(turn.abs() / step).max(1.0) as usize;
        curve.push(at(before));
        for i in 1..chords {
            let (sin, cos) = libm::sincos(from + turn * i as f64 / chords as f64);
            curve.push(at([cos, sin]));
        }
        curve.push(at(after));
    }
}
