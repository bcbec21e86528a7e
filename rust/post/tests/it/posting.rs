//! What is posted, word by word, and every reason for not posting.

use crate::support::{ball_by_center, change, cone, event, feed, grbl, linuxcnc, program, rapid, spindle, stylus};
use styluscam_motion::{EventKind, FeedMode, Program, SpindleDirection, UnitAxis};
use styluscam_post::machine::{
    BlockNumber, CommentForm, Counted, LengthUnit, LineEnd, Point, Separator, TimeUnit, TrailingZeros,
};
use styluscam_post::{cl_text, post, Machine, PostError};

fn code_lines(program: &Program, machine: &Machine) -> Vec<String> {
    let text = post(program, machine).unwrap().text;
    text.lines().filter(|l| !l.starts_with(['(', ';'])).map(String::from).collect()
}

fn refusal(program: &Program, machine: &Machine) -> PostError {
    let error = post(program, machine).unwrap_err();
    assert!(!error.hint().is_empty() && !error.location().is_empty() && !error.code().is_empty(), "{error}");
    error
}

#[test]
fn linuxcnc_code() {
    let expected = [
        "G21 G90 G94 G17 G40 G49 G80",
        "G54",
        "G64 P0.001 Q0",
        "T1 M6",
        "G43 H1",
        "G0 Z10",
        "X10 Y-5",
        "Z1",
        "G1 Z-0.5 F100",
        "X20.125 F1500",
        "Y7.5",
        "G0 Z10",
        "M2",
    ];
    assert_eq!(code_lines(&cone(), &linuxcnc()), expected);
}

#[test]
fn grbl_code() {
    let expected = [
        "G21 G90 G94 G17 G40 G49 G80",
        "G54",
        "T1",
        "G0 Z10",
        "X10 Y-5",
        "Z1",
        "G1 Z-0.5 F100",
        "X20.125 F1500",
        "Y7.5",
        "G0 Z10",
        "M2",
    ];
    assert_eq!(code_lines(&cone(), &grbl()), expected);
}

#[test]
fn the_header_says_what_a_person_checks() {
    let text = post(&cone(), &linuxcnc()).unwrap().text;
    for part in [
        "(cone, first side)",
        "(machine: linuxcnc, units: mm",
        "work offset G54, zero: sheet top",
        "X -50 to 50",
        "Z -20 to 0",
        "deepest Z of a tip: -0.5",
        "tool T1 H1: clothoid D10, Z is its tip",
        "60 deg",
        "[M6 screws]",
    ] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
}

#[test]
fn inches() {
    let mut machine = linuxcnc();
    machine.units.output = LengthUnit::Inch;
    let lines = code_lines(&cone(), &machine);
    assert!(lines.contains(&"G20 G90 G94 G17 G40 G49 G80".to_string()));
    assert!(lines.contains(&"G64 P0.000039 Q0".to_string()), "rounded down: {lines:?}");
    assert!(lines.contains(&"G1 Z-0.0197 F3.94".to_string()), "{lines:?}");
    let text = post(&cone(), &machine).unwrap().text;
    assert!(text.contains("units: inch and inch/min") && text.contains("Z -0.7874 to 0"), "{text}");
}

#[test]
fn a_center_is_posted_above_its_tip() {
    let mut program = cone();
    program.tools = vec![ball_by_center(1, 3.0)];
    let lines = code_lines(&program, &linuxcnc());
    assert!(lines.contains(&"G0 Z13".to_string()) && lines.contains(&"G1 Z2.5 F100".to_string()), "{lines:?}");
    assert!(post(&program, &linuxcnc()).unwrap().text.contains("Z is its center, 3 above the tip"));
}

#[test]
fn rapids_take_the_higher_way() {
    let moves = vec![rapid(0.0, 0.0, 5.0), rapid(9.0, 0.0, 1.0), rapid(0.0, 4.0, 8.0), rapid(1.0, 1.0, 8.0)];
    let lines = code_lines(&program(moves, vec![change(0, 0)], vec![stylus(1)]), &grbl());
    assert_eq!(lines[3..9], ["G0 Z5", "X0 Y0", "X9", "Z1", "Z8", "X0 Y4"]);
    assert_eq!(lines[9], "X1 Y1");
}

#[test]
fn a_tool_change_starts_anew_and_stops_the_spindle() {
    let moves = vec![rapid(0.0, 0.0, 5.0), feed(1.0, 0.0, 5.0, 50.0), rapid(1.0, 0.0, 5.0), feed(2.0, 0.0, 5.0, 50.0)];
    let events = vec![change(0, 0), spindle(0, 3000.0), change(2, 1)];
    let lines = code_lines(&program(moves, events, vec![stylus(1), stylus(2)]), &linuxcnc());
    let expected =
        ["S3000 M3", "G0 Z5", "X0 Y0", "G1 X1 F50", "M5", "T2 M6", "G43 H2", "G0 Z5", "X1 Y0", "G1 X2 F50", "M2"];
    assert_eq!(lines[5..], expected);
}

