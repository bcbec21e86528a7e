//! Scallops as they are measured: the tables of closed forms, both directions, and curved parts.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::common::{ball, expected, limits, tool, Part, Path, CLEARANCE};
use styluscam_geometry::{Tool, Vector};
use styluscam_motion::{Program, Watch};
use styluscam_verify::{
    judge, scallops, Across, Contact, ExpectedOperation, FindingKind, Height, OrderedPasses, Passes, Pitch, Scalar,
    Severity, Subject,
};

/// A wall that rises along X, 10 mm up it and 12 mm wide.
fn wall(slope: f64) -> Part {
    let corners = [[0.0, -6.0], [10.0, -6.0], [10.0, 6.0], [0.0, 6.0]];
    let vertices = corners.map(|[x, y]| Vector::new(x * slope.cos(), y, x * slope.sin()));
    Part::new(vertices.to_vec(), &[[0, 1, 2], [0, 2, 3]])
}

fn by(part: &Part, scalar: Arc<dyn Scalar>, pitch: Pitch) -> [ExpectedOperation; 1] {
    let passes = Passes::Ordered(OrderedPasses { scalar, pitch, continuous: false, smallest_feature: 1.0 });
    expected(part, Contact::Touch, [-100.0, 100.0], passes)
}

/// Passes on the wall, `pitch` mm apart along it, each `off` mm off it.
fn passes(tool: &Tool, slope: f64, [pitch, off]: [f64; 2], up_the_wall: bool) -> Program {
    let (r, z) = tool.cutter().point_at(slope);
    let tip = |up: f64, y: f64| [up * slope.cos() - r - off * slope.sin(), y, up * slope.sin() - z + off * slope.cos()];
    let mut path = Path::new();
    for pass in -2..=12 {
        let at = f64::from(pass) * pitch;
        let [from, to] = if up_the_wall { [[-2.0, at - 5.0], [12.0, at - 5.0]] } else { [[at, -8.0], [at, 8.0]] };
        let (from, to) = (tip(from[0], from[1]), tip(to[0], to[1]));
        path = path.rapid([from[0], from[1], 90.0]).feed(from).feed(to).rapid([to[0], to[1], 90.0]);
    }
    path.program(tool)
}

/// The lowest and the highest scallop that is measured, micrometres.
fn measured(part: &Part, tool: &Tool, expected: &[ExpectedOperation], program: &Program) -> [f64; 2] {
    let tools = [tool.clone()];
    let subject = Subject { expected, ..part.subject(&tools) };
    let found = scallops(program, &subject, &limits(), &expected[0], 300, &Watch::default()).unwrap();
    assert!(found.len() > 150, "{}", found.len());
    let heights = found.iter().map(|scallop| 1e3 * scallop.height);
    [heights.clone().fold(f64::INFINITY, f64::min), heights.fold(0.0, f64::max)]
}

