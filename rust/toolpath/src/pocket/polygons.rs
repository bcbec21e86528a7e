//! Areas of the plane as polygons, and what is done with them: booleans, offsets, what a disc sweeps.
//!
//! Corners lie on a grid of a power of two (some 1e-7 mm for a pocket of a few hundred mm), on which the booleans are exact
//! (i_overlay). Round joins are chords of their arcs, at most `tolerance` off them, inside.

use std::f64::consts::TAU;

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::Overlay;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::i_float::int::point::IntPoint;

/// A position, mm.
pub type Point = [f64; 2];

/// An area: outlines counterclockwise, holes clockwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polygons {
    pub contours: Vec<Vec<Point>>,
}

/// The grid on which areas are computed.
#[derive(Clone, Copy, Debug)]
pub struct Kernel {
    scale: f64,
}

/// Coordinates on the grid stay below this: a factor 2 is left to the library's limit of 2^30.
const HIGHEST: f64 = 536_870_912.0;
/// Cosine of the turns up to which a hollow corner is the chord of an arc: through each of those, curves would cross all others.
const GENTLE: f64 = 0.99;
/// How far coarse chords are off, as a share of the offset.
const COARSE: f64 = 0.01;
/// Turns up to this get one corner, rad; larger ones get their arc from tangent to tangent, for its ends are the path's headings.
const SMOOTH: f64 = 0.01;
/// Turns with a smaller sine are straight on.
const STRAIGHT: f64 = 1e-9;

impl Kernel {
    /// A grid for coordinates up to `farthest`, mm.
    pub fn new(farthest: f64) -> Self {
        let mut scale = 1.0;
        while scale * farthest < HIGHEST {
            scale *= 2.0;
        }
        while scale * farthest > HIGHEST {
            scale *= 0.5;
        }
        Self { scale }
    }

    /// What lies in either.
    pub fn union(&self, a: &Polygons, b: &Polygons) -> Polygons {
        self.boolean(a, b, OverlayRule::Union)
    }

    /// What lies in the first and not in the second.
    pub fn difference(&self, a: &Polygons, b: &Polygons) -> Polygons {
        self.boolean(a, b, OverlayRule::Difference)
    }

    /// What lies in both.
    pub fn intersection(&self, a: &Polygons, b: &Polygons) -> Polygons {
        self.boolean(a, b, OverlayRule::Intersect)
    }

    /// The area within outlines of any direction, by the even-odd rule.
    pub fn even_odd(&self, contours: &[Vec<Point>]) -> Polygons {
        let contours = self.to_grid(contours);
        self.back(Overlay::from_subj(&contours).overlay(OverlayRule::Subject, FillRule::EvenOdd))
    }

    /// The union of many areas that may overlap.
    pub fn union_all(&self, contours: &[Vec<Point>]) -> Polygons {
        let contours = self.to_grid(contours);
        self.back(Overlay::from_subj(&contours).overlay(OverlayRule::Subject, FillRule::Positive))
    }

    /// All points within `distance` of the area; below 0, the points of it farther than that from its outside. mm.
    ///
    /// Where the area's edge is curved more than `distance` its offset folds over. The coarse curve, led through every hollow
    /// corner, fills (or empties) what lies behind such folds, where the edge of the result never is.
    pub fn offset(&self, area: &Polygons, distance: f64, tolerance: f64) -> Polygons {
        if distance.abs() * self.scale < 1.0 {
            return area.clone();
        }
        let kept: Vec<&[Point]> =
            area.contours.iter().filter(|contour| !vanishes(contour, distance)).map(Vec::as_slice).collect();
        self.offset_of(&kept, distance, tolerance)
    }

