//! How far an arc passes beside the path between witnesses: everywhere, not at the witnesses alone.

use std::f64::consts::TAU;

use styluscam_geometry::Vector;
use styluscam_motion::Plane;

use super::circle::Position;
use crate::fitting::{counted, ASIDE};
use crate::PathPoint;

/// An arc that comes this near to a full turn is one, or none, rad: an end that near to its start would be read as the other.
const NEARLY_WHOLE: f64 = 1e-4;
/// Steps back along the arc that are rounding, rad.
const ROUNDING: f64 = 1e-9;

/// An arc between two points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    pub plane: Plane,
    pub centre: Position,
    pub clockwise: bool,
    pub start: Vector,
    pub end: Vector,
}

/// A witness as the arc passes it.
#[derive(Clone, Copy)]
struct Passed<'a> {
    witness: &'a PathPoint,
    /// From the arc's centre, in the plane.
    arm: Position,
    /// Turned through from the arc's start, rad.
    turned: f64,
}

impl Candidate {
    /// Whether the arc passes the witnesses in their order and is off the polyline through them by `most` mm of deviation at most.
    pub fn keeps_to(&self, witnesses: &[PathPoint], most: f64) -> bool {
        let Some((first, rest)) = witnesses.split_first() else { return false };
        // the arc may begin or end a little beside its first and last witness
        let begin = Passed { witness: first, arm: self.arm(first.tip), turned: 0.0 };
        let mut total = self.turn(self.arm(self.start), begin.arm);
        let mut last = begin.arm;
        for witness in rest {
            let arm = self.arm(witness.tip);
            let turn = self.turn(last, arm);
            if turn < -ROUNDING {
                return false;
            }
            total += turn;
            last = arm;
        }
        total += self.turn(last, self.arm(self.end));
        let is_whole = self.start == self.end;
        let too_far = if is_whole { TAU + NEARLY_WHOLE } else { TAU - NEARLY_WHOLE };
        if !(total > 0.0 && total < too_far) || (is_whole && total < TAU - NEARLY_WHOLE) {
            return false;
        }
        let mut before = Passed { turned: self.turn(self.arm(self.start), begin.arm), ..begin };
        if self.off(&before, total) > most {
            return false;
        }
        for witness in rest {
            let arm = self.arm(witness.tip);
            let passed = Passed { witness, arm, turned: before.turned + self.turn(before.arm, arm) };
            if self.off(&passed, total) > most || self.off_between(&before, &passed, total) > most {
                return false;
            }
            before = passed;
        }
        true
    }

    fn arm(&self, point: Vector) -> Position {
        let [first, second, _] = self.plane.axes();
        [point[first] - self.centre[0], point[second] - self.centre[1]]
    }

    /// The angle from one arm to another in the arc's sense, rad, between half a turn back and half a turn on.
    fn turn(&self, from: Position, to: Position) -> f64 {
        let angle = libm::atan2(from[0] * to[1] - from[1] * to[0], from[0] * to[0] + from[1] * to[1]);
        if self.clockwise {
            -angle
        } else {
            angle
        }
    }

    /// Radius and height over the plane where the arc, of a `total` angle, has turned so far.
    fn at(&self, turned: f64, total: f64) -> [f64; 2] {
        let share = (turned / total).clamp(0.0, 1.0);
        let [_, _, third] = self.plane.axes();
        let radii = [self.start, self.end].map(|point| norm(self.arm(point)));
        let heights = [self.start[third], self.end[third]];
        [radii, heights].map(|[from, to]| from + share * (to - from))
    }

    /// A vector of the plane and one across it.
    fn vector(&self, in_plane: Position, across: f64) -> Vector {
        let [first, second, third] = self.plane.axes();
        let mut vector = Vector::zeros();
        (vector[first], vector[second], vector[third]) = (in_plane[0], in_plane[1], across);
        vector
    }

    /// Deviation at a witness, mm.
    fn off(&self, passed: &Passed<'_>, total: f64) -> f64 {
        let [_, _, third] = self.plane.axes();
        let (length, [radius, height]) = (norm(passed.arm), self.at(passed.turned, total));
        let aside = (length - radius) / length;
        let aside = self.vector(passed.arm.map(|x| aside * x), passed.witness.tip[third] - height);
        counted(aside, &passed.witness.normal)
    }

    /// Deviation where the chord between two witnesses passes the centre most closely, mm; 0 where that is at one of them.
    ///
    /// The distance of a chord's point from the centre is convex along the chord: it is largest at an end and least there.
    fn off_between(&self, a: &Passed<'_>, b: &Passed<'_>, total: f64) -> f64 {
        let [_, _, third] = self.plane.axes();
        let chord = [b.arm[0] - a.arm[0], b.arm[1] - a.arm[1]];
        let share = -(a.arm[0] * chord[0] + a.arm[1] * chord[1]) / (chord[0] * chord[0] + chord[1] * chord[1]);
        if !(share > 0.0 && share < 1.0) {
            return 0.0;
        }
        let foot = [a.arm[0] + share * chord[0], a.arm[1] + share * chord[1]];
        let ends = [a, b].map(|passed| self.at(passed.turned, total));
        let radius = ends[0][0].max(ends[1][0]);
        let length = norm(foot);
        let inwards = ((length - radius) / length).min(0.0);
        // the chord's height follows its length, the arc's its angle: see docs/concepts/fitting.md
        let half = 0.5 * (b.turned - a.turned);
        let slope = (self.end[third] - self.start[third]).abs() / total;
        let apart = slope * (libm::tan(half) - half).abs();
        let across = [a, b].into_iter().zip(ends).map(|(passed, [_, z])| (passed.witness.tip[third] - z).abs());
        let across = across.fold(0.0, f64::max) + apart;
        let aside = foot.map(|x| inwards * x);
        let in_plane = self.vector(aside, 0.0);
        let least = ASIDE * libm::hypot(norm(aside), across);
        let along = |normal: &Vector| in_plane.dot(normal).abs() + across * normal[third].abs();
        along(&a.witness.normal).max(along(&b.witness.normal)).max(least)
    }
}

fn norm([x, y]: Position) -> f64 {
    libm::hypot(x, y)
}
