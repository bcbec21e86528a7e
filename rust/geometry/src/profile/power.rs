//! The power law: z = c r^p with p above 1.

use std::cmp::Ordering;

use super::Meridian;

/// z = c r^p.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Power {
    coefficient: f64,
    exponent: f64,
    /// 1 / (c p) and 1 / (p - 1), for r = (tan / (c p))^(1 / (p - 1)).
    scale: f64,
    root: f64,
}

impl Power {
    /// `coefficient` (c) in mm^(1 - p), `exponent` (p) above 1.
    #[must_use]
    pub fn new(coefficient: f64, exponent: f64) -> Self {
        Self { coefficient, exponent, scale: 1.0 / (coefficient * exponent), root: 1.0 / (exponent - 1.0) }
    }
}

impl Meridian for Power {
    fn point_at(&self, slope: f64) -> (f64, f64) {
        let rise = libm::tan(slope);
        // r^(p - 1) = tan / (c p): by logarithm, half the time of a power and good to ln r times its rounding
        let radius = libm::exp(libm::log(rise * self.scale) * self.root);
        // z = c r^p = r tan / p
        (radius, radius * rise / self.exponent)
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_radius_at_a_slope_is_that_of_the_power(
            coefficient in -6.0..6.0_f64,
            exponent in 1.01..20.0_f64,
            size in -3.0..3.0_f64,
        ) {
            let power = Power::new(10_f64.powf(coefficient), exponent);
            let radius = 10_f64.powf(size);
            let rise = power.coefficient * exponent * radius.powf(exponent - 1.0);
            // a slope near 0 or a right angle holds the rise to few digits
            prop_assume!((1e-6..1e3).contains(&rise));
            let (r, z) = power.point_at(rise.atan());
            let lost = 1e-12 + 1e-15 * (rise + 1.0 / rise).min(1e3) / (exponent - 1.0);
            prop_assert!((r / radius - 1.0).abs() < lost, "{r} {radius}");
            prop_assert!((z / (r * rise / exponent) - 1.0).abs() < 1e-12, "{z}");
        }
    }

    #[test]
    fn it_begins_at_the_origin() {
        let (r, z) = Power::new(0.02, 3.3).point_at(0.0);
        assert!(r == 0.0 && z == 0.0, "{r} {z}");
    }
}
