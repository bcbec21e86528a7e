//! Where a program is: a line of its text and the tip's position.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A position of the program.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Place {
    /// Line of the text, from 1; 0 when it was not read from text.
    pub line: u32,
    /// The tool's tip, work coordinates, mm.
    pub position: [f64; 3],
}
