//! Why a pocket could not be planned.

use styluscam_motion::Cancelled;
use thiserror::Error;

use super::request::EntryForm;

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
    /// A profile without a length.
    #[error("profile has no length: {count} points; give two or more that differ")]
    Line {
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
    /// A profile of which no strip lies on one side.
    #[error("beside the profile lies no single strip of {width} mm: it crosses itself; mend it, or state closed where its ends meet")]
    Profile {
        /// The strip's width as given, mm.
        width: f64,
    },
    /// The tool fits nowhere: it is too large, or the islands leave no room.
    #[error(
        "the tool of radius {} mm, with corners of {} mm more, fits nowhere between the walls and islands; take a smaller tool",
        written(*radius), written(*smoothing)
    )]
    TooSmall {
        /// The tool's radius, mm.
        radius: f64,
        /// The smallest radius of the centre's path, mm.
        smoothing: f64,
    },
    /// No entry into the material fits.
    #[error(
        "no {} fits near X{:.3} Y{:.3}, where {left:.1} mm^2 are left to be cleared; take a smaller tool",
        form.words(), at[0], at[1]
    )]
    NoEntry {
        /// Where there is most room, mm.
        at: [f64; 2],
        /// What is left to be cleared, mm^2.
        left: f64,
        /// What was asked for.
        form: EntryForm,
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
            Self::Line { .. } => "profile",
            Self::Edge { .. } => "edge",
            Self::Profile { .. } => "profile",
            Self::TooSmall { .. } => "tool-too-large",
            Self::NoEntry { .. } => "no-entry",
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
            Self::Profile { .. } | Self::Line { .. } => "profile",
            Self::TooSmall { .. } => "tool_radius",
            Self::NoEntry { .. } => "entry",
            Self::Empty => "stock",
            Self::Cancelled => "",
        }
    }
}

/// A length to a nanometre: what its digits say and arithmetic does not.
fn written(length: f64) -> f64 {
    (length * 1e6).round() / 1e6
}
