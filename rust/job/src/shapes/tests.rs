use std::sync::Arc;

use styluscam_geometry::{kinds, Cutter, Facets, Frame, Mesh, ProfileDocument, Vector};

use super::*;
use crate::process::Die;
use crate::tests::setup::{frustum, job, with};
use crate::{Part, MAIN_CHANNEL};

const SHEET: &str = r#"
schema = 1
part = { file = "a.stl", units = "mm", model_face = "tool" }
setup = { sheet = { thickness = 0.5 } }
process = { kind = "spif" }
machine = { name = "linuxcnc" }
[tools.a]
profile = { kind = "ball", diameter = 3.0 }
[[operations]]
kind = "z-level"
step = { height = 1.0 }
tool = "a"
"#;

fn shapes_of(text: &str, channel: &'static str) -> Vec<Shape> {
    let job = job(text);
    shapes(&job, &Scene::new(&job, channel, &frustum()).unwrap(), 1e-3)
}

fn of(shapes: &[Shape], kind: ShapeKind) -> Mesh {
    let drawn = &shapes.iter().find(|shape| shape.kind == kind).unwrap().drawn;
    let triangles: Vec<[i64; 3]> = drawn.triangles.iter().map(|t| t.map(i64::from)).collect();
    Mesh::new(drawn.vertices.clone(), &triangles, &[]).unwrap()
}

fn volume(mesh: &Mesh) -> f64 {
    Facets::of(mesh, |_| true).volume()
}

#[test]
fn the_blank_lies_at_the_height_of_the_flat_sheet_and_reaches_as_far_as_what_holds_it() {
    let scene = Scene::new(&job(SHEET), MAIN_CHANNEL, &frustum()).unwrap();
    let (low, high) = of(&shapes_of(SHEET, MAIN_CHANNEL), ShapeKind::Blank).bounds();
    let part = scene.mesh.bounds();
    assert!((low - Vector::new(part.0.x, part.0.y, -0.5)).norm() < 1e-12);
    assert!((high - Vector::new(part.1.x, part.1.y, 0.0)).norm() < 1e-12);
    let fixture =
        "thickness = 0.5 }, fixture = { center = [1.0, 2.0], clamp = { opening = [100.0, 50.0], height = 4.0 } }";
    let held = shapes_of(&with(SHEET, "thickness = 0.5 }", fixture), MAIN_CHANNEL);
    for (kind, heights) in [(ShapeKind::Blank, [-0.5, 0.0]), (ShapeKind::Clamp, [0.0, 4.0])] {
        let (low, high) = of(&held, kind).bounds();
        assert!((low - Vector::new(-57.0, -31.0, heights[0])).norm() < 1e-9, "{kind:?} {low}");
        assert!((high - Vector::new(59.0, 35.0, heights[1])).norm() < 1e-9, "{kind:?} {high}");
    }
}

#[test]
fn the_formed_sheet_is_as_thick_as_its_law_states() {
    let scene = Scene::new(&job(SHEET), MAIN_CHANNEL, &frustum()).unwrap();
    let upper: Vec<usize> = (0..scene.mesh.triangles().len()).filter(|t| !scene.mesh.looks_down(*t)).collect();
    let area: f64 = upper.iter().map(|t| scene.mesh.area(*t)).sum();
    let plan: f64 = upper.iter().map(|t| scene.mesh.area(*t) * scene.mesh.normal(*t).z).sum();
    for face in ["tool", "mid", "back"] {
        let text = with(SHEET, "\"tool\"", &format!("\"{face}\""));
        let constant = volume(&of(&shapes_of(&text, MAIN_CHANNEL), ShapeKind::FormedSheet));
        assert!((constant / (0.5 * area) - 1.0).abs() < 0.05, "{face}: {constant} {}", 0.5 * area);
        let sine = with(&text, "thickness = 0.5", "thickness = 0.5, law = \"sine\"");
        let sine = volume(&of(&shapes_of(&sine, MAIN_CHANNEL), ShapeKind::FormedSheet));
        assert!((sine - 0.5 * plan).abs() < 1e-9, "{face}: {sine} {}", 0.5 * plan);
    }
}

#[test]
fn a_die_lies_under_the_sheet() {
    let job = job(&with(SHEET, "\"spif\"", "\"tpif\", die = \"female\""));
    let shapes = shapes(&job, &Scene::new(&job, MAIN_CHANNEL, &pit()).unwrap(), 1e-3);
    let [die, sheet] = [ShapeKind::Die(Die::Female), ShapeKind::FormedSheet].map(|kind| of(&shapes, kind));
    // together they fill what is between the sheet's upper face and the die's floor
    let (low, _) = die.bounds();
    let top = Facets::of(&sheet, |t| sheet.normal(t).z > 1e-6);
    let filled = top.body_to(&top.moved(|i| Vector::new(0.0, 0.0, low.z - top.points[i].z))).volume();
    let sum = volume(&die) + volume(&sheet);
    // 0.3 % are missing between both; why is not known yet
    assert!((sum / filled - 1.0).abs() < 5e-3 && volume(&die) > 0.0, "{sum} {filled}");
    assert!(shapes_of(SHEET, MAIN_CHANNEL).iter().all(|shape| shape.kind.key() != "die"));
}

