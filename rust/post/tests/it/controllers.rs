//! What one controller writes in its own path: holes that are called, times, points, ends.

use crate::support::{change, event, feed, program, rapid, spindle, stylus};
use styluscam_motion::{Cycle, CycleKind, CycleStart, CycleStep, EventKind, Program, SpindleDirection};
use styluscam_post::machine::{FeedMode, OptionValue};
use styluscam_post::{difference, post, read, read_path, try_out, Machine, PathSection, PostError, ReadFault};

fn machine(name: &str) -> Machine {
    Machine::shipped(name).unwrap()
}

/// Two holes of a kind, from Z 10, down from 2 to -6; the spindle turns at 500.
fn holes(kind: CycleKind, peck: f64, dwell: f64, lift: bool) -> Program {
    let mut work = program(vec![rapid(0.0, 0.0, 10.0)], vec![change(0, 0), spindle(0, 500.0)], vec![stylus(1)]);
    let turning = Some((500.0, SpindleDirection::Clockwise));
    for x in [0.0, 8.0] {
        let position = work.moves.last().unwrap().end.tip;
        let leave = if lift { position[2] } else { 2.0 };
        let first = work.moves.len();
        let hole =
            Cycle { first, count: 0, kind, at: [x, 15.0], retract: 2.0, bottom: -6.0, leave, feed: 150.0, dwell, peck };
        for step in hole.steps(&CycleStart { position, spindle: turning }).unwrap() {
            match step {
                CycleStep::Move(styluscam_motion::MoveKind::Rapid, [x, y, z]) => work.moves.push(rapid(x, y, z)),
                CycleStep::Move(_, [x, y, z]) => work.moves.push(feed(x, y, z, 150.0)),
                CycleStep::Event(kind) => work.events.push(event(work.moves.len(), kind)),
            }
        }
        let count = work.moves.len() - first;
        work.cycles.push(Cycle { count, ..hole });
    }
    work.moves.push(rapid(20.0, 0.0, 10.0));
    work.events.push(event(work.moves.len(), EventKind::SpindleOff));
    work
}

/// The text between the spindle's start and the last rapid, which must read back as what it was made from.
fn text_of(work: &Program, name: &str) -> Vec<String> {
    let machine = machine(name);
    let posted = post(work, &machine).unwrap();
    let reading = read(&posted.text, &machine, &work.tools).unwrap_or_else(|e| panic!("{e}\n{}", posted.text));
    assert_eq!(difference(work, &posted, &reading, &machine), None, "{}", posted.text);
    assert_eq!(reading.program.cycles.len(), work.cycles.len());
    let lines: Vec<&str> = posted.text.lines().map(without_number).collect();
    let first = lines.iter().position(|line| line.contains("M3")).unwrap() + 1;
    let last = lines.iter().rposition(|line| line.contains("20")).unwrap();
    lines[first..last].iter().filter(|line| !line.starts_with(';')).map(|line| (*line).to_owned()).collect()
}

fn without_number(line: &str) -> &str {
    match line.split_once(' ') {
        Some((number, rest)) if number.bytes().all(|b| b.is_ascii_digit()) && !number.is_empty() => rest,
        _ => line,
    }
}

#[test]
fn sinumerik_calls_a_cycle_at_places() {
    let drilled = text_of(&holes(CycleKind::Drill, 0.0, 0.0, true), "siemens");
    let expected =
        ["G0 Z10", "X0 Y0", "F150", "MCALL CYCLE81(10,2,0,-6)", "G0 X0 Y15", "X8 Y15", "MCALL"].map(String::from);
    assert_eq!(drilled, expected);
    let called = |work: &Program| text_of(work, "siemens").into_iter().find(|l| l.starts_with("MCALL C")).unwrap();
    assert_eq!(called(&holes(CycleKind::Drill, 0.0, 0.5, false)), "MCALL CYCLE82(2,2,0,-6,,0.5)");
    assert_eq!(called(&holes(CycleKind::Peck, 3.0, 0.0, true)), "MCALL CYCLE83(10,2,0,-6,,-1,,0,0,0,1,1)");
    assert_eq!(called(&holes(CycleKind::ChipBreak, 3.0, 0.0, true)), "MCALL CYCLE83(10,2,0,-6,,-1,,0,0,0,1,0)");
    assert_eq!(called(&holes(CycleKind::Tap, 0.0, 0.0, true)), "MCALL CYCLE84(10,2,0,-6,,0,3,,0.3,0,500,500)");
}