#[test]
fn scallops_are_those_of_the_tables() {
    let profile = |text: &str| tool(serde_json::from_str(text).unwrap());
    let ball = profile(r#"{"kind": "ball", "diameter": 10.0}"#);
    let parabola = profile(r#"{"kind": "parabola", "apex_radius": 8.0, "diameter": 60.0}"#);
    let ellipse = profile(r#"{"kind": "ellipse", "radial": 6.0, "axial": 4.0}"#);
    let power = profile(r#"{"kind": "power", "coefficient": 0.016666666666666666, "exponent": 3.0, "diameter": 24.0}"#);
    for (tool, up_the_wall, table) in [
        (&ball, false, [25.063, 25.063, 25.063]),
        (&parabola, false, [12.965, 5.524, 1.953]),
        (&ellipse, false, [17.078, 28.852, 37.584]),
        (&power, false, [27.866, 19.747, 9.194]),
        (&parabola, true, [14.683, 11.049, 7.813]),
        (&power, true, [15.914, 19.795, 18.409]),
    ] {
        for (slope_deg, height) in [20.0_f64, 45.0, 60.0].into_iter().zip(table) {
            let (part, slope) = (wall(slope_deg.to_radians()), slope_deg.to_radians());
            let rows: Arc<dyn Scalar> = Arc::new(Across { direction_rad: 0.0 });
            let scalar = if up_the_wall { rows } else { Arc::new(Height) };
            let step = if up_the_wall { 1.0 } else { slope.sin() };
            // a path that is 4 um off the part leaves the same scallop above its floor
            let program = passes(tool, slope, [1.0, 0.004], up_the_wall);
            let expected = by(&part, scalar, Pitch::Even(step));
            for found in measured(&part, tool, &expected, &program) {
                assert!((found / height - 1.0).abs() < 0.01, "{slope_deg} {up_the_wall}: {found} for {height}");
            }
        }
    }
}

/// A cap of 60 mm about the Z axis up to 40 degrees from its top, seen from outside; or from inside, a dish.
fn cap(inside: bool) -> Part {
    let (rings, segments, radius) = (120_u32, 360_u32, 60.0);
    let mut vertices = vec![Vector::new(0.0, 0.0, 0.0)];
    for ring in 1..=rings {
        let angle = 40.0_f64.to_radians() * f64::from(ring) / f64::from(rings);
        for i in 0..segments {
            let (sin, cos) = (TAU * f64::from(i) / f64::from(segments)).sin_cos();
            let fall = radius * (1.0 - angle.cos());
            let (r, z) = (radius * angle.sin(), if inside { fall } else { -fall });
            vertices.push(Vector::new(r * cos, r * sin, z));
        }
    }
    let at = |ring: u32, i: u32| i64::from(1 + (ring - 1) * segments + i % segments);
    let mut triangles: Vec<[i64; 3]> = (0..segments).map(|i| [0, at(1, i), at(1, i + 1)]).collect();
    for ring in 1..rings {
        for i in 0..segments {
            let [a, b, c, d] = [at(ring, i), at(ring + 1, i), at(ring + 1, i + 1), at(ring, i + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Part::new(vertices, &triangles)
}

/// Loops on the cap, `pitch` mm apart along it; `left_out` is left out.
fn loops(tool: &Tool, inside: bool, pitch: f64, left_out: Option<i32>) -> Program {
    let mut path = Path::new();
    for number in (6..40).rev().filter(|number| Some(*number) != left_out) {
        let angle = f64::from(number) * pitch / 60.0;
        let centre = if inside { 60.0 - 3.0 } else { 60.0 + 3.0 };
        let height = if inside { 60.0 - centre * angle.cos() } else { centre * angle.cos() - 60.0 };
        let tip = |turn: f64| {
            let (sin, cos) = (TAU * turn).sin_cos();
            [centre * angle.sin() * cos, centre * angle.sin() * sin, height - 3.0]
        };
        let [x, y, z] = tip(0.0);
        path = path.rapid([x, y, CLEARANCE + 20.0]).feed([x, y, z]);
        for i in 1..=720 {
            path = path.feed(tip(f64::from(i) / 720.0));
        }
        path = path.rapid([x, y, CLEARANCE + 20.0]);
    }
    path.program(tool)
}

#[test]
fn on_a_curved_part_they_are_those_of_two_circles() {
    let (tool, pitch) = (ball(6.0), 0.9);
    let plane = 1e3 * (3.0 - (9.0_f64 - 0.25 * pitch * pitch).sqrt());
    // convex: 1.0504 times the plane's, hollow: 0.9497 times
    for (inside, ratio) in [(false, 1.0504), (true, 0.9497)] {
        let part = cap(inside);
        let program = loops(&tool, inside, pitch, None);
        let expected = by(&part, Arc::new(Height), Pitch::Even(0.6));
        let [low, high] = measured(&part, &tool, &expected, &program).map(|found| found / plane / ratio);
        assert!((0.98..=1.02).contains(&low) && (0.98..=1.02).contains(&high), "{inside}: {low} {high}");
    }
}

#[test]
fn a_scallop_above_the_one_asked_for_is_found() {
    let (tool, part) = (ball(6.0), cap(true));
    let scallop = 0.9497 * (3.0 - (9.0_f64 - 0.25 * 0.81).sqrt());
    let findings = |height: f64, left_out: Option<i32>| {
        let expected = by(&part, Arc::new(Height), Pitch::Scallop { height, steps: [0.01, 3.0] });
        let tools = [tool.clone()];
        let subject = Subject { expected: &expected, ..part.subject(&tools) };
        let report = judge(&loops(&tool, true, 0.9, left_out), &subject, &limits(), &Watch::default()).unwrap();
        let scallops = report.groups.iter().filter(|group| group.kind == FindingKind::Scallop);
        scallops.map(|group| group.severity).collect::<Vec<_>>()
    };
    assert!(findings(1.01 * scallop, None).is_empty());
    assert_eq!(findings(0.9 * scallop, None), [Severity::Warning]);
    assert!(findings(1.01 * scallop, Some(20)).contains(&Severity::Error));
}
