//! Why a pocket could not be planned.

use styluscam_motion::Cancelled;
use thiserror::Error;

/// No path was planned.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PocketError {
    /// A number is missing or out of its range. Correct the argument named.
    #[error("{key} = {value}: expected {allowed}")]
    Number {
        /// The argument, with the number of the outline and the point.
        key: String,
        /// Its value.
        value: f64,
        /// What is allowed, in words.
        allowed: &'static str,
    },
    /// An outline that holds no area: too few points, or all of them on a line.
    #[error("{key} holds no area: {count} points; give three or more, or two with a bulge")]
    Outline {
        /// The argument and the number of the outline.
        key: String,
        /// Points that it has.
        count: usize,
    },
    /// An edge that the boundary does not have.
    #[error("open_edges: {edge} is not an edge of the boundary, which has {count}")]
    Edge {
        /// The number as given.
        edge: usize,
        /// How many there are.
        count: usize,
    },
    /// The tool fits nowhere: it is too large, or the islands leave no room.
    #[error(
        "the tool of radius {radius} mm, with corners of {smoothing} mm more, fits nowhere between the walls and islands; take a \
         smaller tool"
    )]
    TooSmall {
        /// The tool's radius, mm.
        radius: f64,
        /// The smallest radius of the centre's path, mm.
        smoothing: f64,
    },
    /// Nothing of the stock lies within the pocket.
    #[error("nothing of the stock lies where the tool reaches in the pocket: nothing is to be cut")]
    Empty,
    /// Stopped from outside.
    #[error("cancelled")]
    Cancelled,
}

impl From<Cancelled> for PocketError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

impl PocketError {
    /// A stable name for scripts.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Self::Number { .. } => "out-of-range",
            Self::Outline { .. } => "outline",
            Self::Edge { .. } => "edge",
            Self::TooSmall { .. } => "tool-too-large",
            Self::Empty => "empty-path",
            Self::Cancelled => "cancelled",
        }
    }

    /// The argument that is at fault.
    #[must_use]
    pub fn key(&self) -> &str {
        match self {
            Self::Number { key, .. } | Self::Outline { key, .. } => key,
            Self::Edge { .. } => "open_edges",
            Self::TooSmall { .. } => "tool_radius",
            Self::Empty => "stock",
            Self::Cancelled => "",
        }
    }
}
