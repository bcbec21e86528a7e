//! Double-sided incremental forming.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{About, Opposite, ProcessKind, MAIN_CHANNEL};

/// The channel of the tool under the sheet.
const SUPPORT: &str = "support";

/// Double-sided incremental forming: a sheet between two tools. The one below follows the contacts of the one above, on the
/// other face of the sheet, block by block; its machine is in `[machines.support]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(extend("x-takes-sheet" = true))]
pub struct Dsif {
    /// Name of the tool under the sheet, for all operations.
    #[schemars(extend("x-example" = "\"support\""))]
    pub support_tool: String,
    /// What is left between the tools, as a share of the thickness that the sheet has there: below 1 they squeeze it.
    #[schemars(extend("x-unit" = "1", "minimum" = 0.8, "maximum" = 1.0))]
    pub squeeze: f64,
}

impl Default for Dsif {
    /// The tools touch the sheet and do not squeeze it: what thinning beyond the law takes is the user's to measure.
    fn default() -> Self {
        Self { support_tool: SUPPORT.to_owned(), squeeze: 1.0 }
    }
}

impl Dsif {
    pub(super) const ABOUT: About = About { words: "double-sided incremental forming", for_sheets: true };
}

impl ProcessKind for Dsif {
    fn forms(&self) -> bool {
        true
    }

    fn channels(&self) -> &'static [&'static str] {
        &[MAIN_CHANNEL, SUPPORT]
    }

    fn opposite(&self, channel: &str) -> Option<Opposite<'_>> {
        (channel == SUPPORT).then_some(Opposite { tool: &self.support_tool, squeeze: self.squeeze })
    }
}
