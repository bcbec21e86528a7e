//! A V-shaped engraver.

use std::f64::consts::FRAC_PI_2;

#[cfg(test)]
use proptest::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

#[cfg(test)]
use crate::profile::numbers::numbers;
use crate::{
    error::length,
    profile::{
        chain::Builder,
        kind::{Built, ProfileKind},
        parts::{angle, beyond_flat, LEAST},
    },
    GeometryError,
};

/// A V-shaped engraver with a flat tip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct V {
    /// Diameter of the tip, mm.
    #[serde(default)]
    #[schemars(extend("x-unit" = "mm"))]
    pub tip_diameter: f64,
    /// Included angle, degrees.
    #[schemars(extend("x-unit" = "deg"))]
    pub angle_deg: f64,
    /// Diameter of the base, mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub diameter: f64,
    /// Radius of a flat that is added at the tip, mm.
    #[serde(default)]
    #[schemars(extend("x-unit" = "mm"))]
    pub tip_flat: f64,
}

impl ProfileKind for V {
    fn starter() -> &'static str {
        r#"{"kind": "v", "tip_diameter": 0.2, "angle_deg": 90.0, "diameter": 10.0}"#
    }

    fn tip_flat(&self) -> f64 {
        self.tip_flat
    }

    fn diameter(&self) -> Option<f64> {
        Some(self.diameter)
    }

    fn build(&self, mut tip: Builder) -> Result<Built, GeometryError> {
        let tip_diameter = length("tip_diameter", self.tip_diameter)?;
        let base = beyond_flat(self.diameter, self.tip_flat)?;
        let side = angle("angle_deg", self.angle_deg, 180.0)? / 2.0;
        let rest = base - tip_diameter / 2.0;
        if rest <= LEAST {
            return Err(GeometryError::OutOfRange {
                key: "tip_diameter",
                value: tip_diameter,
                allowed: "less than the diameter",
            });
        }
        tip.straight(tip_diameter / 2.0);
        tip.kink(FRAC_PI_2 - side);
        tip.straight(rest / libm::sin(side));
        Ok(tip.finish().into())
    }

    #[cfg(test)]
    fn any() -> BoxedStrategy<Self> {
        numbers()
            .prop_map(|n| Self {
                tip_diameter: 2.0 * n.beyond() * n.a,
                angle_deg: 179.0 * n.b,
                diameter: n.diameter,
                tip_flat: n.tip_flat,
            })
            .boxed()
    }
}
