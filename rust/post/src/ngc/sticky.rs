//! The words of drilling cycles that hold from block to block.

/// What cycles keep from block to block.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sticky {
    /// Where the first of the cycles in a row began, along the drilling axis.
    pub(super) begin: Option<f64>,
    /// As written, in the unit in force.
    pub(super) bottom: Option<f64>,
    pub(super) retract: Option<f64>,
    pub(super) peck: Option<f64>,
    /// s.
    pub(super) wait: Option<f64>,
}
