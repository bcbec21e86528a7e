//! Bodies whose answers are known.

use styluscam_geometry::{Bvh, Mesh, Vector};

use super::{Body, Hollows, Shell, Unformable};
use crate::UpAxis;

type Heights<'f> = &'f dyn Fn(f64, f64) -> f64;

/// Nodes along a side.
const NODES: usize = 41;

/// A square of 40 mm between two height fields, with its rim; without a lower one: a surface.
fn between(upper: Heights<'_>, lower: Option<Heights<'_>>) -> Mesh {
    let at = |i: usize| -20.0 + i as f64 * 40.0 / (NODES - 1) as f64;
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    let layers: Vec<Heights<'_>> = [Some(upper), lower].into_iter().flatten().collect();
    for layer in &layers {
        for k in 0..NODES * NODES {
            let (x, y) = (at(k % NODES), at(k / NODES));
            points.push(Vector::new(x, y, layer(x, y)));
        }
    }
    let node = |i: usize, j: usize, layer: usize| (layer * NODES * NODES + j * NODES + i) as i64;
    let mut quad = |a: i64, b: i64, c: i64, d: i64| triangles.extend([[a, b, c], [a, c, d]]);
    for (i, j) in (0..NODES - 1).flat_map(|j| (0..NODES - 1).map(move |i| (i, j))) {
        quad(node(i, j, 0), node(i + 1, j, 0), node(i + 1, j + 1, 0), node(i, j + 1, 0));
        if layers.len() == 2 {
            quad(node(i, j, 1), node(i, j + 1, 1), node(i + 1, j + 1, 1), node(i + 1, j, 1));
        }
    }
    let last = NODES - 1;
    for i in (0..last).filter(|_| layers.len() == 2) {
        quad(node(i, 0, 1), node(i + 1, 0, 1), node(i + 1, 0, 0), node(i, 0, 0));
        quad(node(i + 1, last, 1), node(i, last, 1), node(i, last, 0), node(i + 1, last, 0));
        quad(node(0, i + 1, 1), node(0, i, 1), node(0, i, 0), node(0, i + 1, 0));
        quad(node(last, i, 1), node(last, i + 1, 1), node(last, i + 1, 0), node(last, i, 0));
    }
    Mesh::new(points, &triangles, &[]).unwrap()
}

/// A cup with a wall of 27 degrees, 5 mm deep, and a flange.
fn cup(x: f64, y: f64) -> f64 {
    (0.5 * (x.hypot(y) - 16.0)).clamp(-5.0, 0.0)
}

/// A pit with upright walls.
fn pit(x: f64, y: f64) -> f64 {
    if x.abs().max(y.abs()) < 10.5 {
        -8.0
    } else {
        0.0
    }
}

fn sheet(upper: Heights<'_>, thickness: f64) -> Mesh {
    between(upper, Some(&|x, y| upper(x, y) - thickness))
}

fn block(upper: Heights<'_>) -> Mesh {
    between(upper, Some(&|_, _| -20.0))
}

fn changed(mesh: &Mesh, change: impl Fn(usize, [i64; 3]) -> Option<[i64; 3]>) -> Mesh {
    let triangles = mesh.triangles().iter().map(|t| t.map(i64::from)).enumerate();
    let triangles: Vec<[i64; 3]> = triangles.filter_map(|(i, t)| change(i, t)).collect();
    Mesh::new(mesh.vertices().to_vec(), &triangles, &[]).unwrap()
}

