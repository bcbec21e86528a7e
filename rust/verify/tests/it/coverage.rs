//! What passes leave: closed forms, and the distance by brute force.

use crate::common::{ball, clothoid, limits, Part, Path, CLEARANCE};
use styluscam_geometry::{Tool, Vector};
use styluscam_motion::{Program, Watch};
use styluscam_verify::{coverage, FaceCoverage};

/// A plane of 20 x 20 mm that rises along X.
fn ramp(slope: f64) -> Part {
    let corners = [[0.0, 0.0], [20.0, 0.0], [20.0, 20.0], [0.0, 20.0]];
    let vertices = corners.map(|[x, y]| Vector::new(x * slope.cos(), y, x * slope.sin()));
    Part::new(vertices.to_vec(), &[[0, 1, 2], [0, 2, 3]])
}

/// Level passes over the ramp, `pitch` mm apart on it, from one of its edges to a share of it.
fn passes(tool: &Tool, slope: f64, pitch: f64, share: f64) -> Program {
    let (r, z) = tool.cutter().point_at(slope);
    let mut path = Path::new();
    for row in 0..=(share * 20.0 / pitch).round() as usize {
        let along = pitch * row as f64;
        let tip = |y: f64| [along * slope.cos() - r, y, along * slope.sin() - z];
        let [x, y, _] = tip(-10.0);
        path = path.rapid([x, y, CLEARANCE]).feed(tip(-10.0)).feed(tip(30.0));
    }
    path.program(tool)
}

fn covered(part: &Part, tool: &Tool, program: &Program) -> FaceCoverage {
    let tools = [tool.clone()];
    let found = coverage(program, &part.subject(&tools), &limits(), &[true, true], &Watch::default()).unwrap();
    assert_eq!(found.len(), 1);
    found[0]
}

#[test]
fn the_scallop_of_a_ball_is_that_of_its_circle() {
    for (slope, pitch) in [(0.0, 0.5), (0.6, 0.5), (0.6, 0.8), (1.2, 0.3)] {
        let (part, tool) = (ramp(slope), ball(6.0));
        let found = covered(&part, &tool, &passes(&tool, slope, pitch, 1.0));
        let height = 3.0 - (9.0_f64 - 0.25 * pitch * pitch).sqrt();
        assert!((found.scallop / height - 1.0).abs() < 0.01, "{slope} {pitch}: {} {height}", found.scallop);
        // a parabola's mean is a third of its height
        assert!((3.0 * found.mean / height - 1.0).abs() < 0.01, "{slope} {pitch}: {} {height}", found.mean);
        assert!((found.covered - 1.0).abs() < 1e-12 && (found.area - 400.0).abs() < 1e-9);
    }
}

#[test]
fn what_no_pass_comes_near_is_not_covered() {
    let (part, tool) = (ramp(0.4), clothoid(8.0));
    let found = covered(&part, &tool, &passes(&tool, 0.4, 0.5, 0.5));
    assert!(found.covered > 0.5 && found.covered < 0.58, "{found:?}");
    // the far edge, from the last pass: by the tool's distance
    let (r, z) = tool.cutter().point_at(0.4);
    let tip = Vector::new(10.0 * 0.4_f64.cos() - r, 0.0, 10.0 * 0.4_f64.sin() - z);
    let far = Vector::new(20.0 * 0.4_f64.cos(), 0.0, 20.0 * 0.4_f64.sin()) - tip;
    let left = tool.cutter().distance(far.x.abs(), far.z).0;
    assert!((found.left.unwrap() / left - 1.0).abs() < 0.01, "{:?} {left}", found.left);
    assert!(found.scallop <= 0.08 && found.at.unwrap()[0] > 19.8 * 0.4_f64.cos());
}

#[test]
fn a_program_that_touches_nothing_leaves_everything() {
    let (part, tool) = (ramp(0.0), ball(6.0));
    let found = covered(&part, &tool, &Path::new().rapid([0.0, 0.0, CLEARANCE]).program(&tool));
    assert!(found.covered == 0.0 && found.left.is_none(), "{found:?}");
}
