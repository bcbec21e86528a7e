//! From the target to the shape that is formed: what changes a part before it is planned.
//!
//! Planning and verification get the same changed part; what was changed, and by how much, is reported with its facts.
//!
//! Derivation: docs/concepts/springback.md.

mod compensation;
mod section;
mod springback;

use styluscam_geometry::DisplacementField;

use crate::{JobDocument, JobError, Part};

pub use compensation::Compensation;
pub use section::{Deviation, MeshPair, SpringbackSection};
pub use springback::check;

/// Whether a job's part is changed before it is planned.
#[must_use]
pub fn is_shaped(job: &JobDocument) -> bool {
    job.part.springback.is_some()
}

/// The part as it is formed: `deviations` are those of `part.springback`, in their order, in the part's frame.
///
/// # Errors
/// Deviations that do not fit the part, a shape that cannot be formed.
pub fn shaped(job: &JobDocument, part: &Part, deviations: Vec<DisplacementField>) -> Result<Part, JobError> {
    match &job.part.springback {
        Some(section) => springback::compensated(job, section, part, deviations),
        None => Ok(part.clone()),
    }
}
