//! Contours of equal scallop: how far apart they lie, and what has a pass of its own.

use styluscam_geometry::{kinds, Mesh, Tool, ToolDocument, Vector};
use styluscam_motion::Watch;
use styluscam_toolpath::forming::{constant_scallop, Contours};
use styluscam_toolpath::offset::{Envelope, Index};
use styluscam_toolpath::{Pass, Surface};

const RADIUS: f64 = 3.0;
const SCALLOP: f64 = 0.02;
const MARGIN: f64 = 0.001;
/// Of a scallop passes aim at so much.
const AIM: f64 = 0.985;

fn passes(vertices: &[[f64; 3]], triangles: &[[i64; 3]]) -> Vec<Pass> {
    let mesh = Mesh::new(vertices.iter().copied().map(Vector::from).collect(), triangles, &[]).unwrap();
    let ball = kinds::Ball { diameter: 2.0 * RADIUS, radius: None, tip_flat: 0.0 };
    let tool = Tool::new(ToolDocument::of(ball.into())).unwrap();
    let index = Index::new(&mesh);
    let envelope = Envelope::new(&mesh, &index, &tool, None, MARGIN);
    let selected = vec![true; triangles.len()];
    let contours = Contours { scallop: SCALLOP, spacing: 0.5, narrow: 0.1 };
    let surface = Surface::new(&envelope, &selected);
    constant_scallop(&surface, &tool.body(None), &contours, 0.001, &Watch::default()).unwrap()
}

/// Width of a ball's section at the height that passes aim at, mm.
fn chord() -> f64 {
    let below = RADIUS - AIM * SCALLOP;
    2.0 * (RADIUS * RADIUS - below * below).sqrt()
}

/// The largest of some values of a pass's points.
fn farthest(pass: &Pass, value: impl Fn(&Vector) -> f64) -> f64 {
    pass.points.iter().map(|point| value(&point.tip)).fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn on_a_plate_contours_are_a_chord_apart() {
    let (width, height) = (20.0, 12.0);
    let corners = [[-width, -height, 0.0], [width, -height, 0.0], [width, height, 0.0], [-width, height, 0.0]];
    let passes = passes(&corners, &[[0, 1, 2], [0, 2, 3]]);
    let contours: Vec<&Pass> = passes.iter().filter(|pass| pass.closed).collect();
    let count = (height / chord()).ceil() as usize;
    assert!((count - 1..=count + 1).contains(&contours.len()), "{} of {count}", contours.len());
    // but for the innermost, on whose ridge fronts meet
    for pass in contours.iter().filter(|pass| pass.group + 2 < count) {
        // the border lies where the ball leans by a degree over the edge
        let inwards = (pass.group as f64 + 0.48) * chord() - (RADIUS + MARGIN) * 1.0_f64.to_radians().sin();
        let found = [width - farthest(pass, |tip| tip.x), height - farthest(pass, |tip| -tip.y)];
        assert!(
            found.iter().all(|found| (found - inwards).abs() < 0.02 * chord()),
            "{}: {found:?} {inwards}",
            pass.group
        );
        assert!(pass.points.iter().all(|point| (point.tip.z - MARGIN).abs() < 1e-9));
    }
    // along the corners' bisectors contours leave more: from each corner a pass leads inwards
    for [x, y] in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
        let off = |tip: &Vector| ((width - x * tip.x) - (height - y * tip.y)).abs();
        let leads_inwards = |pass: &&Pass| {
            let on = pass.points.iter().filter(|point| off(&point.tip) < 0.1 * chord());
            let from_corner = on.map(|point| height - y * point.tip.y);
            let (near, far) = from_corner.fold((f64::INFINITY, 0.0), |(a, b), d| (d.min(a), d.max(b)));
            !pass.closed && near < chord() && far > 0.8 * height
        };
        assert!(passes.iter().any(|pass| leads_inwards(&pass)), "no pass from the corner {x} {y}");
    }
}

#[test]
fn a_hollow_crease_has_a_pass() {
    let vertices = [
        [-10.0, -8.0, 10.0],
        [0.0, -8.0, 0.0],
        [10.0, -8.0, 4.0],
        [-10.0, 8.0, 10.0],
        [0.0, 8.0, 0.0],
        [10.0, 8.0, 4.0],
    ];
    let passes = passes(&vertices, &[[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]]);
    // the ball touches planes of -45 and 21.8 degrees: its centre is as far off both
    let (steep, gentle) = (std::f64::consts::FRAC_PI_4, 0.4_f64.atan());
    let off = RADIUS + MARGIN;
    let x = off * (gentle.cos().recip() - steep.cos().recip()) / (-1.0 - 0.4);
    let along = passes.iter().find(|pass| farthest(pass, |tip| (tip.x - x).abs()) < 2e-3);
    let ends = along.map(|pass| [farthest(pass, |tip| -tip.y), farthest(pass, |tip| tip.y)]);
    assert!(ends.is_some_and(|ends| ends.iter().all(|end| *end > 7.5)), "{ends:?}");
}
