//! A rectangle with rounded corners.

#[cfg(test)]
use proptest::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

#[cfg(test)]
use crate::profile::numbers::numbers;
use crate::{
    profile::{
        chain::Builder,
        kind::{Built, ProfileKind},
        parts::{beyond_flat, round_cornered},
    },
    GeometryError,
};

/// A rectangle with rounded corners, as the forming stylus: flat, arc, vertical side.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RoundedRectangle {
    /// Diameter of the base, mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub diameter: f64,
    /// Radius of the corners, mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub corner_radius: f64,
    /// Radius of a flat that is added at the tip, mm.
    #[serde(default)]
    #[schemars(extend("x-unit" = "mm"))]
    pub tip_flat: f64,
}

impl ProfileKind for RoundedRectangle {
    fn starter() -> &'static str {
        r#"{"kind": "rounded-rectangle", "diameter": 12.0, "corner_radius": 3.0}"#
    }

    fn tip_flat(&self) -> f64 {
        self.tip_flat
    }

    fn diameter(&self) -> Option<f64> {
        Some(self.diameter)
    }

    fn build(&self, tip: Builder) -> Result<Built, GeometryError> {
        round_cornered(tip, beyond_flat(self.diameter, self.tip_flat)?, self.corner_radius)
    }

    #[cfg(test)]
    fn any() -> BoxedStrategy<Self> {
        numbers()
            .prop_map(|n| Self { diameter: n.diameter, corner_radius: n.beyond() * n.a, tip_flat: n.tip_flat })
            .boxed()
    }
}
