//! The curves of turns in plan: arcs and lines that meet each other and both rows without a corner.
//!
//! A loop of two outer arcs about a larger one is the omega turn of machines that cannot turn on the spot: L. E. Dubins, "On curves
//! of minimal length with a constraint on average curvature, and with prescribed initial and terminal positions and tangents",
//! American Journal of Mathematics 79, 1957 (the words right, left, right). Derived in docs/concepts/rows.md.

use std::f64::consts::{FRAC_PI_2, PI};

/// A position or a direction in plan.
pub(super) type Flat = [f64; 2];

/// Chords of a turn turn by no more, rad: 10 degrees.
const CHORD: f64 = PI / 18.0;
/// Corners of less, rad, are none.
const STRAIGHT: f64 = 1e-6;
/// Rows run against each other, or alike, where the cosine of their angle is this near to one.
const PARALLEL: f64 = 1e-6;

/// Where a turn begins and ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ends {
    /// The end of a row, mm.
    pub from: Flat,
    /// The start of the next one, mm.
    pub to: Flat,
    /// Unit direction in which the first is left.
    pub leaving: Flat,
    /// Unit direction in which the next is entered.
    pub arriving: Flat,
    /// Distance between both rows, mm.
    pub apart: f64,
}

impl Ends {
    /// From end to start, mm.
    pub fn distance(&self) -> f64 {
        norm(minus(self.to, self.from))
    }

    /// Whether the next row runs the other way.
    fn runs_back(&self) -> bool {
        dot(self.leaving, self.arriving) < PARALLEL - 1.0
    }

    /// 1 where the next row lies on the left of the first, else -1.
    fn side(&self) -> f64 {
        if cross(self.leaving, minus(self.to, self.from)) < 0.0 {
            -1.0
        } else {
            1.0
        }
    }

    /// How far the start of the next row lies beyond the end of the first, mm.
    fn ahead(&self) -> f64 {
        dot(self.leaving, minus(self.to, self.from))
    }
}

/// A point of a curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct CurvePoint {
    /// mm.
    pub at: Flat,
    /// Length up to here, as a share of the whole.
    pub share: f64,
}

/// How near chords are to their curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fine {
    /// Largest distance between both, mm.
    pub sagitta: f64,
    /// Largest angle between two chords, rad.
    pub bend: f64,
}

/// Half a circle beyond the ends of two rows that run against each other, the shorter one extended; without its ends.
pub(super) fn outer(ends: &Ends, fine: Fine) -> Option<Vec<CurvePoint>> {
    looped(ends, 0.5 * ends.apart, fine)
}

/// A loop of arcs of one radius, mm, beyond the ends of two rows that run against each other: out, round, and back; between rows that
/// are farther apart than a circle is wide, a quarter of it on either side of a line.
pub(super) fn looped(ends: &Ends, radius: f64, fine: Fine) -> Option<Vec<CurvePoint>> {
    if !ends.runs_back() || radius <= 0.0 {
        return None;
    }
    let (half, side) = (0.5 * ends.apart, ends.side());
    let mut pen = Pen::new(ends.from, ends.leaving, side, fine);
    pen.straight(ends.ahead().max(0.0));
    if radius < half {
        pen.turn(radius, FRAC_PI_2);
        pen.straight(2.0 * (half - radius));
        pen.turn(radius, FRAC_PI_2);
    } else {
        // the middle circle touches both outer ones, whose centres lie a radius outside the rows
        let out = libm::acos(((half + radius) / (2.0 * radius)).min(1.0));
        pen.turn(radius, -out);
        pen.turn(radius, PI + 2.0 * out);
        pen.turn(radius, -out);
    }
    pen.straight((-ends.ahead()).max(0.0));
    Some(pen.points_between(ends.to))
}

