//! The engine's errors as the exceptions of `styluscam.errors`.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use styluscam_geometry::GeometryError;
use styluscam_job::JobError;
use styluscam_motion::Cancelled;
use styluscam_post::{TraceError, TraceFault};

/// The exception of class `class` with its code, location and hint.
pub fn raise(class: &str, message: &str, code: &str, location: &str, hint: &str) -> PyErr {
    Python::attach(|py| match build(py, class, message, code, location, hint) {
        Ok(error) => error,
        Err(failure) => failure, // the package is broken: that is the thing to show
    })
}

fn build(py: Python<'_>, class: &str, message: &str, code: &str, location: &str, hint: &str) -> PyResult<PyErr> {
    let keywords = PyDict::new(py);
    keywords.set_item("code", code)?;
    keywords.set_item("where", location)?;
    keywords.set_item("hint", hint)?;
    let exception = py.import("styluscam.errors")?.getattr(class)?.call((message,), Some(&keywords))?;
    Ok(PyErr::from_value(exception))
}

/// A job's error, or one that it may hold.
pub fn of_job<E: Into<JobError>>(error: E) -> PyErr {
    let error = error.into();
    raise(error.class(), &error.to_string(), error.code(), &error.location(), &error.hint())
}

/// What keeps a program from being traced.
pub fn of_trace(error: &TraceError) -> PyErr {
    if error.fault == TraceFault::Cancelled {
        return cancelled(Cancelled);
    }
    raise("VerifyError", &error.to_string(), error.code(), &error.location(), &error.hint())
}

/// A shape's error.
pub fn of_geometry(error: &GeometryError) -> PyErr {
    raise("GeometryError", &error.to_string(), error.code(), "", "")
}

/// A tool's error.
pub fn of_tool(error: &GeometryError) -> PyErr {
    raise("ToolError", &error.to_string(), error.code(), "", "")
}

/// The call was cancelled.
pub fn cancelled(_: Cancelled) -> PyErr {
    raise("Cancelled", "cancelled", "cancelled", "", "")
}
