//! The power law: z = c r^p with p above 1.

use std::cmp::Ordering;

use super::Meridian;

/// z = c r^p.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Power {
    coefficient: f64,
    exponent: f64,
}

impl Power {
    /// `coefficient` (c) in mm^(1 - p), `exponent` (p) above 1.
    #[must_use]
    pub fn new(coefficient: f64, exponent: f64) -> Self {
        Self { coefficient, exponent }
    }
}

impl Meridian for Power {
    fn point_at(&self, slope: f64) -> (f64, f64) {
        let radius = libm::pow(libm::tan(slope) / (self.coefficient * self.exponent), 1.0 / (self.exponent - 1.0));
        // z = c r^p = r tan / p
        (radius, radius * libm::tan(slope) / self.exponent)
    }

    fn curvature_radius_at(&self, slope: f64) -> f64 {
        let (sin, cos) = libm::sincos(slope);
        if sin <= 0.0 {
            // flat like r^p at the tip: a ball of no radius below 2, a plane above
            return match self.exponent.total_cmp(&2.0) {
                Ordering::Less => 0.0,
                Ordering::Equal => 0.5 / self.coefficient,
                Ordering::Greater => f64::INFINITY,
            };
        }
        // (1 + z'^2)^1.5 / z'', with z'' = (p - 1) z' / r
        self.point_at(slope).0 / ((self.exponent - 1.0) * sin * cos * cos)
    }

    fn slope_at_radius(&self, radius: f64, within: [f64; 2]) -> f64 {
        let rise = self.coefficient * self.exponent * libm::pow(radius, self.exponent - 1.0);
        libm::atan(rise).clamp(within[0], within[1])
    }

    fn height_at_radius(&self, radius: f64, _within: [f64; 2]) -> f64 {
        self.coefficient * libm::pow(radius, self.exponent)
    }
}
