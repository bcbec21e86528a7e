//! Two-point incremental forming: over a die, or into one.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_verify::Support;

use super::{About, Die, ProcessKind};

/// Two-point incremental forming: a sheet over a male die, with a clamp frame that goes down, or into a female one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-takes-sheet" = true))]
pub struct Tpif {
    /// What lies under the sheet.
    #[schemars(extend("x-example" = "\"male\""))]
    pub die: Die,
}

impl Tpif {
    pub(super) const ABOUT: About = About { words: "two-point incremental forming, with a die", for_sheets: true };
}

impl ProcessKind for Tpif {
    fn forms(&self) -> bool {
        true
    }

    fn support(&self) -> Support {
        match self.die {
            Die::Male => Support::DieAndFrame,
            Die::Female => Support::Rim,
        }
    }

    fn die(&self) -> Option<Die> {
        Some(self.die)
    }
}
