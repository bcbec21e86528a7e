//! What holds the sheet, as a job states it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Clamp frame and backing plate: nothing of the tool comes near the one, nor tool and sheet near the other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FixtureSection {
    /// Middle of the openings in plan, work coordinates, mm; the middle of the part's box when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm", "minimum" = -100000.0, "maximum" = 100000.0))]
    pub center: Option<[f64; 2]>,
    /// What is kept clear of clamp and backing, mm.
    #[serde(default = "margin")]
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.0, "maximum" = 100.0))]
    pub margin: f64,
    /// The frame on the sheet.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-example" = "{ opening = [200.0, 150.0], height = 8.0 }"))]
    pub clamp: Option<ClampSection>,
    /// The plate under the sheet.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-example" = "{ opening = 160.0 }"))]
    pub backing: Option<BackingSection>,
}

/// A frame that presses the sheet down around an opening.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClampSection {
    /// Where the sheet is free.
    #[schemars(extend("x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 10000.0))]
    pub opening: Opening,
    /// Height above the sheet, mm.
    #[schemars(extend("x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 500.0))]
    pub height: f64,
    /// Whether it goes down with the path, as over a male die; else it stays.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub follows: bool,
}

/// A plate on which the sheet lies around an opening.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BackingSection {
    /// Where the sheet may go down.
    #[schemars(extend("x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 10000.0))]
    pub opening: Opening,
}

/// An opening: `[width, height]` along X and Y, or a diameter; mm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected a diameter or [width, height], mm")]
pub enum Opening {
    /// A circle's diameter.
    Diameter(f64),
    /// A rectangle's sides along X and Y.
    Sides([f64; 2]),
}

fn margin() -> f64 {
    1.0
}

impl Opening {
    /// Its largest measures, mm.
    #[must_use]
    pub fn sides(self) -> [f64; 2] {
        match self {
            Self::Diameter(diameter) => [diameter, diameter],
            Self::Sides(sides) => sides,
        }
    }
}
