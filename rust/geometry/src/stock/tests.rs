#![allow(clippy::float_cmp)] // corners keep all their digits

use proptest::prelude::*;

use super::*;
use crate::{Frame, GeometryError, Mesh};

/// The corners and triangles of a box between two corners.
fn box_mesh(low: Vector, high: Vector) -> (Vec<Vector>, Vec<[i64; 3]>) {
    let pick = |number: usize, k: usize| if number >> k & 1 == 1 { high[k] } else { low[k] };
    let corners = (0..8).map(|number| Vector::new(pick(number, 0), pick(number, 1), pick(number, 2))).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    (corners, faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

fn solid(parts: &[(Vec<Vector>, Vec<[i64; 3]>)]) -> Solid {
    let mut all: (Vec<Vector>, Vec<[i64; 3]>) = Default::default();
    for (corners, triangles) in parts {
        let first = all.0.len() as i64;
        all.1.extend(triangles.iter().map(|triangle| triangle.map(|corner| corner + first)));
        all.0.extend(corners);
    }
    Solid::new(&Mesh::new(all.0, &all.1, &[]).unwrap()).unwrap()
}

/// What is turned by a profile of radii and heights about Z, from its lower to its upper end on the axis.
fn turned(profile: &[[f64; 2]], sides: i64) -> Mesh {
    let mut corners = Vec::new();
    for [radius, z] in profile {
        corners.extend((0..sides).map(|i| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * i as f64 / sides as f64);
            Vector::new(radius * cos, radius * sin, *z)
        }));
    }
    let ring = |row: i64| {
        (0..sides).flat_map(move |i| {
            let (a, b) = (row * sides + i, row * sides + (i + 1) % sides);
            [[a, b, b + sides], [a, b + sides, a + sides]]
        })
    };
    let triangles: Vec<[i64; 3]> = (0..profile.len() as i64 - 1).flat_map(ring).collect();
    Mesh::new(corners, &triangles, &[]).unwrap()
}

/// A mushroom with a hollow cap, leaning: sides that lean both ways, and an overhang.
fn mushroom(turn: f64) -> Solid {
    let profile = [
        [0.0, 0.0],
        [4.0, 0.5],
        [3.0, 8.0],
        [9.0, 7.0],
        [12.0, 9.5],
        [10.0, 14.0],
        [4.0, 15.0],
        [2.0, 12.0],
        [0.0, 11.5],
    ];
    Solid::new(&turned(&profile, 23).placed(&Frame::turning_up(Vector::new(0.3, -0.2, 1.0).normalize(), turn))).unwrap()
}

#[test]
fn a_cylinder_reaches_its_radius_to_all_sides() {
    let stock = Stock::cylinder([3.0, -1.0], 5.0, [-2.0, 4.0]);
    let (low, high) = stock.bounds();
    assert!((low - Vector::new(-2.0, -6.0, -2.0)).norm() < 1e-12 && (high - Vector::new(8.0, 4.0, 4.0)).norm() < 1e-12);
}

#[test]
fn a_box_is_bounded_by_its_corners() {
    let corners = (Vector::new(-1.0, 2.0, 0.0), Vector::new(4.0, 6.0, 3.0));
    assert_eq!(Stock::of_box(corners.0, corners.1).bounds(), corners);
}

#[test]
fn there_is_none_above_its_top_and_below_its_underside() {
    let (low, high) = (Vector::new(0.0, 0.0, -2.0), Vector::new(9.0, 9.0, 4.0));
    for stock in [Stock::cylinder([0.0; 2], 5.0, [-2.0, 4.0]), Stock::of_solid(solid(&[box_mesh(low, high)]))] {
        assert!(stock.outlines_between([6.0, 4.0]).is_empty() && stock.outlines_between([-2.0, -3.0]).is_empty());
        assert_eq!(stock.outlines_between([6.0, 3.0]).len(), 1);
    }
}

#[test]
fn the_mesh_of_a_box_is_the_box() {
    let (low, high) = (Vector::new(-1.1, 2.3, -0.7), Vector::new(40.3, 6.9, 3.1));
    let (mesh, stock) = (Stock::of_solid(solid(&[box_mesh(low, high)])), Stock::of_box(low, high));
    assert_eq!((mesh.bounds(), mesh.bottom, mesh.top), (stock.bounds(), stock.bottom, stock.top));
    for slab in [[9.0, -9.0], [3.1, 1.0], [2.0, 1.0], [2.0, -0.7], [-0.5, -0.7]] {
        assert_eq!(mesh.outlines_between(slab), stock.outlines_between(slab), "{slab:?}");
    }
}

#[test]
fn the_mesh_of_a_cylinder_is_that_of_its_facets() {
    let upright = [[0.0, -1.0], [7.0, -1.0], [7.0, 5.0], [0.0, 5.0]];
    let stock = Stock::of_solid(Solid::new(&turned(&upright, 48)).unwrap());
    let outlines = stock.outlines_between([4.0, 2.0]);
    assert_eq!((outlines.len(), outlines[0].len()), (1, 48));
    assert!(outlines[0].iter().all(|[x, y, bulge]| (libm::hypot(*x, *y) - 7.0).abs() < 1e-9 && *bulge == 0.0));
}

