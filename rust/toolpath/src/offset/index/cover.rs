//! Boxes and planes over triangles, and over groups of them.

use std::ops::Range;

use rayon::prelude::*;
use styluscam_geometry::Vector;
use styluscam_motion::Watch;
use wide::f32x8;

use super::lanes::Lanes;
use super::lines::STEEPEST;
use super::pieces::Part;
use super::triangles::Triangles;
use super::width::{BATCH, WIDTH};

/// Rounding in a bound, as a share of the lengths and slopes that it is computed from.
const ROUNDING: f64 = 1e-6;
/// Groups of more than this many pieces take their plane from the planes of the groups in them.
const FROM_PARTS: usize = 512;

/// Box and plane of a group of pieces, relative to the index's centre.
#[derive(Clone, Copy)]
pub struct Cover {
    low: [f32; 3],
    high: [f32; 3],
    /// Sum of the triangles' gradients, each weighted by its area in plan, and of the weights.
    slope: [f64; 2],
    weight: f64,
    gradient: [f32; 2],
    /// Of the plane, over the middle of the box in plan.
    lift: f64,
}

/// The pieces in the order of the index.
pub struct Pieces<'a> {
    pub triangles: &'a Triangles,
    /// The triangle of each piece.
    pub of_pieces: &'a [u32],
    /// The boxes of those that are parts of their triangle.
    pub parts: &'a [Option<Box<Part>>],
    pub centre: Vector,
}

impl Pieces<'_> {
    fn corners(&self, piece: usize) -> [Vector; 3] {
        self.triangles.at(self.of_pieces[piece])
    }

    /// Calls `visit` with the corners of a piece, relative to the centre.
    #[inline]
    fn visit(&self, piece: usize, mut visit: impl FnMut(Vector)) {
        let corners = self.corners(piece);
        match &self.parts[piece] {
            Some(part) => part.outline(corners).into_iter().for_each(|p| visit(p - self.centre)),
            None => corners.into_iter().for_each(|p| visit(p - self.centre)),
        }
    }

    fn cover(&self, piece: usize) -> Cover {
        let corners = self.corners(piece);
        let (slope, weight) = weighted_gradient(corners);
        let whole = || Part::whole(corners);
        let Part { low, high } = self.parts[piece].as_deref().cloned().unwrap_or_else(whole);
        let cover = Cover::around([(low - self.centre, high - self.centre)], slope, weight);
        cover.under(self, piece..piece + 1)
    }
}

/// Covers of each piece; fewer when `watch` is cancelled.
pub fn of_pieces(pieces: &Pieces<'_>, watch: &Watch) -> Vec<Cover> {
    let count = pieces.of_pieces.len();
    let mut covers = Vec::with_capacity(count);
    for batch in watch.batches(count, BATCH) {
        covers.par_extend(batch.into_par_iter().map(|piece| pieces.cover(piece)));
    }
    covers
}

/// Covers of groups of eight covers; each group holds `size` pieces. Fewer when `watch` is cancelled.
pub fn of_groups(parts: &[Cover], size: usize, pieces: &Pieces<'_>, watch: &Watch) -> Vec<Cover> {
    let group = |number: usize| {
        let parts = &parts[number * WIDTH..((number + 1) * WIDTH).min(parts.len())];
        let slope = parts.iter().fold([0.0; 2], |a, p| [a[0] + p.slope[0], a[1] + p.slope[1]]);
        let weight = parts.iter().map(|p| p.weight).sum();
        let cover = Cover::around(parts.iter().map(|p| (p.corner(0.0), p.corner(1.0))), slope, weight);
        if size > FROM_PARTS {
            return cover.over_parts(parts);
        }
        cover.under(pieces, number * size..((number + 1) * size).min(pieces.of_pieces.len()))
    };
    let count = parts.len().div_ceil(WIDTH);
    let mut covers = Vec::with_capacity(count);
    for batch in watch.batches(count, BATCH / size.min(FROM_PARTS)) {
        covers.par_extend(batch.into_par_iter().map(group));
    }
    covers
}

