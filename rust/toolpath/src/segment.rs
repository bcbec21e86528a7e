//! Pieces of a path of the tool's tip: lines, arcs and helices, each with its feed and its role.

use std::f64::consts::TAU;

use styluscam_geometry::Vector;
use styluscam_motion::{Arc, Move, Plane, Role};

/// Turns of a helix that differ by less from a whole number are whole: an end that near to its start in plan would be
/// read as a full turn more (arcs take ends nearer than 1e-9 of the radius as one).
const WHOLE: f64 = 1e-8;

/// How fast a segment is travelled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pace {
    /// At the machine's rapid rate. Rapids are lines.
    Rapid,
    /// At a feed, mm/min.
    Feed(f64),
}

/// The curve of a segment, from the end of the one before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Curve {
    /// Straight.
    Line,
    /// About a line along an axis, a full turn at most; it moves evenly along the line where its ends differ there.
    Arc {
        /// The plane across the line.
        plane: Plane,
        /// The line's position in the plane, along its first and second axis, mm.
        centre: [f64; 2],
        /// Seen along the plane's third axis towards its zero: G2, not G3.
        clockwise: bool,
    },
    /// About a vertical line, rising or falling evenly.
    Helix {
        /// The line's position in plan, mm.
        centre: [f64; 2],
        /// Seen from above: G2, not G3.
        clockwise: bool,
        /// Full turns beyond the first arrival at the end's position in plan.
        turns: u32,
    },
}

/// A piece of a path of the tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Where it ends, mm.
    pub end: Vector,
    /// How it gets there.
    pub curve: Curve,
    /// How fast.
    pub pace: Pace,
    /// What it is for. Strategies state it only where the posted text can carry it.
    pub role: Option<Role>,
}

impl Segment {
    /// A rapid straight to a point, mm.
    #[must_use]
    pub fn rapid(end: Vector) -> Self {
        Self { end, curve: Curve::Line, pace: Pace::Rapid, role: None }
    }

    /// A line to a point, mm, at a feed in mm/min.
    #[must_use]
    pub fn line(end: Vector, feed: f64) -> Self {
        Self { end, curve: Curve::Line, pace: Pace::Feed(feed), role: None }
    }

    /// An arc between two points, mm, at a feed in mm/min. `bulge` is the tangent of a quarter of its angle, above 0
    /// counterclockwise as seen from above (AutoCAD's DXF reference, LWPOLYLINE, group code 42); a line for a bulge of 0.
    ///
    /// None for a bulge that is not a number, and for ends at one position in plan: those have no arc of less than a turn.
    #[must_use]
    pub fn arc(start: Vector, end: Vector, bulge: f64, feed: f64) -> Option<Self> {
        let chord = end - start;
        if !bulge.is_finite() || (chord.x == 0.0 && chord.y == 0.0) {
            return None;
        }
        if bulge == 0.0 {
            return Some(Self::line(end, feed));
        }
        // the centre lies on the chord's bisector, to the left of a counterclockwise arc of less than half a turn
        let aside = (1.0 - bulge * bulge) / (4.0 * bulge);
        let middle = (start + end) * 0.5;
        let centre = [middle.x - aside * chord.y, middle.y + aside * chord.x];
        let curve = Curve::Arc { plane: Plane::Xy, centre, clockwise: bulge < 0.0 };
        Some(Self { end, curve, pace: Pace::Feed(feed), role: None })
    }

