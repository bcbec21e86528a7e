//! What a contour follows: lines of edges, on which side, and on which levels.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::Cutter;
use styluscam_toolpath::contouring::{Beside, PlanLine};

use super::Tabs;
use crate::edge_lines::EdgeLine;

/// On which side of edges a tool is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum EdgeSide {
    /// Outside of edges that close.
    Outside,
    /// Inside of them.
    Inside,
    /// On the left of edges that do not close.
    Left,
    /// On the right of them.
    Right,
    /// On the edges: the tip goes along them.
    On,
}

impl EdgeSide {
    pub fn word(self) -> &'static str {
        match self {
            Self::Outside => "outside",
            Self::Inside => "inside",
            Self::Left => "left",
            Self::Right => "right",
            Self::On => "on",
        }
    }

    /// Of a line that closes counterclockwise, or does not close; none where the tool is on it.
    pub fn beside(self) -> Option<Beside> {
        match self {
            Self::Outside | Self::Right => Some(Beside::Right),
            Self::Inside | Self::Left => Some(Beside::Left),
            Self::On => None,
        }
    }

    pub fn fits(self, closed: bool) -> bool {
        match self {
            Self::Outside | Self::Inside => closed,
            Self::Left | Self::Right => !closed,
            Self::On => true,
        }
    }
}

/// A level on which a line is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Height of the tip, mm.
    pub tip: f64,
    /// Stock that stays on the wall, mm.
    pub left: f64,
}

/// A line with the levels on which it is followed.
pub struct Work {
    pub line: EdgeLine,
    /// From the top down; the finish pass last.
    pub levels: Vec<Level>,
    /// Height at which the operation begins: that of the stock, mm.
    pub begins: f64,
}

impl Work {
    pub fn plan_line(&self) -> PlanLine {
        PlanLine { corners: self.line.corners(), closed: self.line.closed }
    }

    /// The highest point of the upright plane that the tool touches, mm.
    pub fn plane_top(&self) -> f64 {
        self.line.top().max(self.begins)
    }

    /// How far the axis is from the line on a level, mm.
    pub fn distance(&self, cutter: &Cutter, side: EdgeSide, level: Level) -> f64 {
        match side.beside() {
            Some(_) => cutter.at_height((self.plane_top() - level.tip).max(0.0)).0 + level.left,
            None => 0.0,
        }
    }
}

/// How lines are followed.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    /// The side of them.
    pub side: EdgeSide,
    /// Height over length of ramps; none where the tool goes straight down.
    pub slope: Option<f64>,
    /// The tabs that stay.
    pub tabs: Option<Tabs>,
}
