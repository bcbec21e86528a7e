//! Programs and the moves that they make: exact answers, and that nothing breaks the interpreter.

use proptest::prelude::*;
use styluscam_motion::{EventKind, Move, MoveKind, Watch};

use super::trace::Limits;
use super::tracer::Tracer;
use super::{Gap, Trace, TraceError, TraceFault};

fn traced(text: &str) -> Result<Trace, TraceError> {
    super::trace(text, &|_| None, &Watch::default())
}

fn moves(text: &str) -> Vec<Move> {
    traced(text).unwrap().program.moves
}

fn ends(text: &str) -> Vec<[f64; 3]> {
    moves(text).iter().map(|one| one.end.tip.map(|length| (length * 1e9).round() / 1e9)).collect()
}

/// Where X stands after each move.
fn positions(text: &str) -> Vec<f64> {
    ends(text).iter().map(|end| end[0]).collect()
}

/// What is noted, but for the unit that most of these programs leave out.
fn gaps(text: &str) -> Vec<Gap> {
    let notes = traced(text).unwrap().notes.into_iter().map(|note| note.gap);
    notes.filter(|gap| *gap != Gap::Unit).collect()
}

fn fault(text: &str) -> (u32, TraceFault) {
    let error = traced(text).unwrap_err();
    (error.line, error.fault)
}

// Parameters

#[test]
fn parameters_of_a_line_are_set_after_it_is_read() {
    assert_eq!(positions("#1=5 #2=#1\nG0 X#1\nG0 X[#2+1]\n#1=7 G0 X#1\nG0 X#1\nM2"), [5.0, 1.0, 5.0, 7.0]);
    assert_eq!(positions("#<_Far Away>=2 #<near>=3\nG0 X[#<_faraway>*#<NEAR>]\nM2"), [6.0]);
}

#[test]
fn the_machine_tells_its_state() {
    assert_eq!(
        positions("G20 G0 X2\nG91 G0 X[#5420+#<_x>]\nG0 X[#<_incremental>+#<_imperial>]\nM2"),
        [50.8, 152.4, 203.2]
    );
    assert_eq!(positions("T7 M6\nG55\nG0 X[#5400+#5220+#<_coord_system>]\nM2"), [559.0]);
    assert_eq!(positions("G10 L2 P3 Y4\nG0 X#5262\nM2"), [4.0]);
}

#[test]
fn what_has_no_value_is_zero_and_noted() {
    let text = "G0 X[1+#<_hal[a.pin]>]\nG0 X[2+#<_hal[a.pin]>]\nM2";
    assert_eq!(positions(text), [1.0, 2.0]);
    let trace = traced(&format!("G21\n{text}")).unwrap();
    assert_eq!(trace.notes.len(), 1);
    assert_eq!(trace.notes[0].to_string(), "line 2: #<_hal[a.pin]> has no value here: 0 is taken (twice)");
}

// Flow

#[test]
fn branches_take_one_way() {
    let text = |n: u32| {
        format!("#1={n}\no1 if [#1 eq 1]\nG0 X1\no1 elseif [#1 eq 2]\nG0 X2\no1 else\nG0 X3\no1 endif\nG0 X9\nM2")
    };
    for (n, path) in [(1, 1.0), (2, 2.0), (5, 3.0)] {
        assert_eq!(positions(&text(n)), [path, 9.0]);
    }
}

#[test]
fn loops_run_as_often_as_they_say() {
    assert_eq!(positions("#1=0\no1 while [#1 lt 3]\n#1=[#1+1]\nG0 X#1\no1 endwhile\nM2"), [1.0, 2.0, 3.0]);
    assert_eq!(positions("#1=0\no1 do\n#1=[#1+1]\nG0 X#1\no1 while [#1 lt 2]\nM2"), [1.0, 2.0]);
    assert_eq!(
        positions("G91\no1 repeat [2]\no2 repeat [2]\nG0 X1\no2 endrepeat\no1 endrepeat\nM2"),
        [1.0, 2.0, 3.0, 4.0]
    );
    assert_eq!(positions("G91\no1 repeat [0]\nG0 X1\no1 endrepeat\nG0 X5\nM2"), [5.0]);
}

