//! Machines with rotary axes: what is posted, what is refused, and what texts mean.

#![allow(clippy::single_range_in_vec_init)] // a run of moves

use crate::support::{ball_by_center, change, event, feed, rapid, spindle, stylus};
use styluscam_motion::{Cycle, CycleKind, Event, EventKind, Move, MoveKind, Program, ToolRecord, UnitAxis};
use styluscam_post::{post, post_to, read, Machine, PostError, ReadFault, Reading};

fn program(tools: Vec<ToolRecord>, moves: Vec<Move>, events: Vec<Event>) -> Program {
    crate::support::program(moves, events, tools)
}

fn fanuc() -> Machine {
    Machine::shipped("fanuc-five-axis").unwrap()
}

fn trunnion() -> Machine {
    Machine::shipped("linuxcnc-trunnion").unwrap()
}

/// Leaning by so much in the plane of Y and Z.
fn leaning(step: Move, degrees: f64) -> Move {
    let (sin, cos) = degrees.to_radians().sin_cos();
    step.with_axis(UnitAxis::new([0.0, sin, cos]).unwrap())
}

fn lines(program: &Program, machine: &Machine) -> Vec<String> {
    let text = post(program, machine).unwrap().text;
    let mut pieces = Vec::new();
    post_to(program, machine, &mut pieces).unwrap();
    assert_eq!(String::from_utf8(pieces).unwrap(), text);
    text.lines().filter(|line| !line.starts_with(['(', '%', 'O'])).map(String::from).collect()
}

/// Two tools, each along a line on which it leans more and more.
fn two_tools() -> Program {
    let path = || [leaning(rapid(0.0, 0.0, 30.0), 30.0), leaning(feed(0.0, 10.0, 0.0, 500.0), 30.0)];
    let moves = [path(), path()].concat();
    program(vec![stylus(1), stylus(2)], moves, vec![change(0, 0), spindle(0, 1000.0), change(2, 1)])
}

#[test]
fn tip_control_is_off_while_tools_are_changed() {
    let expected = [
        "G21",
        "G90 G94 G17 G40 G49 G80",
        "G54",
        "G91 G28 Z0.",
        "G90",
        "T1 M6",
        "T2",
        "S1000 M3",
        "G0 A30. C0.",
        "G43.4 H1",
        "G0 Z30.",
        "X0. Y0.",
        "G1 Y10. Z0. F500.",
        "M5",
        "G49",
        "G91 G28 Z0.",
        "G90",
        "T2 M6",
        "G0 A30. C0.",
        "G43.4 H2",
        "G0 Z30.",
        "X0. Y0.",
        "G1 Y10. Z0. F500.",
        "G49",
        "G91 G28 Z0.",
        "G90",
        "M30",
    ];
    assert_eq!(lines(&two_tools(), &fanuc()), expected);
}

#[test]
fn a_program_that_begins_with_a_hole_states_its_angles() {
    let (at, retract, bottom, leave) = ([5.0, 5.0], 2.0, -6.0, 10.0);
    let moves = vec![rapid(5.0, 5.0, 10.0), rapid(5.0, 5.0, 2.0), feed(5.0, 5.0, -6.0, 150.0), rapid(5.0, 5.0, 10.0)];
    let mut program = program(vec![stylus(1)], moves, vec![change(0, 0), spindle(0, 1000.0)]);
    let hole = Cycle {
        first: 0,
        count: 4,
        kind: CycleKind::Drill,
        at,
        retract,
        bottom,
        leave,
        feed: 150.0,
        dwell: 0.0,
        peck: 0.0,
    };
    program.cycles = vec![hole];
    let lines = lines(&program, &fanuc());
    let drilled = lines.iter().position(|line| line.contains("G81")).unwrap();
    assert!(lines[..drilled].contains(&"G0 A0. C0.".to_owned()), "{lines:?}");
    // and where the tool leans elsewhere it is made of moves
    program.moves.push(leaning(rapid(5.0, 5.0, 20.0), 20.0));
    let text = post(&program, &fanuc()).unwrap().text;
    assert!(!text.contains("G81") && text.contains("G1 Z-6. F150."), "{text}");
}

