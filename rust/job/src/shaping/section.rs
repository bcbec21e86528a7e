//! What a job states of its part's springback, and of its stages.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Units;

/// What formed parts were measured, or simulated, to deviate by; the part is formed the other way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpringbackSection {
    /// One entry for each trial, in their order; each trial was formed with the entries before it compensated. A table
    /// ("trial-1.csv": x, y, z, dx, dy, dz at points of this part, d being measured minus target), or two meshes with the same
    /// triangles: { target = "cup.stl", measured = "scan.stl" }. In the frame of the part's file.
    pub deviations: Vec<Deviation>,
    /// Share of the deviations that is compensated, above 0 to 1.
    #[serde(default = "whole")]
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0.0, "maximum" = 1.0))]
    pub factor: f64,
    /// Unit of the tables, and of meshes whose files do not state one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub units: Option<Units>,
    /// Farthest that a position of the selected faces may lie from the nearest measured point, mm.
    #[serde(default = "max_gap")]
    #[schemars(extend("x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 1000.0))]
    pub max_gap: f64,
}

/// Where a trial's deviation is read from; paths are relative to the job file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected a file's name, or { target = \"...\", measured = \"...\" }")]
pub enum Deviation {
    /// A table of points and deviations.
    Table(String),
    /// Two meshes with the same triangles.
    Meshes(MeshPair),
}

/// The target, and the part as it was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshPair {
    /// STL, OBJ, PLY or 3MF: the target.
    pub target: String,
    /// The same triangles as they were measured.
    pub measured: String,
}

fn whole() -> f64 {
    1.0
}

fn max_gap() -> f64 {
    5.0
}

/// The intermediate stages, by their number or by their wall angles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected a number of stages, or their wall angles like [50.0, 65.0], degrees")]
pub enum Stages {
    /// So many, spread evenly from what the sheet withstands to the part's steepest wall.
    Count(#[schemars(extend("x-unit" = "1"))] f64),
    /// Their wall angles, degrees, rising.
    Angles(#[schemars(extend("x-unit" = "deg"))] Vec<f64>),
}

impl Stages {
    /// How many they are.
    #[must_use]
    pub fn count(&self) -> usize {
        match self {
            Self::Count(count) => *count as usize,
            Self::Angles(angles) => angles.len(),
        }
    }
}