#[test]
fn loops_are_left_and_gone_on_with() {
    let skip = "o2 if [#1 eq 2]\no1 continue\no2 endif\no3 if [#1 eq 4]\no1 break\no3 endif\nG0 X#1\n";
    for (begin, end) in [("o1 while [1]", "o1 endwhile"), ("o1 do", "o1 while [1]"), ("o1 repeat [9]", "o1 endrepeat")]
    {
        let text = format!("#1=0\n{begin}\n#1=[#1+1]\n{skip}{end}\nM2");
        assert_eq!(positions(&text), [1.0, 3.0], "{begin}");
    }
}

#[test]
fn subroutines_have_parameters_of_their_own() {
    let text = "o<a> sub\n#2=[#1*2] #<mine>=4\nG0 X[#1+#2]\no<a> endsub [#2]\n#1=1 #2=100\no<a> call [5]\n\
                G0 X[#1+#2+#<_value>]\nG0 X[exists[#<mine>]+#<_value_returned>]\nM2";
    assert_eq!(positions(text), [15.0, 111.0, 1.0]);
}

#[test]
fn a_return_ends_a_subroutine_early() {
    let text = "o1 sub\no2 if [#1 gt 1]\no1 return [7]\no2 endif\nG0 X#1\no1 endsub\no1 call [1]\no1 call [2]\n\
                G0 X#<_value>\nM2";
    assert_eq!(positions(text), [1.0, 7.0]);
}

#[test]
fn recursion_works_and_ends() {
    let text = "o1 sub\no2 if [#1 le 1]\no1 return [1]\no2 endif\no1 call [#1-1]\no1 endsub [#1*#<_value>]\n\
                o1 call [5]\nG0 X#<_value>\nM2";
    assert_eq!(positions(text), [120.0]);
    assert_eq!(fault("o1 sub\no1 call\no1 endsub\no1 call\nM2"), (2, TraceFault::CallDepth));
}

#[test]
fn subroutines_come_from_files_and_computed_numbers() {
    let find = |name: &str| (name == "hop").then(|| "o<hop> sub\nG0 X#1\nG1 F5 X9\no<hop> endsub\nM2\n".into());
    let trace = super::trace("o<HOP> call [3]\nG0 X1\nM2", &find, &Watch::default()).unwrap();
    let shown: Vec<_> = trace.program.moves.iter().map(|one| (one.end.tip[0], one.line)).collect();
    assert_eq!(shown, [(3.0, 1), (9.0, 1), (1.0, 2)]);
    assert_eq!(trace.notes[0].to_string(), "line 2 of hop: neither G20 nor G21 came before: lengths are taken as mm");
    assert_eq!(positions("o101 sub\nG0 X1\no101 endsub\no[100+1] call\nM2"), [1.0]);
    let text = "o<gone> call\nG0 X1\no<gone> call\nM2";
    assert_eq!(
        traced(text).unwrap().notes[0].to_string(),
        "line 1: there is no subroutine o<gone> here: its call is left out (twice)"
    );
}

#[test]
fn numbers_of_other_controls_are_called_by_m98() {
    assert_eq!(positions("G91 M98 P7 L3\nG0 X10\nM30\nO7\nG0 X1\nM99\n"), [1.0, 2.0, 3.0, 13.0]);
    assert_eq!(gaps("G0 X1\nM99\n"), [Gap::Forever]);
}

#[test]
fn halves_without_their_other_halves_are_told() {
    for (text, line) in
        [("o1 if [0]\nG0 X1\n", 1), ("G0 X1\no1 endwhile\n", 2), ("o1 sub\nG0 X1\n", 1), ("o1 break\n", 1)]
    {
        let (at, fault) = fault(text);
        assert!(at == line && matches!(fault, TraceFault::Unmatched { .. }), "{text}: {fault}");
    }
}

