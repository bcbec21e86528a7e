//! Starter jobs: a commented document for a part that has none yet.

use pyo3::prelude::*;
use styluscam_job::{StarterFace, StarterPart};

use crate::{cutting::table_of, errors::of_job, part::Part};

/// A face for a starter job: name, kind, area (mm^2), smallest and largest slope (degrees).
type ListedFace = (String, String, f64, [f64; 2]);

/// An operation of a starter job and the sentences that state why it is there.
type Reasoned = (String, Vec<String>);

/// A commented job for a part that has none yet, the sentences that state why it is so, and those on each operation by its name. `cutting_data` is a shop's own table: the file
/// as the job should name it, and its text.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // Python's keywords
#[pyo3(signature = (part, file, faces, units=None, edge_gap=0.0, *, material=None, cutting_data=None))]
pub fn starter(
    py: Python<'_>,
    part: &Part,
    file: &str,
    faces: Vec<ListedFace>,
    units: Option<&str>,
    edge_gap: f64,
    material: Option<&str>,
    cutting_data: Option<(String, String)>,
) -> PyResult<(String, Vec<String>, Vec<Reasoned>)> {
    let faces: Vec<StarterFace> =
        faces.into_iter().map(|(name, kind, area, slope_deg)| StarterFace { name, kind, area, slope_deg }).collect();
    let mesh = &part.part.mesh;
    let (name, text) = cutting_data.unzip();
    let table = table_of(text.as_deref())?;
    let cutting_data = name.as_deref();
    let part = StarterPart { file, units, mesh, faces: &faces, edge_gap, material, table: &table, cutting_data };
    let made = py.detach(|| styluscam_job::starter(&part)).map_err(of_job)?;
    let operations = made.operations.into_iter().map(|operation| (operation.id, operation.reasons)).collect();
    Ok((made.text, made.reasons, operations))
}
