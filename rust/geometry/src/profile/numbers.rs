//! Random numbers that suit every kind of profile, for tests.

use proptest::prelude::*;

/// A size, two shares of it, and a flat.
#[derive(Clone, Copy, Debug)]
pub struct Numbers {
    /// Diameter of the base, mm.
    pub diameter: f64,
    /// Radius of the flat at the tip, mm.
    pub tip_flat: f64,
    /// A share, well inside 0 to 1.
    pub a: f64,
    /// Another.
    pub b: f64,
}

impl Numbers {
    /// What the flat leaves of the base's radius, mm.
    pub fn beyond(&self) -> f64 {
        0.5 * self.diameter - self.tip_flat
    }
}

/// Numbers of any size.
pub fn numbers() -> impl Strategy<Value = Numbers> {
    let flat = prop_oneof![Just(0.0), 0.0..0.3_f64];
    (1.0..40.0_f64, 0.05..0.95_f64, 0.05..0.95_f64, flat).prop_map(|(diameter, a, b, flat)| Numbers {
        diameter,
        tip_flat: flat * diameter * 0.5,
        a,
        b,
    })
}