#[test]
fn moves_that_round_to_nothing_are_left_out_and_their_feed_with_them() {
    let moves = vec![
        rapid(0.0, 0.0, 0.0),
        feed(0.0004, 0.0, 0.0, 100.0),
        feed(-0.0004, 0.0, 0.0, 200.0),
        feed(1.0, 0.0, -0.0004, 200.0),
        feed(2.0, 0.0, 0.0, 200.0),
    ];
    let events = vec![change(0, 0), event(1, EventKind::Flood { on: true })];
    let program = program(moves, events, vec![stylus(1)]);
    let posted = post(&program, &grbl()).unwrap();
    let lines: Vec<&str> = posted.text.lines().collect();
    let of_move: Vec<&str> = posted.line_of_move.iter().map(|l| lines[*l as usize - 1]).collect();
    assert_eq!(of_move, ["X0 Y0", "X0 Y0", "X0 Y0", "G1 X1 F200", "X2"]);
}

#[test]
fn a_feed_holds_through_rapids_and_is_said_again_after_templates() {
    let mut moves =
        vec![rapid(0.0, 0.0, 0.0), feed(1.0, 0.0, 0.0, 200.0), rapid(2.0, 0.0, 0.0), feed(3.0, 0.0, 0.0, 200.0)];
    moves.push(feed(4.0, 0.0, 0.0, 200.0));
    moves[4].operation = 1;
    let mut program = program(moves, vec![change(0, 0)], vec![stylus(1)]);
    program.operations.push(program.operations[0].clone());
    assert_eq!(code_lines(&program, &grbl())[5..9], ["G1 X1 F200", "G0 X2", "G1 X3", "G1 X4 F200"]);
}

#[test]
fn events_are_words() {
    let mut program = cone();
    let off = |before| event(before, EventKind::SpindleOff);
    program.events.extend([
        event(1, EventKind::SpindleOn { rpm: 1200.4, direction: SpindleDirection::Counterclockwise }),
        event(1, EventKind::Flood { on: true }),
        event(2, EventKind::Dwell { seconds: 1.5 }),
        event(2, EventKind::Flood { on: false }),
        off(6),
    ]);
    let lines = code_lines(&program, &linuxcnc());
    for word in ["S1200 M4", "M8", "G4 P1.5", "M9", "M5"] {
        assert!(lines.contains(&word.to_string()), "{word} is not in {lines:?}");
    }
    let mut machine = linuxcnc();
    machine.dwell.as_mut().unwrap().unit = TimeUnit::Ms;
    assert!(code_lines(&program, &machine).contains(&"G4 P1500".to_string()));
}

#[test]
fn styles_of_other_controllers() {
    let mut machine = linuxcnc();
    machine.number.point = Point::Always;
    machine.words.separator = Separator::None;
    machine.block_number = Some(BlockNumber::plain(5, 5, 20));
    machine.line.eol = LineEnd::Crlf;
    machine.comment.form = CommentForm::None;
    let text = post(&cone(), &machine).unwrap().text;
    assert!(text.starts_with("N5G21 G90 G94"), "{text}");
    assert!(text.contains("\r\nN10G0Z10.\r\nN15X10.Y-5.\r\nN20Z1.\r\nN5G1Z-0.5F100.\r\n"), "{text}");
    machine.number.trailing_zeros = TrailingZeros::Keep;
    machine.number.plus_sign = true;
    machine.number.leading_zero = false;
    let text = post(&cone(), &machine).unwrap().text;
    assert!(text.contains("G1Z-.500F100.0"), "{text}");
}

#[test]
fn comments_are_cleaned_wrapped_and_never_orders() {
    let mut program = cone();
    let long = format!("{} {}", "x".repeat(100), "nine nine ".repeat(30));
    let texts = ["(a) {b} ; 100% sure? go!~ $H\nG0 Z-99 \u{1}\u{7f}€", "MSG, halt", "debug,#1", &long];
    program.events.extend(texts.map(|t| event(6, EventKind::Comment { text: t.into() })));
    let text = post(&program, &grbl()).unwrap().text;
    assert!(text.contains("([a] {b} , 100 percent sure_ go__ _H G0 Z-99 ___)\n"), "{text}");
    assert!(text.lines().all(|l| l.len() <= 72), "70 characters and the marks: {text}");
    let text = post(&program, &linuxcnc()).unwrap().text;
    assert!(text.contains("(-MSG, halt)") && text.contains("(-debug,#1)"), "{text}");
}

