//! What an earlier program left of its stock.

use styluscam_geometry::{Frame, Stock, Tool, Vector};
use styluscam_motion::Move;
use styluscam_verify as verify;

/// What an earlier program, as it was read back from its text, cut of its stock; work coordinates.
#[derive(Clone, Debug)]
pub struct Earlier {
    /// The stock that it began with, and what that is in words.
    pub(crate) stock: Stock,
    pub(crate) words: String,
    /// From the frame of the part's file to its work coordinates.
    pub(crate) frame: Frame,
    /// Corners of the part's box, mm.
    pub(crate) part: (Vector, Vector),
    /// How far the part's triangles are off it at most, mm.
    pub(crate) deviation: f64,
    /// Its moves, and those of programs before it: the number of each one's tool is its operation.
    pub(crate) moves: Vec<Move>,
    pub(crate) tools: Vec<Tool>,
    /// The same for the verifier.
    pub(crate) cut: verify::Before,
}

impl Earlier {
    /// With what was cut before it.
    pub(crate) fn after(self, before: &Self) -> Self {
        let first = before.tools.len() as u32;
        let own = self.moves.into_iter().map(|step| Move { operation: step.operation + first, ..step });
        Self {
            moves: before.moves.iter().copied().chain(own).collect(),
            tools: before.tools.iter().cloned().chain(self.tools).collect(),
            cut: before.cut.then(&self.cut),
            ..self
        }
    }
}
