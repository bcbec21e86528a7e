//! Starter jobs: a commented document for a part that has none yet.

use pyo3::prelude::*;
use styluscam_job::{StarterFace, StarterPart};

use crate::part::Part;

/// A face for a starter job: name, kind, area (mm^2), smallest and largest slope (degrees).
type ListedFace = (String, String, f64, [f64; 2]);

/// A commented job for a part that has none yet, and the sentences that state why it is so.
#[pyfunction]
#[pyo3(signature = (part, file, faces, units=None, edge_gap=0.0))]
pub fn starter(
    py: Python<'_>,
    part: &Part,
    file: &str,
    faces: Vec<ListedFace>,
    units: Option<&str>,
    edge_gap: f64,
) -> (String, Vec<String>) {
    let faces: Vec<StarterFace> =
        faces.into_iter().map(|(name, kind, area, slope_deg)| StarterFace { name, kind, area, slope_deg }).collect();
    let mesh = &part.part.mesh;
    let made = py.detach(|| styluscam_job::starter(&StarterPart { file, units, mesh, faces: &faces, edge_gap }));
    (made.text, made.reasons)
}