    /// A helix about a vertical line through `centre`, mm, from a point to the height `z`, at a feed in mm/min. `pitch` is the
    /// height of a full turn, mm, above 0; the end lies where its turns lead.
    ///
    /// None for a pitch that is not above 0, for a start on the line or at `z` (1e-8 of a turn or less), and for 2^32
    /// turns or more.
    #[must_use]
    pub fn helix(start: Vector, centre: [f64; 2], clockwise: bool, z: f64, pitch: f64, feed: f64) -> Option<Self> {
        let arm = [start.x - centre[0], start.y - centre[1]];
        let turned = (z - start.z).abs() / pitch;
        let aside = arm.iter().any(|offset| *offset != 0.0);
        if !(aside && pitch > 0.0 && turned > WHOLE && turned < f64::from(u32::MAX)) {
            return None;
        }
        // whole turns end over their start, where the first arrival is a turn by itself
        let whole = turned - turned.floor() <= WHOLE;
        let turns = if whole { turned.floor() - 1.0 } else { turned.floor() } as u32;
        let rest = TAU * (turned - turned.floor());
        let (sin, cos) = libm::sincos(if clockwise { -rest } else { rest });
        let end = if whole {
            Vector::new(start.x, start.y, z)
        } else {
            Vector::new(centre[0] + arm[0] * cos - arm[1] * sin, centre[1] + arm[0] * sin + arm[1] * cos, z)
        };
        let curve = Curve::Helix { centre, clockwise, turns };
        Some(Self { end, curve, pace: Pace::Feed(feed), role: None })
    }

    /// The same segment in a role.
    #[must_use]
    pub fn in_role(self, role: Role) -> Self {
        Self { role: Some(role), ..self }
    }

    /// It as a move of an upright tool, in an operation by its index.
    #[must_use]
    pub fn to_move(&self, operation: u32) -> Move {
        let end: [f64; 3] = self.end.into();
        let plain = match self.pace {
            Pace::Rapid => Move::rapid(end),
            Pace::Feed(feed) => Move::feed(end, feed),
        };
        Move { role: self.role, ..plain.arc(self.turning()).of_operation(operation) }
    }

