//! What an earlier program left of its stock.

use std::sync::Arc;

use pyo3::prelude::*;

/// What an earlier program cut of its stock, after all that was cut of it before; `Scene.left_by` makes it.
#[pyclass(frozen, module = "styluscam._engine")]
pub struct Earlier {
    pub(crate) earlier: Arc<styluscam_job::Earlier>,
}
