//! From the target to the shape that is formed: what changes a part before it is planned.
//!
//! Planning and verification get the same changed part; what was changed, and by how much, is reported with its facts.
//!
//! Derivations: docs/concepts/springback.md, docs/concepts/addendum.md,
//! docs/concepts/stages.md.

mod addendum;
mod compensation;
mod section;
mod springback;
mod stages;

use styluscam_geometry::DisplacementField;

use crate::{JobDocument, JobError, Part};

pub use addendum::{fits, AddendumEnd, AddendumKind, AddendumSection};
pub use compensation::Compensation;
pub use section::{Deviation, MeshPair, SpringbackSection, Stages};
pub use stages::{angles as stage_angles, staged};

/// Checks what the schema cannot state of what changes a part.
///
/// # Errors
/// Keys that exclude each other.
pub fn check(job: &JobDocument) -> Result<(), JobError> {
    addendum::check(job)?;
    springback::check(job)?;
    stages::check(job)
}

/// Whether a job's part is changed before it is planned.
#[must_use]
pub fn is_shaped(job: &JobDocument) -> bool {
    job.part.springback.is_some() || job.part.addendum.is_some()
}

/// The part as it is formed: `deviations` are those of `part.springback`, in their order, in the part's frame.
///
/// # Errors
/// Deviations that do not fit the part, a shape that cannot be formed.
pub fn shaped(job: &JobDocument, part: &Part, deviations: Vec<DisplacementField>) -> Result<Part, JobError> {
    match (&job.part.springback, &job.part.addendum) {
        (Some(section), _) => springback::compensated(job, section, part, deviations),
        (None, Some(section)) => addendum::extended(job, section, part),
        (None, None) => Ok(part.clone()),
    }
}
