//! Circular moves: arcs, full circles and helices in the machine's main planes.

use std::f64::consts::{FRAC_PI_2, TAU};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// In the plane of an arc, ends nearer than this share of its radius are one point: the arc is a full circle.
const SAME: f64 = 1e-9;

/// A main plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Plane {
    /// G17.
    #[default]
    Xy,
    /// G18.
    Zx,
    /// G19.
    Yz,
}

impl Plane {
    /// Its first and second axis, and the one that it is seen along: a right-handed system.
    #[must_use]
    pub fn axes(self) -> [usize; 3] {
        match self {
            Self::Xy => [0, 1, 2],
            Self::Zx => [2, 0, 1],
            Self::Yz => [1, 2, 0],
        }
    }
}

/// How a move turns about a line along an axis, from where the move before it ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Arc {
    /// The centre, work coordinates, mm; along the plane's third axis it has no meaning.
    pub centre: [f64; 3],
    /// The plane in which it turns; along the third axis it rises evenly to the move's end.
    #[serde(default)]
    pub plane: Plane,
    /// Seen along the third axis towards its zero: G2, not G3.
    pub clockwise: bool,
    /// Full turns beyond the first arrival at the end.
    #[serde(default)]
    pub turns: u32,
}

/// The path of an arc between two points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArcPath {
    axes: [usize; 3],
    centre: [f64; 2],
    /// Angle at the start, rad.
    angle: f64,
    /// Angle that is turned through, rad; negative clockwise.
    sweep: f64,
    /// Distance from the centre at both ends, mm: text is rounded, they may differ.
    radii: [f64; 2],
    /// Height along the third axis at both ends, mm.
    heights: [f64; 2],
}

impl Arc {
    /// The path from `start` to `end`, mm. Ends at one point in the plane make a full circle.
    #[must_use]
    pub fn path(&self, start: [f64; 3], end: [f64; 3]) -> ArcPath {
        let axes = self.plane.axes();
        let [first, second, third] = axes;
        let centre = [self.centre[first], self.centre[second]];
        let from = [start[first] - centre[0], start[second] - centre[1]];
        let to = [end[first] - centre[0], end[second] - centre[1]];
        let radii = [from, to].map(|[u, v]| length(u, v));
        let angle = libm::atan2(from[1], from[0]);
        let apart = length(to[0] - from[0], to[1] - from[1]);
        let counter = (libm::atan2(to[1], to[0]) - angle).rem_euclid(TAU);
        let whole = apart <= SAME * radii[0].max(radii[1]);
        let sweep = match (whole, self.clockwise) {
            (true, true) => -TAU,
            (true, false) => TAU,
            (false, true) => counter - TAU,
            (false, false) => counter,
        };
        let more = f64::from(self.turns) * TAU;
        let sweep = if self.clockwise { sweep - more } else { sweep + more };
        ArcPath { axes, centre, angle, sweep, radii, heights: [start[third], end[third]] }
    }
}

impl ArcPath {
    /// The point at a share of the path, 0 to 1.
    #[must_use]
    pub fn at(&self, share: f64) -> [f64; 3] {
        let between = |[a, b]: [f64; 2]| a + share * (b - a);
        let (sin, cos) = libm::sincos(self.angle + share * self.sweep);
        let radius = between(self.radii);
        let [first, second, third] = self.axes;
        let mut point = [0.0; 3];
        point[first] = self.centre[0] + radius * cos;
        point[second] = self.centre[1] + radius * sin;
        point[third] = between(self.heights);
        point
    }

    /// The part of the path between two shares of it.
    #[must_use]
    pub fn part(&self, from: f64, to: f64) -> Self {
        let between = |[a, b]: [f64; 2]| [a + from * (b - a), a + to * (b - a)];
        Self {
            angle: self.angle + from * self.sweep,
            sweep: (to - from) * self.sweep,
            radii: between(self.radii),
            heights: between(self.heights),
            ..*self
        }
    }

    /// The same path elsewhere, shifted along X, Y and Z, mm.
    #[must_use]
    pub fn shifted(&self, by: [f64; 3]) -> Self {
        let [first, second, third] = self.axes;
        let centre = [self.centre[0] + by[first], self.centre[1] + by[second]];
        Self { centre, heights: self.heights.map(|height| height + by[third]), ..*self }
    }

    /// Its length, mm.
    #[must_use]
    pub fn length(&self) -> f64 {
        let around = self.sweep.abs() * 0.5 * (self.radii[0] + self.radii[1]);
        let along = length(self.radii[1] - self.radii[0], self.heights[1] - self.heights[0]);
        length(around, along)
    }

    /// Angle that is turned through, rad; negative clockwise.
    #[must_use]
    pub fn sweep(&self) -> f64 {
        self.sweep
    }

    /// The tangent of a quarter of the angle, as seen from above, positive to the left: 0 where it turns about another axis than Z and
    /// is straight from there.
    #[must_use]
    pub fn bulge(&self) -> f64 {
        match self.axes {
            [0, 1, 2] => libm::tan(0.25 * self.sweep),
            _ => 0.0,
        }
    }

