//! What a job states of the addendum around its part.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What joins the part's edge to the blank, which is clamped around it; cut off after forming.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AddendumSection {
    /// "wall": a constant wall angle from the part's outer edge to the blank's plane. "blended": it leaves the edge by the part's own
    /// slope, and an arc leads from that to the wall's.
    #[serde(default)]
    pub kind: AddendumKind,
    /// Its wall angle, degrees: 0 is level.
    #[schemars(extend("x-example" = "45.0", "x-unit" = "deg", "minimum" = 1.0, "maximum" = 89.0))]
    pub wall_angle_deg: f64,
    /// Radius of the arc between the wall and the blank's plane, mm, and of a blended wall's arc at the part's edge; 0 for none.
    #[serde(default = "corner_radius")]
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.0, "maximum" = 1000.0))]
    pub corner_radius: f64,
    /// Where it ends: "height" in the blank's plane as `height` states it, "opening" as high as it can and still be within the
    /// backing plate's opening and its margin.
    #[serde(default)]
    pub end: AddendumEnd,
    /// How far the blank's plane lies above the highest point of the part's edge (over a male die: below its lowest), mm; as
    /// little as the part and the arcs take when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.0, "maximum" = 1000.0))]
    pub height: Option<f64>,
    /// What is left level of the blank around the wall, for clamping, mm.
    #[serde(default = "flange_width")]
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.1, "maximum" = 1000.0))]
    pub flange_width: f64,
}

/// How the addendum leaves the part's edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AddendumKind {
    /// By a constant angle.
    #[default]
    Wall,
    /// By the part's own slope, which an arc joins to a constant angle.
    Blended,
}

/// Where the addendum ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AddendumEnd {
    /// At a height.
    #[default]
    Height,
    /// At the backing plate's opening.
    Opening,
}

fn corner_radius() -> f64 {
    5.0
}

fn flange_width() -> f64 {
    20.0
}