#[test]
fn a_program_without_end_is_told() {
    let error = stopped("G0 X1\no1 while [1]\no1 endwhile\nM2").unwrap_err();
    assert_eq!((error.line, error.fault), (3, TraceFault::TooManyBlocks { limit: 3000 }));
    let error = stopped("G91\no1 while [1]\nG0 X1\nG0 X-1\no1 endwhile\nM2").unwrap_err();
    assert_eq!((error.line, error.fault), (3, TraceFault::TooManyMoves { limit: 1000 }));
    let error = stopped("G91 F100 G0 Z9\nG81 X1 Z-1 R-1 L1000000000\nM2").unwrap_err();
    assert_eq!((error.line, error.fault), (2, TraceFault::TooManyMoves { limit: 1000 }));
}

#[test]
fn work_is_stopped_from_outside() {
    let watch = Watch::default();
    watch.cancel();
    assert_eq!(super::trace("G0 X1\nM2", &|_| None, &watch).unwrap_err().fault, TraceFault::Cancelled);
}

// Text

#[test]
fn percent_signs_frame_a_program() {
    assert_eq!(positions("%\nG0 X1\n%\nG0 X2\n"), [1.0]);
    assert_eq!(gaps("G0 X1\n"), [Gap::NoEnd]);
    assert_eq!(positions("/G0 X1\nN1.5 g0 x 1 2 ; X3\nM2"), [1.0, 12.0]);
}

#[test]
fn what_the_operator_is_told_is_an_event() {
    let trace = traced("(MSG, Mind the clamp)\n(only a comment)\nG0 X1\n(print,done)\nM2").unwrap();
    let stated: Vec<_> = trace.program.events.iter().map(|event| (event.before, event.kind.clone())).collect();
    let comment = |text: &str| EventKind::Comment { text: text.into() };
    assert_eq!(stated, [(0, comment("Mind the clamp")), (1, comment("done"))]);
}

// Motion

#[test]
fn arcs_by_radius_and_by_centre_are_one() {
    let by_centre = moves("G0 X0 Y0 Z0\nG2 X10 Y0 I5 J0 F100\nG90.1 G3 X0 Y0 I5 J0\nG17 G3 X0 Y0 I5 J5 P3 Z2\nM2");
    let by_radius = moves("G0 X0 Y0 Z0\nG2 X10 Y0 R5 F100\nG3 X0 Y0 R5\nM2");
    assert_eq!(by_centre[1].arc, by_radius[1].arc);
    assert_eq!(by_centre[2].arc.map(|arc| arc.centre), Some([5.0, 0.0, 0.0]));
    assert_eq!(by_centre[3].arc.unwrap().turns, 2);
    // LinuxCNC 2.9.4 prints these centres
    let x = |text: &str| moves(text).last().unwrap().arc.unwrap().centre;
    let near = |a: [f64; 3], axes: [usize; 2], b: [f64; 2]| (0..2).all(|i| (a[axes[i]] - b[i]).abs() < 5e-5);
    assert!(near(x("F1 G0 X2 Y3.2766 Z0\nG2 X3 Y1 R5\nM2"), [0, 1], [-1.9341, 0.1906]));
    assert!(near(x("F1 G0 X3 Y1 Z2\nG18 G2 X4 Z2 R1\nM2"), [2, 0], [2.8660, 3.5]));
    assert!(near(x("F1 G0 X4 Y1 Z2\nG19 G3 Y3 Z1 R-2\nM2"), [1, 2], [1.2584, 0.0168]));
}

#[test]
fn arcs_that_are_none_are_refused() {
    for (text, expected) in [
        ("G0 X0 Y0\nG2 X1\nM2", TraceFault::ArcForm),
        ("G0 X0 Y0\nG2 R1\nX0\nM2", TraceFault::ArcForm),
        ("G0 X0 Y0\nG2 X10 R4\nM2", TraceFault::ArcRadius),
        ("G0 X0 Y0\nG2 I0 J0\nM2", TraceFault::ArcRadius),
        ("G0 X0 Y0\nG2 X1 R1 I1\nM2", TraceFault::ArcForm),
    ] {
        assert_eq!(fault(text).1, expected, "{text}");
    }
}

