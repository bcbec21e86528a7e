//! What can be wrong with a job, in one shape for every front end.

use styluscam_geometry::GeometryError;
use styluscam_motion::Cancelled;
use styluscam_post::{MachineError, PostError, ReadError};
use styluscam_toolpath::PlanError;
use thiserror::Error;

/// Everything that stops a job. `code` is stable, `place` a path in the document or a line of a text, `hint` what to do.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum JobError {
    /// A key of the document is unknown, missing, of the wrong type, out of range, or at odds with another.
    #[error("{message}")]
    Document {
        /// What is wrong, with the value and what is allowed.
        message: String,
        /// Path of the key: `operations[0].step.height`.
        place: String,
        /// What to do.
        hint: String,
        /// Stable name.
        code: &'static str,
    },
    /// The part, a tool or the sheet does not make a shape.
    #[error("{error}")]
    Geometry {
        /// What.
        error: GeometryError,
        /// Path in the document.
        place: String,
    },
    /// Planning failed.
    #[error("{error}")]
    Plan {
        /// Why.
        error: PlanError,
        /// The operation: `operations[0]`.
        place: String,
    },
    /// The machine file is wrong or does not exist.
    #[error("{0}")]
    Machine(#[from] MachineError),
    /// The program does not fit the machine.
    #[error("{0}")]
    Post(#[from] PostError),
    /// The text is not what the machine understands.
    #[error("{0}")]
    Read(#[from] ReadError),
    /// Stopped from outside.
    #[error("cancelled")]
    Cancelled,
}

impl JobError {
    pub(crate) fn document(
        code: &'static str,
        place: impl Into<String>,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) -> Self {
        Self::Document { message: message.into(), place: place.into(), hint: hint.into(), code }
    }

    pub(crate) fn geometry(place: impl Into<String>) -> impl FnOnce(GeometryError) -> Self {
        let place = place.into();
        move |error| Self::Geometry { error, place }
    }

    pub(crate) fn planning(place: impl Into<String>) -> impl FnOnce(PlanError) -> Self {
        let place = place.into();
        move |error| match error {
            PlanError::Cancelled => Self::Cancelled,
            error => Self::Plan { error, place },
        }
    }

    /// The class of the error: the name of the Python exception that stands for it.
    #[must_use]
    pub fn class(&self) -> &'static str {
        match self {
            Self::Document { .. } => "JobError",
            Self::Geometry { place, .. } if place.starts_with("tools") => "ToolError",
            Self::Geometry { .. } => "GeometryError",
            Self::Plan { .. } => "PlanError",
            Self::Machine(_) | Self::Post(_) => "MachineError",
            Self::Read(_) => "VerifyError",
            Self::Cancelled => "Cancelled",
        }
    }

    /// A stable name for scripts.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Self::Document { code, .. } => code,
            Self::Geometry { error, .. } => error.code(),
            Self::Plan { error, .. } => error.code(),
            Self::Machine(error) => error.code(),
            Self::Post(error) => error.code(),
            Self::Read(error) => error.code(),
            Self::Cancelled => "cancelled",
        }
    }

    /// Where: a path in the document, or a line.
    #[must_use]
    pub fn place(&self) -> String {
        match self {
            Self::Document { place, .. } | Self::Geometry { place, .. } | Self::Plan { place, .. } => place.clone(),
            Self::Machine(error) => error.place(),
            Self::Post(error) => error.place(),
            Self::Read(error) => error.place(),
            Self::Cancelled => String::new(),
        }
    }

    /// What to do.
    #[must_use]
    pub fn hint(&self) -> String {
        match self {
            Self::Document { hint, .. } => hint.clone(),
            Self::Machine(error) => error.hint(),
            Self::Post(error) => error.hint(),
            Self::Read(error) => error.hint(),
            Self::Geometry { .. } | Self::Plan { .. } | Self::Cancelled => String::new(),
        }
    }
}

impl From<Cancelled> for JobError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}
