//! Documents as JSON text.

use pyo3::PyResult;

use crate::errors::raise;

/// A document as JSON.
pub fn json<T: serde::Serialize>(value: &T) -> PyResult<String> {
    serde_json::to_string(value).map_err(|e| raise("StylusError", &e.to_string(), "internal", "", ""))
}
