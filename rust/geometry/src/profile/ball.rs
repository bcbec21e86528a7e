//! The ball: a quarter circle from tip to equator.

use std::f64::consts::FRAC_PI_2;

use super::Meridian;

/// A quarter circle: r = R sin, z = R (1 - cos).
#[derive(Clone, Debug, PartialEq)]
pub struct Ball {
    radius: f64,
}

impl Ball {
    /// A ball of `radius` mm, which must be positive.
    #[must_use]
    pub fn new(radius: f64) -> Self {
        Self { radius }
    }

    /// Its radius, mm.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

impl Meridian for Ball {
    fn max_slope(&self) -> f64 {
        FRAC_PI_2
    }

    fn point_at(&self, slope: f64) -> (f64, f64) {
        let (sin, cos) = libm::sincos(slope);
        let half = libm::sin(slope / 2.0);
        // 1 - cos without cancellation near the tip, exact 1 at the equator
        let versine = if slope < 0.5 { 2.0 * half * half } else { 1.0 - cos };
        (self.radius * sin, self.radius * versine)
    }

    fn curvature_radius_at(&self, _slope: f64) -> f64 {
        self.radius
    }

    fn slope_at_radius(&self, radius: f64) -> f64 {
        libm::asin((radius / self.radius).clamp(0.0, 1.0))
    }
}
