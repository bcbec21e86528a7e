//! A ball with a conical side.

use std::f64::consts::FRAC_PI_2;

#[cfg(test)]
use proptest::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

#[cfg(test)]
use crate::profile::numbers::numbers;
use crate::{
    error::positive_length,
    profile::{
        chain::Builder,
        kind::{Built, ProfileKind},
        parts::{angle, beyond_flat, round_tipped},
    },
    GeometryError,
};

/// A ball with a conical side.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TaperedBall {
    /// Radius of the ball at the tip, mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub tip_radius: f64,
    /// Angle between axis and side, degrees.
    #[schemars(extend("x-unit" = "deg"))]
    pub half_angle_deg: f64,
    /// Diameter of the base, mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub diameter: f64,
    /// Radius of the flat at the tip, mm.
    #[serde(default)]
    #[schemars(extend("x-unit" = "mm"))]
    pub tip_flat: f64,
}

impl ProfileKind for TaperedBall {
    fn starter() -> &'static str {
        r#"{"kind": "tapered-ball", "tip_radius": 1.5, "half_angle_deg": 5.0, "diameter": 6.0}"#
    }

    fn tip_flat(&self) -> f64 {
        self.tip_flat
    }

    fn diameter(&self) -> Option<f64> {
        Some(self.diameter)
    }

    fn build(&self, tip: Builder) -> Result<Built, GeometryError> {
        let slope = FRAC_PI_2 - angle("half_angle_deg", self.half_angle_deg, 90.0)?;
        let tip_radius = positive_length("tip_radius", self.tip_radius)?;
        round_tipped(tip, tip_radius, slope, beyond_flat(self.diameter, self.tip_flat)?)
    }

    #[cfg(test)]
    fn any() -> BoxedStrategy<Self> {
        numbers()
            .prop_map(|n| Self {
                tip_radius: n.beyond() * n.a,
                half_angle_deg: 89.0 * n.b,
                diameter: n.diameter,
                tip_flat: n.tip_flat,
            })
            .boxed()
    }
}
