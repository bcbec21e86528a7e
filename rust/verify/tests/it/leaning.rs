//! Tools that lean: what they enter and what they leave, to the depths that arithmetic on paper gives.

use std::sync::Arc;

use crate::common::{expected, limits, Part, Path};
use styluscam_geometry::{Bvh, Mesh, NurbsCurve, Tool, Vector};
use styluscam_motion::{Move, Program, Role, UnitAxis, Watch};
use styluscam_verify::{judge, CheckFaces, Contact, FindingKind, FlankFace, FlankPasses, Passes, Report, Subject};

const LENGTH: f64 = 40.0;
const HEIGHT: f64 = 20.0;
const RADIUS: f64 = 4.0;
/// How far the tool leans along the wall, rad.
const LEAN: f64 = 0.2;

/// A block whose upright wall at Y 0 is face 1; it stands on a plate at Z 0, face 2, where there is one.
fn block(on_plate: bool) -> Part {
    let at = |x: f64, y: f64, z: f64| Vector::new(x, y, z);
    let mut vertices = vec![
        at(0.0, 0.0, 0.0),
        at(LENGTH, 0.0, 0.0),
        at(LENGTH, 0.0, HEIGHT),
        at(0.0, 0.0, HEIGHT),
        at(LENGTH, -30.0, HEIGHT),
        at(0.0, -30.0, HEIGHT),
    ];
    // the wall looks to +Y
    let mut triangles = vec![[0, 2, 1], [0, 3, 2], [3, 4, 2], [3, 5, 4]];
    let mut faces = vec![1, 1, 3, 3];
    if on_plate {
        vertices.extend([at(-50.0, 0.0, 0.0), at(90.0, 0.0, 0.0), at(90.0, 50.0, 0.0), at(-50.0, 50.0, 0.0)]);
        triangles.extend([[6, 7, 8], [6, 8, 9]]);
        faces.extend([2, 2]);
    }
    let mesh = Mesh::new(vertices, &triangles, &faces).unwrap();
    let bvh = Bvh::new(&mesh);
    Part { mesh, bvh }
}

fn line(z: f64) -> NurbsCurve {
    let poles = [[0.0, 0.0, z, 1.0], [LENGTH, 0.0, z, 1.0]];
    NurbsCurve::new(1, vec![0.0, 0.0, 1.0, 1.0], &poles).unwrap()
}

fn wall() -> FlankFace {
    // seen along +X with the upper rail above, +Y is on the left
    FlankFace { name: "Face1".into(), face: Some(1), rails: [line(0.0), line(HEIGHT)], is_left: true }
}

