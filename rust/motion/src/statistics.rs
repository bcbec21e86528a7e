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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Arc, Event, EventKind, Move, Plane, SetupRecord};

    #[test]
    fn lengths_by_kind_and_the_lowest_point_of_an_arc() {
        // a half circle of radius 2 about X, in the plane of X and Z: it hangs 2 mm below its ends
        let below = Arc { centre: [3.0, 0.0, -1.0], plane: Plane::Zx, clockwise: true, turns: 0 };
        let moves = vec![
            Move::rapid([1.0, 0.0, 5.0]),
            Move::rapid([1.0, 0.0, 1.0]),
            Move::feed([1.0, 0.0, -1.0], 60.0),
            Move::feed([5.0, 0.0, -1.0], 600.0).arc(below),
            Move::rapid([5.0, 0.0, 5.0]),
        ];
        let (hangs, _) = moves[3].bounds(Some(moves[2].end.tip));
        let program = Program { moves, ..Program::empty(SetupRecord::default(), Vec::new(), Vec::new()) };
        let found = Statistics::of(&program, &Dynamics::at_once(600.0));
        let around = std::f64::consts::TAU;
        assert!((found.feed_length - (2.0 + around)).abs() < 1e-12);
        // the path to the first point is not counted
        assert!((found.rapid_length - (4.0 + 6.0)).abs() < 1e-12);
        assert!((found.duration - (1.0 + 2.0 + around / 10.0)).abs() < 1e-12, "{}", found.duration);
        assert!((hangs[2] + 3.0).abs() < 1e-12 && (found.lowest + 3.0).abs() < 1e-12, "{}", found.lowest);
    }

    #[test]
    fn a_program_without_feed_moves_has_no_lowest_point() {
        let events = vec![Event { before: 1, kind: EventKind::Dwell { seconds: 2.0 } }];
        let moves = vec![Move::rapid([0.0; 3])];
        let program = Program { moves, events, ..Program::empty(SetupRecord::default(), Vec::new(), Vec::new()) };
        let found = Statistics::of(&program, &Dynamics::at_once(600.0));
        assert!(found.lowest.is_infinite() && found.lowest > 0.0);
        assert!((found.duration - 2.0).abs() < 1e-12);
    }
}