#[test]
fn klartext_defines_a_cycle_and_calls_it() {
    let drilled = text_of(&holes(CycleKind::Drill, 0.0, 0.0, true), "heidenhain");
    let expected = [
        "L Z+10 R0 FMAX",
        "L X+0 Y+0 R0 FMAX",
        "CYCL DEF 200 DRILLING ~",
        "  Q200=+0.25 ;SET-UP CLEARANCE ~",
        "  Q201=-7.75 ;DEPTH ~",
        "  Q206=150 ;FEED RATE FOR PLNGNG ~",
        "  Q202=+7.75 ;PLUNGING DEPTH ~",
        "  Q210=+0 ;DWELL TIME AT TOP ~",
        "  Q203=+1.75 ;SURFACE COORDINATE ~",
        "  Q204=+8.25 ;2ND SET-UP CLEARANCE ~",
        "  Q211=0 ;DWELL TIME AT DEPTH",
        "L X+0 Y+15 R0 FMAX M99",
        "L X+8 Y+15 R0 FMAX M99",
        "L Z+10 R0 FMAX",
    ];
    assert_eq!(drilled[..drilled.len()], expected[..drilled.len()]);
    let tapped = text_of(&holes(CycleKind::Tap, 0.0, 0.0, true), "heidenhain");
    assert!(tapped.contains(&"  Q239=+0.3 ;PITCH ~".to_owned()), "{tapped:?}");
    assert_eq!(tapped.last().map(String::as_str), Some("M3"), "the spindle is started again");
    text_of(&holes(CycleKind::Peck, 3.0, 0.0, false), "heidenhain");
    text_of(&holes(CycleKind::ChipBreak, 3.0, 0.0, true), "heidenhain");
}

fn fault(name: &str, lines: &str) -> ReadFault {
    let head = match name {
        "siemens" => "G710 G90 G94 G17 G40\nG54\nCYCLE832(0.001,1,1)\nT1\nM6\nD1\nS500 M3\nG0 Z10\nX0 Y0\n",
        "heidenhain" => "0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S500\n2 M3\n3 L Z+10 R0 FMAX\n4 L X+0 Y+0 R0 FMAX\n",
        _ => "G21 G90 G94 G17 G40 G49 G80\nG54\nT1 M6\nS500 M3\nG0 G43 Z10. H1\nX0. Y0.\n",
    };
    let end = if name == "heidenhain" { "M30\nEND PGM A MM\n" } else { "M30\n" };
    read(&format!("{head}{lines}\n{end}"), &machine(name), &[]).expect_err(lines).fault
}

#[test]
fn calls_that_are_not_understood() {
    let not_read = |lines: &str| assert!(matches!(fault("siemens", lines), ReadFault::NotRead { .. }), "{lines}");
    not_read("F100\nMCALL CYCLE81(10,2,0,-6)\nG1 X5 Y5"); // no rapid
    not_read("F100\nMCALL CYCLE81(10,2,0,-6)\nG0 X5 Z5"); // not across
    not_read("F100\nMCALL CYCLE83(10,2,0,-6,,-1,,0.5,0,0,1,1)\nG0 X5"); // degression
    not_read("MCALL POCKET3(1,2)\nG0 X5");
    not_read("MCALL CYCLE84(10,2,0,-6,,0,3,,0.3,0,400,500)\nG0 X5"); // two speeds
    assert!(matches!(fault("siemens", "F100\nMCALL CYCLE81(1,2,0,-6)\nG0 X5"), ReadFault::CycleUpwards));
    assert!(matches!(
        fault("siemens", "MCALL CYCLE84(10,2,0,-6,,0,3,,0.3,0,400,400)\nG0 X5"),
        ReadFault::NoRevolutions
    ));
    assert!(matches!(fault("siemens", "X5 MCALL"), ReadFault::StrayWord));
    assert!(matches!(fault("heidenhain", "L X+5 R0 FMAX M99"), ReadFault::MissingWord { .. }));
    let cycle = "CYCL DEF 200 ~\nQ200=2 ~\nQ201=-8 ~\nQ206=100 ~\nQ202=8 ~\nQ203=0 ~\nQ204=5";
    assert!(matches!(fault("heidenhain", &format!("{cycle} ~\nQ395=1")), ReadFault::NotRead { .. }));
    assert!(matches!(fault("heidenhain", &format!("{cycle} ~\nQ204=5")), ReadFault::WordTwice));
    assert!(matches!(fault("heidenhain", &format!("{cycle} ~\nL X+5 R0 FMAX M99")), ReadFault::UnknownWords));
    assert!(matches!(fault("heidenhain", "CYCL DEF 200"), ReadFault::MissingWord { .. }));
}