#[test]
fn a_channel_from_below_has_the_same_shapes_turned() {
    let both = SHEET.replace("\"spif\"", "\"dsif\", support_tool = \"b\"").replace(
        "[[operations]]",
        "[tools.b]\nnumber = 2\nprofile = { kind = \"ball\", diameter = 2.0 }\n[[operations]]",
    );
    let both = with(
        &both,
        "machine = { name = \"linuxcnc\" }",
        "machine = { name = \"linuxcnc\" }\nmachines.support = { name = \"linuxcnc\" }",
    );
    let both = with(
        &both,
        "thickness = 0.5 }",
        "thickness = 0.5 }, fixture = { center = [1.0, 2.0], backing = { opening = 70.0 } }",
    );
    let [main, support] = [MAIN_CHANNEL, "support"].map(|channel| shapes_of(&both, channel));
    let half = Frame::turning_up(-Vector::z(), 0.0);
    assert_eq!(main.len(), support.len());
    for (a, b) in main.iter().zip(&support) {
        let [one, other] = [of(&main, a.kind).placed(&half), of(&support, b.kind)];
        assert!((volume(&one) / volume(&other) - 1.0).abs() < 1e-6, "{:?}", a.kind);
        let off = (one.bounds().0 - other.bounds().0).norm() + (one.bounds().1 - other.bounds().1).norm();
        assert!(off < 1e-6, "{:?} {off}", a.kind);
    }
}

/// A loop of a ball's tip around the middle, 0.1 mm apart.
fn round(radius: f64, z: f64) -> Vec<[f64; 3]> {
    let count = (63.0 * radius) as usize;
    let angle = move |i: usize| std::f64::consts::TAU * i as f64 / count as f64;
    (0..=count).map(|i| [radius * libm::cos(angle(i)), radius * libm::sin(angle(i)), z]).collect()
}

fn ball(diameter: f64) -> Cutter {
    let (profile, _) = ProfileDocument::from(kinds::Ball { diameter, radius: None, tip_flat: 0.0 }).build().unwrap();
    Cutter::new(&profile, 0.0)
}

/// A pit of 4 mm in a flat sheet, its walls 45 degrees steep.
fn pit() -> Part {
    let square = |half: f64, z: f64| {
        [[-half, -half], [half, -half], [half, half], [-half, half]].map(|[x, y]| Vector::new(x, y, z))
    };
    let vertices = [square(16.0, 0.0), square(12.0, 0.0), square(8.0, -4.0)].concat();
    let mut triangles = vec![[8, 9, 10], [8, 10, 11]];
    for (i, first) in (0..4_i64).flat_map(|i| [(i, 0), (i, 4)]) {
        let [a, b] = [first + i, first + (i + 1) % 4];
        triangles.extend([[a, b, b + 4], [a, b + 4, a + 4]]);
    }
    Part {
        mesh: Mesh::new(vertices, &triangles, &[]).unwrap(),
        inward: 0.0,
        outward: 0.0,
        shaped: None,
        curves: Arc::default(),
    }
}

#[test]
fn while_it_is_formed_the_sheet_hangs_as_low_as_the_loop_and_is_never_below_its_shape() {
    let job = job(SHEET);
    let scene = Scene::new(&job, MAIN_CHANNEL, &pit()).unwrap();
    let drawn = shapes(&job, &scene, 1e-3).swap_remove(1).drawn;
    let cutter = ball(2.0);
    let tips: Vec<[f64; 3]> = [round(7.0, 5.0), round(7.0, -1.0), round(6.0, -3.0)].concat();
    let tools = vec![Some(&cutter); tips.len()];
    let ends = [round(7.0, 0.0).len() - 1, round(7.0, 0.0).len() * 2 - 1, tips.len() - 1];
    let found = standing(&job, &scene, 1e-3, &Travel { tips: &tips, tools: &tools, moments: &ends }).unwrap();
    let middle = drawn.vertices.iter().position(|v| libm::hypot(v.x, v.y) < 2.0 && (v.z + 4.0).abs() < 1e-6).unwrap();
    let corner = drawn.vertices.iter().position(|v| (v - Vector::new(8.0, 8.0, -4.0)).norm() < 1e-6).unwrap();
    let at = |moment: usize, vertex: usize| drawn.vertices[vertex].z + found[moment][vertex];
    for (moment, height) in [(0, 0.0), (1, -1.0), (2, -3.0)] {
        assert!((at(moment, middle) - height).abs() < 0.25, "{moment}: {}", at(moment, middle));
        assert!(at(moment, corner).abs() < 1e-9, "outside the loops it is flat");
    }
    assert!(found.iter().flatten().all(|above| *above >= 0.0));
}
