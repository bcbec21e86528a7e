//! Motion to FreeCAD's path commands: G0, G1, G2, G3, and the plane of arcs.
//!
//! A tool that leans states its axis in straight commands by the unit vector I, J, K, from the tip up: FreeCAD draws such commands as lines to
//! X, Y, Z, while it would turn the drawing by angles A, B, C; and no control takes these words for a move of an upright tool.
//!
//! FreeCAD reads I, J, K of arcs as the centre relative to an arc's start, and an arc that ends where it starts as a full circle; it
//! has no word for further turns (FreeCAD src/Mod/CAM/App/PathSegmentWalker.cpp, Path/Geom.py). Lengths mm, feeds mm/s.

use std::f64::consts::{PI, TAU};

use styluscam_motion::{Arc, FeedMode, Move, MoveKind, Plane, Pose, Program, Role};

use crate::faults::faults;
use crate::number::write_integer;
use crate::role;

/// Ends of an arc nearer than this (mm) in its plane may be one point with six decimals: FreeCAD would read a full circle.
const WRITTEN: f64 = 1e-5;
/// Ends of an arc nearer than this share of its radius are one point: a full circle, as for the program.
const SAME: f64 = 1e-9;
/// Characters of a usual command, for the first size of the text.
const USUAL: usize = 48;

faults! {
    /// A move that FreeCAD's path commands cannot express. Moves count from 1.
    pub enum PathTextError;
    /// An arc whose start no move before it states.
    Start {
        /// Which move.
        number: usize,
    } = "path-arc-start", ("move {number} is an arc with an unknown start"), "begin with a rapid move or a line";
    /// An arc of a tool that leans.
    Axis {
        /// Which move.
        number: usize,
    } = "path-axis", ("move {number} is an arc of a tool that leans: a path for FreeCAD has straight ones only"),
        "plan with fit = \"lines\"";
    /// A feed in another unit than mm/min.
    FeedMode {
        /// Which move.
        number: usize,
    } = "path-feed-mode", ("move {number} has a feed that is not in mm/min: a path for FreeCAD states mm/s"),
        "post the program for the machine without FreeCAD";
}

/// A program's moves as the text that FreeCAD's `Path.Path(text)` reads, one command a line. It leaves the XY plane as it
/// found it. What happens between the moves is not in it: in FreeCAD that is the tool controller's and the post's. What moves are for
/// stands in remarks, as in a posted text.
///
/// Numbers are rounded as FreeCAD's `toGCode` rounds them, so that what is read of it is written, saved and opened again
/// without a change.
///
/// # Errors
/// [`PathTextError`] for the first move that has no such command.
pub fn path_text(program: &Program) -> Result<String, PathTextError> {
    let mut out = Text { out: String::with_capacity(program.moves.len() * USUAL), plane: Plane::Xy, role: None };
    for (index, (start, step)) in program.segments().enumerate() {
        let number = index + 1;
        if step.arc.is_some() && !step.end.axis.is_up() {
            return Err(PathTextError::Axis { number });
        }
        if step.kind == MoveKind::Feed && step.feed_mode != FeedMode::PerMinute {
            return Err(PathTextError::FeedMode { number });
        }
        if step.kind == MoveKind::Feed {
            out.state_role(step.role);
        }
        match (step.kind, step.arc, start) {
            (MoveKind::Rapid, ..) => out.line("G0", step.end, None),
            (MoveKind::Feed, None, _) => out.line("G1", step.end, Some(step.feed)),
            (MoveKind::Feed, Some(arc), Some(start)) => out.arc(start, step, arc),
            (MoveKind::Feed, Some(_), None) => return Err(PathTextError::Start { number }),
        }
    }
    out.change_to(Plane::Xy);
    out.state_role(None);
    Ok(out.out)
}

struct Text {
    out: String,
    plane: Plane,
    role: Option<Role>,
}