#[test]
fn feeds_follow_their_mode() {
    let feeds = |text: &str| moves(text).iter().map(|one| one.feed).collect::<Vec<_>>();
    let text = "G20 G0 X0 Y0 Z0\nG1 X1 F10\nG21 G93 G1 X35.4 F2\nS100 G95 F0.1\nX45.4\nG94 F5 X55.4\nM2";
    assert_eq!(
        feeds(text).iter().map(|feed| (feed * 1e9).round() / 1e9).collect::<Vec<_>>(),
        [0.0, 254.0, 20.0, 10.0, 5.0]
    );
    assert_eq!(feeds("G0 X0 Y0 Z0\nG1 X1\nM2"), [0.0, super::note::FEED_UNKNOWN]);
    assert_eq!(gaps("G0 X0 Y0 Z0\nG1 X1\nM2"), [Gap::Feed]);
}

#[test]
fn polar_words_turn_about_the_zero() {
    // LinuxCNC 2.9.4 prints these positions
    let found = ends("G90 G0 X2 Y1\n@1 ^90\n@2\n^30\nG91 @1\n^15\n@1 ^10\nM2");
    let printed =
        [[2.0, 1.0], [0.0, 1.0], [0.0, 2.0], [1.7321, 1.0], [2.5981, 1.5], [2.1213, 2.1213], [2.2943, 3.2766]];
    assert!(
        found.iter().zip(printed).all(|(a, b)| (a[0] - b[0]).abs() < 5e-5 && (a[1] - b[1]).abs() < 5e-5),
        "{found:?}"
    );
    assert_eq!(fault("G0 X1 @2\nM2").1, TraceFault::PolarWithCartesian);
}

#[test]
fn beziers_end_where_they_shall_and_pass_their_middle() {
    let found = ends("F100 G0 X0 Y0 Z0\nG5.1 X4 Y0 I2 J4\nM2");
    assert!(found.len() > 10 && found.last() == Some(&[4.0, 0.0, 0.0]));
    assert!(found.iter().all(|[x, y, _]| (y - 2.0 * x * (4.0 - x) / 4.0).abs() < 1e-8), "{found:?}");
    let cubic = ends("F100 G0 X0 Y0 Z0\nG5 X3 Y0 I1 J3 P-1 Q3\nG5 X6 Y0 P-1 Q-3\nM2");
    let highest = cubic.iter().map(|end| end[1]).fold(0.0, f64::max);
    let lowest = cubic.iter().map(|end| end[1]).fold(0.0, f64::min);
    assert!((highest - 2.25).abs() < 0.01 && (lowest + 2.25).abs() < 0.01, "{highest} {lowest}");
}

#[test]
fn a_feed_from_an_unknown_place_begins_at_the_machines_zero() {
    let trace = traced("F100\nG1 X5\nM2").unwrap();
    let kinds: Vec<_> = trace.program.moves.iter().map(|one| (one.kind, one.end.tip[0])).collect();
    assert_eq!(kinds, [(MoveKind::Rapid, 0.0), (MoveKind::Feed, 5.0)]);
    let starts = ['X', 'Y', 'Z'].map(|axis| Gap::Start { axis });
    assert_eq!(trace.notes.into_iter().map(|note| note.gap).collect::<Vec<_>>(), [&[Gap::Unit], &starts[..]].concat());
}

// Cycles

/// Rapids and feeds along Z: letters and heights.
fn drilled(text: &str) -> Vec<(char, f64)> {
    let letter = |one: &Move| if one.kind == MoveKind::Rapid { 'R' } else { 'F' };
    moves(text).iter().map(|one| (letter(one), (one.end.tip[2] * 1e9).round() / 1e9)).collect()
}

#[test]
fn holes_are_drilled_from_the_retract_plane() {
    let text = "F100 G0 X0 Y0 Z10\nG99 G81 X1 Y2 Z-3 R1\nM2";
    assert_eq!(drilled(text), [('R', 10.0), ('R', 10.0), ('R', 1.0), ('F', -3.0), ('R', 1.0)]);
    // LinuxCNC 2.9.4: G85 feeds out to R, G89 and tapping to where the cycle ends
    let out = |cycle: &str| drilled(&format!("F100 G0 X0 Y0 Z10\nG98 {cycle} X1 Y2 Z-3 R1\nM2"))[3..].to_vec();
    assert_eq!(out("G85"), [('F', -3.0), ('F', 1.0), ('R', 10.0)]);
    assert_eq!(out("G89"), [('F', -3.0), ('F', 10.0)]);
    assert_eq!(out("G84"), [('F', -3.0), ('F', 10.0)]);
    // LinuxCNC 2.9.4: where the series began below R, that is gone to first, from above too
    let found = ends("F100 G0 X0 Y0 Z0\nG99 G81 X1 Z-3 R5\nX2 R2\nM2");
    assert_eq!(found[4..6], [[1.0, 0.0, 5.0], [1.0, 0.0, 2.0]]);
    // what is not stated again is kept as it was written
    assert_eq!(ends("F100 G0 X0 Y0 Z9\nG99 G81 X1 Z-1 R1\nG20 X2\nM2").last(), Some(&[50.8, 0.0, 25.4]));
}

