//! Length, time and extent of a program.

use crate::{MoveKind, Program};

/// What a program amounts to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Statistics {
    /// Path length at feed, mm.
    pub feed_length: f64,
    /// Path length at rapid, mm; the way to the first point is not known and not counted.
    pub rapid_length: f64,
    /// Time at the programmed feeds, with dwells, s; rapids at `rapid_rate`. Acceleration is not counted.
    pub duration: f64,
    /// Lowest coordinate of any feed move's end, mm; infinity when there is none.
    pub lowest: f64,
}

impl Statistics {
    /// Measures `program`, with rapids at `rapid_rate` mm/min.
    #[must_use]
    pub fn of(program: &Program, rapid_rate: f64) -> Self {
        let mut sum = Self { lowest: f64::INFINITY, ..Self::default() };
        let mut minutes = 0.0;
        for (start, step) in program.segments() {
            let length = start.map_or(0.0, |s| distance(s, step.end));
            match step.kind {
                MoveKind::Rapid => {
                    sum.rapid_length += length;
                    minutes += length / rapid_rate;
                }
                MoveKind::Feed => {
                    sum.feed_length += length;
                    minutes += length / step.feed;
                    sum.lowest = sum.lowest.min(step.end[2]);
                }
            }
        }
        let dwell: f64 = program
            .events
            .iter()
            .map(|e| if let crate::EventKind::Dwell { seconds } = e.kind { seconds } else { 0.0 })
            .sum();
        sum.duration = minutes * 60.0 + dwell;
        sum
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [dx, dy, dz] = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    (dx * dx + dy * dy + dz * dz).sqrt()
}
