//! Length, time and extent of a program.

use crate::{Dynamics, MoveKind, Program};

/// What a program amounts to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Statistics {
    /// Path length at feed, mm.
    pub feed_length: f64,
    /// Path length at rapid, mm; the path to the first point is not known and not counted.
    pub rapid_length: f64,
    /// Time with dwells, s; see [`Dynamics::times`].
    pub duration: f64,
    /// Lowest Z that any feed move reaches, mm; infinity when there is none.
    pub lowest: f64,
}

impl Statistics {
    /// Measures `program` as a machine runs it.
    #[must_use]
    pub fn of(program: &Program, dynamics: &Dynamics) -> Self {
        let mut sum = Self { lowest: f64::INFINITY, duration: dynamics.times(program).1, ..Self::default() };
        for (start, step) in program.segments() {
            let length = start.map_or(0.0, |s| step.length(s));
            match step.kind {
                MoveKind::Rapid => sum.rapid_length += length,
                MoveKind::Feed => {
                    sum.feed_length += length;
                    sum.lowest = sum.lowest.min(step.bounds(start).0[2]);
                }
            }
        }
        sum
    }
}
