//! A curve without a closed form by slope: piecewise polynomials, evaluated by slope to rounding.

use std::f64::consts::FRAC_PI_2;

use super::Meridian;

/// Coefficients of the polynomials for radius and height, lowest first; their derivatives have one less.
pub(super) const TERMS: usize = 14;

/// Bins of the table of starting values.
const BINS: usize = 256;
/// A Newton step this small (of half an interval) leaves an error of its square.
const SMALL_STEP: f64 = 1e-7;

/// Part of the curve: r and z as polynomials of u in [-1, 1].
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Interval {
    /// r of u.
    pub r: [f64; TERMS],
    /// z of u.
    pub z: [f64; TERMS],
    /// dr/du and dz/du, interleaved: both are needed at once.
    rates: [[f64; 2]; TERMS - 1],
    /// Slopes at both ends, rad.
    pub slopes: [f64; 2],
    /// Radii at both ends, mm.
    pub radii: [f64; 2],
}

impl Interval {
    pub fn new(r: [f64; TERMS], z: [f64; TERMS], slopes: [f64; 2]) -> Self {
        let rates = std::array::from_fn(|k| {
            let factor = (k + 1) as f64;
            [factor * r[k + 1], factor * z[k + 1]]
        });
        let radii = [horner(&r, -1.0), horner(&r, 1.0)];
        Self { r, z, rates, slopes, radii }
    }

    pub fn point(&self, u: f64) -> (f64, f64) {
        let (mut r, mut z) = (0.0, 0.0);
        for k in (0..TERMS).rev() {
            r = r * u + self.r[k];
            z = z * u + self.z[k];
        }
        (r, z)
    }

    /// First and second derivatives of (r, z) by u.
    pub fn rates(&self, u: f64) -> ([f64; 2], [f64; 2]) {
        let (mut d, mut dd) = ([0.0; 2], [0.0; 2]);
        for rate in self.rates.iter().rev() {
            dd = [dd[0] * u + d[0], dd[1] * u + d[1]];
            d = [d[0] * u + rate[0], d[1] * u + rate[1]];
        }
        (d, dd)
    }

    /// Coefficients of dr/du and dz/du, lowest first.
    pub fn rate_polynomials(&self) -> [[f64; TERMS - 1]; 2] {
        [0, 1].map(|i| self.rates.map(|rate| rate[i]))
    }

    /// Where the slope is that of the direction (cos, sin), which lies within this interval.
    fn parameter_of(&self, (cos, sin): (f64, f64), start: f64) -> f64 {
        rising_root(start, SMALL_STEP, |u| {
            let (d, dd) = self.rates(u);
            (d[1] * cos - d[0] * sin, dd[1] * cos - dd[0] * sin)
        })
    }

    /// Where the radius is this one, which lies within this interval.
    fn parameter_of_radius(&self, radius: f64) -> f64 {
        let [low, high] = self.radii;
        let width = high - low;
        let start = if width > 0.0 { 2.0 * (radius - low) / width - 1.0 } else { 1.0 };
        rising_root(start.clamp(-1.0, 1.0), 1e-12, |u| (self.point(u).0 - radius, self.rates(u).0[0]))
    }
}

fn horner(coefficients: &[f64; TERMS], u: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * u + c)
}

/// The zero in [-1, 1] of a function that passes from below to above it: Newton, kept in a bracket that shrinks.
///
/// Ends after a Newton step of at most `step`.
fn rising_root(start: f64, step: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
    let (mut low, mut high, mut u) = (-1.0_f64, 1.0_f64, start);
    for _ in 0..100 {
        let (value, rate) = f(u);
        if value < 0.0 {
            low = u;
        } else {
            high = u;
        }
        let next = u - value / rate;
        if next >= low && next <= high {
            let small = (next - u).abs() <= step;
            u = next;
            if small {
                break;
            }
        } else {
            u = 0.5 * (low + high);
        }
        if high - low <= f64::EPSILON {
            break;
        }
    }
    u
}

/// Starting value of u within one bin of slopes: a cubic, where the whole bin lies in one interval.
#[derive(Clone, Debug, PartialEq)]
struct Bin {
    interval: usize,
    start: Option<[f64; 4]>,
}

/// A convex curve from the tip as piecewise polynomials.
///
/// Slopes lie between those of its ends; beyond them it stays at its end points.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    intervals: Vec<Interval>,
    bins: Vec<Bin>,
    from: f64,
    to: f64,
    bins_per_slope: f64,
    start: (f64, f64),
    end: (f64, f64),
}

impl Fitted {
    /// Intervals in order from the tip to the base; at least one, slopes not falling.
    pub(super) fn new(intervals: Vec<Interval>, start: (f64, f64), end: (f64, f64)) -> Self {
        let from = intervals.first().map_or(0.0, |interval| interval.slopes[0]);
        let to = intervals.last().map_or(FRAC_PI_2, |interval| interval.slopes[1]);
        let bins_per_slope = BINS as f64 / (to - from);
        let mut fitted = Self { intervals, bins: Vec::new(), from, to, bins_per_slope, start, end };
        let ends: Vec<_> = (0..=BINS).map(|k| fitted.table_entry(from + k as f64 / bins_per_slope)).collect();
        fitted.bins = ends.windows(2).map(|pair| fitted.bin(&pair[0], &pair[1])).collect();
        fitted
    }

