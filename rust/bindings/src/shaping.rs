//! The part as a job forms it.

use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use styluscam_geometry::DisplacementField;

use crate::{arrays, errors, job::Job, part::Part};

/// Points and displacements, (N, 3) each.
type Samples<'py> = (PyReadonlyArray2<'py, f64>, PyReadonlyArray2<'py, f64>);

fn field(index: usize, (points, displacements): &Samples<'_>) -> PyResult<DisplacementField> {
    let (points, displacements) =
        (arrays::vectors(points, "points")?, arrays::vectors(displacements, "displacements")?);
    let field = DisplacementField::new(&points, &displacements);
    let path = format!("part.springback.deviations[{index}]");
    field.map_err(|e| errors::raise("GeometryError", &format!("{path}: {e}"), e.code(), &path, ""))
}

/// The part as a job forms it; `deviations` are the points (N, 3) and displacements (N, 3), mm, of those that it names.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)] // PyO3 hands arrays by value
pub fn shaped(py: Python<'_>, job: &Job, part: &Part, deviations: Vec<Samples<'_>>) -> PyResult<Part> {
    let fields = deviations.iter().enumerate().map(|(index, samples)| field(index, samples));
    let fields = fields.collect::<PyResult<Vec<_>>>()?;
    let shaped = py.detach(|| styluscam_job::shaped(&job.document, &part.part, fields));
    Ok(Part::of(shaped.map_err(errors::of_job)?))
}