    fn offset_of(&self, contours: &[&[Point]], distance: f64, tolerance: f64) -> Polygons {
        let fine = contours.iter().map(|contour| offset_curve(contour, distance, tolerance, GENTLE));
        let sag = COARSE * distance.abs();
        let behind = distance - (2.0 * sag).copysign(distance);
        let coarse = contours.iter().map(|contour| offset_curve(&coarsened(contour, sag, false), behind, sag, 2.0));
        // each by itself: where the one turns around to the right, the other must not make up for it
        let fine = self.union_all(&fine.collect::<Vec<_>>());
        let coarse = self.union_all(&coarse.collect::<Vec<_>>());
        let offset = if distance > 0.0 { self.union(&fine, &coarse) } else { self.intersection(&fine, &coarse) };
        offset.thinned(0.3 * tolerance)
    }

    /// What a disc of `radius` sweeps along a path, mm.
    pub fn sweep(&self, path: &[Point], radius: f64, tolerance: f64) -> Polygons {
        let back = path.iter().rev().skip(1).take(path.len().saturating_sub(2));
        let there_and_back = path.iter().chain(back).copied().collect::<Vec<Point>>();
        self.offset_of(&[&there_and_back], radius, tolerance)
    }

    fn boolean(&self, a: &Polygons, b: &Polygons, rule: OverlayRule) -> Polygons {
        let (a, b) = (self.to_grid(&a.contours), self.to_grid(&b.contours));
        self.back(Overlay::from_subj_and_clip(&a, &b).overlay(rule, FillRule::NonZero))
    }

    fn to_grid(self, contours: &[Vec<Point>]) -> Vec<Vec<IntPoint<i32>>> {
        let on_grid = |point: &Point| {
            let [x, y] = point.map(|x| libm::round(x * self.scale).clamp(-HIGHEST * 2.0, HIGHEST * 2.0 - 1.0) as i32);
            IntPoint::new(x, y)
        };
        contours.iter().map(|contour| contour.iter().map(on_grid).collect()).collect()
    }

    fn back(&self, shapes: Vec<Vec<Vec<IntPoint<i32>>>>) -> Polygons {
        let point = |p: IntPoint<i32>| [f64::from(p.x) / self.scale, f64::from(p.y) / self.scale];
        let contours = shapes.into_iter().flatten().map(|contour| contour.into_iter().map(point).collect());
        Polygons { contours: contours.collect() }
    }
}

impl Polygons {
    pub fn is_empty(&self) -> bool {
        self.contours.is_empty()
    }

    /// mm^2.
    pub fn area(&self) -> f64 {
        self.contours.iter().map(|contour| signed_area(contour)).sum()
    }

    /// A circle as a polygon whose sides touch it from inside.
    pub fn disc(centre: Point, radius: f64, tolerance: f64) -> Self {
        let count = libm::ceil(TAU / arc_step(radius, tolerance)).max(8.0) as usize;
        let corner = |i: usize| {
            let (sin, cos) = libm::sincos(i as f64 / count as f64 * TAU);
            [centre[0] + radius * cos, centre[1] + radius * sin]
        };
        Self { contours: vec![(0..count).map(corner).collect()] }
    }

    /// With longer chords along its hollow arcs, so that it is larger by up to `sag` there, mm.
    pub fn filled(&self, sag: f64) -> Self {
        Self { contours: self.contours.iter().map(|contour| coarsened(contour, sag, true)).collect() }
    }

    /// Without the corners that are less than `tolerance` off the line between those that stay.
    pub fn thinned(self, tolerance: f64) -> Self {
        Self { contours: self.contours.into_iter().map(|contour| thinned(&contour, tolerance)).collect() }
    }

    /// Corners of the smallest upright box around it; None where it is empty.
    pub fn bounds(&self) -> Option<[Point; 2]> {
        let mut corners = self.contours.iter().flatten();
        let first = *corners.next()?;
        Some(corners.fold([first, first], |[low, high], p| {
            [[low[0].min(p[0]), low[1].min(p[1])], [high[0].max(p[0]), high[1].max(p[1])]]
        }))
    }
}

