//! The cycloid: r = a (t + sin t), z = a (1 - cos t), slope t / 2.

use std::f64::consts::PI;

use super::Meridian;

/// Half an arch of a cycloid, from its lowest point to its cusp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycloid {
    circle: f64,
}

impl Cycloid {
    /// The cycloid that reaches `radius` mm at a right angle: its rolling circle has the radius `radius` / pi.
    #[must_use]
    pub fn from_radius(radius: f64) -> Self {
        Self { circle: radius / PI }
    }
}

impl Meridian for Cycloid {
    fn point_at(&self, slope: f64) -> (f64, f64) {
        let sin = libm::sin(slope);
        (self.circle * (2.0 * slope + libm::sin(2.0 * slope)), 2.0 * self.circle * sin * sin)
    }

    fn curvature_radius_at(&self, slope: f64) -> f64 {
        4.0 * self.circle * libm::cos(slope)
    }
}