    /// The larger distance from the centre, mm.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radii[0].max(self.radii[1])
    }

    /// How much the distances of start and end from the centre differ, mm.
    #[must_use]
    pub fn mismatch(&self) -> f64 {
        (self.radii[1] - self.radii[0]).abs()
    }

    /// The box around it: lowest and highest coordinates, mm.
    #[must_use]
    pub fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let (from, to) = (self.angle.min(self.angle + self.sweep), self.angle.max(self.angle + self.sweep));
        let first = (from / FRAC_PI_2).ceil();
        let quadrants = (0..4).map(|i| (first + f64::from(i)) * FRAC_PI_2).filter(|angle| *angle <= to);
        let shares = quadrants.map(|angle| (angle - self.angle) / self.sweep).chain([0.0, 1.0]);
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for point in shares.map(|share| self.at(share)) {
            for axis in 0..3 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        (low, high)
    }

    /// How far the path is from its chord at most, each point from the chord's point at the same share, mm.
    ///
    /// An eighth of the largest second derivative: of r(s) (cos, sin)(a s), that is `r a^2 + 2 r' a`.
    #[must_use]
    pub fn sag(&self) -> f64 {
        let turn = self.sweep.abs();
        0.125 * turn * (self.radius() * turn + 2.0 * self.mismatch())
    }

    /// Into how many equal chords it is to be cut that none is farther than `sag` mm from it.
    #[must_use]
    pub fn chords(&self, sag: f64) -> usize {
        let count = (self.sag() / sag).sqrt().ceil();
        if count.is_finite() {
            (count as usize).max(1)
        } else {
            1
        }
    }
}

fn length(a: f64, b: f64) -> f64 {
    libm::sqrt(a * a + b * b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const ORIGIN: [f64; 3] = [0.0; 3];

    fn about(plane: Plane, clockwise: bool) -> Arc {
        Arc { centre: ORIGIN, plane, clockwise, turns: 0 }
    }

    fn gap(a: [f64; 3], b: [f64; 3]) -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    }

    #[test]
    fn a_quarter_is_a_quarter_and_the_other_way_the_rest() {
        let (from, to) = ([2.0, 0.0, 5.0], [0.0, 2.0, 5.0]);
        assert!((about(Plane::Xy, false).path(from, to).length() - TAU / 2.0).abs() < 1e-12);
        assert!((about(Plane::Xy, true).path(from, to).length() - 3.0 * TAU / 2.0).abs() < 1e-12);
    }

    #[test]
    fn planes_turn_right_handed() {
        // from the first axis to the second, counterclockwise: a quarter
        for (plane, from, to) in [
            (Plane::Xy, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
            (Plane::Zx, [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]),
            (Plane::Yz, [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
        ] {
            let path = about(plane, false).path(from, to);
            assert!((path.sweep() - TAU / 4.0).abs() < 1e-12, "{plane:?}");
            let half = std::f64::consts::FRAC_1_SQRT_2;
            assert!(gap(path.at(0.5), [from, to].map(|p| p.map(|x| x * half)).into_iter().fold(ORIGIN, add)) < 1e-12);
        }
    }

    fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
        [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
    }

    #[test]
    fn equal_ends_are_a_full_circle_and_turns_are_added() {
        let start = [3.0, 0.0, 1.0];
        let arc = Arc { turns: 2, ..about(Plane::Xy, true) };
        let path = arc.path(start, [3.0, 0.0, -1.0]);
        assert!((path.sweep() + 3.0 * TAU).abs() < 1e-12);
        assert!((path.length() - (3.0 * TAU * 3.0).hypot(2.0)).abs() < 1e-12);
        assert!(gap(path.at(1.0), [3.0, 0.0, -1.0]) < 1e-12);
    }

    #[test]
    fn the_box_holds_the_quadrants() {
        let path = about(Plane::Xy, false).path([3.0, -4.0, 0.0], [-3.0, 4.0, 2.0]);
        let (low, high) = path.bounds();
        assert!(gap(low, [-3.0, -4.0, 0.0]) < 1e-12 && gap(high, [5.0, 5.0, 2.0]) < 1e-12, "{low:?} {high:?}");
    }

    proptest! {
        #[test]
        fn chords_keep_to_the_path(radius in 0.1..50.0_f64, off in -0.02..0.02_f64, turn in 0.01..6.2_f64,
                                  rise in -9.0..9.0_f64, sag in 1e-5..0.1_f64, share in 0.0..1.0_f64) {
            let from = [radius, 0.0, 0.0];
            let to = [(radius + off) * turn.cos(), (radius + off) * turn.sin(), rise];
            let path = about(Plane::Xy, false).path(from, to);
            prop_assert!((path.sweep() - turn).abs() < 1e-9);
            prop_assert!(gap(path.at(0.0), from) < 1e-9 && gap(path.at(1.0), to) < 1e-9);
            let count = path.chords(sag);
            let chord = (share * count as f64).floor() / count as f64;
            let piece = path.part(chord, chord + 1.0 / count as f64);
            let inside = (share - chord) * count as f64;
            let (a, b) = (piece.at(0.0), piece.at(1.0));
            let straight = [0, 1, 2].map(|i| a[i] + inside * (b[i] - a[i]));
            prop_assert!(gap(straight, path.at(share)) <= piece.sag() + 1e-12);
            prop_assert!(piece.sag() <= sag * (1.0 + 1e-9));
        }
    }
}