#[test]
fn pecks_come_out_or_break_the_chip() {
    let full = drilled("F100 G0 X0 Y0 Z1\nG83 Z-2 R1 Q1.5\nM2");
    assert_eq!(full[2..], [('F', -0.5), ('R', 1.0), ('R', -0.246), ('F', -2.0), ('R', 1.0)]);
    let short = drilled("F100 G0 X0 Y0 Z1\nG73 Z-2 R1 Q1.5\nM2");
    assert_eq!(short[2..], [('F', -0.5), ('R', -0.246), ('F', -2.0), ('R', 1.0)]);
}

#[test]
fn repeated_cycles_go_on_by_their_increments() {
    // LinuxCNC 2.9.4: R counts from where the series began
    let found = ends("F100 G98 G0 X0 Y0 Z10\nG91 G81 X1 Z-1 R-3 L2\nM2");
    let holes: Vec<_> = found.iter().filter(|end| end[2] < 6.5).collect();
    assert_eq!(holes, [&[1.0, 0.0, 6.0], &[2.0, 0.0, 6.0]]);
    assert_eq!(found.last(), Some(&[2.0, 0.0, 10.0]));
}

#[test]
fn cycles_work_in_every_plane() {
    let found = ends("F100 G0 X10 Y0 Z0\nG19 G99 G81 Y1 Z2 X-1 R3\nM2");
    assert_eq!(found[1..], [[10.0, 1.0, 2.0], [3.0, 1.0, 2.0], [-1.0, 1.0, 2.0], [3.0, 1.0, 2.0]]);
}

#[test]
fn cycles_that_do_not_fit_are_refused() {
    assert_eq!(fault("G0 Z5\nG81 X1 Z3 R1\nM2").1, TraceFault::CycleDepths);
    assert_eq!(fault("G0 Z5\nG83 X1 Z0 R1\nM2").1, TraceFault::CycleDepths);
    assert_eq!(fault("G0 Z5\nG81 X1 Z0\nM2").1, TraceFault::WordMissing { what: "R of a cycle" });
    assert_eq!(fault("G0 X1\nG80 X1\nM2"), (2, TraceFault::NoMotionMode));
    assert_eq!(positions("G80 G0 X1\nX2\nG80 G28 X3\nM2"), [1.0, 2.0, 3.0, 0.0]);
    assert_eq!(fault("G0 X1\nG0 X1 G1\nM2"), (2, TraceFault::SameGroup));
}

#[test]
fn threads_go_deeper_pass_by_pass() {
    // LinuxCNC 2.9.4 prints these positions
    let found = ends("G18 S300 M3 G0 X10 Y0 Z5\nG76 P1.5 Z-10 I-2 J0.4 R1.5 K1.2 Q29.5 H1 E1 L2\nM2");
    let printed = [[10.8, 4.7737], [7.6, 4.7737], [7.6, -8.5474], [8.8, -9.5474], [10.8, -9.5474], [10.565, 4.6408]];
    let near = |a: &[f64; 3], b: [f64; 2]| (a[0] - b[0]).abs() < 5.1e-5 && (a[2] - b[1]).abs() < 5.1e-5;
    assert!(found[1..].iter().zip(printed).all(|(a, b)| near(a, b)), "{found:?}");
    assert_eq!(found.len(), 1 + 7 * 5 + 1);
    assert!(near(found.last().unwrap(), [10.0, -10.0]));
}

// Coordinates