/// Eight covers side by side.
pub fn lanes(covers: &[Cover]) -> Lanes {
    let mut lanes = Lanes::NOTHING;
    let row = |value: &dyn Fn(&Cover) -> f32, nothing: f32| {
        let mut row = [nothing; WIDTH];
        for (slot, cover) in row.iter_mut().zip(covers) {
            *slot = value(cover);
        }
        f32x8::new(row)
    };
    for i in 0..2 {
        lanes.low[i] = row(&|c| c.low[i], 0.0);
        lanes.high[i] = row(&|c| c.high[i], 0.0);
        lanes.gradient[i] = row(&|c| c.gradient[i], 0.0);
    }
    lanes.lift = row(&Cover::safe_lift, lanes.lift.to_array()[0]);
    lanes
}

impl Cover {
    fn around(boxes: impl IntoIterator<Item = (Vector, Vector)>, slope: [f64; 2], weight: f64) -> Self {
        let infinite = Vector::repeat(f64::INFINITY);
        let (low, high) =
            boxes.into_iter().fold((infinite, -infinite), |(low, high), b| (low.inf(&b.0), high.sup(&b.1)));
        let gradient = if weight > 0.0 { slope.map(|g| (g / weight) as f32) } else { [0.0; 2] };
        Self {
            low: std::array::from_fn(|i| below(low[i])),
            high: std::array::from_fn(|i| above(high[i])),
            slope,
            weight,
            gradient,
            lift: f64::NEG_INFINITY,
        }
    }

    /// With the lowest plane that has the pieces below it, or the top of the box where that is lower.
    fn under(mut self, pieces: &Pieces<'_>, range: Range<usize>) -> Self {
        let [x, y] = self.middle();
        let [gx, gy] = self.gradient.map(f64::from);
        for piece in range {
            pieces.visit(piece, |p| self.lift = self.lift.max(p.z - gx * (p.x - x) - gy * (p.y - y)));
        }
        self.flat_if_better()
    }

    /// With a plane over the planes of its parts.
    fn over_parts(mut self, parts: &[Self]) -> Self {
        let [x, y] = self.middle();
        let [gx, gy] = self.gradient.map(f64::from);
        for part in parts {
            let ([px, py], [hx, hy]) = (part.middle(), part.half());
            let [ax, ay] = part.gradient.map(f64::from);
            let corner = (ax - gx).abs() * hx + (ay - gy).abs() * hy;
            self.lift = self.lift.max(part.lift - gx * (px - x) - gy * (py - y) + corner);
        }
        self.flat_if_better()
    }

    fn flat_if_better(mut self) -> Self {
        let top = f64::from(self.high[2]);
        if self.lift >= top {
            (self.gradient, self.lift) = ([0.0; 2], top);
        }
        self
    }

    fn middle(&self) -> [f64; 2] {
        [0, 1].map(|i| 0.5 * f64::from(self.low[i] + self.high[i]))
    }

    fn half(&self) -> [f64; 2] {
        [0, 1].map(|i| 0.5 * (f64::from(self.high[i]) - f64::from(self.low[i])))
    }

    fn corner(&self, share: f64) -> Vector {
        let from = if share > 0.0 { &self.high } else { &self.low };
        Vector::new(f64::from(from[0]), f64::from(from[1]), f64::from(from[2]))
    }

    /// The lift, raised by all that rounding can take from a bound.
    fn safe_lift(&self) -> f32 {
        let [hx, hy] = self.half();
        let steepness = f64::from(self.gradient[0].abs() + self.gradient[1].abs());
        above(self.lift + ROUNDING * ((steepness + STEEPEST) * (hx + hy) + self.lift.abs()))
    }
}

/// The gradient and the area in plan that weighs it; walls keep their direction, but not their infinite gradient.
fn weighted_gradient([a, b, c]: [Vector; 3]) -> ([f64; 2], f64) {
    let normal = (b - a).cross(&(c - a));
    let steepness = (normal.x * normal.x + normal.y * normal.y).sqrt();
    let weight = normal.z.abs().max(steepness / STEEPEST);
    let sign = if normal.z < 0.0 { 1.0 } else { -1.0 };
    ([normal.x * sign, normal.y * sign], weight)
}

fn below(x: f64) -> f32 {
    let near = x as f32;
    if f64::from(near) > x {
        near.next_down()
    } else {
        near
    }
}

fn above(x: f64) -> f32 {
    let near = x as f32;
    if f64::from(near) < x {
        near.next_up()
    } else {
        near
    }
}
