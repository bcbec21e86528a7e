//! Which stock is cleared.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