    /// How it turns on its way; none of a line.
    #[must_use]
    pub fn turning(&self) -> Option<Arc> {
        let about = |plane: Plane, in_plane: [f64; 2], clockwise, turns| {
            let (mut centre, [first, second, _]): ([f64; 3], _) = (self.end.into(), plane.axes());
            [centre[first], centre[second]] = in_plane;
            Arc { centre, plane, clockwise, turns }
        };
        match self.curve {
            Curve::Line => None,
            Curve::Arc { plane, centre, clockwise } => Some(about(plane, centre, clockwise, 0)),
            Curve::Helix { centre, clockwise, turns } => Some(about(Plane::Xy, centre, clockwise, turns)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use styluscam_motion::MoveKind;

    fn near(a: [f64; 3], b: [f64; 3]) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12)
    }

    /// The path of a segment's move: its middle, its length and the angle it turns through.
    fn path(segment: &Segment, start: Vector) -> ([f64; 3], f64, f64) {
        let arc = segment.to_move(0).path(start.into()).unwrap();
        (arc.at(0.5), arc.length(), arc.sweep())
    }

    #[test]
    fn a_positive_bulge_turns_counterclockwise() {
        // half a turn, bulge 1, from (0, 0) to (2, 0): counterclockwise it passes (1, -1)
        let (start, end) = (Vector::zeros(), Vector::new(2.0, 0.0, 0.0));
        let (middle, length, sweep) = path(&Segment::arc(start, end, 1.0, 500.0).unwrap(), start);
        assert!(near(middle, [1.0, -1.0, 0.0]), "{middle:?}");
        assert!((length - TAU / 2.0).abs() < 1e-12 && (sweep - TAU / 2.0).abs() < 1e-12);
        let (middle, _, sweep) = path(&Segment::arc(start, end, -1.0, 500.0).unwrap(), start);
        assert!(near(middle, [1.0, 1.0, 0.0]) && (sweep + TAU / 2.0).abs() < 1e-12);
    }

    #[test]
    fn a_bulge_is_the_tangent_of_a_quarter_of_the_angle() {
        let start = Vector::new(3.0, 0.0, -1.0);
        for degrees in [30.0_f64, 90.0, 200.0, 300.0] {
            let angle = degrees.to_radians();
            let end = Vector::new(3.0 * libm::cos(angle), 3.0 * libm::sin(angle), -1.0);
            let segment = Segment::arc(start, end, libm::tan(0.25 * angle), 500.0).unwrap();
            let Curve::Arc { centre: [x, y], clockwise: false, .. } = segment.curve else { panic!("{segment:?}") };
            assert!(x.abs() < 1e-12 && y.abs() < 1e-12, "{degrees}: {x} {y}");
            assert!((path(&segment, start).2 - angle).abs() < 1e-12);
        }
    }

    #[test]
    fn a_bulge_of_zero_is_a_line_and_what_is_no_arc_is_none() {
        let (start, end) = (Vector::zeros(), Vector::x());
        assert_eq!(Segment::arc(start, end, 0.0, 500.0), Some(Segment::line(end, 500.0)));
        assert_eq!(Segment::arc(start, end, f64::NAN, 500.0), None);
        assert_eq!(Segment::arc(start, Vector::z(), 1.0, 500.0), None);
    }

    #[test]
    fn a_helix_turns_once_for_each_pitch() {
        // 2.25 turns down from (5, 0, 0), clockwise about (2, 0): a quarter on from there is (2, -3)
        let start = Vector::new(5.0, 0.0, 0.0);
        let segment = Segment::helix(start, [2.0, 0.0], true, -4.5, 2.0, 300.0).unwrap();
        assert!(near(segment.end.into(), [2.0, -3.0, -4.5]), "{:?}", segment.end);
        assert_eq!(segment.curve, Curve::Helix { centre: [2.0, 0.0], clockwise: true, turns: 2 });
        let (_, length, sweep) = path(&segment, start);
        assert!((sweep + 2.25 * TAU).abs() < 1e-12);
        assert!((length - libm::hypot(2.25 * TAU * 3.0, 4.5)).abs() < 1e-12);
        // one pitch lower after a turn
        let path = segment.to_move(0).path(start.into()).unwrap();
        assert!(near(path.at(1.0 / 2.25), [5.0, 0.0, -2.0]));
    }

    #[test]
    fn whole_turns_of_a_helix_end_over_their_start() {
        let start = Vector::new(5.0, 0.0, 0.0);
        let segment = Segment::helix(start, [2.0, 0.0], false, -6.0, 2.0, 300.0).unwrap();
        assert!(near(segment.end.into(), [5.0, 0.0, -6.0]));
        assert!((path(&segment, start).2 - 3.0 * TAU).abs() < 1e-12);
        for pitch in [0.0, -1.0, f64::NAN, 1e-12] {
            assert_eq!(Segment::helix(start, [2.0, 0.0], false, -6.0, pitch, 300.0), None, "{pitch}");
        }
        // a little more than three turns by rounding is three turns
        let rounded = Segment::helix(start, [2.0, 0.0], false, -6.0 - 1e-13, 2.0, 300.0).unwrap();
        assert!((path(&rounded, start).2 - 3.0 * TAU).abs() < 1e-12);
        assert_eq!(Segment::helix(start, [5.0, 0.0], false, -6.0, 1.0, 300.0), None);
        assert_eq!(Segment::helix(start, [2.0, 0.0], false, 0.0, 1.0, 300.0), None);
    }

    #[test]
    fn segments_become_moves_with_their_feed_and_role() {
        let end = Vector::new(1.0, 2.0, 3.0);
        assert_eq!(Segment::rapid(end).to_move(4), Move::rapid([1.0, 2.0, 3.0]).of_operation(4));
        let step = Segment::line(end, 250.0).in_role(Role::Lead).to_move(4);
        assert_eq!((step.kind, step.role, step.operation), (MoveKind::Feed, Some(Role::Lead), 4));
        assert!((step.feed - 250.0).abs() < 1e-12);
    }
}
