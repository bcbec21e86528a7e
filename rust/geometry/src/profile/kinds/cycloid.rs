//! Half an arch of a cycloid.

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
        cycloid,
        kind::{Built, ProfileKind},
        parts::{beyond_flat, whole},
    },
    GeometryError,
};

/// r = a (t + sin t), z = a (1 - cos t).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cycloid {
    /// Diameter of the base, mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub diameter: f64,
    /// Radius of the flat at the tip, mm.
    #[serde(default)]
    #[schemars(extend("x-unit" = "mm"))]
    pub tip_flat: f64,
}

impl ProfileKind for Cycloid {
    fn starter() -> &'static str {
        r#"{"kind": "cycloid", "diameter": 12.0}"#
    }

    fn tip_flat(&self) -> f64 {
        self.tip_flat
    }

    fn diameter(&self) -> Option<f64> {
        Some(self.diameter)
    }

    fn build(&self, tip: Builder) -> Result<Built, GeometryError> {
        let base = beyond_flat(self.diameter, self.tip_flat)?;
        Ok(whole(tip, Curve::Cycloid(cycloid::Cycloid::from_radius(base))))
    }

    #[cfg(test)]
    fn any() -> BoxedStrategy<Self> {
        numbers().prop_map(|n| Self { diameter: n.diameter, tip_flat: n.tip_flat }).boxed()
    }
}
