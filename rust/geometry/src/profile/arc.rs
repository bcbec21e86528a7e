//! Part of a circle: the ball, corner radii, barrels, and the balls that kinks grow into.

use super::Meridian;

/// Steps that mend rounding are shorter than this, rad.
const NEWTON: f64 = 1e-6;

/// A circular arc, relative to its start: r = R (sin - sin start), z = R (cos start - cos).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    radius: f64,
    start: f64,
}

impl Arc {
    /// An arc of `radius` mm that begins at the slope `start`, rad.
    #[must_use]
    pub fn new(radius: f64, start: f64) -> Self {
        Self { radius, start }
    }

    /// Its radius, mm.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The same arc `ball` mm farther out.
    #[must_use]
    pub fn grown(&self, ball: f64) -> Self {
        Self { radius: self.radius + ball, ..*self }
    }
}

impl Meridian for Arc {
    fn point_at(&self, slope: f64) -> (f64, f64) {
        if self.start <= 0.0 {
            let (sin, cos) = libm::sincos(slope);
            let half = libm::sin(slope / 2.0);
            // 1 - cos without cancellation near the tip, exact 1 at the equator
            let versine = if slope < 0.5 { 2.0 * half * half } else { 1.0 - cos };
            return (self.radius * sin, self.radius * versine);
        }
        // by the chord: differences of sines would cancel on a flat arc of a large circle
        let chord = 2.0 * self.radius * libm::sin(0.5 * (slope - self.start));
        let (sin, cos) = libm::sincos(0.5 * (slope + self.start));
        (chord * cos, chord * sin)
    }

    fn curvature_radius_at(&self, _slope: f64) -> f64 {
        self.radius
    }

    fn slope_at_radius(&self, radius: f64, within: [f64; 2]) -> f64 {
        let slope = libm::asin((libm::sin(self.start) + radius / self.radius).clamp(0.0, 1.0));
        // one step of Newton: the sine of a large circle has lost digits; not where the radius hardly changes
        let step = (radius - self.point_at(slope).0) / (self.radius * libm::cos(slope));
        let slope = if step.abs() < NEWTON { slope + step } else { slope };
        slope.clamp(within[0], within[1])
    }

    fn slope_at_height(&self, height: f64, within: [f64; 2]) -> f64 {
        // 1 - cos, relative to that of the start: nothing cancels near the tip
        let half = libm::sin(0.5 * self.start);
        let versine = (2.0 * half * half + height / self.radius).max(0.0);
        let sin = (versine * (2.0 - versine)).max(0.0).sqrt();
        libm::atan2(sin, 1.0 - versine).clamp(within[0], within[1])
    }

    fn slope_nearest(&self, (r, z): (f64, f64), within: [f64; 2], _guess: f64) -> f64 {
        // the direction from the centre, relative to that to the start
        let (sin, cos) = libm::sincos(self.start);
        let (along, away) = (r * cos + z * sin, r * sin - z * cos);
        (self.start + libm::atan2(along, self.radius + away)).clamp(within[0], within[1])
    }

    fn height_at_radius(&self, radius: f64, _within: [f64; 2]) -> f64 {
        let (sin, cos) = libm::sincos(self.start);
        let (first, up) = (self.radius * sin, self.radius * cos);
        // r (r + 2 R sin) = z (2 R cos - z): near a right angle the difference of squares of R would have lost it
        let product = radius * (2.0 * first + radius);
        let rest = (up * up - product).max(0.0).sqrt();
        product / (up + rest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::FRAC_PI_2;

    proptest! {
        #[test]
        fn height_gives_back_the_slope(
            radius in 1e-3..1e3_f64,
            start in prop_oneof![Just(0.0), 0.0..1.5_f64],
            share in 0.0..1.0_f64,
        ) {
            let arc = Arc::new(radius, start);
            let slope = start + share * (FRAC_PI_2 - start);
            let (_, height) = arc.point_at(slope);
            let found = arc.slope_at_height(height, [start, FRAC_PI_2]);
            prop_assert!((arc.point_at(found).1 - height).abs() <= 1e-15 * radius, "{slope} {found}");
        }
    }
}
