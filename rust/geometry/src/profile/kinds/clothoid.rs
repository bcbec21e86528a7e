//! A clothoid: flat at the tip, its curvature grows evenly.

use std::f64::consts::FRAC_PI_2;

#[cfg(test)]
use proptest::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

#[cfg(test)]
use crate::profile::numbers::numbers;
use crate::{
    error::positive_area,
    profile::{
        chain::Builder,
        clothoid::Clothoid as Spiral,
        curve::Curve,
        kind::{Built, ProfileKind},
        parts::beyond_flat,
    },
    GeometryError,
};

/// Curvature grows linearly with arc length from the tip: R L = A.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Clothoid {
    /// Diameter of the base, mm; leave it out when `scale` is given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm"))]
    pub diameter: Option<f64>,
    /// The constant A, mm^2; needs `end_slope_deg`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm^2"))]
    pub scale: Option<f64>,
    /// Slope at which the curve ends, degrees; 90 unless given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "deg"))]
    pub end_slope_deg: Option<f64>,
    /// Radius of the flat at the tip, mm.
    #[serde(default)]
    #[schemars(extend("x-unit" = "mm"))]
    pub tip_flat: f64,
}

impl ProfileKind for Clothoid {
    fn starter() -> &'static str {
        r#"{"kind": "clothoid", "diameter": 12.0}"#
    }

    fn tip_flat(&self) -> f64 {
        self.tip_flat
    }

    fn diameter(&self) -> Option<f64> {
        self.diameter
    }

    fn build(&self, mut tip: Builder) -> Result<Built, GeometryError> {
        let base = self.diameter.map(|diameter| beyond_flat(diameter, self.tip_flat)).transpose()?;
        let end = match self.end_slope_deg {
            None => FRAC_PI_2,
            Some(value) if value > 0.0 && value <= 90.0 => value.to_radians(),
            Some(value) => {
                let allowed = "above 0 and up to 90 degrees";
                return Err(GeometryError::OutOfRange { key: "end_slope_deg", value, allowed });
            }
        };
        let curve = match (base, self.scale) {
            (Some(radius), None) => Spiral::from_radius(radius, end),
            (None, Some(scale)) if self.end_slope_deg.is_some() => Spiral::from_scale(positive_area("scale", scale)?),
            _ => return Err(GeometryError::Keys("clothoid takes diameter, or scale with end_slope_deg".to_owned())),
        };
        tip.curve(Curve::Clothoid(curve), 0.0, end);
        Ok(tip.finish().into())
    }

    #[cfg(test)]
    fn any() -> BoxedStrategy<Self> {
        (numbers(), any::<bool>())
            .prop_map(|(n, is_whole)| Self {
                diameter: Some(n.diameter),
                scale: None,
                end_slope_deg: (!is_whole).then_some(90.0 * n.a),
                tip_flat: n.tip_flat,
            })
            .boxed()
    }
}