#[test]
fn what_a_leaning_tool_does_not_do_is_refused() {
    let refused = |program: &Program| match post(program, &fanuc()).unwrap_err() {
        PostError::Unsupported { what } => what,
        other => panic!("{other}"),
    };
    let mut by_center = two_tools();
    by_center.tools[1] = ball_by_center(2, 3.0);
    assert!(refused(&by_center).contains("at its tip"));
    let with = |kind: EventKind| {
        let mut program = two_tools();
        program.events.insert(2, event(1, kind));
        program
    };
    assert!(refused(&with(EventKind::WorkOffset { wcs: "G55".into() })).contains("work offset"));
    let touch = EventKind::Probe { end: [None, None, Some(1.0)], feed: 100.0, must_touch: true };
    assert!(refused(&with(touch)).contains("probing"));
    let mut tapping = two_tools();
    let (at, leave) = ([0.0, 10.0], 0.0);
    let tap = Cycle {
        first: 1,
        count: 1,
        kind: CycleKind::Tap,
        at,
        retract: 0.0,
        bottom: 0.0,
        leave,
        feed: 500.0,
        dwell: 0.0,
        peck: 0.0,
    };
    tapping.cycles = vec![tap];
    assert!(refused(&tapping).contains("tapping"));
}

#[test]
fn limits_are_those_of_the_linear_axes() {
    // a table turned by 30 deg about X carries Y100 up to Z50
    let path = vec![leaning(rapid(0.0, 100.0, 5.0), 30.0), leaning(feed(0.0, 110.0, 0.0, 500.0), 30.0)];
    let high = program(vec![stylus(1)], path, vec![change(0, 0)]);
    for mut machine in [fanuc(), trunnion()] {
        machine.limits.z = Some([-200.0, 55.0]);
        post(&high, &machine).unwrap();
        machine.limits.z = Some([-200.0, 54.0]);
        let error = post(&high, &machine).unwrap_err();
        assert!(matches!(error, PostError::AxisLimit { axis: 'Z', .. }), "{error}");
    }
    // the tip stays, the part turns under it by way of its highest: both ends are lower
    let turn = vec![leaning(rapid(0.0, 100.0, 50.0), -85.0), leaning(feed(0.0, 100.0, 50.0, 500.0), 85.0)];
    let turn = program(vec![stylus(1)], turn, vec![change(0, 0)]);
    let mut machine = fanuc();
    machine.limits.z = Some([-200.0, 105.0]);
    assert!(matches!(post(&turn, &machine).unwrap_err(), PostError::AxisLimit { axis: 'Z', index: 1, .. }));
}

#[test]
fn axes_without_an_angle_of_0_stand_as_they_can() {
    let mut machine = trunnion();
    machine.rotary.as_mut().unwrap().axes[1].limits_deg = [90.0, 180.0];
    let upright =
        program(vec![stylus(1)], vec![rapid(10.0, 0.0, 5.0), feed(20.0, 0.0, 0.0, 500.0)], vec![change(0, 0)]);
    let posted = post(&upright, &machine).unwrap();
    assert!(posted.text.contains("G0 A0 C90\nZ5\nX0 Y10\nG1 Y20 Z0 F"), "{}", posted.text);
    let reading = read(&posted.text, &machine, &upright.tools).unwrap();
    let last = reading.program.moves.last().unwrap();
    assert!((last.end.tip[0] - 20.0).abs() < 1e-9 && last.end.axis.is_up() && (last.feed - 500.0).abs() < 0.1);
}

fn reading(code: &str, machine: &Machine) -> Result<Reading, ReadFault> {
    read(&format!("T1 M6\nG21 G90 G17 G94 G43 H1\n{code}M2\n"), machine, &[]).map_err(|error| error.fault)
}

/// The trunnion with a control that can track the tip.
fn tracking() -> Machine {
    let toml = "extends = \"linuxcnc-trunnion\"\nname = \"tracking\"\n[rotary]\ntip_control = { on = \"M128\", off = \"M129\" }\n";
    Machine::from_toml(toml).unwrap()
}

fn near(found: [f64; 3], wanted: [f64; 3]) -> bool {
    found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-9)
}

#[test]
fn a_place_is_the_same_in_the_coordinates_of_the_machine_and_of_the_tip() {
    let code = "G0 A90 C0\nZ50\nX10 Y20\nG1 X11 F100\nM128\nG1 X12\nM129\nG1 Y21\n";
    let moves = reading(code, &tracking()).unwrap().program.moves;
    let tips: Vec<_> = moves.iter().map(|step| step.end.tip).collect();
    // Y of the machine is -Z of a part that is turned by 90 deg about X, Z is its Y
    for (tip, wanted) in
        tips[1..].iter().zip([[10.0, 50.0, -20.0], [11.0, 50.0, -20.0], [12.0, 50.0, -20.0], [12.0, 50.0, -21.0]])
    {
        assert!(near(*tip, wanted), "{tips:?}");
    }
    assert!(moves.iter().all(|step| near(step.end.axis.vector(), [0.0, 1.0, 0.0])));
}

