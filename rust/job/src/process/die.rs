//! What lies under a sheet that is formed over or into a shape.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A die under the sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Die {
    /// The part is formed over it from outside, from its top outwards and down; the clamp frame goes down with the path.
    Male,
    /// The part is formed into it from inside; the sheet is clamped at its rim.
    Female,
}