/// The sides of a closed contour.
pub fn sides(contour: &[Point]) -> impl Iterator<Item = (Point, Point)> + '_ {
    contour.iter().copied().zip(contour.iter().copied().cycle().skip(1))
}

/// Corners looked ahead of the last that stays.
const AHEAD: usize = 24;

fn thinned(contour: &[Point], tolerance: f64) -> Vec<Point> {
    let count = contour.len();
    let mut kept = Vec::with_capacity(count);
    let mut from = 0;
    while from < count {
        kept.extend(contour.get(from));
        let mut to = from + 1;
        while to < count && to - from < AHEAD && is_straight(contour, from, to + 1, tolerance) {
            to += 1;
        }
        from = to;
    }
    if kept.len() < 3 {
        return contour.to_vec();
    }
    kept
}

/// Whether the corners between two are less than `tolerance` off the line between them.
fn is_straight(contour: &[Point], from: usize, to: usize, tolerance: f64) -> bool {
    let (Some(a), Some(b)) = (contour.get(from), contour.get(to % contour.len())) else { return false };
    let along = [b[0] - a[0], b[1] - a[1]];
    let length = libm::hypot(along[0], along[1]);
    let off = |p: &Point| {
        let arm = [p[0] - a[0], p[1] - a[1]];
        let on = arm[0] * along[0] + arm[1] * along[1];
        (arm[0] * along[1] - arm[1] * along[0]).abs() < tolerance * length && on > 0.0 && on < length * length
    };
    length > 0.0 && contour.get(from + 1..to).is_some_and(|between| between.iter().all(off))
}

/// mm^2, below 0 clockwise.
pub fn signed_area(contour: &[Point]) -> f64 {
    0.5 * sides(contour).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>()
}

/// Angle of the chords that are `tolerance` off an arc of `radius`, rad.
fn arc_step(radius: f64, tolerance: f64) -> f64 {
    let cos = (1.0 - tolerance / radius.max(tolerance)).clamp(-1.0, 1.0);
    (2.0 * libm::acos(cos)).clamp(1e-3, 0.5)
}

/// Whether nothing is left of a hole that is offset inwards, or of an outline: the disc does not fit between two sides of its box.
fn vanishes(contour: &[Point], distance: f64) -> bool {
    if signed_area(contour) * distance > 0.0 {
        return false;
    }
    let span = |axis: usize| {
        let values = contour.iter().filter_map(|p| p.get(axis));
        values.clone().copied().fold(f64::NEG_INFINITY, f64::max) - values.copied().fold(f64::INFINITY, f64::min)
    };
    span(0).min(span(1)) < 2.0 * distance.abs()
}

/// A contour with the chords of its arcs joined to longer ones, at most `sag` off it; of hollow arcs only, if so wished.
fn coarsened(contour: &[Point], sag: f64, only_hollow: bool) -> Vec<Point> {
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
fn offset_curve(contour: &[Point], distance: f64, tolerance: f64, gentle: f64) -> Vec<Point> {
    let mut corners: Vec<Point> = contour.to_vec();
    corners.dedup();
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    let step = arc_step(distance.abs(), tolerance);
    if let ([centre], true) = (corners.as_slice(), distance > 0.0) {
        return Polygons::disc(*centre, distance, tolerance).contours.concat();
    }
    let count = corners.len();
    let normals: Vec<Point> = sides(&corners)
        .map(|(a, b)| {
            let along = [b[0] - a[0], b[1] - a[1]];
            let length = libm::hypot(along[0], along[1]);
            [along[1] / length, -along[0] / length]
        })
        .collect();
    let mut curve = Vec::with_capacity(2 * count);
    for (i, corner) in corners.iter().enumerate() {
        let (Some(before), Some(after)) = (normals.get((i + count - 1) % count), normals.get(i)) else { continue };
        join(&mut curve, *corner, [*before, *after], distance, step, gentle);
    }
    curve
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
