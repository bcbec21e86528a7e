//! Which stock is cleared.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Largest engagement angle where a job states none, and of jobs that are proposed, deg: a quarter of the tool's diameter as stepover.
pub(crate) const ENGAGEMENT_DEG: f64 = 60.0;

/// Which stock is cleared on a level.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Clears {
    /// That in areas over the selected faces: a pocket.
    #[default]
    Faces,
    /// All that the tool reaches, around the part too: roughing.
    Stock,
}

impl Clears {
    pub(super) fn is_all(self) -> bool {
        self == Self::Stock
    }
}
