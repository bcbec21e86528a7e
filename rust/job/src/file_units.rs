//! The units of files that do not state one.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Units of a mesh file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Units {
    /// Millimetres.
    Mm,
    /// Centimetres.
    Cm,
    /// Metres.
    M,
    /// Inches.
    #[serde(alias = "inch")]
    In,
    /// Feet.
    Ft,
    /// Micrometres.
    Um,
}
