//! The words of canned cycles, which stay in force from hole to hole.

/// Heights along the drilling axis, and what is done between them.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CycleWords {
    /// Where the first of the cycles in a row began.
    pub initial: Option<f64>,
    pub bottom: Option<f64>,
    /// R.
    pub retract: Option<f64>,
    /// Q.
    pub peck: Option<f64>,
    /// P, s.
    pub dwell: Option<f64>,
}

impl CycleWords {
    /// Takes over what a block states.
    pub fn take(&mut self, stated: Self) {
        *self = Self {
            initial: stated.initial.or(self.initial),
            bottom: stated.bottom.or(self.bottom),
            retract: stated.retract.or(self.retract),
            peck: stated.peck.or(self.peck),
            dwell: stated.dwell.or(self.dwell),
        };
    }
}

/// Where a hole ends: at the retract plane (G99), or where the cycles began, if that is higher (G98).
pub(crate) fn end_height(low_return: bool, retract: f64, initial: f64) -> f64 {
    if low_return {
        retract
    } else {
        retract.max(initial)
    }
}
