//! A ball, or the part of a larger one that the diameter cuts off.

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
        parts::{beyond_flat, ended, whole},
    },
    GeometryError,
};

/// A half circle, the ball-end tool; or with `radius` the part of a larger circle that the diameter cuts off.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ball {
    /// Diameter of the base, mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub diameter: f64,
    /// Radius of the circle, mm; half the diameter when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm"))]
    pub radius: Option<f64>,
    /// Radius of the flat at the tip, mm.
    #[serde(default)]
    #[schemars(extend("x-unit" = "mm"))]
    pub tip_flat: f64,
}

impl ProfileKind for Ball {
    fn starter() -> &'static str {
        r#"{"kind": "ball", "diameter": 10.0}"#
    }

    fn tip_flat(&self) -> f64 {
        self.tip_flat
    }

    fn diameter(&self) -> Option<f64> {
        Some(self.diameter)
    }

    fn build(&self, tip: Builder) -> Result<Built, GeometryError> {
        let base = beyond_flat(self.diameter, self.tip_flat)?;
        let radius = positive_length("radius", self.radius.unwrap_or(base))?;
        if radius < base {
            return Err(GeometryError::OutOfRange {
                key: "radius",
                value: radius,
                allowed: "at least half the diameter: the circle must reach the base",
            });
        }
        let curve = Curve::Arc(Arc::new(radius, 0.0));
        Ok(if radius <= base { whole(tip, curve) } else { ended(tip, curve, base) })
    }

    #[cfg(test)]
    fn any() -> BoxedStrategy<Self> {
        (numbers(), any::<bool>())
            .prop_map(|(n, is_cut)| Self {
                diameter: n.diameter,
                radius: is_cut.then_some(n.beyond() / n.a),
                tip_flat: n.tip_flat,
            })
            .boxed()
    }
}
