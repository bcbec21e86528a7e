//! Parts whose walls and corners are known.

use std::sync::Arc;

use std::f64::consts::FRAC_PI_3;

use styluscam_geometry::{Mesh, Vector};

use super::walls;
use crate::{from_toml, JobDocument, JobError, Part, Scene};

/// Radius of the fillet and lengths of the parts, mm.
const RADIUS: f64 = 3.0;
const LONG: f64 = 10.0;

fn job(faces: &str) -> JobDocument {
    from_toml(&format!(
        r#"
        schema = 1
        part = {{ file = "a.step", faces = {faces} }}
        process = {{ kind = "milling" }}
        machine = {{ name = "linuxcnc" }}
        [tools.a]
        profile = {{ kind = "ball", diameter = 1.0 }}
        [[operations]]
        kind = "z-level"
        tool = "a"
        tolerance = 0.01
        step = {{ height = 0.5 }}
        feeds = {{ cut = 600.0, plunge = 100.0 }}
        spindle = {{ mode = "off" }}
        "#
    ))
    .unwrap()
}

fn found(mesh: Mesh, faces: &str) -> Result<super::Walls, JobError> {
    let job = job(faces);
    let scene = Scene::new(
        &job,
        crate::MAIN_CHANNEL,
        &Part { mesh, inward: 0.0, outward: 0.0, shaped: None, curves: Arc::default() },
    )?;
    walls(&job, &scene, 0)
}

/// A box of 20 x 10 x 5 mm open at the top, seen from inside: its floor is face 1, its walls are faces 2 to 5.
fn open_box() -> Mesh {
    let plan = [(0.0, 0.0), (20.0, 0.0), (20.0, 10.0), (0.0, 10.0)];
    let vertices = [0.0, 5.0].iter().flat_map(|z| plan.map(|(x, y)| Vector::new(x, y, *z))).collect();
    let mut triangles: Vec<[i64; 3]> = vec![[0, 1, 2], [0, 2, 3]];
    for (a, b) in [(0, 1), (1, 2), (2, 3), (3, 0)] {
        triangles.extend([[b, a, a + 4], [b, a + 4, b + 4]]);
    }
    Mesh::new(vertices, &triangles, &[1, 1, 2, 2, 3, 3, 4, 4, 5, 5]).unwrap()
}

/// A floor (face 1), a fillet of 3 mm that turns by 60 degrees (face 2), and the wall behind it (face 3); normals are exact.
fn trough(strips: usize) -> Mesh {
    let turn = |i: usize| FRAC_PI_3 * i as f64 / strips as f64;
    let up = |angle: f64| Vector::new(-angle.sin(), 0.0, angle.cos());
    let arc = (0..=strips).map(|i| (Vector::new(0.0, 0.0, RADIUS) - RADIUS * up(turn(i)), i));
    let end = arc.clone().next_back().unwrap().0 + 4.0 * Vector::new(FRAC_PI_3.cos(), 0.0, FRAC_PI_3.sin());
    let line: Vec<Vector> =
        std::iter::once(Vector::new(-5.0, 0.0, 0.0)).chain(arc.map(|(p, _)| p)).chain([end]).collect();
    let vertices = [0.0, LONG].iter().flat_map(|y| line.iter().map(|p| p + *y * Vector::y())).collect();
    let (mut triangles, mut faces, mut normals) = (Vec::new(), Vec::new(), Vec::new());
    for i in 0..line.len() - 1 {
        let face = if i == 0 {
            1
        } else if i <= strips {
            2
        } else {
            3
        };
        let [near, far] = match face {
            1 => [up(0.0); 2],
            2 => [up(turn(i - 1)), up(turn(i))],
            _ => [up(FRAC_PI_3); 2],
        };
        let (a, b, c, d) = (i, i + 1, i + 1 + line.len(), i + line.len());
        triangles.extend([[a, b, c], [a, c, d]].map(|corners| corners.map(|k| k as i64)));
        normals.extend([[near, far, far], [near, far, near]]);
        faces.extend([face; 2]);
    }
    Mesh::with_normals(vertices, &triangles, &faces, &normals).unwrap()
}

#[test]
fn the_edges_around_a_floor_are_one_corner_as_long_as_they() {
    let found = found(open_box(), "\"all\"").unwrap();
    let [corner] = &found.corners[..] else { panic!("{:?}", found.corners) };
    assert_eq!((corner.radius, corner.length, corner.turn_deg()), (0.0, 60.0, 90.0));
    let area: f64 = found.walls.iter().map(|wall| wall.area).sum();
    assert_eq!((found.walls.len(), area), (2, 200.0));
    assert!(found.walls.iter().all(|wall| wall.slope == 0.0 && wall.face == 1));
}

#[test]
fn a_box_seen_from_outside_has_no_corner_to_reach_into() {
    let inside = open_box();
    let triangles: Vec<[i64; 3]> = inside.triangles().iter().map(|corners| corners.map(i64::from)).collect();
    // mirrored points turn its walls' normals outwards, the floor's stays
    let mirrored = inside.vertices().iter().map(|p| Vector::new(p.x, p.y, -p.z)).collect();
    let lid = found(Mesh::new(mirrored, &triangles, inside.faces()).unwrap(), "\"all\"").unwrap();
    assert_eq!((lid.corners.len(), lid.walls.len()), (0, 2));
}

#[test]
fn a_fillet_has_its_radius_its_turn_and_its_length() {
    let found = found(trough(16), "\"all\"").unwrap();
    let [corner] = &found.corners[..] else { panic!("{:?}", found.corners) };
    // a triangle's mean normal lies a sixth of a strip beside its chord: the radius is seen by the square of that
    let strip = FRAC_PI_3 / 16.0;
    assert!((corner.radius / RADIUS - 1.0).abs() < strip * strip / 35.0, "{corner:?}");
    assert!((corner.turn_deg() - 60.0).abs() < 1e-12, "{corner:?}");
    let chord = 2.0 * RADIUS * (0.5 * strip).sin();
    assert!((corner.length * corner.radius * FRAC_PI_3 - 16.0 * chord * LONG).abs() < 1e-12, "{corner:?}");
    let hollow: Vec<_> = found.walls.iter().filter(|wall| wall.face == 2).map(|wall| wall.bend).collect();
    assert!(hollow.len() == 32 && hollow.iter().all(|bend| bend.twist.abs() + bend.level.abs() < 1e-12), "{hollow:?}");
}

#[test]
fn faces_that_are_not_selected_do_not_count() {
    let found = found(trough(16), "[\"Face1\", \"Face3\"]").unwrap();
    assert!(found.corners.is_empty() && found.walls.iter().all(|wall| wall.bend.up == 0.0));
    let slopes: Vec<f64> = found.walls.iter().map(|wall| wall.slope.to_degrees().round()).collect();
    assert_eq!(slopes, [0.0, 0.0, 60.0, 60.0]);
}

#[test]
fn faces_that_are_not_there_or_do_not_face_up_are_errors() {
    assert_eq!(found(open_box(), "[\"Face9\"]").unwrap_err().code(), "no-such-face");
    let upright = found(open_box(), "[\"Face2\"]").unwrap_err();
    assert_eq!((upright.code(), upright.location().as_str()), ("no-faces", "part.faces"));
    assert!(upright.hint().contains("setup.up"));
}
