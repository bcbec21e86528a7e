//! What is found of leaning tools, as it is put together.

use super::report::OperationFlank;
use crate::faults::Fault;
use crate::tally::Worst;

/// What is found of a program's leaning tools.
#[derive(Default)]
pub(crate) struct Judged {
    pub faults: Vec<Fault>,
    pub flanks: Vec<OperationFlank>,
    /// Positions at which the clearance was measured, and points of surfaces.
    pub samples: usize,
    /// Deepest entry into the part, mm.
    pub gouge: Worst,
    /// Most that is left of a surface that is milled, mm.
    pub excess: Worst,
}