fn with<T>(mesh: &Mesh, look: impl FnOnce(&Body<'_>) -> T) -> T {
    let bvh = Bvh::new(mesh);
    look(&Body::new(mesh, &bvh))
}

#[test]
fn closed_and_open_surfaces_are_told_apart() {
    let solid = block(&cup);
    assert_eq!(with(&solid, |body| body.shell()), Shell::Closed);
    assert_eq!(with(&between(&cup, None), |body| body.shell()), Shell::Open);
    assert_eq!(with(&changed(&solid, |_, [a, b, c]| Some([a, c, b])), |body| body.shell()), Shell::InsideOut);
    let turned = |i: usize, [a, b, c]: [i64; 3]| Some(if i.is_multiple_of(3) { [a, c, b] } else { [a, b, c] });
    assert_eq!(with(&changed(&solid, turned), |body| body.shell()), Shell::Mixed);
}

#[test]
fn a_lost_or_doubled_triangle_does_not_open_a_body() {
    let solid = block(&cup);
    assert_eq!(with(&changed(&solid, |i, t| (i != 1000).then_some(t)), |body| body.shell()), Shell::Closed);
    let torn = changed(&solid, |i, t| (!i.is_multiple_of(18)).then_some(t));
    assert_eq!(with(&torn, |body| body.shell()), Shell::Torn);
    let twice: Vec<[i64; 3]> = solid.triangles().iter().flat_map(|t| [t.map(i64::from); 2]).collect();
    let twice = Mesh::new(solid.vertices().to_vec(), &twice, &[]).unwrap();
    assert_eq!(with(&twice, |body| body.shell()), Shell::Closed);
}

#[test]
fn a_sheet_has_one_thickness_and_a_solid_has_not() {
    let thickness = with(&sheet(&cup, 1.0), |body| body.thickness()).unwrap();
    assert!(thickness.is_sheet() && (thickness.median - 1.0).abs() < 0.02, "{thickness:?}");
    assert!(!with(&block(&cup), |body| body.thickness()).unwrap().is_sheet());
    // a cube is as thick everywhere, and no sheet
    let cube = between(&|_, _| 40.0, Some(&|_, _| 0.0));
    assert!(!with(&cube, |body| body.thickness()).unwrap().is_sheet());
}

#[test]
fn a_sheet_is_formed_where_its_border_is_on_top_and_no_wall_is_too_steep() {
    let depth = |upper: Heights<'_>| with(&sheet(upper, 1.0), |body| body.formed_depth(Some(1.0)));
    assert!((depth(&cup).unwrap() - 5.0).abs() < 0.1);
    assert!(
        matches!(depth(&|x, y| -cup(x, y)), Err(Unformable::LowBorder { below, is_lowest: true }) if (below - 5.0).abs() < 0.1)
    );
    assert_eq!(depth(&|_, _| 0.0), Err(Unformable::Flat));
    assert!(matches!(with(&between(&pit, None), |body| body.formed_depth(None)), Err(Unformable::Steep(_))));
    // over a male die the border goes down with the frame; what is too steep stays so
    let laid = |mesh: &Mesh| with(mesh, |body| body.laid_depth(None));
    assert!((laid(&block(&|x, y| -cup(x, y))).unwrap() - 5.0).abs() < 0.1);
    assert!(matches!(laid(&between(&pit, None)), Err(Unformable::Steep(_))));
}

#[test]
fn what_is_cut_from_below_is_hidden_from_above() {
    let upside_down = between(&|_, _| 0.0, Some(&|x, y| -20.0 - pit(x, y)));
    let sides = with(&upside_down, |body| body.sides());
    assert_eq!((sides[0].up, sides[1].up), (UpAxis::PlusZ, UpAxis::MinusZ));
    assert!(sides[0].hidden > 0.15 && sides[1].hidden < 0.02, "{sides:?}");
}

#[test]
fn a_trough_bounds_the_tool_by_its_radius_and_a_slot_by_its_width() {
    let bound = |mesh: &Mesh| with(mesh, |body| Hollows::bound(&body.hollows().faces, 0.01));
    let trough = block(&|x, _| if x.abs() < 5.0 { -(36.0 - x * x).sqrt() + 11.0_f64.sqrt() } else { 0.0 });
    assert!((bound(&trough).unwrap() / 6.0 - 1.0).abs() < 0.1, "{:?}", bound(&trough));
    let slot = block(&|x, _| if x.abs() < 2.5 { -8.0 } else { 0.0 });
    // nodes are 1 mm apart: the slot's walls lean from 2 to 3 mm, and it is 5 mm wide in the middle
    let found = bound(&slot).unwrap();
    assert!((1.7..2.8).contains(&found), "{found}");
    assert_eq!(bound(&block(&|x, y| 10.0 - 0.01 * (x * x + y * y))), None);
}

#[test]
fn the_same_is_found_again() {
    let mesh = block(&cup);
    let look = |body: &Body<'_>| {
        format!("{:?} {:?} {:?} {:?}", body.hollows(), body.sides(), body.heights(), body.thickness())
    };
    assert_eq!(with(&mesh, look), with(&mesh, look));
}
