//! From the part that is wanted to the shape that is formed: what changes a part before it is planned.
//!
//! Planning and verification get the same changed part; what was changed, and by how much, is reported with its facts.

mod springback;

use rayon::prelude::*;
use styluscam_geometry::{DisplacementField, Mesh, Vector};

use crate::operations::Fact;
use crate::{JobDocument, JobError, Part};

pub use springback::{check, Deviation, SpringbackSection};

/// What was done to a part.
#[derive(Clone, Debug)]
pub struct Shaped {
    /// The part as it is wanted, with the triangles of the changed one.
    pub(crate) target: Mesh,
    /// What was changed.
    pub facts: Vec<Fact>,
    /// How far within triangles the linear map differs from the one by which points are taken back, mm.
    pub linear: f64,
    compensation: springback::Compensation,
}

impl Part {
    /// The part as it is wanted, which decides what its faces are for and where its highest point lies.
    #[must_use]
    pub(crate) fn wanted(&self) -> &Mesh {
        self.shaped.as_ref().map_or(&self.mesh, |shaped| &shaped.target)
    }

    /// What was changed.
    #[must_use]
    pub fn changes(&self) -> &[Fact] {
        self.shaped.as_ref().map_or(&[], |shaped| &shaped.facts)
    }

    /// Where points of the changed part lie on the one that is wanted, mm; none where that is not unique.
    #[must_use]
    pub fn wanted_points(&self, points: &[Vector]) -> Vec<Option<Vector>> {
        let wanted =
            |point: &Vector| self.shaped.as_ref().map_or(Some(*point), |shaped| shaped.compensation.undone(*point));
        points.par_iter().map(wanted).collect()
    }
}

/// Whether a job's part is changed before it is planned.
#[must_use]
pub fn is_shaped(job: &JobDocument) -> bool {
    job.part.springback.is_some()
}

/// The part as it is formed: `deviations` are those of `part.springback`, in their order, in the part's frame.
///
/// # Errors
/// Deviations that do not fit the part, a shape that cannot be formed.
pub fn shaped(job: &JobDocument, part: Part, deviations: Vec<DisplacementField>) -> Result<Part, JobError> {
    match &job.part.springback {
        Some(section) => springback::compensated(job, section, part, deviations),
        None => Ok(part),
    }
}
