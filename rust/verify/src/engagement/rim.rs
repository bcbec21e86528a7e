//! The tool's rim at one position, and where it crosses circles and lines.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use styluscam_geometry::{PlanePiece, PlanePoint};

/// The circle on which material is looked for.
#[derive(Clone, Copy, Debug)]
pub struct Rim {
    pub centre: PlanePoint,
    pub radius: f64,
}

/// Directions narrower than this are rounding, rad: 1e-8 mm on a rim of 10 mm.
const ROUNDING: f64 = 1e-9;

impl Rim {
    pub fn at(&self, direction: f64) -> PlanePoint {
        let (sin, cos) = libm::sincos(direction);
        [self.centre[0] + self.radius * cos, self.centre[1] + self.radius * sin]
    }

    /// Radius of a disc about the interval's middle that holds the interval, mm.
    pub fn reach(&self, [from, to]: [f64; 2]) -> f64 {
        2.0 * self.radius * libm::sin((0.25 * (to - from)).min(0.5 * PI))
    }

    /// Appends the directions in which the rim crosses a circle.
    pub fn crossings_with_circle(&self, centre: PlanePoint, radius: f64, found: &mut Vec<f64>) {
        let arm = [centre[0] - self.centre[0], centre[1] - self.centre[1]];
        let distance = libm::hypot(arm[0], arm[1]);
        if distance > self.radius + radius || distance < (self.radius - radius).abs() || distance <= 0.0 {
            return;
        }
        let cos = (self.radius * self.radius + distance * distance - radius * radius) / (2.0 * self.radius * distance);
        let half = libm::acos(cos.clamp(-1.0, 1.0));
        let middle = libm::atan2(arm[1], arm[0]);
        found.extend([(middle - half).rem_euclid(TAU), (middle + half).rem_euclid(TAU)]);
    }

    /// Appends the directions in which the rim crosses the line through two points, moved `aside` to its left.
    pub fn crossings_with_line(&self, start: PlanePoint, end: PlanePoint, aside: f64, found: &mut Vec<f64>) {
        let along = [end[0] - start[0], end[1] - start[1]];
        let length = libm::hypot(along[0], along[1]);
        if length <= 0.0 {
            return;
        }
        let left = [-along[1] / length, along[0] / length];
        let away = left[0] * (start[0] - self.centre[0]) + left[1] * (start[1] - self.centre[1]) + aside;
        let cos = away / self.radius;
        if cos.abs() > 1.0 {
            return;
        }
        let half = libm::acos(cos);
        let middle = libm::atan2(left[1], left[0]);
        found.extend([(middle - half).rem_euclid(TAU), (middle + half).rem_euclid(TAU)]);
    }

    /// The directions in an interval, and its end, in which the rim passes from one square cell of a size to the next, in ascending order.
    pub fn crossings_with_grid(&self, [from, to]: [f64; 2], size: f64, found: &mut Vec<f64>) {
        found.clear();
        // in a quarter each coordinate goes one way: a line is crossed once
        for quarter in 0..4 {
            let [first, last] = [quarter, quarter + 1].map(|i| f64::from(i) * FRAC_PI_2);
            let (start, end) = (from.max(first), to.min(last));
            if start >= end {
                continue;
            }
            for (axis, (a, b)) in self.at(start).into_iter().zip(self.at(end)).enumerate() {
                let (low, high) = (a.min(b) / size, a.max(b) / size);
                let mut line = libm::ceil(low);
                while line <= high {
                    let share = ((line * size - self.centre[axis]) / self.radius).clamp(-1.0, 1.0);
                    found.push(direction_in(quarter, axis, share));
                    line += 1.0;
                }
            }
        }
        found.retain(|direction| *direction > from && *direction < to);
        found.sort_by(f64::total_cmp);
        found.push(to);
    }

    /// Leaves of an interval what lies outside the disc of `radius` swept along a piece.
    pub fn outside_sweep(
        &self,
        interval: [f64; 2],
        piece: &PlanePiece,
        radius: f64,
        scratch: &mut Vec<f64>,
        left: &mut Vec<[f64; 2]>,
    ) {
        let distance = piece.distance(self.at(0.5 * (interval[0] + interval[1])));
        let reach = self.reach(interval);
        if distance > radius + reach {
            left.push(interval);
            return;
        }
        if distance + reach < radius {
            return;
        }
        scratch.clear();
        self.crossings_with_circle(piece.start, radius, scratch);
        self.crossings_with_circle(piece.end, radius, scratch);
        match &piece.circle {
            Some(circle) => {
                self.crossings_with_circle(circle.centre, circle.radius + radius, scratch);
                self.crossings_with_circle(circle.centre, (circle.radius - radius).abs(), scratch);
            }
            None => {
                self.crossings_with_line(piece.start, piece.end, radius, scratch);
                self.crossings_with_line(piece.start, piece.end, -radius, scratch);
            }
        }
        self.split(interval, scratch, left, |point| piece.distance(point) > radius);
    }

    /// Cuts an interval at the crossings and keeps the parts whose middle `stays`.
    pub fn split(
        &self,
        [from, to]: [f64; 2],
        crossings: &mut Vec<f64>,
        left: &mut Vec<[f64; 2]>,
        stays: impl Fn(PlanePoint) -> bool,
    ) {
        crossings.retain(|direction| *direction > from && *direction < to);
        crossings.sort_by(f64::total_cmp);
        crossings.push(to);
        let mut start = from;
        let mut kept: Option<[f64; 2]> = None;
        for end in crossings.iter().copied() {
            if end - start > ROUNDING {
                if stays(self.at(0.5 * (start + end))) {
                    kept = Some([kept.map_or(start, |[first, _]| first), end]);
                } else {
                    left.extend(kept.take());
                }
            }
            start = end;
        }
        left.extend(kept);
    }
}

/// The direction in a quarter of the circle of which a cosine (axis 0) or sine (axis 1) is known.
fn direction_in(quarter: i32, axis: usize, share: f64) -> f64 {
    match (axis, quarter) {
        (0, 0 | 1) => libm::acos(share),
        (0, _) => TAU - libm::acos(share),
        (_, 0) => libm::asin(share),
        (_, 1 | 2) => PI - libm::asin(share),
        (_, _) => TAU + libm::asin(share),
    }
}
