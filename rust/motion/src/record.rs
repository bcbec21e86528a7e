//! Plain records that travel with a program: what a header, a reader or a person needs to know.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which point of the tool the program moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ToolReference {
    /// The lowest point, on the axis.
    #[default]
    Tip,
    /// The centre of the tip's sphere.
    Center,
}

/// A tool as the machine knows it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ToolRecord {
    /// The name it has in the job.
    pub name: String,
    /// Its number in the machine's tool table.
    pub number: u32,
    /// The length offset's number (H word); the tool's number unless the job states another.
    pub length_offset: u32,
    /// What it is, in words: `clothoid D10`.
    pub description: String,
    /// Which point the posted coordinates move.
    pub reference: ToolReference,
    /// Height of that point above the tip, mm: 0 for the tip.
    pub reference_height: f64,
    /// Diameter of the base, mm.
    pub diameter: f64,
}

/// The set-up: everything about zero that a person checks before pressing start.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SetupRecord {
    /// The job's title.
    pub title: String,
    /// Work offset: `G54`.
    pub wcs: String,
    /// Where the zero point is, in words.
    pub zero: String,
    /// Lower corner of the part's box in work coordinates, mm.
    pub part_min: [f64; 3],
    /// Upper corner of the part's box in work coordinates, mm.
    pub part_max: [f64; 3],
    /// Height at which rapids may cross the part, mm.
    pub clearance: f64,
    /// Lines for the header, in order: what planning and verification report.
    pub notes: Vec<String>,
}

/// An operation as the program's reader sees it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OperationRecord {
    /// Its id in the job.
    pub id: String,
    /// Its kind: `z-level`.
    pub kind: String,
    /// Index of its tool.
    pub tool: u32,
}