#[test]
fn a_cycle_by_hand() {
    let text = "0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S500\n2 M3\n3 L Z+10 R0 FMAX\n4 L X+0 Y+0 R0 FMAX\n\
        5 CYCL DEF 200 DRILLING ~\nQ200=2 ;A ~\nQ201=-8 ~\nQ206=100 ~\nQ202=3 ~\nQ210=0 ~\nQ203=+0 ~\nQ204=+50 ~\nQ211=0.2\n\
        6 L X+5 Y+5 R0 FMAX\n7 CYCL CALL\n8 M30\n9 END PGM A MM\n";
    let cycle = read(text, &machine("heidenhain"), &[]).unwrap().program.cycles.remove(0);
    assert_eq!((cycle.kind, cycle.retract, cycle.bottom, cycle.leave), (CycleKind::Peck, 2.0, -8.0, 50.0));
    assert_eq!((cycle.peck, cycle.dwell, cycle.feed), (3.0, 0.2, 100.0));
}

#[test]
fn numbers_without_a_point_may_be_increments() {
    for line in ["G1 X10 F100.", "G1 X10. F100", "G98 G81 X1. Y1. Z-5 R2. F100.", "G2 X10. Y0. I5 F100."] {
        assert!(matches!(fault("fanuc", line), ReadFault::NoPoint), "{line}");
    }
    assert!(matches!(fault("fanuc", "G4 P500."), ReadFault::PointInTime));
    assert!(read("G21 G90 G54 T1 M6\nG0 G43 Z0 H1\nX0 Y0\nM30\n", &machine("fanuc"), &[]).is_ok(), "0 is 0");
}

#[test]
fn words_that_a_cycle_has_no_use_for() {
    for line in [
        "G98 G83 X1. Y1. Z-5. R2. Q1. P500 F100.",
        "G98 G81 X1. Y1. Z-5. R2. Q1. F100.",
        "G98 G81 X1. Y1. Z-5. R2. P500 F100.",
    ] {
        assert!(matches!(fault("fanuc", line), ReadFault::NotRead { .. }), "{line}");
    }
}

#[test]
fn a_tool_call_does_not_turn_the_spindle_on() {
    let text = "0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S500\n2 M3\n3 L Z+10 R0 FMAX\n4 L X+0 Y+0 R0 FMAX\n\
        5 TOOL CALL 2 Z S2000\n6 L Z+5 R0 FMAX\n7 M30\n8 END PGM A MM\n";
    let events = read(text, &machine("heidenhain"), &[]).unwrap().program.events;
    let starts = events.iter().filter(|e| matches!(e.kind, EventKind::SpindleOn { .. })).count();
    assert_eq!(starts, 1);
}

#[test]
fn what_still_runs_at_the_end_is_switched_off() {
    let events = vec![change(0, 0), spindle(0, 500.0), event(0, EventKind::Flood { on: true })];
    let work = program(vec![rapid(0.0, 0.0, 10.0)], events, vec![stylus(1)]);
    let text = post(&work, &machine("marlin")).unwrap().text;
    assert!(text.trim_end().ends_with("M9\nM5"), "{text}");
}

#[test]
fn a_wait_is_in_seconds_whatever_feeds_are() {
    let mut haas = machine("haas");
    haas.set_option("feed_mode", OptionValue::Text("per-revolution".into())).unwrap();
    assert_eq!(haas.feed.mode, FeedMode::PerRevolution);
    let moves = vec![rapid(0.0, 0.0, 10.0), feed(0.0, 0.0, 5.0, 100.0), feed(1.0, 0.0, 5.0, 100.0)];
    let events = vec![change(0, 0), spindle(0, 500.0), event(2, EventKind::Dwell { seconds: 0.5 })];
    let work = program(moves, events, vec![stylus(1)]);
    let posted = post(&work, &haas).unwrap();
    assert!(posted.text.contains("G94 G4 P500\nG95\nX1. F0.2"), "{}", posted.text);
    let reading = read(&posted.text, &haas, &work.tools).unwrap();
    assert_eq!(difference(&work, &posted, &reading, &haas), None);
}

#[test]
fn a_hole_with_something_else_on_its_way_is_made_of_moves() {
    let mut work = holes(CycleKind::Drill, 0.0, 0.0, true);
    let middle = work.cycles[0].first + 1;
    work.events.push(event(middle, EventKind::Flood { on: true }));
    work.events.sort_by_key(|event| event.before);
    let text = post(&work, &machine("fanuc")).unwrap().text;
    assert!(text.contains("M8") && text.matches("G81").count() == 1, "{text}");
    let mut tapped = holes(CycleKind::Tap, 0.0, 0.0, true);
    let middle = tapped.cycles[0].first + 1;
    tapped.events.push(event(middle, EventKind::Flood { on: true }));
    tapped.events.sort_by_key(|event| event.before);
    assert!(matches!(post(&tapped, &machine("fanuc")), Err(PostError::TapMoves { .. })));
}

