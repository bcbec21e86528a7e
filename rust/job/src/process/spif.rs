//! Single-point incremental forming.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{About, ProcessKind};

/// Single-point incremental forming: a sheet, no die.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(extend("x-takes-sheet" = true))]
pub struct Spif {}

impl Spif {
    pub(super) const ABOUT: About = About { words: "single-point incremental forming", for_sheets: true };
}

impl ProcessKind for Spif {
    fn forms(&self) -> bool {
        true
    }
}
