//! What an operation is planned with.

use styluscam_geometry::Tool;
use styluscam_motion::Watch;
use styluscam_post::Machine;
use styluscam_toolpath::PlanError;

use crate::heights::TipHeights;
use crate::{faces, JobDocument, JobError, OperationSection, Scene};

/// The job, the part, the machine and the tool of one operation.
#[derive(Clone, Copy)]
pub struct Context<'a> {
    /// The whole job.
    pub job: &'a JobDocument,
    /// The part as it lies on the machine.
    pub scene: &'a Scene,
    /// The machine: its resolution is part of the tolerance.
    pub machine: &'a Machine,
    /// The operation.
    pub section: &'a OperationSection,
    /// Its number in the job, from 0.
    pub index: usize,
    /// Its tool.
    pub tool: &'a Tool,
    /// Progress and cancelling.
    pub watch: &'a Watch,
}

impl Context<'_> {
    /// The operation's path in the document.
    #[must_use]
    pub fn path(&self) -> String {
        format!("operations[{}]", self.index)
    }

    /// The faces that it is for, in the order of their numbers.
    ///
    /// # Errors
    /// A name that no face has, a face that faces down.
    pub fn faces(&self) -> Result<Vec<u32>, JobError> {
        faces::of_operation(self.job, self.scene, self.section, self.index)
    }

    /// Between which heights its tip stays.
    pub(crate) fn heights(&self) -> TipHeights {
        TipHeights::of(self.job, self.scene, self.section)
    }

    /// A planning error as one of this operation.
    pub(crate) fn error(&self, error: PlanError) -> JobError {
        JobError::planning(self.path())(error)
    }

    /// Distance between nodes or points, mm, that finds every feature asked for.
    #[must_use]
    pub fn node_spacing(&self) -> f64 {
        self.section.common.smallest_feature / std::f64::consts::SQRT_2
    }
}
