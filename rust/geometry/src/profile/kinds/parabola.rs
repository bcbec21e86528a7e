//! A parabola.

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
        conic,
        curve::Curve,
        kind::{Built, ProfileKind},
        parts::{beyond_flat, ended},
    },
    GeometryError,
};

/// z = r^2 / 2 R0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parabola {
    /// Radius of curvature at the tip (R0), mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub apex_radius: f64,
    /// Diameter of the base, mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub diameter: f64,
    /// Radius of the flat at the tip, mm.
    #[serde(default)]
    #[schemars(extend("x-unit" = "mm"))]
    pub tip_flat: f64,
}

impl ProfileKind for Parabola {
    fn starter() -> &'static str {
        r#"{"kind": "parabola", "apex_radius": 6.0, "diameter": 14.0}"#
    }

    fn tip_flat(&self) -> f64 {
        self.tip_flat
    }

    fn diameter(&self) -> Option<f64> {
        Some(self.diameter)
    }

    fn build(&self, tip: Builder) -> Result<Built, GeometryError> {
        let curve = conic::Parabola::new(positive_length("apex_radius", self.apex_radius)?);
        Ok(ended(tip, Curve::Parabola(curve), beyond_flat(self.diameter, self.tip_flat)?))
    }

    #[cfg(test)]
    fn any() -> BoxedStrategy<Self> {
        numbers()
            .prop_map(|n| Self { apex_radius: n.diameter * n.a, diameter: n.diameter, tip_flat: n.tip_flat })
            .boxed()
    }
}
