//! Axes that turn the part or the tool.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What an axis turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Carrier {
    /// The part.
    Table,
    /// The tool.
    Head,
}

/// An axis that turns. A positive angle turns what it carries by the right-hand rule: where a control counts a table's angle by the
/// tool's turn as seen from the part, the direction is the opposite one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RotaryAxis {
    /// `A`, `B` or `C`.
    pub letter: char,
    /// What it turns.
    pub carries: Carrier,
    /// About which direction, at angles 0, of any length.
    pub direction: [f64; 3],
    /// A point that it does not move, mm: of tables in work coordinates, of heads from the tool's tip, both at angles 0.
    #[serde(default)]
    pub pivot: [f64; 3],
    /// Lowest and highest angle, deg.
    #[serde(default = "one_turn")]
    pub limits_deg: [f64; 2],
}

fn one_turn() -> [f64; 2] {
    [-360.0, 360.0]
}

/// How the control's own tracking of the tip is switched: coordinates are the tip's in the part while it is on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TipControl {
    /// Template of the block that switches it on: `G43.4 H{{ tool.length_offset }}`.
    pub on: String,
    /// The block that switches it off: `G49`.
    pub off: String,
}

impl TipControl {
    /// The codes that the blocks begin with: on, off.
    pub(crate) fn codes(&self) -> [Option<(u8, i64)>; 2] {
        [&self.on, &self.off].map(|block| block.split_whitespace().next().and_then(crate::block::code))
    }

    /// Whether the block that switches it on names the tool's length offset by this letter too.
    pub(crate) fn names_length(&self, letter: char) -> bool {
        self.on.split_whitespace().skip(1).any(|word| word.starts_with(letter))
    }
}

/// Two axes that turn the part or the tool. A program whose tool leans is posted on a machine with them only.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RotaryRules {
    /// Both axes. Where they carry the same, the first carries the second.
    pub axes: [RotaryAxis; 2],
    /// How the control tracks the tip. Left out, coordinates are where the linear axes stand, and feeds must be in inverse time.
    pub tip_control: Option<TipControl>,
    /// Decimal places of angles.
    #[serde(default = "five")]
    pub angle_decimals: u8,
    /// How far the tip may leave its line between two blocks, mm, where the control does not track it; the tool's axis may lean
    /// aside by what moves a point 50 mm up by as much.
    #[serde(default = "micrometre")]
    pub tip_tolerance: f64,
}

fn five() -> u8 {
    5
}

fn micrometre() -> f64 {
    0.001
}