#[test]
fn what_follows_a_change_of_offsets_lies_where_it_is_in_space() {
    assert_eq!(positions("G10 L2 P1 X100\nG0 X1\nM2"), [1.0]);
    assert_eq!(positions("G0 X1\nG10 L2 P1 X100\nG0 X1\nG55 G0 X1\nM2"), [1.0, 101.0, 1.0]);
    assert_eq!(positions("G0 X5\nG92 X0\nG0 X1\nG92.1 G0 X1\nG52 X3\nG0 X1\nM2"), [5.0, 6.0, 1.0, 4.0]);
    assert_eq!(positions("G0 X5\nG10 L20 P1 X0\nG0 X1\nG53 G0 X1\nM2"), [5.0, 6.0, 1.0]);
    // LinuxCNC 2.9.4 puts the zero to X1.5981 Y-1.5
    let turned = ends("G0 X0 Y0\nG10 L2 P1 X-1 Y-3 R30\nG0 X7 Y-13\nG10 L20 P1 X4\nG0 X0 Y0\nM2");
    assert!((turned[2][0] - 1.5981).abs() < 5e-5 && (turned[2][1] + 1.5).abs() < 5e-5, "{turned:?}");
    let turned = ends("G0 X0 Y0\nG10 L2 P1 X1 R90\nG0 X2 Y0\nM2");
    assert!((turned[1][0] - 1.0).abs() < 1e-9 && (turned[1][1] - 2.0).abs() < 1e-9);
}

#[test]
fn the_work_offset_is_that_of_the_first_move() {
    let offset = |text: &str| traced(text).unwrap().program.setup.wcs;
    assert_eq!(offset("G0 X1\nG55 G0 X2\nM2"), "G54");
    assert_eq!(offset("G59 G0 X1\nM2"), "G59");
    assert_eq!(offset("G59.3 G0 X1\nM2"), "G59.3");
}

#[test]
fn homes_are_gone_to_over_a_place() {
    assert_eq!(ends("G0 X5 Y5 Z5\nG28.1\nG0 X9 Y9 Z9\nG91 G28 Z1\nM2")[2..], [[9.0, 9.0, 10.0], [9.0, 9.0, 5.0]]);
    assert_eq!(positions("G0 X5\nG28 U0\nG28\nM2"), [5.0, 5.0, 5.0, 0.0]);
}

#[test]
fn tool_lengths_are_those_that_the_program_sets() {
    let text = "G0 X0 Y0 Z0\nG43 H1\nG10 L1 P1 Z20\nG43 H1\nG0 X1 Z5\nG53 G0 Z0\nM2";
    assert_eq!(ends(text)[1..], [[1.0, 0.0, 5.0], [1.0, 0.0, -20.0]]);
    assert_eq!(gaps(text), [Gap::ToolTable]);
}

#[test]
fn diameters_are_halved() {
    assert_eq!(positions("G7 G0 X10\nG91 X4\nG90 G8 X10\nM2"), [5.0, 7.0, 10.0]);
}

#[test]
fn modes_are_stored_and_brought_back() {
    let text = "o1 sub\nM73\nG20 G91 G0 X1\no1 endsub\nG0 X5\no1 call\nG0 X1\nM70\nG20\nM72\nG0 X2\nM2";
    assert_eq!(positions(text), [5.0, 30.4, 1.0, 2.0]);
}

#[test]
fn probes_come_to_their_end() {
    let text = "F10 G0 X0 Y0 Z5\nG38.2 Z-5\nG0 X[#5063*-1+#5070]\nG38.3 X9\nG0 X#5070\nM2";
    assert_eq!(positions(text), [0.0, 0.0, 6.0, 9.0, 0.0]);
    assert_eq!(gaps(text), [Gap::Probe]);
}

#[test]
fn codes_of_one_machine_are_left_out_with_their_axes() {
    let text = "G0 X1\nM428 X5\nG88.1 X7\nX8\nG0 X2\nM2";
    assert_eq!(positions(text), [1.0, 2.0]);
    assert_eq!(gaps(text), ["M428", "G88.1"].map(|code| Gap::Code { code: code.into() }));
}

// Nothing to see

