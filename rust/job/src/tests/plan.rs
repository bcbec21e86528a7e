//! Plans with exact answers: heights, contacts, events, ends.

use std::collections::BTreeSet;

use styluscam_motion::{EventKind, MoveKind, Program, SpindleDirection};

use super::setup::{job, levels, milling, planned, with, LEVELS};
use crate::{JobError, MAIN_CHANNEL};

fn program(text: &str) -> Program {
    planned(&job(text)).unwrap_or_else(|error| panic!("{error}\n{text}")).channels.remove(MAIN_CHANNEL).unwrap().program
}

/// Heights of level feeds, highest first, mm in thousandths.
fn heights(program: &Program) -> Vec<i64> {
    let ends = program.moves.windows(2).filter(|pair| pair[1].kind == MoveKind::Feed);
    let level = ends.filter(|pair| pair[0].end.tip[2] == pair[1].end.tip[2]).map(|pair| pair[1].end.tip[2]);
    let found: BTreeSet<i64> = level.map(|z| (z * 1000.0).round() as i64).collect();
    found.into_iter().rev().collect()
}

#[test]
fn levels_lie_a_step_apart_below_the_top_and_down_to_the_table() {
    assert_eq!(heights(&program(&levels())), [3000, 2000, 1000, 0]);
    let between = milling(&format!("z_top = 3.5\nz_bottom = 1.0\n{LEVELS}"));
    assert_eq!(heights(&program(&between)), [2500, 1500, 1000]);
}

#[test]
fn a_ball_touches_the_walls_where_its_slope_is_theirs() {
    // centre of the ball R from the plane x + z = 10: the tip's x at a height is 10 - (z + R) + R sqrt 2
    let program = program(&levels());
    for z in [3.0, 2.0, 1.0, 0.0_f64] {
        let exact = 10.0 - (z + 1.5) + 1.5 * 2.0_f64.sqrt();
        let at_height = program.moves.iter().filter(|step| (step.end.tip[2] - z).abs() < 1e-9);
        let feeds = at_height.filter(|step| step.kind == MoveKind::Feed);
        let farthest = feeds.map(|step| step.end.tip[0]).fold(f64::NEG_INFINITY, f64::max);
        // a gouge of 0.001 mm is allowed, an excess of the tolerance, along the wall's normal
        let (least, most) = (exact - 0.001 * 2.0_f64.sqrt(), exact + 0.01 * 2.0_f64.sqrt());
        assert!((least..=most).contains(&farthest), "at {z}: {farthest}, exactly {exact}");
    }
}

#[test]
fn rapids_cross_at_the_clearance_height_and_end_there() {
    // two faces that do not touch each other: levels on one side of the part, then on the other
    let program = program(&milling(&format!("faces = [\"Face3\", \"Face5\"]\n{LEVELS}")));
    let crossing = program.moves.windows(2).filter(|pair| {
        let [from, to] = [pair[0].end.tip, pair[1].end.tip];
        pair[1].kind == MoveKind::Rapid && (from[0], from[1]) != (to[0], to[1])
    });
    assert!(crossing.clone().count() > 0);
    assert!(crossing.clone().all(|pair| pair[1].end.tip[2] == 14.0), "4 mm of the part and 10 of clearance");
    let ends = [program.moves.first().unwrap(), program.moves.last().unwrap()];
    assert_eq!(ends.map(|step| (step.kind, step.end.tip[2])), [(MoveKind::Rapid, 14.0); 2]);
}

#[test]
fn the_tool_is_changed_once_and_what_an_operation_switches_on_is_off_at_the_end() {
    let kinds = |text: &str| program(text).events.into_iter().map(|event| event.kind).collect::<Vec<_>>();
    let spindle = "spindle = { mode = \"fixed\", rpm = 9000.0 }\n";
    let turning = EventKind::SpindleOn { rpm: 9000.0, direction: SpindleDirection::Clockwise };
    let one = milling(&format!("{spindle}coolant = \"flood\"\n{LEVELS}"));
    let (change, flood) = (EventKind::ToolChange { tool: 0 }, |on: bool| EventKind::Flood { on });
    let expected = [change.clone(), turning.clone(), flood(true), EventKind::SpindleOff, flood(false)];
    assert_eq!(kinds(&one), expected);
    let two = format!("{one}\n[[operations]]\ntool = \"a\"\ntolerance = 0.01\n{spindle}{LEVELS}");
    let expected = [change, turning.clone(), flood(true), turning, flood(false), EventKind::SpindleOff];
    assert_eq!(kinds(&two), expected);
}

#[test]
fn a_tolerance_that_rounding_uses_up_is_an_error_that_names_the_operation() {
    let error = planned(&job(&with(&levels(), "tolerance = 0.01", "tolerance = 0.0005"))).expect_err("too fine");
    assert!(matches!(error, JobError::Plan { .. }), "{error}");
    assert_eq!(error.location(), "operations[0]");
    assert!(error.to_string().contains("0.0005"), "{error}");
}

#[test]
fn a_selection_above_the_lowest_height_reaches_nothing_and_that_is_an_error() {
    let error =
        planned(&job(&milling(&format!("z_top = -1.0\nz_bottom = -2.0\n{LEVELS}")))).expect_err("nothing there");
    assert!(matches!(error, JobError::Plan { .. }), "{error}");
    assert!(!error.hint().is_empty() || error.to_string().contains("z_"), "{error}");
}
