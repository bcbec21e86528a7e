//! The arcs that a block's I, J, K or R describe.

use styluscam_motion::{Arc, ArcPath, Plane};

/// Turns of one arc at most: each takes its chords.
pub(crate) const MOST_TURNS: u32 = 1000;
/// Radii are compared with this slack, mm.
const ROUNDED: f64 = 1e-9;

/// How much lengths of an arc may differ, because they were rounded.
#[derive(Clone, Copy)]
pub(crate) struct Slack {
    /// mm.
    pub absolute: f64,
    /// A share of the radius.
    pub relative: f64,
}

impl Slack {
    /// How much it is for a radius, mm.
    pub fn of(self, radius: f64) -> f64 {
        self.absolute + self.relative * radius
    }
}

/// The smallest arc that is taken.
#[derive(Clone, Copy)]
pub(crate) struct Least {
    /// mm.
    pub radius: f64,
    /// rad.
    pub angle: f64,
}

/// What is wrong with an arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ArcFault {
    /// A full circle by R.
    FullByRadius,
    /// R is less than half the distance of the ends.
    ShortRadius,
    /// No radius, or one below the smallest.
    NoRadius,
    /// No angle, or one below the smallest.
    NoAngle,
}

/// An arc's ends.
#[derive(Clone, Copy)]
pub(crate) struct Ends {
    pub start: [f64; 3],
    pub end: [f64; 3],
    pub plane: Plane,
    pub clockwise: bool,
}

impl Ends {
    /// The centre by R, which half the chord may exceed by `slack`: above zero the shorter arc of the two, below zero the longer one.
    pub fn centre_by_radius(&self, radius: f64, slack: Slack) -> Result<[f64; 3], ArcFault> {
        let [first, second, _] = self.plane.axes();
        let chord = [self.end[first] - self.start[first], self.end[second] - self.start[second]];
        let length = libm::hypot(chord[0], chord[1]);
        if length <= 0.0 {
            return Err(ArcFault::FullByRadius);
        }
        let half = 0.5 * length;
        if half > radius.abs() + slack.absolute + slack.relative * radius.abs() {
            return Err(ArcFault::ShortRadius);
        }
        let over = (radius * radius - half * half).max(0.0).sqrt();
        let left = if self.clockwise == (radius < 0.0) { over } else { -over };
        let mut centre = self.start;
        centre[first] += 0.5 * chord[0] - left * chord[1] / length;
        centre[second] += 0.5 * chord[1] + left * chord[0] / length;
        Ok(centre)
    }

    /// The arc about a centre, whatever its ends.
    pub fn about(&self, centre: [f64; 3], turns: u32) -> Arc {
        Arc { centre, plane: self.plane, clockwise: self.clockwise, turns }
    }

    /// The path of an arc between these ends, when there is one.
    pub fn path(&self, arc: &Arc, least: Least) -> Result<ArcPath, ArcFault> {
        let path = arc.path(self.start, self.end);
        let radius = path.radius();
        if radius <= 0.0 || radius < least.radius - ROUNDED {
            return Err(ArcFault::NoRadius);
        }
        if path.sweep().abs() < least.angle {
            return Err(ArcFault::NoAngle);
        }
        Ok(path)
    }
}

/// The centre by I, J and K, mm: they count from `zero`, and where one is left out the centre lies at `rest`.
pub(crate) fn centre_by_offsets(zero: [f64; 3], rest: [f64; 3], offsets: [Option<f64>; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| offsets[axis].map_or(rest[axis], |offset| zero[axis] + offset))
}
