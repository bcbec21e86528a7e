//! Milling.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{About, ProcessKind};

/// Milling: no sheet.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Milling {
    /// A table of cutting data of your own (TOML), which goes before the shipped one; relative to the job file.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-advanced" = true, "x-example" = "\"shop.toml\""))]
    pub cutting_data: Option<String>,
}

impl Milling {
    pub(super) const ABOUT: About = About { words: "", for_sheets: false };
}

impl ProcessKind for Milling {
    fn forms(&self) -> bool {
        false
    }

    fn cutting_data(&self) -> Option<&str> {
        self.cutting_data.as_deref()
    }
}
