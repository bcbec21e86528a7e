//! How far one level lies below the other.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What sets the distance between levels, or between turns that go down.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Step {
    /// This distance, mm.
    Height(#[schemars(extend("x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 100.0))] f64),
}

impl Step {
    /// The distance in height, mm.
    #[must_use]
    pub fn height(self) -> f64 {
        let Self::Height(height) = self;
        height
    }
}