#[test]
fn what_is_not_known_stays_unknown() {
    let machine = tracking();
    let unknown = |code: &str| {
        let reading = reading(code, &machine).unwrap();
        (reading.unknown_positions, reading.unknown_heights)
    };
    let start = "G0 A90 C0\nZ50\nX10 Y20\n";
    // turns before the first position are no moves: Z, X Y
    assert_eq!(unknown(start), (vec![0..1], vec![]));
    // nor do angles count that come after a position
    assert_eq!(unknown("G0 Z50\nA90 C0\nX10 Y20\n"), (vec![0..2], vec![0..1]));
    // a tool change moves Z; where the tip is tracked all of its coordinates
    assert_eq!(unknown(&format!("{start}T2 M6\nG43 H2\nG0 X20\nZ40\n")), (vec![0..1, 2..3], vec![2..3]));
    assert_eq!(unknown(&format!("{start}M128\nT2 M6\nG43 H2\nG0 X20\nZ40\nY5\n")), (vec![0..1, 2..4], vec![2..3]));
    // so does a move to the machine's own position
    assert_eq!(unknown(&format!("{start}M128\nG53 G0 Z0\nG0 Z40\nX20 Y5\n")), (vec![0..1, 2..3], vec![]));
    assert_eq!(unknown(&format!("{start}G53 G0 A0\nG0 X20\nA5\n")), (vec![0..1, 2..3], vec![2..3]));
    let fault = reading(&format!("{start}G53 G0 C0\nG1 X20 F100\n"), &machine).unwrap_err();
    assert_eq!(fault, ReadFault::FeedFromUnknown { axis: 'C' });
    let fault = reading("G0 Z50\nX0 Y0\nG1 A1 C1 F100\n", &machine).unwrap_err();
    assert_eq!(fault, ReadFault::FeedFromUnknown { axis: 'A' });
}

#[test]
fn one_line_is_as_many_moves_as_its_path_takes() {
    let code = "G0 A0 C0\nZ50\nX10 Y0\nM0\nG1 C90 F900\n(a remark)\nG0 X20\n";
    let reading = reading(code, &tracking()).unwrap();
    let moves = &reading.program.moves;
    let turning: Vec<_> = moves.iter().filter(|step| step.line == 7).collect();
    assert!(turning.len() > 100 && turning.iter().all(|step| step.kind == MoveKind::Feed));
    // 90 deg at 900 deg/min take a tenth of a minute
    let length = 10.0 * std::f64::consts::FRAC_PI_2;
    assert!(turning.iter().all(|step| (step.feed - 10.0 * length).abs() < 1e-3), "{}", turning[0].feed);
    let remark = reading
        .program
        .events
        .iter()
        .find(|event| matches!(&event.kind, EventKind::Comment { text } if text == "a remark"));
    assert_eq!((remark.unwrap().before, reading.stops.as_slice()), (moves.len() - 1, [2].as_slice()));
    assert!(near(moves.last().unwrap().end.tip, [0.0, -20.0, 50.0]));
}

#[test]
fn holes_of_a_turned_table_are_plain_moves() {
    let code = "G0 A90 C0\nZ50\nX10 Y20\nG81 X12 Y20 Z40 R48 F100\nG80\n";
    let machine = tracking();
    let drilled = reading(code, &machine).unwrap().program;
    assert!(drilled.cycles.is_empty());
    assert!(drilled.moves.iter().any(|step| step.kind == MoveKind::Feed && near(step.end.tip, [12.0, 40.0, -20.0])));
    let upright = reading(&code.replace("A90", "A0"), &machine).unwrap().program;
    assert_eq!(upright.cycles.len(), 1);
    let tracked = reading(&code.replace("G81", "M128\nG81"), &machine).unwrap_err();
    assert!(matches!(tracked, ReadFault::NotRead { .. }), "{tracked:?}");
}

#[test]
fn the_linear_axes_stand_elsewhere_than_the_tip() {
    let code = "G0 A90 C0\nZ50\nX10 Y20\nG1 X11 F100\nM128\nG1 A60 X12\n";
    let reading = reading(code, &tracking()).unwrap();
    let (axes, program) = (reading.axes.unwrap(), reading.program);
    assert_eq!(axes.moves.len(), program.moves.len());
    assert!(near(axes.moves[1].end.tip, [10.0, 20.0, 50.0]) && near(axes.moves[2].end.tip, [11.0, 20.0, 50.0]));
    // the part's Y50 Z-20 when it is turned by 60 deg
    let (sin, cos) = 60.0_f64.to_radians().sin_cos();
    let last = axes.moves.last().unwrap();
    assert!(near(last.end.tip, [12.0, 50.0 * cos + 20.0 * sin, 50.0 * sin - 20.0 * cos]), "{last:?}");
    assert!(near(program.moves.last().unwrap().end.tip, [12.0, 50.0, -20.0]) && program.moves.len() > 6);
}

#[test]
fn without_a_turn_they_are_one() {
    assert!(reading("G0 A0 C0\nZ50\nX10 Y20\nG1 X11 F100\n", &tracking()).unwrap().axes.is_none());
}
