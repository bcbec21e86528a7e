//! What programs before one have cut of its stock.

use styluscam_geometry::Tool;
use styluscam_motion::ArcPath;

/// The moves of programs that have cut the stock before one, in its work coordinates.
#[derive(Clone, Debug, Default)]
pub struct Before {
    pub(crate) stretches: Vec<Stretch>,
    /// The tools that its stretches name.
    pub(crate) tools: Vec<Tool>,
}

/// A move or a piece of one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stretch {
    /// The tool's tip where it starts, when it is known, mm.
    pub start: Option<[f64; 3]>,
    /// The tool's tip where it ends, mm.
    pub end: [f64; 3],
    /// How it gets there, when not straight.
    pub bend: Option<ArcPath>,
    /// Index of the tool, when one is known.
    pub tool: Option<usize>,
    pub is_rapid: bool,
}

impl Before {
    /// With what comes after it.
    #[must_use]
    pub fn then(&self, after: &Self) -> Self {
        let first = self.tools.len();
        let later =
            after.stretches.iter().map(|stretch| Stretch { tool: stretch.tool.map(|tool| tool + first), ..*stretch });
        Self {
            stretches: self.stretches.iter().copied().chain(later).collect(),
            tools: self.tools.iter().chain(&after.tools).cloned().collect(),
        }
    }
}