/// What is taken off both rows' ends, mm, and the line between these ends with its corners rounded by half the distance between
/// the rows: half a circle where the ends lie side by side. No corner takes more than that distance off a row, nor more than `most`.
pub(super) fn rounded(ends: &Ends, most: [f64; 2], fine: Fine) -> Option<([f64; 2], Vec<CurvePoint>)> {
    let half = 0.5 * ends.apart;
    let line = minus(ends.to, ends.from);
    let length = norm(line);
    let along = [line[0] / length, line[1] / length];
    let corners = [angle(ends.leaving, along), angle(along, ends.arriving)];
    let tangents = [0, 1].map(|corner| half.min(half * libm::tan(0.5 * corners[corner].abs())));
    if tangents[0] > most[0] || tangents[1] > most[1] || length <= 0.0 {
        return None;
    }
    let start = [0, 1].map(|axis| ends.from[axis] - tangents[0] * ends.leaving[axis]);
    let end = [0, 1].map(|axis| ends.to[axis] + tangents[1] * ends.arriving[axis]);
    let radius = |corner: usize| {
        if corners[corner].abs() > STRAIGHT {
            tangents[corner] / libm::tan(0.5 * corners[corner].abs())
        } else {
            0.0
        }
    };
    let mut pen = Pen::new(start, ends.leaving, 1.0, fine);
    pen.turn(radius(0), corners[0]);
    pen.straight((length - tangents[0] - tangents[1]).max(0.0));
    pen.turn(radius(1), corners[1]);
    Some((tangents, pen.points_between(end)))
}

/// Draws a curve from its beginning on.
struct Pen {
    at: Flat,
    /// Direction, rad from +X.
    heading: f64,
    /// 1 or -1: turns are counted to this side.
    side: f64,
    fine: Fine,
    length: f64,
    points: Vec<(Flat, f64)>,
}

impl Pen {
    fn new(at: Flat, direction: Flat, side: f64, fine: Fine) -> Self {
        let heading = libm::atan2(direction[1], direction[0]);
        Self { at, heading, side, fine, length: 0.0, points: Vec::new() }
    }

    fn straight(&mut self, length: f64) {
        if length > 0.0 {
            let (sin, cos) = libm::sincos(self.heading);
            self.go([self.at[0] + length * cos, self.at[1] + length * sin], length);
        }
    }

    fn turn(&mut self, radius: f64, angle: f64) {
        if !(radius > 0.0 && angle.abs() > STRAIGHT) {
            return;
        }
        let finest = 2.0 * libm::acos((1.0 - self.fine.sagitta / radius).max(0.0));
        let chords = (angle.abs() / CHORD.min(self.fine.bend).min(finest)).ceil().max(1.0);
        let signed = self.side * angle;
        let (sin, cos) = libm::sincos(self.heading);
        let left = signed.signum();
        let centre = [self.at[0] - left * radius * sin, self.at[1] + left * radius * cos];
        let arm = minus(self.at, centre);
        for chord in 1..=(chords as u32) {
            let (sin, cos) = libm::sincos(signed * f64::from(chord) / chords);
            let to = [centre[0] + arm[0] * cos - arm[1] * sin, centre[1] + arm[0] * sin + arm[1] * cos];
            self.go(to, radius * angle.abs() / chords);
        }
        self.heading += signed;
    }

    fn go(&mut self, to: Flat, length: f64) {
        self.length += length;
        self.at = to;
        self.points.push((to, self.length));
    }

    /// What was drawn, without its last point, which is `end`.
    fn points_between(mut self, end: Flat) -> Vec<CurvePoint> {
        debug_assert!(norm(minus(self.at, end)) < 1e-6, "{:?} {end:?}", self.at);
        self.points.pop();
        let length = self.length.max(f64::MIN_POSITIVE);
        self.points.into_iter().map(|(at, so_far)| CurvePoint { at, share: so_far / length }).collect()
    }
}

/// From one direction to another, rad, above 0 to the left.
fn angle(from: Flat, to: Flat) -> f64 {
    libm::atan2(cross(from, to), dot(from, to))
}

