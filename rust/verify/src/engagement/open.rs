//! Which directions of a circle are still open: arcs of angles, and what is taken out of them.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Directions in `[0, 2 pi)` as intervals (from, to) in ascending order, rad.
#[derive(Clone, Debug, Default)]
pub struct Open {
    intervals: Vec<[f64; 2]>,
    spare: Vec<[f64; 2]>,
}

impl Open {
    /// All directions.
    pub fn all(&mut self) {
        self.intervals.clear();
        self.intervals.push([0.0, TAU]);
    }

    /// The directions less than a right angle from a heading.
    pub fn ahead(&mut self, heading: f64) {
        self.intervals.clear();
        let from = (heading - FRAC_PI_2).rem_euclid(TAU);
        if from + PI <= TAU {
            self.intervals.push([from, from + PI]);
        } else {
            self.intervals.extend([[0.0, from + PI - TAU], [from, TAU]]);
        }
    }

    pub fn is_empty(&self) -> bool {
        self.intervals.is_empty()
    }

    /// Angle of all of them together, rad.
    pub fn total(&self) -> f64 {
        self.intervals.iter().map(|[from, to]| to - from).sum()
    }

    /// How wide all of them together are across a heading on a circle of a radius, mm.
    pub fn width(&self, heading: f64, radius: f64) -> f64 {
        let across = |direction: f64| radius * libm::sin(direction - heading);
        self.intervals.iter().map(|[from, to]| across(*to) - across(*from)).sum()
    }

    /// Keeps of each interval what `split` leaves of it.
    pub fn keep(&mut self, mut split: impl FnMut([f64; 2], &mut Vec<[f64; 2]>)) {
        self.spare.clear();
        for interval in &self.intervals {
            split(*interval, &mut self.spare);
        }
        std::mem::swap(&mut self.intervals, &mut self.spare);
    }
}