#[test]
fn of_a_block_with_a_boss_there_is_the_boss_alone_above_the_block() {
    let (block, boss) = ([0.0, 0.0, 0.0, 40.0, 30.0, 10.0], [5.0, 5.0, 10.0, 15.0, 20.0, 18.0]);
    let part = |[x, y, z, u, v, w]: [f64; 6]| box_mesh(Vector::new(x, y, z), Vector::new(u, v, w));
    let stock = Stock::of_solid(solid(&[part(block), part(boss)]));
    let rectangle = |[x, y, _, u, v, _]: [f64; 6]| vec![rectangle_outline([x, y], [u, v])];
    assert_eq!(stock.outlines_between([18.0, 14.0]).into_owned(), rectangle(boss));
    assert_eq!(stock.outlines_between([14.0, 10.0]).into_owned(), rectangle(boss));
    assert_eq!(stock.outlines_between([14.0, 9.999]).into_owned(), rectangle(block));
    assert_eq!(stock.outlines_between([10.0, 6.0]).into_owned(), rectangle(block));
}

#[test]
fn a_hole_stays_open_where_it_goes_all_the_way_down_a_slab() {
    let ring = turned(&[[4.0, 0.0], [9.0, 0.0], [9.0, 6.0], [4.0, 6.0], [4.0, 0.0]], 30);
    let stock = Stock::of_solid(Solid::new(&ring).unwrap());
    assert_eq!(stock.outlines_between([5.0, 1.0]).len(), 2);
    assert!(!stock.solid().unwrap().holds(Vector::new(0.0, 0.0, 3.0), 0.1));
    assert!(stock.solid().unwrap().holds(Vector::new(6.0, 0.0, 3.0), 0.0));
    assert_eq!(stock.solid().unwrap().height_at([6.0, 0.5]), Some(6.0));
    assert_eq!(stock.solid().unwrap().height_at([1.0, 0.5]), None);
}

#[test]
fn a_mesh_that_is_open_is_no_body() {
    let (corners, mut triangles) = box_mesh(Vector::zeros(), Vector::new(4.0, 5.0, 6.0));
    triangles.pop();
    let error = Solid::new(&Mesh::new(corners, &triangles, &[]).unwrap()).unwrap_err();
    assert!(matches!(error, GeometryError::NotClosed { at } if at[0] == 4.0), "{error}");
}

#[test]
fn an_inverted_body_is_turned() {
    let (corners, triangles) = box_mesh(Vector::zeros(), Vector::new(4.0, 5.0, 6.0));
    let inverted: Vec<[i64; 3]> = triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    let stock = Stock::of_solid(solid(&[(corners, inverted)]));
    assert_eq!(stock.outlines_between([5.0, 1.0]).into_owned(), vec![rectangle_outline([0.0, 0.0], [4.0, 5.0])]);
}

/// Whether a point lies within outlines of straight lines, by the even-odd rule.
fn is_within(outlines: &[Vec<[f64; 3]>], [x, y]: [f64; 2]) -> bool {
    let pieces = outlines.iter().flat_map(|outline| PlanePiece::outline(outline));
    let crosses = pieces.filter(|PlanePiece { start: [ax, ay], end: [bx, by], .. }| {
        (*ay > y) != (*by > y) && x < ax + (bx - ax) * (y - ay) / (by - ay)
    });
    crosses.count() % 2 == 1
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn outlines_hold_just_what_has_material_between_two_heights(
        turn in 0.0..6.0_f64, floor in -6.0..16.0_f64, thick in 0.01..6.0_f64,
        points in prop::collection::vec((-14.0..14.0_f64, -14.0..14.0_f64), 100),
    ) {
        let solid = mushroom(turn);
        let outlines = solid.outlines_between([floor + thick, floor]);
        for (x, y) in points {
            let near = outlines.iter().flat_map(|outline| PlanePiece::outline(outline)).map(|piece| piece.distance([x, y]));
            if near.fold(f64::INFINITY, f64::min) < 1e-4 {
                continue;
            }
            // by points of the upright line: none of the arithmetic of outlines
            let mut heights: Vec<f64> = solid.heights_over(Vector::new(x, y, 0.0)).collect();
            heights.sort_by(f64::total_cmp);
            let (pairs, rest) = heights.as_chunks::<2>();
            prop_assert!(rest.is_empty());
            let has_material = pairs.iter().any(|[from, to]| *from < floor + thick && *to > floor);
            prop_assert_eq!(is_within(&outlines, [x, y]), has_material, "{} {} of {}", x, y, floor);
        }
    }

    #[test]
    fn a_slab_is_what_its_two_halves_are(turn in 0.0..6.0_f64, floor in -6.0..16.0_f64, halves in (0.1..4.0_f64, 0.1..4.0_f64)) {
        let solid = mushroom(turn);
        let middle = floor + halves.0;
        let whole = solid.outlines_between([middle + halves.1, floor]);
        let parts = [[middle + halves.1, middle], [middle, floor]].map(|slab| solid.outlines_between(slab));
        for i in 0..400 {
            let at = [f64::from(i % 20) * 1.37 - 13.0, f64::from(i / 20) * 1.37 - 13.0];
            prop_assert_eq!(is_within(&whole, at), parts.iter().any(|part| is_within(part, at)));
        }
    }
}