#[test]
fn a_spindle_has_a_slowest_speed() {
    let mut slow = machine("haas");
    slow.limits.min_rpm = Some(600.0);
    let work = program(vec![rapid(0.0, 0.0, 1.0)], vec![change(0, 0), spindle(0, 500.0)], vec![stylus(1)]);
    assert!(matches!(post(&work, &slow), Err(PostError::SpindleSpeed { min: 600.0, .. })));
}

#[test]
fn a_space_ends_no_number() {
    for line in ["X1 0.", "X1. 5", "X-1 .5"] {
        assert!(matches!(fault("linuxcnc", line), ReadFault::SpaceInNumber), "{line}");
    }
}

#[test]
fn the_path_mode_of_freecad_is_not_handed_on() {
    let text = "M6 T1\nM3 S500\nG0 Z5\nG64 P0.01\nG0 X1 Y1\n".to_owned();
    let section = PathSection { label: "own".into(), kind: Some("custom".into()), text, coolant: None };
    let setup = program(Vec::new(), Vec::new(), Vec::new()).setup;
    let work = read_path(&[section], &[stylus(1)], setup).unwrap();
    let heidenhain = post(&work, &machine("heidenhain")).unwrap().text;
    assert!(!heidenhain.contains("G64 P") && heidenhain.contains("; G64 left out"), "{heidenhain}");
}

#[test]
fn a_hole_is_reached_from_the_height_where_the_tool_stands() {
    let text = "0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S500\n2 M3\n3 L Z+100 R0 FMAX\n4 L X+0 Y+0 R0 FMAX\n\
        5 CYCL DEF 200 ~\nQ200=2 ~\nQ201=-6 ~\nQ206=100 ~\nQ202=6 ~\nQ203=+0 ~\nQ204=+10\n6 L X+10 R0 FMAX M99\n\
        7 L Z+100 R0 FMAX\n8 L X+50 R0 FMAX M99\n9 L Z+100 R0 FMAX\n10 M30\n11 END PGM A MM\n";
    let mut work = read(text, &machine("heidenhain"), &[]).unwrap().program;
    work.tools[0].reference_height = 0.0;
    for name in ["fanuc", "linuxcnc", "siemens", "heidenhain", "grbl"] {
        let controller = machine(name);
        let posted = post(&work, &controller).unwrap();
        let reading = read(&posted.text, &controller, &work.tools).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(difference(&work, &posted, &reading, &controller), None, "{}", posted.text);
        let mut from = [0.0; 3];
        for step in &reading.program.moves {
            let across = step.kind == styluscam_motion::MoveKind::Rapid && (step.end.tip[0] - from[0]).abs() > 1.0;
            assert!(!across || step.end.tip[2] > 99.0, "{name} crosses at {:?}\n{}", step.end.tip, posted.text);
            from = step.end.tip;
        }
    }
}

#[test]
fn what_stands_between_holes_is_said() {
    let counter = EventKind::SpindleOn { rpm: 500.0, direction: SpindleDirection::Counterclockwise };
    let mut work = holes(CycleKind::Drill, 0.0, 0.0, true);
    work.events.insert(2, event(work.cycles[1].first, counter));
    assert!(post(&work, &machine("fanuc")).unwrap().text.contains("S500 M4"));
    let faster = EventKind::SpindleOn { rpm: 900.0, direction: SpindleDirection::Clockwise };
    let mut work = holes(CycleKind::Drill, 0.0, 0.0, true);
    work.events.insert(2, event(work.cycles[0].first + 1, faster));
    let text = post(&work, &machine("fanuc")).unwrap().text;
    assert!(text.contains("S900 M3") && text.matches("G81").count() == 1, "{text}");
}

#[test]
fn a_cycle_that_its_moves_do_not_make_is_made_of_them() {
    for change in [
        (|c: &mut Cycle| c.feed = 5000.0) as fn(&mut Cycle),
        |c| c.retract = -5.5,
        |c| c.dwell = 4.0,
        |c| c.kind = CycleKind::Bore,
    ] {
        let mut work = holes(CycleKind::Drill, 0.0, 0.0, true);
        change(&mut work.cycles[0]);
        let text = post(&work, &machine("fanuc")).unwrap().text;
        assert!(text.contains("G1 Z-6. F150.") && text.matches("G81").count() == 1, "{text}");
    }
}