fn tool(more: &str) -> Tool {
    Tool::new(serde_json::from_str(&format!(r#"{{"profile": {{"kind": "flat", "diameter": 8.0}}{more}}}"#)).unwrap())
        .unwrap()
}

fn tool_of(diameter: f64) -> Tool {
    let text = format!(r#"{{"profile": {{"kind": "flat", "diameter": {diameter:?}}}}}"#);
    Tool::new(serde_json::from_str(&text).unwrap()).unwrap()
}

fn leaning(angle: f64) -> UnitAxis {
    UnitAxis::new([angle.sin(), 0.0, angle.cos()]).unwrap()
}

/// Along the wall in so many moves, the axis `y` from it and the tip `z` over its foot: from 10 mm before it to 10 mm behind it.
fn pass(tool: &Tool, [y, z]: [f64; 2], moves: usize) -> Program {
    let axis = leaning(LEAN);
    let mut path = Path::new().rapid([-10.0, y, 40.0]).feed([-10.0, y, z]);
    for i in 1..=moves {
        path = path.feed([-10.0 + 60.0 * i as f64 / moves as f64, y, z]);
    }
    path = path.rapid([50.0, y, 40.0]);
    let last = path.moves.len() - 1;
    for (i, step) in path.moves.iter_mut().enumerate() {
        *step = step.with_axis(axis);
        if i > 0 && i < last {
            *step = step.role(if i == 1 { Role::Lead } else { Role::Cut });
        }
    }
    path.program(tool)
}

fn judged(part: &Part, tool: &Tool, program: &Program, left: f64) -> Report {
    let passes = Passes::Flank(FlankPasses { faces: vec![wall()], left, foot: 0.0, max_error: 0.005 });
    let mut expected = expected(part, Contact::Clear, [f64::NEG_INFINITY, f64::INFINITY], passes);
    expected[0].expectation.selected.fill(false);
    let tools = [tool.clone()];
    let subject = Subject { expected: &expected, ..part.subject(&tools) };
    judge(program, &subject, &limits(), &Watch::default()).unwrap()
}

fn kinds(report: &Report) -> Vec<FindingKind> {
    report.counts.keys().copied().collect()
}

fn value(report: &Report, kind: FindingKind) -> f64 {
    report.findings.iter().find(|finding| finding.kind == kind).unwrap().value_mm.unwrap()
}

#[test]
fn a_leaning_cylinder_along_a_flat_wall_leaves_nothing() {
    let (part, tool) = (block(false), tool(""));
    for moves in [1, 7] {
        let report = judged(&part, &tool, &pass(&tool, [RADIUS, -5.0], moves), 0.0);
        assert!(report.ok && report.findings.is_empty(), "{:?}", report.findings);
        let [flank] = &report.flanks[..] else { panic!("{:?}", report.flanks) };
        assert!(flank.faces[0].over < 1e-6 && flank.faces[0].under < 1e-6, "{flank:?}");
        assert!(flank.faces[0].missed == 0.0 && flank.turning.speed_max < 1e-6);
    }
}

#[test]
fn an_upright_tool_in_an_operation_whose_tool_may_lean_is_measured_likewise() {
    let (part, tool) = (block(false), tool(""));
    let upright = |y: f64| {
        let mut program = pass(&tool, [y, -5.0], 3);
        program.moves.iter_mut().for_each(|step| *step = step.with_axis(UnitAxis::UP));
        judged(&part, &tool, &program, 0.0)
    };
    let report = upright(RADIUS - 0.004);
    assert!(report.ok && report.flanks[0].faces[0].missed == 0.0, "{:?}", report.findings);
    assert!((report.flanks[0].faces[0].over - 0.004).abs() < 1e-6);
    assert_eq!(kinds(&upright(RADIUS - 0.03)), [FindingKind::Gouge]);
}

#[test]
fn what_is_entered_and_left_is_measured() {
    let (part, tool) = (block(false), tool(""));
    let entered = judged(&part, &tool, &pass(&tool, [RADIUS - 0.03, -5.0], 3), 0.0);
    assert_eq!(kinds(&entered), [FindingKind::Gouge]);
    assert!((value(&entered, FindingKind::Gouge) - 0.03).abs() < 1e-6 && (entered.gouge_max - 0.03).abs() < 1e-6);
    let left = judged(&part, &tool, &pass(&tool, [RADIUS + 0.02, -5.0], 3), 0.0);
    assert_eq!(kinds(&left), [FindingKind::Excess]);
    assert!((value(&left, FindingKind::Excess) - 0.02).abs() < 1e-6 && (left.excess_max - 0.02).abs() < 1e-6);
    // it is what is to be left
    assert!(judged(&part, &tool, &pass(&tool, [RADIUS + 0.02, -5.0], 3), 0.02).ok);
    // within max_error the edges of the wall's neighbours are entered as well
    assert!(judged(&part, &tool, &pass(&tool, [RADIUS - 0.004, -5.0], 3), 0.0).ok);
}

#[test]
fn what_the_end_of_the_tool_does_not_reach_is_missed() {
    let (part, tool) = (block(false), tool(""));
    let report = judged(&part, &tool, &pass(&tool, [RADIUS, 5.0], 3), 0.0);
    assert_eq!(kinds(&report), [FindingKind::MissingPass]);
    // the rim is at the wall at the tip's height, and below it where the tool leans forward
    let missed = report.flanks[0].faces[0].missed;
    assert!((0.20..0.27).contains(&missed), "{missed}");
}

#[test]
fn the_rim_of_a_leaning_end_is_lower_than_its_tip() {
    let (part, tool) = (block(true), tool(""));
    let clear = judged(&part, &tool, &pass(&tool, [RADIUS, RADIUS * LEAN.sin()], 3), 0.0);
    assert!(!kinds(&clear).contains(&FindingKind::Gouge), "{:?}", clear.findings);
    let report = judged(&part, &tool, &pass(&tool, [RADIUS, 0.0], 3), 0.0);
    let depth = value(&report, FindingKind::Gouge);
    assert!((depth - RADIUS * LEAN.sin()).abs() < 1e-6, "{depth}");
}

#[test]
fn a_wide_shank_and_a_holder_hit_the_block() {
    let part = block(false);
    // the shank begins 12 mm up a tool whose tip is 5 mm below the foot: beside the wall
    let shank = tool(r#", "shank_diameter": 12.0, "length": 60.0, "base": {"kind": "cylindrical", "height": 12.0}"#);
    let report = judged(&part, &shank, &pass(&shank, [RADIUS, -5.0], 3), 0.0);
    assert!(kinds(&report).contains(&FindingKind::ShankCollision), "{:?}", report.findings);
    assert!((value(&report, FindingKind::ShankCollision) - 2.0).abs() < 1e-4, "{:?}", report.findings);
    let held = tool(r#", "length": 20.0, "holder": {"diameter": 30.0, "length": 40.0}"#);
    let report = judged(&part, &held, &pass(&held, [RADIUS, -5.0], 3), 0.0);
    assert!(kinds(&report).contains(&FindingKind::HolderCollision), "{:?}", report.findings);
}

#[test]
fn a_rapid_through_the_block_is_found() {
    let (part, tool) = (block(false), tool(""));
    let mut program = pass(&tool, [RADIUS, -5.0], 3);
    let last = program.moves.pop().unwrap();
    let through = Move::rapid([20.0, -20.0, 15.0]).with_axis(last.end.axis).on_line(99);
    program.moves.extend([through, last]);
    let report = judged(&part, &tool, &program, 0.0);
    assert!(kinds(&report).contains(&FindingKind::RapidIntoMaterial), "{:?}", report.findings);
}

#[test]
fn triangles_between_stated_rails_are_the_surface_s_own() {
    let (part, tool) = (block(false), tool(""));
    let report = |y: f64, max_error: f64| {
        let stated = FlankFace { face: None, name: "the stated rails".into(), ..wall() };
        let passes = Passes::Flank(FlankPasses { faces: vec![stated], left: 0.0, foot: 0.0, max_error });
        let mut expected = expected(&part, Contact::Clear, [f64::NEG_INFINITY, f64::INFINITY], passes);
        expected[0].expectation.selected.fill(false);
        let tools = [tool.clone()];
        let subject = Subject { expected: &expected, ..part.subject(&tools) };
        judge(&pass(&tool, [y, -5.0], 3), &subject, &limits(), &Watch::default()).unwrap()
    };
    assert!(report(RADIUS - 0.004, 0.005).ok, "{:?}", report(RADIUS - 0.004, 0.005).findings);
    assert!(!report(RADIUS - 0.006, 0.005).ok);
}

#[test]
fn check_faces_are_kept_away_from() {
    let (part, tool) = (block(true), tool(""));
    let plate: Vec<[i64; 3]> = vec![[6, 7, 8], [6, 8, 9]];
    let mesh = Mesh::new(part.mesh.vertices().to_vec(), &plate, &[]).unwrap();
    let bvh = Bvh::new(&mesh);
    let check = CheckFaces { mesh, bvh, clearance: 1.5 };
    let passes = Passes::Flank(FlankPasses { faces: vec![wall()], left: 0.0, foot: 0.0, max_error: 0.005 });
    let mut expected = expected(&part, Contact::Clear, [f64::NEG_INFINITY, f64::INFINITY], passes);
    expected[0].expectation.selected.fill(false);
    expected[0].expectation.region.check = Some(Arc::new(check));
    let tools = [tool.clone()];
    let subject = Subject { expected: &expected, ..part.subject(&tools) };
    // the rim is this far over the plate
    for (over, is_near) in [(1.0, true), (1.6, false)] {
        let program = pass(&tool, [RADIUS, RADIUS * LEAN.sin() + over], 3);
        let report = judge(&program, &subject, &limits(), &Watch::default()).unwrap();
        assert_eq!(kinds(&report).contains(&FindingKind::CheckClearance), is_near, "{:?}", report.findings);
        if is_near {
            assert!((value(&report, FindingKind::CheckClearance) - over).abs() < 1e-6);
        }
    }
}

#[test]
fn a_move_into_the_surface_between_its_samples_is_found() {
    let (part, tool) = (block(false), tool(""));
    let mut program = pass(&tool, [RADIUS, -5.0], 30);
    // samples are 0.62 mm apart along the wall and 1.25 mm up: in between, the rim of a slender tool that leans away pokes in
    let needle = tool_of(0.4);
    let away = UnitAxis::new([0.0, 0.3_f64.sin(), 0.3_f64.cos()]).unwrap();
    let at = program.moves.len() - 1;
    let poke = |depth: f64| {
        let tip = [20.31, 0.2 * 0.3_f64.cos() - depth, 9.3];
        Move::feed(tip, 600.0).role(Role::Cut).on_line(99).with_axis(away)
    };
    program.moves.splice(at..at, [poke(-1.0), poke(0.15), poke(-1.0)]);
    let report = judged(&part, &needle, &program, 0.0);
    assert!((value(&report, FindingKind::Gouge) - 0.15).abs() < 1e-3, "{:?}", report.findings);
}

#[test]
fn below_the_foot_nothing_is_owed() {
    let (part, tool) = (block(false), tool(""));
    let report = |foot: f64| {
        let passes = Passes::Flank(FlankPasses { faces: vec![wall()], left: 0.0, foot, max_error: 0.005 });
        let mut expected = expected(&part, Contact::Clear, [f64::NEG_INFINITY, f64::INFINITY], passes);
        expected[0].expectation.selected.fill(false);
        let tools = [tool.clone()];
        let subject = Subject { expected: &expected, ..part.subject(&tools) };
        judge(&pass(&tool, [RADIUS, 5.0], 3), &subject, &limits(), &Watch::default()).unwrap()
    };
    assert_eq!(kinds(&report(3.0)), [FindingKind::MissingPass]);
    assert!(report(6.0).ok, "{:?}", report(6.0).findings);
}

#[test]
fn a_sudden_turn_is_a_jump() {
    let (part, tool) = (block(false), tool(""));
    let mut program = pass(&tool, [RADIUS, -5.0], 40);
    for (i, step) in program.moves.iter_mut().enumerate() {
        let turned = if i > 20 { 0.05 } else { 0.0 };
        *step = step.with_axis(leaning(LEAN + 0.0005 * i as f64 + turned));
    }
    let report = judged(&part, &tool, &program, 0.0);
    assert_eq!(kinds(&report), [FindingKind::AxisJump], "{:?}", report.findings);
    assert!(report.ok, "it is a warning");
}

#[test]
fn a_leaning_tool_in_another_operation_is_an_error() {
    let (part, tool) = (block(false), tool(""));
    let passes = Passes::Unordered { reason: "none" };
    let expected = expected(&part, Contact::Clear, [f64::NEG_INFINITY, f64::INFINITY], passes);
    let (tools, program) = ([tool.clone()], pass(&tool, [RADIUS, -5.0], 3));
    let subject = Subject { expected: &expected, ..part.subject(&tools) };
    let report = judge(&program, &subject, &limits(), &Watch::default()).unwrap();
    assert!(kinds(&report).contains(&FindingKind::ToolAxis) && !report.ok);
}

#[test]
fn a_chord_enters_a_round_boss_by_its_sagitta() {
    // the tool goes along a chord of the path around a boss of radius 30, upright, its neighbours beyond it
    let axis = UnitAxis::new([0.0, (1e-4_f64).sin(), (1e-4_f64).cos()]).unwrap();
    let (boss, around) = (30.0, 30.0 + RADIUS);
    let tool = tool("");
    let at = |degrees: f64| degrees.to_radians().sin_cos();
    let mut path = Path::new();
    for i in 0..=6 {
        let (sin, cos) = at(10.0 * f64::from(i));
        let tip = [around * cos, around * sin, -1.0];
        path = if i == 0 { path.rapid([tip[0], tip[1], 40.0]).feed(tip) } else { path.feed(tip) };
    }
    let mut program = path.program(&tool);
    program.moves.iter_mut().for_each(|step| *step = step.with_axis(axis));
    let arc = |z: f64| {
        let (sin, cos) = at(25.0);
        // a quadratic arc from 5 to 55 degrees
        let turned = |x: f64, y: f64| {
            let (s, c) = at(30.0);
            [x * c - y * s, x * s + y * c]
        };
        let [a, b, c] = [turned(boss * cos, -boss * sin), turned(boss / cos, 0.0), turned(boss * cos, boss * sin)];
        let poles = [[a[0], a[1], z, 1.0], [b[0], b[1], z, cos], [c[0], c[1], z, 1.0]];
        NurbsCurve::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], &poles).unwrap()
    };
    let part = block(false);
    let face = FlankFace { name: "boss".into(), face: None, rails: [arc(0.0), arc(10.0)], is_left: false };
    let passes = Passes::Flank(FlankPasses { faces: vec![face], left: 0.0, foot: 0.0, max_error: 0.005 });
    let mut expected = expected(&part, Contact::Clear, [f64::NEG_INFINITY, f64::INFINITY], passes);
    expected[0].expectation.selected.fill(false);
    let tools = [tool];
    let subject = Subject { expected: &expected, ..part.subject(&tools) };
    let report = judge(&program, &subject, &limits(), &Watch::default()).unwrap();
    let sagitta = around * (1.0 - (5.0_f64).to_radians().cos());
    let found = report.flanks[0].faces[0].over;
    // the axis leans by 1e-4
    assert!((found - sagitta).abs() < 2e-3 && sagitta > 0.1, "{found} {sagitta}");
}