#[test]
fn an_exact_path() {
    let mut machine = linuxcnc();
    machine.smoothing.tolerance = 0.0;
    assert!(code_lines(&cone(), &machine).contains(&"G61".to_string()));
}

// Refusals

#[test]
fn a_program_without_moves() {
    assert_eq!(refusal(&program(vec![], vec![], vec![]), &linuxcnc()), PostError::Empty);
}

#[test]
fn a_machine_that_is_wrong() {
    let mut machine = linuxcnc();
    machine.number.mm.linear = 99;
    assert!(matches!(refusal(&cone(), &machine), PostError::Machine(_)));
}

#[test]
fn an_unknown_work_offset() {
    let mut program = cone();
    program.setup.wcs = "G59.1".into();
    assert!(post(&program, &linuxcnc()).is_ok());
    assert!(matches!(refusal(&program, &grbl()), PostError::Wcs { .. }));
}

#[test]
fn numbers_that_are_none() {
    for (value, index) in [(f64::NAN, 0), (f64::INFINITY, 1), (1e300, 2), (-1e14, 2)] {
        let mut program = cone();
        program.moves[3].end.tip[index] = value;
        assert!(matches!(refusal(&program, &linuxcnc()), PostError::Number { .. }));
    }
    let mut program = cone();
    program.tools[0].reference_height = f64::NAN;
    assert!(matches!(refusal(&program, &linuxcnc()), PostError::Number { .. }));
}

#[test]
fn feeds_out_of_range() {
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY, 0.04] {
        let mut program = cone();
        program.moves[2].feed = value;
        assert!(matches!(refusal(&program, &linuxcnc()), PostError::Feed { index: 2, .. }), "{value}");
    }
    let mut machine = linuxcnc();
    machine.limits.max_feed = Some(1000.0);
    assert!(matches!(refusal(&cone(), &machine), PostError::FeedTooHigh { index: 3, .. }));
}

#[test]
fn a_tool_axis_that_is_not_up() {
    let mut program = cone();
    let tilted = UnitAxis::new([0.6, 0.0, 0.8]).unwrap();
    assert!(!cl_text(&program).unwrap().contains("0.8"), "upright tools need no axis");
    program.moves[2] = program.moves[2].with_axis(tilted);
    assert!(matches!(refusal(&program, &linuxcnc()), PostError::ToolAxis { index: 2 }));
    let text = cl_text(&program).unwrap();
    let ends: Vec<_> = text.lines().filter_map(|line| line.strip_prefix("GOTO/")).collect();
    assert_eq!(ends.len(), program.moves.len());
    for (index, end) in ends.into_iter().enumerate() {
        assert!(end.ends_with(if index == 2 { ",0.6,0,0.8" } else { ",0,0,1" }), "{end}");
    }
}

#[test]
fn a_feed_that_is_not_per_minute() {
    for mode in [FeedMode::PerRevolution, FeedMode::InverseTime] {
        let mut program = cone();
        program.moves[2] = program.moves[2].with_feed(0.1, mode);
        assert!(matches!(refusal(&program, &linuxcnc()), PostError::FeedMode { index: 2 }));
        assert_eq!(cl_text(&program).unwrap_err().code(), "post-feed-mode");
    }
}

#[test]
fn places_out_of_range() {
    let mut machine = linuxcnc();
    machine.limits.z = Some([0.0, 20.0]);
    assert!(matches!(refusal(&cone(), &machine), PostError::AxisLimit { index: 2, axis: 'Z', .. }));
    let mut centered = cone();
    centered.tools = vec![ball_by_center(1, 3.0)];
    assert!(post(&centered, &machine).is_ok(), "the posted point counts, not the tip");
    machine.limits.z = None;
    machine.limits.travel = Some([300.0, 10.0, 80.0]);
    assert!(matches!(refusal(&cone(), &machine), PostError::Travel { axis: 'Y', .. }));
}

#[test]
fn records_and_orders_that_do_not_fit() {
    let mut program = cone();
    program.events = vec![change(1, 0), change(0, 0)];
    assert_eq!(refusal(&program, &linuxcnc()), PostError::EventOrder { event: 1 });
    program.events = vec![change(0, 0), change(7, 0)];
    assert_eq!(refusal(&program, &linuxcnc()), PostError::EventOrder { event: 1 });
    program.events = vec![change(0, 5)];
    assert!(matches!(refusal(&program, &linuxcnc()), PostError::NoSuchRecord { what: "tool", index: 5, .. }));
    let mut program = cone();
    program.moves[1].operation = 1;
    assert!(matches!(refusal(&program, &linuxcnc()), PostError::NoSuchRecord { what: "operation", .. }));
}

