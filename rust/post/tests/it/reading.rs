//! What people write by hand, and every reason for not reading it.

#![allow(clippy::single_range_in_vec_init)] // a run of moves

use crate::support::{ball_by_center, grbl, linuxcnc, stylus};
use proptest::prelude::*;
use styluscam_motion::{EventKind, MoveKind, SpindleDirection, ToolRecord};
use styluscam_post::machine::{BlockDelete, LengthUnit, TimeUnit};
use styluscam_post::{read, Machine, ReadError, ReadFault, Reading};

fn reads(text: &str, machine: &Machine) -> Reading {
    read(text, machine, &[]).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn ends(text: &str, machine: &Machine) -> Vec<[f64; 3]> {
    reads(text, machine).program.moves.iter().map(|m| m.end.tip).collect()
}

fn refusal_with(text: &str, machine: &Machine, tools: &[ToolRecord]) -> ReadError {
    let error = read(text, machine, tools).expect_err(text);
    assert!(!error.hint().is_empty() && !error.location().is_empty() && !error.code().is_empty(), "{error}");
    error
}

fn refusal(text: &str, machine: &Machine) -> ReadFault {
    refusal_with(text, machine, &[]).fault
}

/// The fault of a line that follows a proper start.
fn fault(line: &str) -> ReadFault {
    let error = refusal_with(&format!("G21 G90\nG0 X0 Y0 Z5\n{line}\nM2\n"), &linuxcnc(), &[]);
    assert_eq!(error.line, 3, "{error}");
    error.fault
}

#[test]
fn a_program_by_hand() {
    let text = "%\n\
        (a plate) ; by hand\n\
        N10 g21 G90 g17 g40 g49 g80 g94 g54 g64 p0.01 q0.01\n\
        t3 m6 s1000 m3 m8\n\
        G0 Z5\n\
        g 0 x 10. y -2.5\n\
        G01 Z-1 F300\n\
        X20\n\
        G91 Y+.5 (half a step) G1\n\
        G90 G4 P0.5\n\
        G00Z5M5\n\
        M9\n\
        M30\n\
        anything [goes] here\n\
        %\n";
    let reading = reads(text, &linuxcnc());
    let program = &reading.program;
    let moves: Vec<_> = program.moves.iter().map(|m| (m.kind, m.end.tip, m.feed, m.line)).collect();
    let expected = [
        (MoveKind::Rapid, [10.0, -2.5, 5.0], 0.0, 5),
        (MoveKind::Rapid, [10.0, -2.5, 5.0], 0.0, 6),
        (MoveKind::Feed, [10.0, -2.5, -1.0], 300.0, 7),
        (MoveKind::Feed, [20.0, -2.5, -1.0], 300.0, 8),
        (MoveKind::Feed, [20.0, -2.0, -1.0], 300.0, 9),
        (MoveKind::Rapid, [20.0, -2.0, 5.0], 0.0, 11),
    ];
    assert_eq!(moves, expected);
    assert_eq!((reading.first_known_move, reading.unknown_positions.clone()), (1, vec![0..1]));
    let events: Vec<_> = program.events.iter().map(|e| (e.before, e.kind.clone())).collect();
    let comment = |text: &str| EventKind::Comment { text: text.into() };
    let expected = [
        (0, comment("a plate")),
        (0, comment("by hand")),
        (0, EventKind::ToolChange { tool: 0 }),
        (0, EventKind::SpindleOn { rpm: 1000.0, direction: SpindleDirection::Clockwise }),
        (0, EventKind::Flood { on: true }),
        (4, comment("half a step")),
        (5, EventKind::Dwell { seconds: 0.5 }),
        (5, EventKind::SpindleOff),
        (6, EventKind::Flood { on: false }),
    ];
    assert_eq!(events, expected);
    assert_eq!((program.tools[0].number, program.setup.wcs.as_str()), (3, "G54"));
    assert_eq!(program.operations.len(), 1);
}

#[test]
fn units_modes_and_offsets() {
    assert_eq!(ends("G20\nG0 X1 Y2 Z.5\nM2", &linuxcnc()), [[25.4, 50.8, 12.7]]);
    assert_eq!(ends("G20\nG0 X1 Y1 Z1\nG21\nX1\nM2", &linuxcnc())[1][0], 1.0);
    let text = "G20 G90\nG0 X0 Y0 Z0\nG1 X1 F10\nG21\nY1\nM2";
    assert!((reads(text, &linuxcnc()).program.moves[2].feed - 254.0).abs() < 1e-9);
    assert_eq!(reads("G59.1 G21\nG0 X1 Y2 Z3\nM2", &linuxcnc()).program.setup.wcs, "G59.1");
    assert_eq!(reads("G21 G0 X1 Y2 Z3 G54\nG54 X2", &grbl()).program.moves.len(), 2);
    let mut machine = linuxcnc();
    machine.reader.default_units = Some(LengthUnit::Inch);
    assert_eq!(ends("G0 X1 Y0 Z0\nM2", &machine), [[25.4, 0.0, 0.0]]);
    machine.dwell.as_mut().unwrap().unit = TimeUnit::Ms;
    let events = reads("G4 P500\nM2", &machine).program.events;
    assert_eq!(events[0].kind, EventKind::Dwell { seconds: 0.5 });
    machine.dwell.as_mut().unwrap().word = 'X';
    assert_eq!(reads("G4 X250\nM2", &machine).program.events[0].kind, EventKind::Dwell { seconds: 0.25 });
    machine.dwell.as_mut().unwrap().word = 'S';
    assert_eq!(reads("S7 M3\nG4 S250\nM2", &machine).program.events.len(), 2);
}

#[test]
fn two_dialects() {
    let skipped = "G21\nG0 X0 Y0 Z0\n/X1\n / (c) X2\nM2\n";
    assert_eq!(ends(skipped, &linuxcnc()).len(), 1);
    assert_eq!(ends(skipped, &grbl()).len(), 3);
    let mut machine = linuxcnc();
    machine.reader.block_delete = BlockDelete::Error;
    assert_eq!(refusal(skipped, &machine), ReadFault::BlockDelete);
    assert_eq!(refusal("%\nM2", &grbl()), ReadFault::Percent);
    assert_eq!(refusal("G21\n%\nM2", &linuxcnc()), ReadFault::Percent);
    assert_eq!(refusal("G21 %\nM2", &linuxcnc()), ReadFault::Percent);
    assert_eq!(ends("%\nG21\nG0 X1 Y1 Z1\n%\nG99", &linuxcnc()).len(), 1);
    assert_eq!(refusal("G21\nG0 X1 Y1 Z1\n", &linuxcnc()), ReadFault::NoEnd);
    assert_eq!(ends("G21\nG0 X1 Y1 Z1", &grbl()).len(), 1);
    assert_eq!(refusal("G21\nM2\nG0 X1", &grbl()), ReadFault::AfterEnd);
    assert_eq!(reads("G21\nM2\n(bye)\n\n", &grbl()).program.moves.len(), 0);
    for word in ["M6", "M7", "G43 H1", "G64 P0.1", "G61.1", "G90.1"] {
        assert!(matches!(refusal(&format!("T1\n{word}"), &grbl()), ReadFault::Refused { .. }), "{word}");
    }
    assert_eq!(refusal("G59.1", &grbl()), ReadFault::Refused { machine: "grbl".into() });
    let tools = [stylus(4)];
    let events = read("T4\nG21\nG0 X0 Y0 Z0", &grbl(), &tools).unwrap().program.events;
    assert_eq!(events[0].kind, EventKind::ToolChange { tool: 0 });
    assert!(read("T4\nG21 G61\nG43 H4\nG0 X0 Y0 Z0\nM2", &linuxcnc(), &tools).unwrap().program.events.is_empty());
}

#[test]
fn tips_below_their_centers() {
    let tools = [stylus(1), ball_by_center(2, 3.0)];
    let text = "G21 G61\nT1 M6\nG43 H1\nG0 X0 Y0 Z10\nT2 M6\nG43 H2\nX5\nZ10\nM2";
    let reading = read(text, &linuxcnc(), &tools).unwrap();
    let ends: Vec<_> = reading.program.moves.iter().map(|m| m.end.tip).collect();
    assert_eq!(ends, [[0.0, 0.0, 10.0], [5.0, 0.0, 7.0], [5.0, 0.0, 7.0]]);
    assert_eq!((reading.first_known_move, reading.unknown_positions), (0, vec![1..2]));
    let operations: Vec<_> = reading.program.moves.iter().map(|m| m.operation).collect();
    assert_eq!(operations, [0, 1, 1]);
    assert_eq!(reading.program.operations[1].tool, 1);
    assert_eq!(
        read("G21 G61\nG43 H2\nG0 X0 Y0 Z0\nM2", &linuxcnc(), &tools[1..]).unwrap().program.moves[0].end.tip[2],
        -3.0
    );
}

#[test]
fn what_must_stand_before_a_move() {
    let tools = [stylus(1)];
    let of = |text: &str| read(&format!("G21\n{text}\nG0 X0 Y0 Z0\nM2"), &linuxcnc(), &tools).map_err(|e| e.fault);
    for sound in ["T1 M6\nG43 H1\nG64 P0.001 Q0", "G61\nT1 M6\nG43", "G61.1\nG43 H1", "G64\nG64 P0.0005\nG43 H1"] {
        assert!(of(sound).is_ok(), "{sound}");
    }
    for text in ["G61\nT1 M6", "G61\nT1 M6\nG43 H1\nG49"] {
        assert_eq!(of(text).unwrap_err(), ReadFault::NoLengthOffset { expected: 1 }, "{text}");
    }
    for text in ["G43 H1", "G43 H1\nG64", "G43 H1\nG64 P0.1", "G61\nG43 H1\nG64 P0.0011"] {
        assert_eq!(of(text).unwrap_err(), ReadFault::PathTolerance { limit: 0.001 }, "{text}");
    }
    // without the job's tools nothing is known of their lengths
    assert!(read("G21\nG0 X0 Y0 Z0\nM2", &linuxcnc(), &[]).is_ok());
}

#[test]
fn places_that_are_not_known() {
    let text = "G21\nG0 X1 Y2\nZ5\nG1 Z-1 F100\nG53 G0 Z0\nX0 Y0\nG53 G0 X0 Y0\nM2";
    let reading = reads(text, &linuxcnc());
    let ends: Vec<_> = reading.program.moves.iter().map(|m| m.end.tip).collect();
    assert_eq!(ends, [[1.0, 2.0, 5.0], [1.0, 2.0, 5.0], [1.0, 2.0, -1.0], [0.0, 0.0, -1.0]]);
    assert_eq!((reading.first_known_move, reading.unknown_positions), (1, vec![0..1, 3..4]));
    let remarks = reading
        .program
        .events
        .iter()
        .filter(|e| matches!(&e.kind, EventKind::Comment { text } if text.starts_with("G53")));
    assert_eq!(remarks.count(), 2);
    let again = reads("G21\nG0 X1 Y2 Z5\nG53 G0 Z0\nX9\nG0 Z7\nM2", &linuxcnc());
    assert_eq!(again.program.moves[1].end.tip, [9.0, 2.0, 7.0]);
    assert_eq!(again.unknown_positions, [1..2]);
}

#[test]
fn remarks_name_operations() {
    let text = "G21\nT1 M6\n(operation walls: z-level)\nG0 X0 Y0 Z0\n(operation floor: spiral)\nX1\nM2";
    let program = reads(text, &linuxcnc()).program;
    let ids: Vec<_> = program.operations.iter().map(|o| (o.id.as_str(), o.kind.as_str())).collect();
    assert_eq!(ids, [("walls", "z-level"), ("floor", "spiral")]);
    assert_eq!(program.moves[1].operation, 1);
}

#[test]
fn the_place_of_an_error() {
    let error = refusal_with("G21\nG0 X1 (ß) G10 Y1\n", &linuxcnc(), &[]);
    assert_eq!((error.line, error.column, error.word.as_str()), (2, 11, "G10"));
    assert_eq!(error.to_string(), "line 2, column 11: shifts of the zero point are not read yet: \"G10\"");
    assert_eq!(error.location(), "line 2, column 11");
}

#[test]
fn words_that_cannot_be_read() {
    assert_eq!(fault("G1 X1 & Y2"), ReadFault::Character);
    assert_eq!(fault("X1)"), ReadFault::Character);
    assert_eq!(fault("X"), ReadFault::NumberExpected);
    assert_eq!(fault("X Y1"), ReadFault::NumberExpected);
    assert_eq!(fault("X1e5"), ReadFault::UnknownWord);
    assert_eq!(fault("X1.2.3"), ReadFault::Character);
    assert_eq!(fault("X--1"), ReadFault::NumberExpected);
    assert_eq!(fault("X1234567890123456"), ReadFault::NumberTooLong);
    assert_eq!(fault("X0.1234567890123456"), ReadFault::NumberTooLong);
    assert_eq!(fault("X0.0000000000000001"), ReadFault::NumberTooLong);
    assert_eq!(fault("X1 (open"), ReadFault::UnclosedComment);
    assert_eq!(fault("X1 (a (b) c)"), ReadFault::NestedComment);
    assert_eq!(fault(&format!("X{}1", " ".repeat(260))), ReadFault::LineTooLong { length: 262, max: 252 });
    assert_eq!(fault("A10"), ReadFault::UnknownWord);
    assert_eq!(fault("E1"), ReadFault::UnknownWord);
    for code in ["G5", "G0.5", "G1.05", "G-1", "M66", "M3.5", "M-5", "G99999999999999"] {
        assert_eq!(fault(code), ReadFault::UnknownCode, "{code}");
    }
}

#[test]
fn codes_that_are_not_read() {
    for text in [
        "G41",
        "G42.1",
        "G43.1 Z1",
        "G76",
        "G38.4 Z-1",
        "G28",
        "G92 X0",
        "G10 L2",
        "O100",
        "M98",
        "#1=2",
        "X[1+2]",
        "X#1",
    ] {
        let found = fault(text);
        let fits = matches!(found, ReadFault::NotRead { .. })
            || matches!(text, "X[1+2]" | "X#1") && found == ReadFault::NumberExpected;
        assert!(fits, "{text}: {found}");
    }
}

#[test]
fn blocks_that_contradict_themselves() {
    for text in [
        "G0 G1 X1", "G90 G91", "G20 G21", "M3 M5", "M8 M9", "M9 M7", "M0 M1", "G54 G55", "G61 G64", "G17 G18",
        "G43 G49", "G40 G40",
    ] {
        assert_eq!(fault(text), ReadFault::SameGroup, "{text}");
    }
    assert_eq!(fault("X1 X2"), ReadFault::WordTwice);
    assert_eq!(fault("G1 F1 F2"), ReadFault::WordTwice);
    for text in ["X1 P2", "X1 Q2", "X1 H2", "G49 H1", "G4 P1 G64", "G4 P1 Q1"] {
        assert_eq!(fault(text), ReadFault::StrayWord, "{text}");
    }
    assert!(matches!(fault("G4"), ReadFault::MissingWord { .. }));
    assert_eq!(fault("G4 P-1"), ReadFault::Negative);
    assert_eq!(fault("S-1"), ReadFault::Negative);
    assert_eq!(fault("F0"), ReadFault::ZeroFeed);
    assert_eq!(fault("F-1"), ReadFault::ZeroFeed);
    assert_eq!(fault("T1.5"), ReadFault::NotNatural);
    assert_eq!(fault("T-1"), ReadFault::NotNatural);
    assert_eq!(fault("G43 H-1"), ReadFault::NotNatural);
    assert_eq!(fault("G20 F10"), ReadFault::FeedWithUnits);
    assert_eq!(fault("G1 X1"), ReadFault::NoFeed);
    assert_eq!(fault("G80 X1"), ReadFault::NoMotionMode);
    assert_eq!(fault("M6"), ReadFault::NoToolSelected);
    let changed = refusal_with("G21 G90\nT1 M6\nG43 H1 G61\nG0 X0 Y0 Z5\nG55\nM2\n", &linuxcnc(), &[stylus(1)]);
    assert_eq!((changed.line, changed.fault), (5, ReadFault::WcsChanged));
    assert_eq!(fault("G53 G91 G0 Z0"), ReadFault::MachineCoordinates);
    assert_eq!(fault("G53 G80 Z0"), ReadFault::MachineCoordinates);
    assert!(matches!(fault("G53 G0"), ReadFault::MissingWord { .. }));
}

#[test]
fn motion_that_starts_nowhere() {
    let linuxcnc = linuxcnc();
    assert_eq!(refusal("G0 X1 Y1 Z1\nM2", &linuxcnc), ReadFault::NoUnits);
    assert_eq!(refusal("F100\nM2", &linuxcnc), ReadFault::NoUnits);
    assert_eq!(refusal("G21\nX1\nM2", &linuxcnc), ReadFault::NoMotionMode);
    assert_eq!(refusal("G21 G91\nG0 X1\nM2", &linuxcnc), ReadFault::IncrementalFromUnknown);
    assert_eq!(refusal("G21\nG1 X1 Y1 F9\nM2", &linuxcnc), ReadFault::FeedFromUnknown { axis: 'Z' });
    assert_eq!(refusal("G21\nG0 X1 Y1\nM2", &linuxcnc), ReadFault::NeverPlaced { axis: 'Z' });
    assert_eq!(refusal("G21\nG0 X1 Y1 Z1\nT1 M6\nG1 X2 F9\nM2", &linuxcnc), ReadFault::FeedFromUnknown { axis: 'Z' });
    let two = [stylus(1), stylus(2)];
    let fault = |text: &str| refusal_with(text, &linuxcnc, &two).fault;
    assert_eq!(fault("G21\nG0 X1 Y1 Z1\nM2"), ReadFault::NoToolLoaded);
    assert_eq!(fault("T3 M6\nM2"), ReadFault::UnknownTool { number: 3 });
    assert_eq!(fault("T1 M6\nG43 H2\nM2"), ReadFault::LengthOffset { found: 2, expected: 1 });
    let mut few = grbl();
    few.wcs.truncate(2);
    assert_eq!(refusal("G56", &few), ReadFault::Wcs);
    let mut without = grbl();
    without.dwell = None;
    assert!(matches!(refusal("G4", &without), ReadFault::Refused { .. }));
    let mut wrong = grbl();
    wrong.limits.rapid_rate = -1.0;
    assert!(matches!(refusal("G21", &wrong), ReadFault::Machine(_)));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Whatever the text, there is a program or an error, and the program's positions are finite.
    #[test]
    fn any_text_is_read_or_refused(text in "([GMXYZFSTHPQN]{0,1}[-+]?[0-9]{0,3}[.]?[0-9]{0,2}[ ]{0,1}|[(;)%/\n]|\\PC){0,60}") {
        for machine in [linuxcnc(), grbl()] {
            if let Ok(reading) = read(&text, &machine, &[]) {
                prop_assert!(reading.program.moves.iter().all(|m| m.end.tip.iter().all(|v| v.is_finite())));
            }
        }
    }

    /// Blocks of the right shape, in any order.
    #[test]
    fn any_blocks_are_read_or_refused(
        blocks in prop::collection::vec(
            prop_oneof![
                Just("G0 X1".to_string()), Just("G1 Y2 F3".into()), Just("Z4".into()), Just("G91".into()), Just("G90".into()),
                Just("T1 M6".into()), Just("T2 M6".into()), Just("G53 G0 Z0".into()), Just("G53 G0 X0 Y0".into()), Just("G21".into()), Just("G20".into()),
                Just("G43 H1".into()), Just("M3 S5".into()), Just("S6".into()), Just("(operation a: b)".into()), Just("G0 X1 Y1 Z1".into()),
            ],
            0..30,
        )
    ) {
        let text = format!("G21\n{}\nM2\n", blocks.join("\n"));
        if let Ok(reading) = read(&text, &linuxcnc(), &[]) {
            let program = &reading.program;
            prop_assert!(program.moves.iter().all(|m| (m.operation as usize) < program.operations.len()));
            prop_assert!(program.events.windows(2).all(|w| w[0].before <= w[1].before));
            prop_assert!(reading.unknown_positions.iter().all(|run| run.start < run.end && run.end <= program.moves.len()));
            let placed: Vec<_> = program.moves.iter().enumerate().filter(|(i, _)| !reading.unknown_positions.iter().any(|r| r.contains(i))).collect();
            prop_assert!(placed.first().is_none_or(|(i, _)| *i >= reading.first_known_move));
        }
    }
}
