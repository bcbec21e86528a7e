//! A barrel.

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
        arc::Arc,
        chain::Builder,
        curve::Curve,
        kind::{Built, ProfileKind},
        parts::beyond_flat,
    },
    GeometryError,
};

/// A ball that runs tangentially into an arc of a larger circle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Barrel {
    /// Diameter where it is widest, mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub diameter: f64,
    /// Radius of the generating arc, mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub radius: f64,
    /// Radius of the ball at the tip, mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub tip_radius: f64,
    /// Radius of the flat at the tip, mm.
    #[serde(default)]
    #[schemars(extend("x-unit" = "mm"))]
    pub tip_flat: f64,
}

impl ProfileKind for Barrel {
    fn starter() -> &'static str {
        r#"{"kind": "barrel", "diameter": 10.0, "radius": 40.0, "tip_radius": 2.0}"#
    }

    fn tip_flat(&self) -> f64 {
        self.tip_flat
    }

    fn diameter(&self) -> Option<f64> {
        Some(self.diameter)
    }

    fn build(&self, mut tip: Builder) -> Result<Built, GeometryError> {
        let base = beyond_flat(self.diameter, self.tip_flat)?;
        let radius = positive_length("radius", self.radius)?;
        let tip_radius = positive_length("tip_radius", self.tip_radius)?;
        if tip_radius > base || radius < base {
            return Err(GeometryError::Keys(format!(
                "barrel: tip_radius = {tip_radius} <= half the diameter = {base} <= radius = {radius} must hold"
            )));
        }
        // both circles have one tangent where their distances from the axis are equal: R_t sin = D/2 - R + R sin
        let meets = if radius > tip_radius { libm::asin((radius - base) / (radius - tip_radius)) } else { 0.0 };
        tip.curve(Curve::Arc(Arc::new(tip_radius, 0.0)), 0.0, meets);
        tip.curve(Curve::Arc(Arc::new(radius, meets)), meets, FRAC_PI_2);
        Ok(tip.finish().into())
    }

    #[cfg(test)]
    fn any() -> BoxedStrategy<Self> {
        numbers()
            .prop_map(|n| Self {
                diameter: n.diameter,
                radius: n.beyond() / n.a,
                tip_radius: n.beyond() * n.b,
                tip_flat: n.tip_flat,
            })
            .boxed()
    }
}
