//! On which side of the sheet, or the part, the chuck is that holds the tool.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::{Frame, Vector};

/// On which side of the sheet or the part the chuck is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Chuck {
    /// Above: the machine's Z points up, from the work to the spindle.
    #[default]
    Above,
    /// Below: the tool comes from below. The machine's Z points down, from the work to the spindle, X is as above, and Y the other
    /// way.
    Below,
}

impl Chuck {
    /// The turn from above, where `up` points up, to the machine's axes.
    pub(crate) fn turn(self) -> Frame {
        match self {
            Self::Above => Frame::identity(),
            Self::Below => turned_over(),
        }
    }
}

/// The turn to the machine of a tool from the other side: half about X.
pub(crate) fn turned_over() -> Frame {
    Frame::turning_up(-Vector::z(), 0.0)
}
