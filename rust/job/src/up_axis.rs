//! Which axis of the model points to the spindle.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::Vector;

/// An axis of the model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum UpAxis {
    /// +X.
    #[serde(rename = "+x")]
    PlusX,
    /// -X.
    #[serde(rename = "-x")]
    MinusX,
    /// +Y.
    #[serde(rename = "+y")]
    PlusY,
    /// -Y.
    #[serde(rename = "-y")]
    MinusY,
    /// +Z.
    #[default]
    #[serde(rename = "+z")]
    PlusZ,
    /// -Z: the model upside down.
    #[serde(rename = "-z")]
    MinusZ,
}

impl UpAxis {
    /// As the job writes it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::PlusX => "+x",
            Self::MinusX => "-x",
            Self::PlusY => "+y",
            Self::MinusY => "-y",
            Self::PlusZ => "+z",
            Self::MinusZ => "-z",
        }
    }

    /// Its unit vector in the model's frame.
    #[must_use]
    pub fn vector(self) -> Vector {
        match self {
            Self::PlusX => Vector::x(),
            Self::MinusX => -Vector::x(),
            Self::PlusY => Vector::y(),
            Self::MinusY => -Vector::y(),
            Self::PlusZ => Vector::z(),
            Self::MinusZ => -Vector::z(),
        }
    }
}
