//! A flat end with a sharp corner.

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
    },
    GeometryError,
};

/// A flat end with a sharp corner.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Flat {
    /// Diameter of the cutter, mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub diameter: f64,
    /// Part of the end, which is flat as a whole: at most half the diameter, and without effect.
    #[serde(default)]
    #[schemars(extend("x-unit" = "mm"))]
    pub tip_flat: f64,
}

impl ProfileKind for Flat {
    fn starter() -> &'static str {
        r#"{"kind": "flat", "diameter": 10.0}"#
    }

    fn tip_flat(&self) -> f64 {
        self.tip_flat
    }

    fn added_flat(&self) -> f64 {
        0.0
    }

    fn diameter(&self) -> Option<f64> {
        Some(self.diameter)
    }

    fn build(&self, mut tip: Builder) -> Result<Built, GeometryError> {
        let radius = positive_length("diameter", self.diameter)? / 2.0;
        if self.tip_flat > radius {
            let allowed = "at most half the diameter";
            return Err(GeometryError::OutOfRange { key: "tip_flat", value: self.tip_flat, allowed });
        }
        tip.straight(radius);
        Ok(tip.finish().into())
    }

    #[cfg(test)]
    fn any() -> BoxedStrategy<Self> {
        numbers().prop_map(|n| Self { diameter: n.diameter, tip_flat: n.tip_flat }).boxed()
    }
}
