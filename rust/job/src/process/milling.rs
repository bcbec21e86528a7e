//! Milling.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{About, ProcessKind};

/// Milling: no sheet.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Milling {}

impl Milling {
    pub(super) const ABOUT: About = About { words: "", for_sheets: false };
}

impl ProcessKind for Milling {
    fn forms(&self) -> bool {
        false
    }
}
