//! Half an ellipse.

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
        parts::{beyond_flat, ended, whole},
    },
    GeometryError,
};

/// Half an ellipse.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ellipse {
    /// Semi-axis across the tool's axis, mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub radial: f64,
    /// Semi-axis along the tool's axis, mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub axial: f64,
    /// Diameter of the base, mm, if the ellipse ends before its equator.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm"))]
    pub diameter: Option<f64>,
    /// Radius of the flat at the tip, mm.
    #[serde(default)]
    #[schemars(extend("x-unit" = "mm"))]
    pub tip_flat: f64,
}

impl ProfileKind for Ellipse {
    fn starter() -> &'static str {
        r#"{"kind": "ellipse", "radial": 6.0, "axial": 4.0}"#
    }

    fn tip_flat(&self) -> f64 {
        self.tip_flat
    }

    fn diameter(&self) -> Option<f64> {
        self.diameter
    }

    fn build(&self, tip: Builder) -> Result<Built, GeometryError> {
        let base = self.diameter.map(|diameter| beyond_flat(diameter, self.tip_flat)).transpose()?;
        let radial = positive_length("radial", self.radial)?;
        let curve = Curve::Ellipse(conic::Ellipse::new(radial, positive_length("axial", self.axial)?));
        match base {
            None => Ok(whole(tip, curve)),
            Some(base) if base <= radial => Ok(ended(tip, curve, base)),
            Some(base) => Err(GeometryError::OutOfRange {
                key: "diameter",
                value: 2.0 * base,
                allowed: "at most twice the radial semi-axis, tip flat added",
            }),
        }
    }

    #[cfg(test)]
    fn any() -> BoxedStrategy<Self> {
        numbers()
            .prop_map(|n| Self {
                radial: n.diameter * n.a,
                axial: n.diameter * n.b,
                diameter: None,
                tip_flat: n.tip_flat,
            })
            .boxed()
    }
}
