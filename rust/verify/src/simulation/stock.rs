//! What a simulation comes to.

use super::grid::Grid;

/// Material after the last move.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// Where the nodes are.
    pub grid: Grid,
    /// Height at every node, row by row from the lowest Y, mm.
    pub heights: Vec<f64>,
    /// Height before the first move, mm.
    pub top: f64,
    /// The same at every node, where stock is not level; also of what lies beside it.
    pub before: Option<Vec<f64>>,
}
