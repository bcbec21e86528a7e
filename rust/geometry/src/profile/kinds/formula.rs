//! A curve by formula.

#[cfg(test)]
use proptest::prelude::*;

#[cfg(test)]
use crate::profile::numbers::{numbers, Numbers};
use crate::{
    profile::{
        chain::Builder,
        curve::Curve,
        formula::{self, TracedPart},
        kind::{Built, ProfileKind, ProfileReport},
        parts::beyond_flat,
    },
    GeometryError,
};

pub use crate::profile::formula::FormulaDocument as Formula;

impl ProfileKind for Formula {
    fn starter() -> &'static str {
        r#"{"kind": "formula", "r": "a * sin(t)", "z": "b * (1 - cos(t))",
"t": [0.0, 1.5707963267948966], "parameters": {"a": 6.0, "b": 4.0}}"#
    }

    fn tip_flat(&self) -> f64 {
        self.tip_flat
    }

    fn diameter(&self) -> Option<f64> {
        self.diameter
    }

    fn build(&self, mut tip: Builder) -> Result<Built, GeometryError> {
        let mut beyond = self.clone();
        if let Some(diameter) = self.diameter {
            beyond.diameter = Some(2.0 * beyond_flat(diameter, self.tip_flat)?);
        }
        let traced = formula::trace(&beyond)?;
        for part in traced.parts {
            match part {
                TracedPart::Curve { curve, from, to } => tip.curve(Curve::Fitted(curve.into()), from, to),
                TracedPart::Straight { slope, from, to } => {
                    tip.kink(slope);
                    tip.straight(libm::hypot(to.0 - from.0, to.1 - from.1));
                }
            }
        }
        Ok(Built { profile: tip.finish(), report: ProfileReport { notes: traced.notes, fit_deviation: None } })
    }

    /// Of a formula that is another kind's curve.
    #[cfg(test)]
    fn any() -> BoxedStrategy<Self> {
        (0..3_u8, 0.2..0.95_f64, numbers())
            .prop_map(|(form, a, Numbers { diameter, tip_flat, .. })| {
                let size = 0.5 * diameter;
                let keys = match form {
                    0 => serde_json::json!({"z": format!("r^2 / {}", 4.0 * a * size), "diameter": diameter}),
                    1 => serde_json::json!({
                        "r": format!("{size} * sin(t)"), "z": format!("{} * cos(t)", a * size), "t": [0.0, 1.5]
                    }),
                    _ => serde_json::json!({
                        "implicit": format!("(r/{size})^2 + (z/{0} - 1)^2 - 1", a * size), "start": [size, a * size]
                    }),
                };
                Self { tip_flat, ..serde_json::from_value(keys).unwrap() }
            })
            .boxed()
    }
}
