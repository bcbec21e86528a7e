//! What is known of a flank-milled surface, as data.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::place::Place;

/// What an operation leaves of the ruled surfaces that it mills with the side of the tool.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OperationFlank {
    /// The operation's id.
    pub operation: String,
    /// Its surfaces.
    pub faces: Vec<FlankFaceError>,
    /// How its tool's axis turns along its passes.
    pub turning: AxisTurning,
}

/// What the moving tool leaves of a ruled surface, along its normals. Lengths mm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FlankFaceError {
    /// As a person names it.
    pub name: String,
    /// How deep the tool enters it at the worst; 0 when it does not.
    pub over: f64,
    /// Where the tool is then.
    pub over_at: Option<Place>,
    /// How much it leaves at the worst, beyond the stock that is to stay.
    pub under: f64,
    /// Where the tool is then.
    pub under_at: Option<Place>,
    /// Share of the surface over which the tool does not come at all, 0 to 1.
    pub missed: f64,
    /// What is left at evenly spaced shares of the rails, one list of shares of the rulings each: below 0 what is cut too deep, infinite
    /// where the tool does not come; too much for a document.
    #[serde(skip)]
    pub left: Vec<Vec<f64>>,
    /// The points there, work coordinates.
    #[serde(skip)]
    pub points: Vec<Vec<[f64; 3]>>,
}

/// How a tool's axis turns along its passes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct AxisTurning {
    /// At most, deg/s.
    pub speed_max: f64,
    /// At most, deg/s^2.
    pub acceleration_max: f64,
    /// Turn for each mm at the worst beside the mean.
    pub unevenness: f64,
}