    /// Interval, u and du/dslope at a slope, from scratch.
    fn table_entry(&self, slope: f64) -> (usize, f64, f64) {
        let index = self.interval_of_slope(slope);
        let interval = &self.intervals[index];
        let direction = direction(slope);
        let u = interval.parameter_of(direction, even_start(interval, slope));
        let (d, dd) = interval.rates(u);
        (index, u, (d[0] * d[0] + d[1] * d[1]) / (d[0] * dd[1] - d[1] * dd[0]))
    }

    fn bin(&self, low: &(usize, f64, f64), high: &(usize, f64, f64)) -> Bin {
        let width = 1.0 / self.bins_per_slope;
        let (rise, left, right) = (high.1 - low.1, low.2 * width, high.2 * width);
        let cubic = [low.1, left, 3.0 * rise - 2.0 * left - right, left + right - 2.0 * rise];
        let usable = low.0 == high.0 && cubic.iter().all(|c| c.is_finite()) && left.min(right) >= 0.0;
        Bin { interval: low.0, start: usable.then_some(cubic) }
    }

    fn interval_of_slope(&self, slope: f64) -> usize {
        let index = self.intervals.partition_point(|interval| interval.slopes[1] < slope);
        index.min(self.intervals.len() - 1)
    }

    /// Interval and u at a slope strictly between the ends'.
    fn locate(&self, slope: f64) -> (&Interval, f64) {
        let scaled = (slope - self.from) * self.bins_per_slope;
        let index = (scaled as usize).min(BINS - 1);
        let bin = &self.bins[index];
        let (interval, start) = match bin.start {
            Some(c) => {
                let x = scaled - index as f64;
                let start = c[0] + x * (c[1] + x * (c[2] + x * c[3]));
                (&self.intervals[bin.interval], start.clamp(-1.0, 1.0))
            }
            None => {
                let interval = &self.intervals[self.interval_of_slope(slope)];
                (interval, even_start(interval, slope))
            }
        };
        (interval, interval.parameter_of(direction(slope), start))
    }

    /// Its pieces, from the tip.
    pub(super) fn intervals(&self) -> &[Interval] {
        &self.intervals
    }

    /// Slopes at which the curve begins and ends, rad.
    #[must_use]
    pub fn slopes(&self) -> (f64, f64) {
        (self.from, self.to)
    }

    fn locate_radius(&self, radius: f64) -> (&Interval, f64) {
        let index = self.intervals.partition_point(|interval| interval.radii[1] < radius);
        let interval = &self.intervals[index.min(self.intervals.len() - 1)];
        (interval, interval.parameter_of_radius(radius))
    }
}

impl Meridian for Fitted {
    fn point_at(&self, slope: f64) -> (f64, f64) {
        if slope <= self.from {
            return self.start;
        }
        if slope >= self.to {
            return self.end;
        }
        let (interval, u) = self.locate(slope);
        let (r, z) = interval.point(u);
        (r.max(0.0), z.max(0.0))
    }

    fn curvature_radius_at(&self, slope: f64) -> f64 {
        let (interval, u) = match (self.intervals.first(), self.intervals.last()) {
            (Some(first), _) if slope <= self.from => (first, -1.0),
            (_, Some(last)) if slope >= self.to => (last, 1.0),
            _ => self.locate(slope),
        };
        let (d, dd) = interval.rates(u);
        let speed = (d[0] * d[0] + d[1] * d[1]).sqrt();
        let turning = d[0] * dd[1] - d[1] * dd[0];
        if turning <= f64::EPSILON * speed * speed {
            f64::INFINITY
        } else {
            speed * speed * speed / turning
        }
    }

    fn slope_at_radius(&self, radius: f64, _within: [f64; 2]) -> f64 {
        if radius <= self.start.0 {
            return self.from;
        }
        if radius >= self.end.0 {
            return self.to;
        }
        let (interval, u) = self.locate_radius(radius);
        let (d, _) = interval.rates(u);
        libm::atan2(d[1], d[0]).clamp(interval.slopes[0], interval.slopes[1])
    }

    fn height_at_radius(&self, radius: f64, _within: [f64; 2]) -> f64 {
        if radius <= self.start.0 {
            return self.start.1;
        }
        if radius >= self.end.0 {
            return self.end.1;
        }
        let (interval, u) = self.locate_radius(radius);
        interval.point(u).1.max(0.0)
    }
}

/// cos and sin of a slope.
fn direction(slope: f64) -> (f64, f64) {
    let (sin, cos) = libm::sincos(slope);
    (cos, sin)
}

/// u as if the slope grew evenly over the interval.
fn even_start(interval: &Interval, slope: f64) -> f64 {
    let [low, high] = interval.slopes;
    if high > low {
        (2.0 * (slope - low) / (high - low) - 1.0).clamp(-1.0, 1.0)
    } else {
        0.0
    }
}
