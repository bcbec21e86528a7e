//! Shank and holder: found where they meet the part, to the depth that arithmetic on paper gives.
#![allow(clippy::disallowed_methods, clippy::unwrap_used)] // helpers of tests are not test functions

mod common;

use common::{limits, Part, Path, CLEARANCE};
use styluscam_geometry::{ModelFace, Sheet, SheetLaw, Tool, Vector};
use styluscam_motion::{Arc, Plane, Program, Watch};
use styluscam_verify::{judge, FindingKind, Report};

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
    let subject = styluscam_verify::Subject { sheet, ..part.subject(&tools) };
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
