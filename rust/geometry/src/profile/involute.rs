//! A curve whose radius of curvature changes evenly with the slope: part of a circle's involute, or of an offset of one.

use super::Meridian;

/// Radius of curvature `radius + rate * (slope - start)`, counted from the curve's start.
///
/// Of the curves with a continuous radius of curvature it is the plainest: r and z by slope are the integrals of
/// that line times cos and sin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Involute {
    start: f64,
    radius: f64,
    rate: f64,
}

impl Involute {
    /// The curve that begins at the slope `start` (rad) with `radius` (mm), which then grows by `rate` (mm/rad).
    #[must_use]
    pub fn new(start: f64, radius: f64, rate: f64) -> Self {
        Self { start, radius, rate }
    }

    /// The curve along a chord of `length` mm that turns by `before` rad up to the chord's slope and by `after` beyond
    /// it; `None` where its radius would have to come near 0: a chord outside the middle third of the turn.
    #[must_use]
    pub fn over_chord(start: f64, length: f64, before: f64, after: f64) -> Option<Self> {
        let half = 0.5 * (before + after);
        let (sin, cos) = libm::sincos(0.5 * (before - after));
        let middle = length * cos / (2.0 * libm::sin(half));
        let rate = length * sin / (2.0 * sine_less_arc_cosine(half));
        ((rate * half).abs() <= MOST_CHANGE * middle).then(|| Self::new(start, middle - rate * half, rate))
    }

    /// The same curve `ball` mm farther out.
    #[must_use]
    pub fn grown(&self, ball: f64) -> Self {
        Self { radius: self.radius + ball, ..*self }
    }
}

/// The radius changes by this share of its mean on either side, at most: beyond, two arcs are rounder.
const MOST_CHANGE: f64 = 0.8;

impl Meridian for Involute {
    fn point_at(&self, slope: f64) -> (f64, f64) {
        // by the chord, as for an arc: nothing cancels where the curve is nearly straight
        let half = 0.5 * (slope - self.start);
        if half == 0.0 {
            return (0.0, 0.0);
        }
        let along = 2.0 * (self.radius + self.rate * half) * libm::sin(half);
        let across = 2.0 * self.rate * sine_less_arc_cosine(half);
        let (sin, cos) = libm::sincos(0.5 * (slope + self.start));
        (along * cos - across * sin, along * sin + across * cos)
    }

    fn curvature_radius_at(&self, slope: f64) -> f64 {
        self.radius + self.rate * (slope - self.start)
    }

    fn height_at_radius(&self, radius: f64, within: [f64; 2]) -> f64 {
        let slope = self.slope_at_radius(radius, within);
        let (r, z) = self.point_at(slope);
        // on a nearly straight piece the last bit of the slope is a long distance: along the tangent, which is the curve
        let rest = (radius - r) * libm::tan(slope);
        if rest.is_finite() {
            z + rest
        } else {
            z
        }
    }
}

/// sin x - x cos x by its power series, the sum of (-1)^(n+1) 2n x^(2n+1) / (2n+1)!, for |x| up to pi/4.
fn sine_less_arc_cosine(x: f64) -> f64 {
    let square = x * x;
    SERIES.iter().rev().fold(0.0, |sum, term| term - square * sum) * square * x
}

/// Terms of the series: the ninth is below 1e-17 of the first.
const TERMS: usize = 9;
const SERIES: [f64; TERMS] = series();

const fn series() -> [f64; TERMS] {
    let mut out = [0.0; TERMS];
    let mut factorial = 1.0;
    let mut n = 1;
    while n <= TERMS {
        factorial *= (2 * n * (2 * n + 1)) as f64;
        out[n - 1] = (2 * n) as f64 / factorial;
        n += 1;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_series_is_the_function() {
        for x in [1e-3, 0.1, 0.4, 0.785_f64] {
            let exact = x.sin() - x * x.cos();
            assert!((sine_less_arc_cosine(x) - exact).abs() < 3e-16, "{x}");
        }
        // where the difference cancels: x^3/3 - x^5/30
        let x = 1e-6_f64;
        assert!((sine_less_arc_cosine(x) / (x.powi(3) / 3.0 - x.powi(5) / 30.0) - 1.0).abs() < 1e-15);
    }

    proptest! {
        #[test]
        fn it_is_the_integral_of_its_radius(start in 0.0..0.7_f64, turn in 0.01..0.8_f64, radius in 0.1..10.0_f64, share in -0.9..5.0_f64) {
            let rate = share * radius / turn;
            let curve = Involute::new(start, radius, rate);
            let count = 2000;
            let (mut r, mut z) = (0.0, 0.0);
            for i in 0..count {
                let slope = start + turn * (f64::from(i) + 0.5) / f64::from(count);
                let step = (radius + rate * (slope - start)) * turn / f64::from(count);
                r += step * slope.cos();
                z += step * slope.sin();
            }
            let (cr, cz) = curve.point_at(start + turn);
            prop_assert!((cr - r).abs() < 1e-6 * radius && (cz - z).abs() < 1e-6 * radius, "{cr} {r} {cz} {z}");
        }

        #[test]
        fn it_leads_along_the_chord(start in 0.0..0.5_f64, turn in 1e-9..0.8_f64, share in 0.4..0.6_f64, length in 0.1..5.0_f64) {
            let (before, after) = (share * turn, (1.0 - share) * turn);
            let curve = Involute::over_chord(start, length, before, after).unwrap();
            let (r, z) = curve.point_at(start + (before + after));
            let (sin, cos) = (start + before).sin_cos();
            // a slope is known to its last bit only: so is a turn of 1e-9
            let close = (1e-14 + 1e-15 / turn) * length;
            prop_assert!((r - length * cos).abs() < close && (z - length * sin).abs() < close, "{r} {z}");
        }
    }
}
