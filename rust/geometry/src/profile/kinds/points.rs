//! A convex curve through measured points.

#[cfg(test)]
use proptest::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{
    error::length,
    profile::{
        chain::Builder,
        kind::{Built, ProfileKind, ProfileReport},
        points,
    },
    GeometryError,
};

/// A convex curve through measured points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Points {
    /// (r, z) from the tip outwards, mm; moved so that the first is the tip.
    #[schemars(extend("x-unit" = "mm"))]
    pub points: Vec<[f64; 2]>,
    /// How far the points may be from the profile, inside or outside, mm.
    #[serde(default = "fit_tolerance")]
    #[schemars(extend("x-unit" = "mm"))]
    pub fit_tolerance: f64,
    /// Radius of a flat that is added at the tip, mm.
    #[serde(default)]
    #[schemars(extend("x-unit" = "mm"))]
    pub tip_flat: f64,
}

impl ProfileKind for Points {
    fn starter() -> &'static str {
        r#"{"kind": "points",
"points": [[0.0, 0.0], [1.0, 0.05], [2.0, 0.21], [3.0, 0.5], [4.0, 1.0], [5.0, 2.0]], "fit_tolerance": 0.01}"#
    }

    fn tip_flat(&self) -> f64 {
        self.tip_flat
    }

    fn build(&self, tip: Builder) -> Result<Built, GeometryError> {
        let fit = points::fit(&self.points, length("fit_tolerance", self.fit_tolerance)?, &tip)?;
        Ok(Built {
            profile: fit.profile,
            report: ProfileReport { notes: fit.notes, fit_deviation: Some(fit.deviation) },
        })
    }

    #[cfg(test)]
    fn any() -> BoxedStrategy<Self> {
        let step = (0.05..2.0_f64, 0.001..1.0_f64, prop_oneof![4 => Just(0), 1 => 1..4_usize]);
        let flat = prop_oneof![Just(0.0), 0.0..3.0_f64];
        (prop::collection::vec(step, 2..30), 0.1..1.4_f64, flat)
            .prop_map(|(steps, last, tip_flat)| {
                let total: f64 = steps.iter().map(|step| 2.0 * step.1).sum();
                let (mut at, mut slope) = ([0.0, 0.0], 0.0);
                let mut points = vec![at];
                for (length, turned, more) in steps {
                    // a step that curves, then one that may go on as a line: two lines would make a corner
                    for count in [1, 1 + more] {
                        slope += turned / total * last;
                        for _ in 0..count {
                            at = [at[0] + length * f64::cos(slope), at[1] + length * f64::sin(slope)];
                            points.push(at);
                        }
                    }
                }
                Self { points, fit_tolerance: 1e-6, tip_flat }
            })
            .boxed()
    }
}

fn fit_tolerance() -> f64 {
    1e-3
}
