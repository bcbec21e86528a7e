//! What can be wrong with a job, in one shape for every front end.

use styluscam_geometry::GeometryError;
use styluscam_motion::Cancelled;
use styluscam_post::{MachineError, PostError, ReadError};
use styluscam_toolpath::PlanError;
use thiserror::Error;

/// Everything that stops a job. `code` is stable, `location` a path in the document or a line of a text, `hint` what to do.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum JobError {
    /// A key of the document is unknown, missing, of the wrong type, out of range, or at odds with another.
    #[error("{message}")]
    Document {
        /// What is wrong, with the value and what is allowed.
        message: String,
        /// Path of the key: `operations[0].step.height`.
        location: String,
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
        location: String,
    },
    /// Planning failed.
    #[error("{error}")]
    Plan {
        /// Why.
        error: PlanError,
        /// The operation: `operations[0]`.
        location: String,
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
        location: impl Into<String>,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) -> Self {
        Self::Document { message: message.into(), location: location.into(), hint: hint.into(), code }
    }

    /// The same where a document has it under another path.
    pub(crate) fn at(self, location: &str) -> Self {
        match self {
            Self::Document { message, hint, code, .. } => Self::document(code, location, message, hint),
            other => other,
        }
    }

    pub(crate) fn geometry(location: impl Into<String>) -> impl FnOnce(GeometryError) -> Self {
        let location = location.into();
        move |error| Self::Geometry { error, location }
    }

    pub(crate) fn planning(location: impl Into<String>) -> impl FnOnce(PlanError) -> Self {
        let location = location.into();
        move |error| match error {
            PlanError::Cancelled => Self::Cancelled,
            error => Self::Plan { error, location },
        }
    }

    /// The class of the error: the name of the Python exception that it becomes.
    #[must_use]
    pub fn class(&self) -> &'static str {
        match self {
            Self::Document { .. } => "JobError",
            Self::Geometry { location, .. } if location.starts_with("tools") => "ToolError",
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
    pub fn location(&self) -> String {
        match self {
            Self::Document { location, .. } | Self::Geometry { location, .. } | Self::Plan { location, .. } => {
                location.clone()
            }
            Self::Machine(error) => error.location(),
            Self::Post(error) => error.location(),
            Self::Read(error) => error.location(),
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
