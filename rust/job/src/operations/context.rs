//! What an operation is planned with.

use styluscam_geometry::Tool;
use styluscam_motion::Watch;
use styluscam_post::Machine;
use styluscam_toolpath::PlanError;

use super::before::Before;
use crate::heights::TipHeights;
use crate::region::OperationRegion;
use crate::{JobError, OperationKeys, Scene};

/// The part, the machine, the tool and the selection of one operation: the job, resolved.
pub struct Context<'a> {
    /// The part as it lies on the machine.
    pub scene: &'a Scene,
    /// The machine: its resolution is part of the tolerance.
    pub machine: &'a Machine,
    /// The keys that every kind takes.
    pub common: &'a OperationKeys,
    /// The operation's path in the document: "operations[2]".
    pub path: String,
    /// Its number in its program, from 0.
    pub operation: u32,
    /// Its tool.
    pub tool: &'a Tool,
    /// Height of the point that posted coordinates are for above the tip, mm.
    pub reference_height: f64,
    /// The faces that it is for, in the order of their numbers.
    pub faces: Vec<u32>,
    /// Whether they are named, and not selected by a rule.
    pub are_faces_named: bool,
    /// Where its passes may run beyond that.
    pub(crate) region: OperationRegion,
    /// Between which heights its tip stays.
    pub(crate) heights: TipHeights,
    /// What the operations before it do.
    pub(crate) before: Before<'a>,
    /// Progress and cancelling.
    pub watch: &'a Watch,
}

impl Context<'_> {
    /// A planning error as one of this operation.
    pub(crate) fn error(&self, error: PlanError) -> JobError {
        JobError::planning(self.path.clone())(error)
    }

    /// Distance between nodes or points, mm, that finds every feature asked for.
    #[must_use]
    pub fn node_spacing(&self) -> f64 {
        self.common.smallest_feature / std::f64::consts::SQRT_2
    }
}
