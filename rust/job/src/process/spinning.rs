//! Shear spinning: a sheet over a mandrel that turns.
//!
//! Each ring of the disc keeps its radius and is shifted along the axis, so that the thickness in that direction stays: t = t0 sin(a)
//! across a wall at the angle a to the axis (B. Avitzur, C. T. Yang, "Analysis of Power Spinning of Cones", Journal of Engineering for
//! Industry 82, 1960). Derived in docs/concepts/forming-processes.md.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_verify::Support;

use super::{About, ProcessKind};

/// Shear spinning: a disc of sheet and a mandrel of the part's shape turn about Z, and the tool goes along the part's meridian, from
/// the centre outwards, once. X is the distance from the axis, Y stays 0. Parts that are surfaces of revolution about Z only.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(extend("x-takes-sheet" = true))]
pub struct Spinning {}

impl Spinning {
    pub(super) const ABOUT: About = About { words: "shear spinning over a mandrel", for_sheets: true };
}

impl ProcessKind for Spinning {
    fn forms(&self) -> bool {
        true
    }

    fn turns_part(&self) -> bool {
        true
    }

    fn support(&self) -> Support {
        Support::Mandrel
    }
}