#[test]
fn a_library_and_a_still_program_are_told_apart() {
    let text = "o<a> sub\nG0 X1\no<a> endsub\no7 sub\no7 endsub\nM2";
    assert_eq!(fault(text), (0, TraceFault::OnlySubroutines { names: "o<a>, o7".into() }));
    let called = fault("o1 sub\nT1 M6\no1 endsub\no1 call\nM2");
    assert_eq!(called, (0, TraceFault::NoMoves { left_out: String::new() }));
    assert_eq!(fault("G21\nM2"), (0, TraceFault::NoMoves { left_out: String::new() }));
    let missing = traced("o<gone> call\nM6 T1\nM2").unwrap_err();
    assert_eq!(missing.to_string(), "no move in it: there is nothing to see; not known here: o<gone>");
}

#[test]
fn places_out_of_this_world_are_refused() {
    assert_eq!(fault("G0 X2000000\nM2"), (1, TraceFault::TooFar));
    assert_eq!(fault("G0 X1 Y1\nG2 I1 P4000000000\nM2"), (2, TraceFault::TooLarge));
    assert_eq!(fault("G0 X1 Y1\nG4 P4000000\nM2"), (2, TraceFault::TooLarge));
    assert_eq!(gaps("F0.0000001 G0 X0 Y0 Z0\nG1 X1\nM2"), [Gap::Feed]);
}

const WORDS: [&str; 60] = [
    "G0",
    "G1",
    "G2",
    "G3",
    "G5",
    "G5.1",
    "G28",
    "G10 L2 P1",
    "G10 L20 P0",
    "G10 L1 P3",
    "G17",
    "G18",
    "G19",
    "G20",
    "G21",
    "G38.2",
    "G43 H3",
    "G43.1",
    "G53",
    "G55",
    "G73",
    "G76",
    "G81",
    "G83",
    "G89",
    "G90",
    "G91",
    "G92",
    "G92.3",
    "G93",
    "G95",
    "G98",
    "X1",
    "Y-2",
    "Z[#1+3]",
    "I5",
    "J1",
    "K.5",
    "R2",
    "P3",
    "Q1",
    "L2",
    "F100",
    "S9",
    "T1 M6",
    "M3",
    "M70",
    "M72",
    "M73",
    "M98 P1",
    "M99",
    "#1=[#1+1]",
    "#<a>=#1",
    "@2",
    "^40",
    "R-1",
    "X#5420",
    "A5",
    "D1",
    "E1",
];

const LINES: [&str; 22] = [
    "o1 sub",
    "o1 endsub",
    "o1 call [3]",
    "o1 return [#1]",
    "o2 if [#1 gt 2]",
    "o2 elseif [#1]",
    "o2 else",
    "o2 endif",
    "o3 while [#1 lt 5]",
    "o3 endwhile",
    "o4 do",
    "o4 while [#1 gt 7]",
    "o5 repeat [3]",
    "o5 endrepeat",
    "o3 break",
    "o5 continue",
    "o6",
    "%",
    "(msg, hi)",
    "/G1 X1",
    "#1=1",
    "o[#1] call",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    #[test]
    fn no_text_breaks_it(text in "\\PC{0,80}") {
        let _ = stopped(&text);
    }

    #[test]
    fn no_bytes_break_it(bytes in proptest::collection::vec(any::<u8>(), 0..120)) {
        let _ = stopped(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn no_program_breaks_it(lines in proptest::collection::vec(line(), 0..25)) {
        let found = stopped(&lines.join("\n"));
        if let Ok(trace) = found {
            let sound = |one: &Move| one.end.tip.iter().all(|x| x.is_finite()) && (one.feed > 0.0) == (one.kind == MoveKind::Feed);
            prop_assert!(trace.program.moves.iter().all(sound));
        }
    }
}

fn line() -> impl Strategy<Value = String> {
    let words = proptest::collection::vec(proptest::sample::select(&WORDS[..]), 1..6).prop_map(|words| words.join(" "));
    prop_oneof![3 => words, 2 => proptest::sample::select(&LINES[..]).prop_map(String::from)]
}

/// A run that is soon given up.
fn stopped(text: &str) -> Result<Trace, TraceError> {
    let limits = Limits { blocks: 3000, moves: 1000 };
    Tracer::new(text, &|_| None, &Watch::default(), limits).run()
}
