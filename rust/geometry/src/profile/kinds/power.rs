//! A power law.

#[cfg(test)]
use proptest::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

#[cfg(test)]
use crate::profile::numbers::numbers;
use crate::{
    profile::{
        chain::Builder,
        curve::Curve,
        kind::{Built, ProfileKind},
        parts::{beyond_flat, ended},
        power,
    },
    GeometryError,
};

/// z = c r^p.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Power {
    /// The coefficient c, mm^(1 - p).
    #[schemars(extend("x-unit" = "mm^(1-p)"))]
    pub coefficient: f64,
    /// The exponent p, above 1.
    #[schemars(extend("x-unit" = "1"))]
    pub exponent: f64,
    /// Diameter of the base, mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub diameter: f64,
    /// Radius of the flat at the tip, mm.
    #[serde(default)]
    #[schemars(extend("x-unit" = "mm"))]
    pub tip_flat: f64,
}

impl ProfileKind for Power {
    fn starter() -> &'static str {
        r#"{"kind": "power", "coefficient": 0.02, "exponent": 3.0, "diameter": 12.0}"#
    }

    fn tip_flat(&self) -> f64 {
        self.tip_flat
    }

    fn diameter(&self) -> Option<f64> {
        Some(self.diameter)
    }

    fn build(&self, tip: Builder) -> Result<Built, GeometryError> {
        let (coefficient, exponent) = (self.coefficient, self.exponent);
        if !(1.01..=20.0).contains(&exponent) {
            return Err(GeometryError::OutOfRange { key: "exponent", value: exponent, allowed: "1.01 to 20" });
        }
        if !(1e-9..=1e9).contains(&coefficient) {
            return Err(GeometryError::OutOfRange { key: "coefficient", value: coefficient, allowed: "1e-9 to 1e9" });
        }
        let curve = Curve::Power(power::Power::new(coefficient, exponent));
        Ok(ended(tip, curve, beyond_flat(self.diameter, self.tip_flat)?))
    }

    #[cfg(test)]
    fn any() -> BoxedStrategy<Self> {
        numbers()
            .prop_map(|n| Self {
                coefficient: n.a * n.beyond().powf(-0.1 - 4.0 * n.b),
                exponent: 1.1 + 4.0 * n.b,
                diameter: n.diameter,
                tip_flat: n.tip_flat,
            })
            .boxed()
    }
}