#[test]
fn motion_that_starts_nowhere() {
    let mut program = cone();
    program.events.clear();
    assert_eq!(refusal(&program, &linuxcnc()), PostError::NoTool { index: 0 });
    let mut program = cone();
    program.events = vec![change(0, 0), change(3, 0)];
    assert_eq!(refusal(&program, &linuxcnc()), PostError::FeedFromUnknown { index: 3 });
}

#[test]
fn tools_that_do_not_fit() {
    let mut program = cone();
    program.tools[0].number = 256;
    assert!(post(&program, &linuxcnc()).is_ok());
    assert_eq!(refusal(&program, &grbl()), PostError::ToolNumber { number: 256, max: 255 });
    program.tools[0].number = 0;
    assert!(matches!(refusal(&program, &grbl()), PostError::ToolNumber { number: 0, .. }));
    let mut program = cone();
    program.tools.push(ball_by_center(1, 3.0));
    assert!(matches!(refusal(&program, &linuxcnc()), PostError::ToolNumberTwice { number: 1, .. }));
    let moves = vec![rapid(0.0, 0.0, 5.0), rapid(1.0, 0.0, 5.0)];
    let two = crate::support::program(moves, vec![change(0, 0), change(1, 1)], vec![stylus(1), stylus(2)]);
    assert_eq!(refusal(&two, &grbl()), PostError::ToolChange { event: 1 });
    let pauses = code_lines(&two, &crate::support::grbl_with_pauses());
    assert_eq!(pauses[2..], ["T1", "G0 Z5", "X0 Y0", "T2", "M0", "G0 Z5", "X1 Y0", "M2"]);
}

#[test]
fn spindles_and_words_that_are_missing() {
    let mut program = cone();
    program.events.push(spindle(1, 9000.0));
    let mut machine = linuxcnc();
    machine.limits.max_rpm = Some(8000.0);
    assert!(matches!(refusal(&program, &machine), PostError::SpindleSpeed { .. }));
    for rpm in [-1.0, f64::NAN, f64::INFINITY, 1e300] {
        program.events[1] = spindle(1, rpm);
        assert!(matches!(refusal(&program, &linuxcnc()), PostError::SpindleSpeed { .. }));
    }
    program.events[1] = spindle(1, 100.0);
    machine = linuxcnc();
    machine.spindle.clockwise = None;
    assert!(matches!(refusal(&program, &machine), PostError::SpindleDirection { .. }));
    machine.coolant.flood = None;
    program.events[1] = event(1, EventKind::Flood { on: true });
    assert!(matches!(refusal(&program, &machine), PostError::Unsupported { .. }));
    machine.dwell = None;
    program.events[1] = event(1, EventKind::Dwell { seconds: 1.0 });
    assert!(matches!(refusal(&program, &machine), PostError::Unsupported { .. }));
    program.events[1] = event(1, EventKind::Dwell { seconds: -1.0 });
    assert!(matches!(refusal(&program, &linuxcnc()), PostError::Dwell { event: 1, .. }));
    program.events[1] = event(1, EventKind::Dwell { seconds: f64::NAN });
    assert!(matches!(refusal(&program, &linuxcnc()), PostError::Number { .. }));
}

#[test]
fn lines_that_the_machine_cannot_read() {
    let mut machine = grbl();
    machine.templates.program_end = format!("G4 P{}\nM2", "1".repeat(80));
    assert!(matches!(refusal(&cone(), &machine), PostError::LineTooLong { length: 83, max: 79, .. }));
    machine.templates.program_end = format!("M2 ({})", "1 ".repeat(80));
    assert!(post(&cone(), &machine).is_ok(), "comments do not count");
    machine.line.counted = Counted::All;
    assert!(matches!(refusal(&cone(), &machine), PostError::LineTooLong { .. }));
    machine.templates.program_end = "M2 (why?)".into();
    assert!(matches!(refusal(&cone(), &machine), PostError::Character { character: '?', .. }));
    machine.templates.program_end = "M2 (Ü)".into();
    assert!(matches!(refusal(&cone(), &machine), PostError::Character { character: 'Ü', .. }));
}

#[test]
fn templates_that_fail() {
    for (template, line) in [
        ("{{ end }}\n{{ nothing }}", 2),
        ("{% for i in range(100000) %}{% for j in range(100000) %}x{% endfor %}{% endfor %}", 1),
    ] {
        let mut machine = linuxcnc();
        machine.templates.program_end = template.into();
        match refusal(&cone(), &machine) {
            PostError::Machine(styluscam_post::MachineError::Template { name, line: found, .. }) => {
                assert_eq!((name.as_str(), found), ("templates.program_end", line));
            }
            other => panic!("{other}"),
        }
    }
}