impl Text {
    /// A remark where the role changes.
    fn state_role(&mut self, role: Option<Role>) {
        if role != self.role {
            self.out.push('(');
            self.out.push_str(&role::remark(role));
            self.out.push_str(")\n");
            self.role = role;
        }
    }

    /// A straight command.
    fn line(&mut self, name: &str, end: Pose, feed: Option<f64>) {
        self.begin(name, end.tip);
        if !end.axis.is_up() {
            self.word(" I", end.axis.vector()[0]);
            self.word(" J", end.axis.vector()[1]);
            self.word(" K", end.axis.vector()[2]);
        }
        self.finish(feed);
    }

    /// The commands of an arc: full turns first, each with its share of the rise.
    fn arc(&mut self, start: [f64; 3], step: &Move, arc: Arc) {
        let [first, second, third] = arc.plane.axes();
        let path = arc.path(start, step.end.tip);
        let all = path.sweep().abs();
        let mut at = start;
        for turn in 1..=arc.turns {
            let mut after = start;
            after[third] = path.at(f64::from(turn) * TAU / all)[third];
            self.turn(at, after, arc, step.feed);
            at = after;
        }
        let mut end = step.end.tip;
        let apart = libm::hypot(end[first] - start[first], end[second] - start[second]);
        if apart <= SAME * path.radius() {
            (end[first], end[second]) = (start[first], start[second]); // FreeCAD closes a circle where they are equal
        } else if apart < WRITTEN && all - f64::from(arc.turns) * TAU < PI {
            self.change_to(arc.plane);
            self.line("G1", Pose { tip: end, ..step.end }, Some(step.feed));
            return;
        }
        self.turn(at, end, arc, step.feed);
    }

    /// One G2 or G3, at most a full turn.
    fn turn(&mut self, start: [f64; 3], end: [f64; 3], arc: Arc, feed: f64) {
        self.change_to(arc.plane);
        self.begin(if arc.clockwise { "G2" } else { "G3" }, end);
        let [_, _, third] = arc.plane.axes();
        for axis in (0..3).filter(|&axis| axis != third) {
            self.word([" I", " J", " K"][axis], arc.centre[axis] - start[axis]);
        }
        self.finish(Some(feed));
    }

    fn change_to(&mut self, plane: Plane) {
        if plane != self.plane {
            self.plane = plane;
            self.out.push_str(match plane {
                Plane::Xy => "G17\n",
                Plane::Zx => "G18\n",
                Plane::Yz => "G19\n",
            });
        }
    }

    fn begin(&mut self, name: &str, [x, y, z]: [f64; 3]) {
        self.out.push_str(name);
        self.word(" X", x);
        self.word(" Y", y);
        self.word(" Z", z);
    }

    fn finish(&mut self, feed_mm_min: Option<f64>) {
        if let Some(feed) = feed_mm_min {
            self.word(" F", feed / 60.0);
        }
        self.out.push('\n');
    }