#[test]
fn a_stop_that_stops_the_spindle_too() {
    let mut work = holes(CycleKind::Drill, 0.0, 0.0, true);
    work.moves.push(feed(20.0, 0.0, 5.0, 100.0));
    let last = work.moves.len() - 1;
    work.events.insert(work.events.len() - 1, event(last, EventKind::Stop { optional: true }));
    work.events.last_mut().unwrap().before = last + 1;
    let posted = post(&work, &machine("heidenhain")).unwrap();
    let lines: Vec<&str> = posted.text.lines().map(without_number).collect();
    let stop = lines.iter().position(|line| *line == "M1").unwrap();
    assert_eq!(lines[stop + 1], "M3");
    assert!(matches!(fault("heidenhain", "M1\nL Z-1 R0 F100"), ReadFault::Halted));
}

#[test]
fn a_stop_of_the_spindle_comes_behind_the_move_of_its_block() {
    let text = "0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S500\n2 M3\n3 L Z+10 R0 FMAX\n4 L X+0 Y+0 R0 FMAX\n\
        5 L X+5 R0 F100 M5\n6 M30\n7 END PGM A MM\n";
    let work = read(text, &machine("heidenhain"), &[]).unwrap().program;
    let off = work.events.iter().find(|e| e.kind == EventKind::SpindleOff).unwrap();
    assert_eq!(off.before, work.moves.len());
    let first = read("G21 G90 G94 S500 M3\nG0 Z1\nX0 Y0\nG1 X5 F100 M5\nM2\n", &machine("grbl"), &[]).unwrap().program;
    let off = first.events.iter().find(|e| e.kind == EventKind::SpindleOff).unwrap();
    assert_eq!(off.before, first.moves.len() - 1);
}

#[test]
fn templates_that_move_or_stop_fail_their_trial() {
    let tried = |toml: &str| try_out(&Machine::from_toml(&format!("schema = 1\nname = \"x\"\n{toml}")).unwrap());
    for (base, key, text) in [
        ("grbl", "operation_start", "G0 Z-50"),
        ("linuxcnc", "operation_start", "G0 X999"),
        ("linuxcnc", "operation_start", "M5"),
        ("linuxcnc", "operation_start", "S20"),
        ("linuxcnc", "operation_start", "M9"),
        ("linuxcnc", "operation_start", "G18"),
        ("fanuc", "operation_end", "G91 G28 Z0.\\nG90"),
        ("fanuc", "operation_end", "M9\\nM5"),
        ("grbl", "work_offset", "G0 Z-100\\n{{ wcs }}"),
        ("fanuc", "work_offset", "{{ wcs }}\\nM5"),
    ] {
        let error = tried(&format!("extends = \"{base}\"\n[templates]\n{key} = \"{text}\"\n"));
        assert!(error.is_err(), "{base} {key} {text}");
    }
    let wash = "extends = \"grbl\"\n[templates]\nprogram_end = \"{% if options.wash %}G0 Z-50\\n{% endif %}M2\"\n[options.wash]\ndescription = \"wash\"\nvalue = false\n";
    assert!(tried(wash).is_err(), "an option that moves the tool");
}

#[test]
fn work_offsets_and_their_words_go_together() {
    let file = |toml: &str| Machine::from_toml(&format!("schema = 1\nname = \"x\"\nextends = \"siemens\"\n{toml}"));
    assert!(file("wcs = [\"G54\"]\nwcs_words = [\"G54\", \"G55\"]").is_err());
    let two = file("wcs = [\"G55\", \"G56\"]").unwrap();
    let mut work = holes(CycleKind::Drill, 0.0, 0.0, true);
    work.setup.wcs = "G55".into();
    assert!(post(&work, &two).unwrap().text.contains("\nG55\n"));
}

#[test]
fn a_first_line_that_names_the_program() {
    let toml = "schema = 1\nname = \"fagor\"\nextends = \"linuxcnc\"\n[dwell]\nword = \"K\"\n[reader]\nhead = \"%\"\n\
        [templates]\nprogram_start = \"%PART,MX,\\n{{ header }}\\n{{ units_word }} G90 {{ feed_word }} G17 G40 G49 G80\\n{{ wcs }}\\n{{ smoothing }}\"\n";
    let fagor = Machine::from_toml(toml).unwrap();
    try_out(&fagor).unwrap();
    let mut work = holes(CycleKind::Drill, 0.0, 0.0, true);
    work.events.insert(2, event(1, EventKind::Dwell { seconds: 0.5 }));
    let text = post(&work, &fagor).unwrap().text;
    assert!(text.starts_with("%PART,MX,\n") && text.contains("G4 K0.5"), "{text}");
}
