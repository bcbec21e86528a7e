//! Shank and holder: found where they meet the part, to the depth that arithmetic on paper gives.

use crate::common::{expected, limits, Part, Path, CLEARANCE};
use styluscam_geometry::{ModelFace, Sheet, SheetLaw, Stock, Tool, Vector};
use styluscam_motion::{Arc, Plane, Program, Watch};
use styluscam_verify::{cut_by, judge, Before, Contact, FindingKind, Passes, Report, Severity, Subject};

/// A floor at Z -30 and a wall at X 0 that rises to Z 0, 100 mm wide.
fn step() -> Part {
    let at = |x: f64, y: f64, z: f64| Vector::new(x, y, z);
    let vertices = vec![
        at(-50.0, -50.0, 0.0),
        at(0.0, -50.0, 0.0),
        at(0.0, 50.0, 0.0),
        at(-50.0, 50.0, 0.0),
        at(0.0, -50.0, -30.0),
        at(50.0, -50.0, -30.0),
        at(50.0, 50.0, -30.0),
        at(0.0, 50.0, -30.0),
    ];
    Part::new(vertices, &[[0, 1, 2], [0, 2, 3], [1, 4, 7], [1, 7, 2], [4, 5, 6], [4, 6, 7]])
}

fn tool(more: &str) -> Tool {
    let text = format!(r#"{{"profile": {{"kind": "ball", "diameter": 6.0}}{more}}}"#);
    Tool::new(serde_json::from_str(&text).unwrap()).unwrap()
}

/// Along the floor, the axis `x` from the wall; the tip `up` over the floor.
fn along(tool: &Tool, x: f64, up: f64) -> Program {
    let z = up - 30.0;
    Path::new().rapid([x, -10.0, CLEARANCE]).feed([x, -10.0, z]).feed([x, 10.0, z]).program(tool)
}

fn judged(tool: &Tool, sheet: Option<Sheet>, program: &Program) -> Report {
    let (part, tools) = (step(), [tool.clone()]);
    let subject = Subject { sheet, ..part.subject(&tools) };
    judge(program, &subject, &limits(), &Watch::default()).unwrap()
}

fn depth(report: &Report, kind: FindingKind) -> Option<f64> {
    report.findings.iter().find(|f| f.kind == kind).map(|f| f.value_mm.unwrap())
}

#[test]
fn a_shank_beside_a_wall() {
    for (base, radius) in [
        ("", 5.0),
        (r#", "base": {"kind": "cylindrical", "height": 20.0}"#, 5.0),
        (r#", "base": {"kind": "cylindrical", "height": 27.1}"#, 0.0), // 0.1 mm over the wall
        (r#", "base": {"kind": "chamfer", "height": 54.0}"#, 4.0),     // half of the cone is over the wall
    ] {
        let tool = tool(&format!(r#", "shank_diameter": 10.0{base}"#));
        for x in [3.5, 4.5, 5.5] {
            let report = judged(&tool, None, &along(&tool, x, 0.0));
            let found = depth(&report, FindingKind::ShankCollision);
            let cone: f64 = if base.contains("chamfer") { 2.0 / 54.0 } else { 0.0 };
            let expected = (radius - x) * cone.atan().cos();
            assert_eq!(found.is_some(), expected > 0.001, "{base} {x} {found:?}");
            if let Some(found) = found {
                assert!(
                    (found - expected).abs() < 1e-6 && report.findings[0].line == 12,
                    "{base} {x}: {found} {expected}"
                );
            }
            assert_eq!(depth(&report, FindingKind::HolderCollision), None);
        }
    }
}

#[test]
fn a_holder_over_an_edge() {
    let tool = tool(r#", "length": 28.0, "holder": {"diameter": 40.0, "length": 50.0}"#);
    let report = judged(&tool, None, &along(&tool, 10.0, 0.0));
    // 2 mm below the edge and 10 mm over it: the shorter path out is up
    assert!((depth(&report, FindingKind::HolderCollision).unwrap() - 2.0).abs() < 1e-6);
    assert!(report.findings[0].message.contains("stick out"), "{}", report.findings[0].message);
    assert_eq!(depth(&judged(&tool, None, &along(&tool, 10.0, 2.0005)), FindingKind::HolderCollision), None);
    assert!(judged(&tool, None, &along(&tool, 20.1, 0.0)).ok);
    // a sheet on the part comes off the clearance that is left
    let sheet = Sheet { thickness: 1.0, law: SheetLaw::Constant, model_face: ModelFace::Back };
    assert!(
        (depth(&judged(&tool, Some(sheet), &along(&tool, 10.0, 2.5)), FindingKind::HolderCollision).unwrap() - 0.5)
            .abs()
            < 1e-6
    );
}

#[test]
fn a_shank_on_an_arc() {
    // the arc bulges towards the wall: 4.6 mm from it in the middle, 5.1 at its ends
    let tool = tool(r#", "shank_diameter": 10.0"#);
    let half = (10.0_f64.powi(2) - 9.5_f64.powi(2)).sqrt();
    let mut program =
        Path::new().rapid([5.1, -half, CLEARANCE]).feed([5.1, -half, -30.0]).feed([5.1, half, -30.0]).program(&tool);
    program.moves[2].arc = Some(Arc { centre: [14.6, 0.0, 0.0], plane: Plane::Xy, clockwise: true, turns: 0 });
    let report = judged(&tool, None, &program);
    assert!((depth(&report, FindingKind::ShankCollision).unwrap() - 0.4).abs() < 1e-6, "{:?}", report.findings);
    program.moves[2].arc = None;
    assert!(judged(&tool, None, &program).ok);
}

/// By how much a pass along the part is found to cut too deep, mm.
fn deep(tool: &Tool, stock: &Stock, program: &Program) -> Option<f64> {
    let (part, tools) = (step(), [tool.clone()]);
    let expected = expected(&part, Contact::Touch, [-40.0, 0.0], Passes::Unordered { reason: "they are not" });
    let subject = Subject { stock: Some(stock), stock_is_stated: true, expected: &expected, ..part.subject(&tools) };
    let report = judge(program, &subject, &limits(), &Watch::default()).unwrap();
    let found = report.findings.iter().filter(|finding| finding.kind == FindingKind::StockAbove);
    assert!(found.clone().all(|finding| finding.severity == Severity::Warning));
    found.map(|finding| finding.value_mm.unwrap()).reduce(f64::max)
}

/// Level at a height along Y 0 in moves of a length, from beside the stock.
fn in_moves(tool: &Tool, z: f64, length: f64) -> Program {
    let mut path = Path::new().rapid([-60.0, 0.0, CLEARANCE]).feed([-60.0, 0.0, z]);
    let mut x = -60.0;
    while x < 60.0 {
        x += length;
        path = path.feed([x, 0.0, z]);
    }
    path.program(tool)
}

#[test]
fn a_pass_that_cuts_too_deep_is_found_however_short_its_moves_are() {
    let (ball, stock) = (tool(""), boxed(WIDE[0], WIDE[1]));
    for length in [120.0, 5.0, 2.0, 1.0, 0.5, 0.1] {
        let found = deep(&ball, &stock, &in_moves(&ball, -20.0, length)).unwrap();
        // a node is no farther from the axis than half a radius
        assert!((19.5..=20.0).contains(&found), "{length}: {found}");
        assert_eq!(deep(&ball, &stock, &in_moves(&ball, -6.0, length)), None, "{length}");
    }
}

#[test]
fn a_tool_much_narrower_than_the_stock_is_asked_too() {
    let fine = Tool::new(serde_json::from_str(r#"{"profile": {"kind": "flat", "diameter": 0.8}}"#).unwrap()).unwrap();
    for y in [0.0, 0.13, 0.25, 0.4] {
        let stock = boxed([-250.0, -250.0 + y, -30.0], [250.0, 250.0 + y, 0.0]);
        assert_eq!(deep(&fine, &stock, &in_moves(&fine, -20.0, 0.3)), Some(20.0), "{y}");
    }
}

#[test]
fn a_skin_on_a_wall_may_be_as_high_as_it_is() {
    // along the wall of a corner and back along the other, with 0.5 mm on both
    let ball = tool("");
    let corner = [boxed([-50.0, -3.5, -30.0], [50.0, -3.0, 0.0]), boxed([3.0, -50.0, -30.0], [3.5, 50.0, 0.0])];
    let mut path = Path::new().rapid([-60.0, 0.0, CLEARANCE]).feed([-60.0, 0.0, -20.0]);
    for i in 0..=300 {
        path = path.feed([-60.0 + 0.2 * f64::from(i), 0.0, -20.0]);
    }
    for i in 0..=300 {
        path = path.feed([0.0, 0.2 * f64::from(i), -20.0]);
    }
    let program = path.program(&ball);
    for stock in corner {
        assert_eq!(deep(&ball, &stock, &program), None);
    }
}

/// The floor in a box of stock, what was cut of that before, and how far the holder and the shank are in it, mm.
fn in_stock(tool: &Tool, stock: &Stock, before: Option<&Before>, program: &Program) -> [Option<f64>; 2] {
    let (part, tools) = (step(), [tool.clone()]);
    let subject = Subject { stock: Some(stock), stock_is_stated: true, before, ..part.subject(&tools) };
    let report = judge(program, &subject, &limits(), &Watch::default()).unwrap();
    [FindingKind::HolderCollision, FindingKind::ShankCollision].map(|kind| depth(&report, kind))
}

fn boxed(low: [f64; 3], high: [f64; 3]) -> Stock {
    Stock::of_box(Vector::from(low), Vector::from(high))
}

const WIDE: [[f64; 3]; 2] = [[-50.0, -50.0, -30.0], [50.0, 50.0, 0.0]];
const HELD: &str = r#", "length": 24.0, "holder": {"diameter": 40.0, "length": 50.0}"#;

#[test]
fn a_holder_in_stock_that_stands_beside_the_slot() {
    let held = tool(HELD);
    let path = along(&held, 25.0, 0.0);
    let found = in_stock(&held, &boxed(WIDE[0], WIDE[1]), None, &path);
    assert!((found[0].unwrap() - 6.0).abs() < 1e-9 && found[1].is_none(), "{found:?}");
    // the stock ends at the holder's underside, or in plan where the holder does not come
    let low = boxed(WIDE[0], [50.0, 50.0, -6.0]);
    assert_eq!(in_stock(&held, &low, None, &path), [None; 2]);
    let aside = boxed(WIDE[0], [4.9, 50.0, 0.0]);
    assert_eq!(in_stock(&held, &aside, None, &path), [None; 2]);
    let under = boxed(WIDE[0], [6.0, 50.0, 0.0]);
    assert!(in_stock(&held, &under, None, &path)[0].is_some());
}

#[test]
fn a_shank_in_a_slot_that_is_narrower() {
    let wide = tool(r#", "shank_diameter": 10.0, "base": {"kind": "cylindrical", "height": 17.0}"#);
    let found = in_stock(&wide, &boxed(WIDE[0], WIDE[1]), None, &along(&wide, 25.0, 0.0));
    assert!((found[1].unwrap() - 10.0).abs() < 1e-9 && found[0].is_none(), "{found:?}");
    assert_eq!(in_stock(&wide, &boxed(WIDE[0], WIDE[1]), None, &along(&wide, 25.0, 10.0)), [None; 2]);
}

#[test]
fn what_was_cut_before_is_no_stock() {
    let (held, long, stock) = (tool(HELD), tool(""), boxed(WIDE[0], WIDE[1]));
    let rows = |step: f64| {
        let mut path = Path::new().rapid([0.0, -60.0, CLEARANCE]);
        for row in 0..=20 {
            let x = f64::from(row) * step;
            path = path.feed([x, -60.0, -30.0]).feed([x, 60.0, -30.0]).feed([x, 60.0, CLEARANCE]).rapid([
                x + step,
                -60.0,
                CLEARANCE,
            ]);
        }
        path.program(&long)
    };
    let (part, tools) = (step(), [long.clone()]);
    let subject = Subject { stock: Some(&stock), ..part.subject(&tools) };
    let before = |step: f64| cut_by(&rows(step), &subject, &limits());
    let path = along(&held, 25.0, 0.0);
    assert_eq!(in_stock(&held, &stock, Some(&before(2.5)), &path), [None; 2]);
    // ridges of 4 mm stand between rows that are farther apart than the tool is wide
    let found = in_stock(&held, &stock, Some(&before(10.0)), &path)[0].unwrap();
    assert!((found - 6.0).abs() < 1e-9, "{found}");
}

#[test]
fn what_the_profile_takes_on_the_way_down_is_not_under_the_holder() {
    let held = tool(HELD);
    let down = Path::new().rapid([25.0, 0.0, CLEARANCE]).feed([25.0, 0.0, -30.0]).program(&held);
    let narrow = boxed([22.2, -2.8, -30.0], [27.8, 2.8, 0.0]);
    // the corners of the box are outside the tool
    assert!((in_stock(&held, &narrow, None, &down)[0].unwrap() - 6.0).abs() < 1e-9);
    let within = boxed([23.0, -2.0, -30.0], [27.0, 2.0, 0.0]);
    assert_eq!(in_stock(&held, &within, None, &down), [None; 2]);
    let ramp = Path::new().rapid([23.9, 0.0, CLEARANCE]).feed([23.9, 0.0, 0.0]).feed([26.1, 0.0, -30.0]).program(&held);
    let within = boxed([23.9, -2.0, -30.0], [26.1, 2.0, 0.0]);
    assert_eq!(in_stock(&held, &within, None, &ramp), [None; 2]);
}

#[test]
fn a_holder_in_a_wall_of_stock_on_an_arc() {
    // round a block from outside: chords of the path would be farther off than the holder reaches into it
    let held = tool(HELD);
    let stock = Stock::cylinder([0.0; 2], 45.0, [-30.0, 0.0]);
    for (over, is_found) in [(0.04, false), (0.7, true), (1.0, true)] {
        let side = (65.0 - over) * std::f64::consts::FRAC_1_SQRT_2;
        let ends = [[side, -side, -30.0], [side, side, -30.0]];
        let mut program = Path::new().rapid([side, -side, CLEARANCE]).feed(ends[0]).feed(ends[1]).program(&held);
        program.moves[2].arc = Some(Arc { centre: [0.0; 3], plane: Plane::Xy, clockwise: false, turns: 0 });
        let found = in_stock(&held, &stock, None, &program)[0];
        assert_eq!(found.is_some(), is_found, "{over}: {found:?}");
    }
}

#[test]
fn a_holder_in_the_part_is_not_said_to_be_in_stock() {
    let (part, held, stock) = (step(), tool(HELD), boxed([-50.0, -50.0, -30.0], [0.0, 50.0, 0.0]));
    let tools = [held.clone()];
    let subject = Subject { stock: Some(&stock), stock_is_stated: true, ..part.subject(&tools) };
    let report = judge(&along(&held, 10.0, 0.0), &subject, &limits(), &Watch::default()).unwrap();
    let found: Vec<_> = report.findings.iter().filter(|finding| finding.kind == FindingKind::HolderCollision).collect();
    assert!(found.iter().all(|finding| finding.message.contains("enters the part")), "{found:?}");
    assert!(!found.is_empty());
}