    /// A letter and a number with up to six decimals. As `Command::toGCode` does, it cuts after the seventh and rounds that
    /// half away from zero; unlike there, what rounds to zero has no sign: FreeCAD would write it without one when it is
    /// opened again.
    fn word(&mut self, letter: &str, value: f64) {
        const ONE: u64 = 1_000_000;
        self.out.push_str(letter);
        #[allow(clippy::cast_possible_truncation)] // cut on purpose; coordinates stay within 1e5 mm
        let tenths = (value * 1e7) as i64;
        let millionths = (tenths.unsigned_abs() + 5) / 10;
        if tenths < 0 && millionths > 0 {
            self.out.push('-');
        }
        write_integer(&mut self.out, millionths / ONE);
        let mut rest = millionths % ONE;
        if rest > 0 {
            self.out.push('.');
            let mut place = ONE;
            while rest > 0 {
                place /= 10;
                #[allow(clippy::cast_possible_truncation)] // a digit
                self.out.push(char::from(b'0' + (rest / place) as u8));
                rest %= place;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use styluscam_motion::{SetupRecord, UnitAxis};

    use super::*;

    fn text(moves: Vec<Move>) -> Result<String, PathTextError> {
        let mut program = Program::empty(SetupRecord::default(), vec![], vec![]);
        program.moves = moves;
        path_text(&program)
    }

    #[test]
    fn lines_have_six_decimals_and_mm_s() {
        let moves = vec![Move::rapid([1.0, -2.5, 30.0]), Move::feed([0.1234567, -0.0000004, -0.1], 1000.0)];
        assert_eq!(text(moves).unwrap(), "G0 X1 Y-2.5 Z30\nG1 X0.123457 Y0 Z-0.1 F16.666667\n");
    }

    #[test]
    fn roles_stand_before_the_first_move_of_each_and_end() {
        let at = |x: f64| Move::feed([x, 0.0, 0.0], 60.0);
        let moves = vec![
            Move::rapid([0.0; 3]),
            at(1.0).role(Role::Ramp),
            at(2.0).role(Role::Ramp),
            Move::rapid([3.0, 0.0, 0.0]),
            at(4.0).role(Role::Ramp),
            at(5.0),
            at(6.0).role(Role::Cut),
        ];
        let expected =
            "G0 X0 Y0 Z0\n(role ramp)\nG1 X1 Y0 Z0 F1\nG1 X2 Y0 Z0 F1\nG0 X3 Y0 Z0\nG1 X4 Y0 Z0 F1\n(role none)\n\
                        G1 X5 Y0 Z0 F1\n(role cut)\nG1 X6 Y0 Z0 F1\n(role none)\n";
        assert_eq!(text(moves).unwrap(), expected);
    }

    #[test]
    fn numbers_are_cut_after_the_seventh_decimal() {
        let moves = vec![Move::rapid([0.000_000_5, -0.000_000_49, 99_999.999_999_6])];
        assert_eq!(text(moves).unwrap(), "G0 X0.000001 Y0 Z100000\n");
    }

    #[test]
    fn straight_moves_of_a_tool_that_leans_state_its_axis() {
        let axis = UnitAxis::new([0.6, 0.0, 0.8]).unwrap();
        let moves = vec![
            Move::rapid([1.0, 2.0, 3.0]).with_axis(axis),
            Move::feed([2.0; 3], 60.0).with_axis(axis),
            Move::rapid([0.0; 3]),
        ];
        let expected = "G0 X1 Y2 Z3 I0.6 J0 K0.8\nG1 X2 Y2 Z2 I0.6 J0 K0.8 F1\nG0 X0 Y0 Z0\n";
        assert_eq!(text(moves).unwrap(), expected);
    }

    #[test]
    fn an_arc_of_a_tilted_tool_another_feed_and_a_start_that_is_not_known_are_refused() {
        let axis = UnitAxis::new([0.6, 0.0, 0.8]).unwrap();
        let around = Arc { centre: [1.0, 0.0, 0.0], plane: Plane::Xy, clockwise: true, turns: 0 };
        let moves = vec![Move::rapid([0.0; 3]), Move::feed([2.0, 0.0, 0.0], 1.0).arc(around).with_axis(axis)];
        assert_eq!(text(moves).unwrap_err(), PathTextError::Axis { number: 2 });
        let error = text(vec![Move::feed([0.0; 3], 1.0).with_feed(0.1, FeedMode::PerRevolution)]).unwrap_err();
        assert_eq!(error, PathTextError::FeedMode { number: 1 });
        let arc = Arc { centre: [1.0, 0.0, 0.0], plane: Plane::Xy, clockwise: true, turns: 0 };
        let error = text(vec![Move::feed([2.0, 0.0, 0.0], 1.0).arc(arc)]).unwrap_err();
        assert_eq!(error, PathTextError::Start { number: 1 });
    }
}