fn minus(a: Flat, b: Flat) -> Flat {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: Flat, b: Flat) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: Flat, b: Flat) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn norm(a: Flat) -> f64 {
    libm::hypot(a[0], a[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn to(sagitta: f64) -> Fine {
        Fine { sagitta, bend: f64::INFINITY }
    }

    fn ends(apart: f64, ahead: f64, back: bool) -> Ends {
        let arriving = if back { [-1.0, 0.0] } else { [1.0, 0.0] };
        Ends { from: [2.0, 1.0], to: [2.0 + ahead, 1.0 + apart], leaving: [1.0, 0.0], arriving, apart: apart.abs() }
    }

    /// The largest corner of rows and curve together, rad.
    fn largest_corner(ends: &Ends, begin: Flat, curve: &[CurvePoint], finish: Flat) -> f64 {
        let before = [begin[0] - ends.leaving[0], begin[1] - ends.leaving[1]];
        let behind = [finish[0] + ends.arriving[0], finish[1] + ends.arriving[1]];
        let inner = curve.iter().map(|point| point.at);
        let all: Vec<Flat> = [before, begin].into_iter().chain(inner).chain([finish, behind]).collect();
        let sides: Vec<Flat> =
            all.windows(2).map(|pair| minus(pair[1], pair[0])).filter(|side| norm(*side) > 1e-7).collect();
        sides.windows(2).map(|pair| angle(pair[0], pair[1]).abs()).fold(0.0, f64::max)
    }

    proptest! {
        #[test]
        fn turns_have_no_corner(apart in prop_oneof![-3.0..-0.1_f64, 0.1..3.0_f64], ahead in -4.0..4.0_f64,
                                back in any::<bool>(), radius in 0.05..5.0_f64) {
            let ends = ends(apart, ahead, back);
            let allowed = CHORD + 1e-4;
            let (taken, curve) = rounded(&ends, [10.0; 2], to(1e-3)).unwrap();
            let begin = [ends.from[0] - taken[0], ends.from[1]];
            let finish = [ends.to[0] + taken[1] * ends.arriving[0], ends.to[1]];
            prop_assert!(taken.iter().all(|taken| *taken <= 0.5 * ends.apart + 1e-12));
            prop_assert!(largest_corner(&ends, begin, &curve, finish) < allowed);
            let loops = [looped(&ends, radius, to(1e-3)), outer(&ends, to(1e-3))];
            for curve in loops {
                prop_assert_eq!(curve.is_some(), back);
                let Some(curve) = curve else { continue };
                prop_assert!(largest_corner(&ends, ends.from, &curve, ends.to) < allowed);
                // it lies beyond both ends
                let first = ends.from[0].max(ends.to[0]);
                prop_assert!(curve.iter().any(|point| point.at[0] > first));
            }
        }
    }

    #[test]
    fn ends_side_by_side_get_half_a_circle() {
        let ends = ends(1.0, 0.0, true);
        let (taken, curve) = rounded(&ends, [1.0; 2], to(1e-4)).unwrap();
        assert!(taken.iter().all(|taken| (taken - 0.5).abs() < 1e-12));
        assert!(curve.iter().all(|point| (norm(minus(point.at, [1.5, 1.5])) - 0.5).abs() < 1e-9));
        assert!(rounded(&ends, [0.4, 1.0], to(1e-4)).is_none());
    }

    #[test]
    fn a_loop_has_its_radius() {
        let ends = ends(1.0, 0.0, true);
        let curve = looped(&ends, 2.0, to(1e-4)).unwrap();
        // right of the first row's direction: the centre of the first arc; the middle one reaches 2 beyond its centre
        let far = curve.iter().map(|point| point.at[0]).fold(0.0, f64::max);
        let centre = 2.0 + libm::sqrt(16.0 - 2.5 * 2.5);
        assert!((far - centre - 2.0).abs() < 1e-3, "{far}");
    }
}
