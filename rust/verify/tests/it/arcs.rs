//! Arcs are checked as arcs: against the same path in short chords.

use crate::common::{ball, clothoid, limits, tip_on_cone, Part, Path, CLEARANCE};
use styluscam_geometry::{Tool, Vector};
use styluscam_motion::{Arc, Plane, Program, Watch};
use styluscam_verify::{coverage, judge, FindingKind, Report};

const LOW: f64 = 10.0;
const HIGH: f64 = 30.0;

/// A loop around the cone at one level, in arcs that end at these angles.
fn loop_of_arcs(tool: &Tool, inner: bool, angles: &[f64]) -> Program {
    let radius = 0.5 * (LOW + HIGH);
    let z = if inner { radius - HIGH } else { LOW - radius };
    let at = |angle: f64| -> [f64; 3] {
        tip_on_cone(&tool.cutter(), None, inner, Vector::new(radius * angle.cos(), radius * angle.sin(), z), 0.001)
    };
    let start = at(0.0);
    let mut path = Path::new().rapid([start[0], start[1], CLEARANCE]).feed(start);
    for angle in angles {
        path = path.feed(at(*angle));
        let centre = [0.0, 0.0, start[2]];
        path.moves.last_mut().unwrap().arc = Some(Arc { centre, plane: Plane::Xy, clockwise: false, turns: 0 });
    }
    path.program(tool)
}

/// The same program with every arc in chords.
fn chorded(program: &Program, count: usize) -> Program {
    let mut chorded = program.clone();
    chorded.moves.clear();
    for (start, step) in program.segments() {
        match start.and_then(|s| step.path(s)) {
            None => chorded.moves.push(*step),
            Some(path) => chorded.moves.extend((1..=count).map(|i| {
                let mut chord = *step;
                chord.arc = None;
                chord.end.tip = if i == count { step.end.tip } else { path.at(i as f64 / count as f64) };
                chord
            })),
        }
    }
    chorded
}

fn judged(part: &Part, tool: &Tool, program: &Program) -> Report {
    judge(program, &part.subject(std::slice::from_ref(tool)), &limits(), &Watch::default()).unwrap()
}

const QUARTERS: [f64; 4] = [1.7, 3.0, 4.5, std::f64::consts::TAU];

#[test]
fn sound_arcs_pass_and_cover_as_chords_do() {
    for inner in [true, false] {
        for tool in [ball(8.0), clothoid(8.0)] {
            let (part, program) = (Part::cone(inner, LOW, HIGH, 600, 20), loop_of_arcs(&tool, inner, &QUARTERS));
            let report = judged(&part, &tool, &program);
            assert!(report.ok && report.findings.is_empty(), "{inner}: {:?}", report.findings);
            assert!((report.contact_share - 1.0).abs() < 1e-12 && report.samples > 40);
            let selected = vec![true; part.mesh.triangles().len()];
            let left = |program: &Program| {
                let tools = std::slice::from_ref(&tool);
                coverage(program, &part.subject(tools), &limits(), &selected, &Watch::default()).unwrap()[0]
                    .left
                    .unwrap()
            };
            assert!((left(&program) - left(&chorded(&program, 2000))).abs() < 2e-4);
        }
    }
}

#[test]
fn a_reversed_arc_gouges_or_leaves_the_part() {
    for inner in [true, false] {
        let tool = ball(8.0);
        let mut program = loop_of_arcs(&tool, inner, &[0.5, std::f64::consts::TAU]);
        program.moves[2].arc.as_mut().unwrap().centre[0] += 2.0;
        let start = program.moves[1].end.tip;
        program.moves[2].arc.as_mut().unwrap().clockwise = true;
        assert!(program.moves[2].path(start).is_some());
        let report = judged(&Part::cone(inner, LOW, HIGH, 600, 20), &tool, &program);
        assert!(!report.ok && report.findings.iter().any(|f| f.line == 13), "{:?}", report.findings);
    }
}

#[test]
fn depths_are_those_of_ten_thousand_chords() {
    for inner in [true, false] {
        for (tool, shift) in [(ball(8.0), [0.03, 0.0]), (clothoid(8.0), [-0.02, 0.05]), (ball(8.0), [0.0, -0.2])] {
            let mut program = loop_of_arcs(&tool, inner, &QUARTERS);
            // both ends of the second arc are kept, its centre is not: it is deepest somewhere along the path
            let (from, to) = (program.moves[2].end.tip, program.moves[3].end.tip);
            let [x, y] = [0, 1].map(|axis| 0.5 * (from[axis] + to[axis]));
            let centre = &mut program.moves[3].arc.as_mut().unwrap().centre;
            let along = (x * shift[0] + y * shift[1]) / (x * x + y * y);
            centre[0] += along * x;
            centre[1] += along * y;
            let part = Part::cone(inner, LOW, HIGH, 600, 20);
            let (report, expected) = (judged(&part, &tool, &program), judged(&part, &tool, &chorded(&program, 10_000)));
            let (found, expected) = (report.gouge_max, expected.gouge_max);
            assert!((found - expected).abs() < 1e-6, "{inner} {shift:?}: {found} {expected}");
            let gouged = report.findings.iter().any(|f| f.kind == FindingKind::Gouge);
            assert_eq!(gouged, expected > 0.001, "{found}");
        }
    }
}

#[test]
fn what_a_long_arc_leaves_between_its_ends_is_found() {
    let tool = ball(8.0);
    let mut program = loop_of_arcs(&tool, false, &[3.0, std::f64::consts::TAU]);
    let start = program.moves[1].end.tip;
    let path = program.moves[2].path(start).unwrap();
    // outwards: both ends touch, what lies between does not
    let [x, y, _] = path.at(0.5);
    let arc = program.moves[2].arc.as_mut().unwrap();
    arc.centre[0] += 0.01 * x;
    arc.centre[1] += 0.01 * y;
    let report = judged(&Part::cone(false, LOW, HIGH, 600, 20), &tool, &program);
    let kinds: Vec<_> = report.findings.iter().map(|f| (f.kind, f.line)).collect();
    assert!(kinds.contains(&(FindingKind::Excess, 13)) || kinds.contains(&(FindingKind::Gouge, 13)), "{kinds:?}");
}
