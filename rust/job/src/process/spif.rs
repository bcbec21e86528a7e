//! Single-point incremental forming.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{About, ProcessKind};

/// Single-point incremental forming: a sheet, no die.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(extend("x-takes-sheet" = true))]
pub struct Spif {
    /// What the sheet is made of, by the name of a shipped material: it sets the steepest wall that the sheet withstands.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
}

impl Spif {
    pub(super) const ABOUT: About = About { words: "single-point incremental forming", for_sheets: true };
}

impl ProcessKind for Spif {
    fn forms(&self) -> bool {
        true
    }

    fn material(&self) -> Option<&str> {
        self.material.as_deref()
    }
}
