//! Meshes as files have them.

use std::f64::consts::PI;

use super::triangles::{area_vector, bounds};
use super::*;

/// Triangles by their corners' coordinates.
#[derive(Clone, Default)]
struct Triangles(Vec<[Vector; 3]>);

impl Triangles {
    fn quad(&mut self, [a, b, c, d]: [Vector; 4]) {
        self.0.extend([[a, b, c], [a, c, d]]);
    }

    fn with(mut self, other: Self) -> Self {
        self.0.extend(other.0);
        self
    }

    fn reversed(mut self) -> Self {
        self.0.iter_mut().for_each(|t| t.swap(1, 2));
        self
    }

    fn mended(&self) -> Soup {
        let points: Vec<Vector> = self.0.iter().flatten().copied().collect();
        let triangles: Vec<[i64; 3]> = (0..self.0.len() as i64).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        Soup::new(&points, &triangles).unwrap()
    }

    fn shapes(&self) -> Vec<Shape> {
        self.mended().faces().1
    }
}

fn block(low: [f64; 3], high: [f64; 3]) -> Triangles {
    let at = |i: usize, j: usize, k: usize| Vector::new([low, high][i][0], [low, high][j][1], [low, high][k][2]);
    let mut made = Triangles::default();
    made.quad([at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0)]);
    made.quad([at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)]);
    made.quad([at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)]);
    made.quad([at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)]);
    made.quad([at(1, 1, 0), at(0, 1, 0), at(0, 1, 1), at(1, 1, 1)]);
    made.quad([at(0, 1, 0), at(0, 0, 0), at(0, 0, 1), at(0, 1, 1)]);
    made
}

fn cube() -> Triangles {
    block([0.0; 3], [10.0; 3])
}

/// A round body of some sides about the Z axis; its radius over each height.
fn turned(sides: usize, meridian: &[(f64, f64)]) -> Triangles {
    let at = |(r, z): (f64, f64), i: usize| {
        let angle = 2.0 * PI * (i % sides) as f64 / sides as f64;
        Vector::new(r * angle.cos(), r * angle.sin(), z)
    };
    let mut made = Triangles::default();
    for i in 0..sides {
        for pair in meridian.windows(2) {
            made.quad([at(pair[0], i), at(pair[0], i + 1), at(pair[1], i + 1), at(pair[1], i)]);
        }
        let (first, last) = (meridian[0], meridian[meridian.len() - 1]);
        made.0.push([Vector::new(0.0, 0.0, first.1), at(first, i + 1), at(first, i)]);
        made.0.push([Vector::new(0.0, 0.0, last.1), at(last, i), at(last, i + 1)]);
    }
    made
}

/// A height field over a square of so many cells, with walls and a floor below it.
fn field(cells: usize, height: impl Fn(f64, f64) -> f64) -> Triangles {
    let at = |i: usize, j: usize| {
        let (x, y) = (100.0 * i as f64 / cells as f64, 100.0 * j as f64 / cells as f64);
        Vector::new(x, y, height(x, y))
    };
    let foot = |p: Vector| Vector::new(p.x, p.y, -20.0);
    let mut made = Triangles::default();
    for i in 0..cells {
        for j in 0..cells {
            let quad = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            made.quad(quad);
            made.quad([foot(quad[0]), foot(quad[3]), foot(quad[2]), foot(quad[1])]);
        }
        for (p, q) in [
            (at(i, 0), at(i + 1, 0)),
            (at(cells, i), at(cells, i + 1)),
            (at(i + 1, cells), at(i, cells)),
            (at(0, i + 1), at(0, i)),
        ] {
            made.quad([foot(p), foot(q), q, p]);
        }
    }
    made
}

/// Reproducible noise from -1 to 1.
fn noise(x: f64, y: f64) -> f64 {
    let wave = ((x * 12.9898 + y * 78.233).sin() * 43_758.545_3).fract();
    2.0 * wave.abs() - 1.0
}

fn volume(soup: &Soup) -> f64 {
    let six = |t: &[u32; 3]| soup.vertices[t[0] as usize].dot(&area_vector(&soup.vertices, *t));
    soup.triangles.iter().map(six).sum::<f64>() / 6.0
}

#[test]
fn a_sound_mesh_stays_as_it_is() {
    let soup = cube().mended();
    assert_eq!((soup.vertices.len(), soup.triangles.len()), (8, 12));
    assert_eq!(soup.mending, Mending { closed: true, ..Mending::default() });
}

#[test]
fn copies_are_dropped() {
    let soup = cube().with(cube()).mended();
    assert_eq!((soup.triangles.len(), soup.mending.duplicate, soup.mending.closed), (12, 12, true));
}

#[test]
fn a_wall_between_bodies_goes() {
    let soup = cube().with(block([10.0, 0.0, 0.0], [20.0, 10.0, 10.0])).mended();
    // the walls are cut along different diagonals where their makers did so
    let (left, walls) = (soup.triangles.len(), soup.mending.back_to_back);
    assert_eq!((left + walls, soup.mending.closed), (24, true));
    assert!((volume(&soup) - 2000.0).abs() < 1e-9);
}

#[test]
fn walls_of_the_same_triangles_go() {
    let wall = |x: f64| {
        let mut wall = Triangles::default();
        let at = |y: f64, z: f64| Vector::new(x, y, z);
        wall.quad([at(0.0, 0.0), at(10.0, 0.0), at(10.0, 10.0), at(0.0, 10.0)]);
        wall
    };
    let mut right = block([10.0, 0.0, 0.0], [20.0, 10.0, 10.0]);
    right.0.retain(|t| t.iter().any(|p| p.x > 10.0));
    let soup = cube().with(right).with(wall(10.0).reversed()).mended();
    assert_eq!((soup.triangles.len(), soup.mending.back_to_back, soup.mending.closed), (20, 4, true));
    assert!((volume(&soup) - 2000.0).abs() < 1e-9);
    // a second skin on one side of a body is not a wall: the body would open
    let soup = cube().with(wall(10.0).reversed()).mended();
    assert_eq!((soup.triangles.len(), soup.mending.double_sided, soup.mending.closed), (12, 2, true));
    assert!((volume(&soup) - 1000.0).abs() < 1e-9);
}

#[test]
fn a_surface_with_two_sides_keeps_one() {
    let mut sheet = Triangles::default();
    let at = |x: f64, y: f64| Vector::new(x, y, 0.1 * x);
    sheet.quad([at(0.0, 0.0), at(10.0, 0.0), at(10.0, 10.0), at(0.0, 10.0)]);
    let soup = sheet.clone().reversed().with(sheet).mended();
    assert_eq!((soup.triangles.len(), soup.mending.double_sided), (2, 2));
    assert!(soup.triangles.iter().all(|t| area_vector(&soup.vertices, *t).z > 0.0));
}

#[test]
fn a_fin_without_thickness_stays() {
    let mut fin = Triangles::default();
    let at = |x: f64, z: f64| Vector::new(x, x, z);
    fin.0.push([at(0.0, 10.0), at(10.0, 10.0), at(5.0, 15.0)]);
    let soup = cube().with(fin.clone()).with(fin.reversed()).mended();
    assert_eq!((soup.triangles.len(), soup.mending.closed), (14, true));
}

#[test]
fn corners_that_almost_meet_are_joined() {
    let mut shaken = cube();
    for (i, p) in shaken.0.iter_mut().flatten().enumerate() {
        *p += 2e-5 * Vector::new(noise(i as f64, 1.0), noise(i as f64, 2.0), noise(i as f64, 3.0));
    }
    let soup = shaken.mended();
    assert_eq!((soup.vertices.len(), soup.triangles.len(), soup.mending.closed), (8, 12, true));
    assert!(soup.mending.joined > 20 && soup.mending.moved > 1e-6 && soup.mending.moved < 1e-4);
    assert!(soup.mending.join_distance < 2e-4);
}

#[test]
fn slivers_as_wide_as_what_is_joined_do_no_harm() {
    // a tenth of the triangles cut in two by a point beside a corner, about as far from it as corners are joined
    for size in 0..12 {
        let big = 55.0 + f64::from(size);
        let made = turned(40, &[(0.5 * big, 0.0), (0.4 * big, 20.0), (0.3 * big, 25.0), (0.1 * big, 28.0)]);
        let mut cut = made.clone();
        for t in (0..made.0.len()).filter(|t| noise(*t as f64, 7.0) > 0.8) {
            let [a, b, c] = made.0[t];
            let beside = a + (b - a) * (0.001 / (b - a).norm());
            cut.0[t] = [beside, b, c];
            cut.0.push([a, beside, c]);
        }
        let soup = cut.mended();
        assert_eq!((soup.mending.unclear, soup.mending.inside_out), (None, 0), "{big}");
        assert!((volume(&soup) / volume(&made.mended()) - 1.0).abs() < 1e-3, "{big}");
    }
}

#[test]
fn a_gap_that_is_meant_stays() {
    let mut slit = cube();
    slit.0.truncate(10);
    let soup = slit.mended();
    assert_eq!((soup.mending.joined, soup.mending.closed), (0, false));
}

#[test]
fn a_triangle_without_area_is_removed_and_nothing_opens() {
    let mut made = cube();
    // the top's first triangle gets its corner on a line between two others, a flat one fills the seam
    let [a, b, c] = made.0[2];
    let middle = (a + c) / 2.0;
    made.0[2] = [a, b, c];
    made.0.remove(3);
    let d = Vector::new(0.0, 10.0, 10.0);
    made.0.extend([[a, middle, d], [middle, c, d], [a, c, middle]]);
    let soup = made.mended();
    assert_eq!((soup.mending.degenerate, soup.mending.closed), (1, true));
    assert!((volume(&soup) - 1000.0).abs() < 1e-9);
    assert!(soup.triangles.iter().all(|t| area_vector(&soup.vertices, *t).norm() > 1.0));
}

#[test]
fn a_body_inside_out_is_turned() {
    let soup = cube().reversed().mended();
    assert_eq!((soup.mending.inside_out, soup.mending.turned), (12, 0));
    assert!((volume(&soup) - 1000.0).abs() < 1e-9);
}

#[test]
fn some_triangles_inside_out_are_turned() {
    let mut made = cube();
    [1, 5, 8].iter().for_each(|t| made.0[*t].swap(1, 2));
    let soup = made.mended();
    assert_eq!((soup.mending.turned, soup.mending.inside_out, soup.mending.closed), (3, 0, true));
    assert!((volume(&soup) - 1000.0).abs() < 1e-9);
}

#[test]
fn a_hollow_stays_and_turns_with_its_body() {
    let hollow = block([3.0; 3], [7.0; 3]).reversed();
    let sound = cube().with(hollow).with(block([20.0; 3], [30.0; 3]));
    let soup = sound.mended();
    assert_eq!(soup.mending.inside_out, 0);
    assert!((volume(&soup) - (2000.0 - 64.0)).abs() < 1e-9);
    let soup = sound.reversed().mended();
    assert_eq!(soup.mending.inside_out, 36);
    assert!((volume(&soup) - (2000.0 - 64.0)).abs() < 1e-9);
    let one = cube().with(block([20.0; 3], [30.0; 3]).reversed()).mended();
    assert_eq!(one.mending.inside_out, 12);
}

#[test]
fn a_body_with_a_small_hole_is_turned_too() {
    let mut made = field(40, |_, _| 0.0).reversed();
    // a hole with 16 sides: more than are closed
    let middle = Vector::new(50.0, 50.0, 0.0);
    made.0.retain(|t| !t.iter().all(|p| (p - middle).amax() < 5.1));
    let soup = made.mended();
    assert_eq!((soup.mending.inside_out, soup.mending.closed), (made.0.len(), false));
}

#[test]
fn a_surface_wound_both_ways_is_unclear() {
    let mut made = field(4, |x, _| 0.1 * x);
    made.0.retain(|t| t.iter().all(|p| p.z > -19.0));
    let count = made.0.len();
    made.0[..count / 2].iter_mut().for_each(|t| t.swap(1, 2));
    assert!(made.mended().mending.unclear.is_some());
    let mut few = field(4, |x, _| 0.1 * x);
    few.0.retain(|t| t.iter().all(|p| p.z > -19.0));
    few.0[3].swap(1, 2);
    let mending = few.mended().mending;
    assert_eq!((mending.turned, mending.unclear), (1, None));
}

#[test]
fn a_moebius_strip_is_unclear() {
    let at = |i: usize, side: f64| {
        let turn = 2.0 * PI * i as f64 / 24.0;
        let lean = 0.5 * turn;
        let radius = 10.0 + 2.0 * side * lean.cos();
        Vector::new(radius * turn.cos(), radius * turn.sin(), 2.0 * side * lean.sin())
    };
    let mut strip = Triangles::default();
    for i in 0..23 {
        strip.quad([at(i, -1.0), at(i + 1, -1.0), at(i + 1, 1.0), at(i, 1.0)]);
    }
    strip.quad([at(23, -1.0), at(0, 1.0), at(0, -1.0), at(23, 1.0)]);
    assert!(strip.mended().mending.unclear.is_some());
}

#[test]
fn a_cube_has_six_planes() {
    assert_eq!(cube().shapes(), [Shape::Plane; 6]);
    let (faces, _) = cube().mended().faces();
    // from the top down: the top is the first, the floor the last
    assert_eq!((faces[2], faces[3], faces[0], faces[1]), (1, 1, 6, 6));
}

#[test]
fn a_round_side_is_one_face() {
    for sides in [10, 12, 16, 32, 200] {
        let shapes = turned(sides, &[(5.0, 0.0), (5.0, 20.0)]).shapes();
        assert_eq!(shapes, [Shape::Plane, Shape::Cylinder, Shape::Plane], "{sides} sides");
    }
    for sides in [10, 16, 100] {
        let shapes = turned(sides, &[(8.0, 0.0), (3.0, 12.0)]).shapes();
        assert_eq!(shapes, [Shape::Plane, Shape::Cone, Shape::Plane], "{sides} sides");
    }
    let few = turned(6, &[(5.0, 0.0), (5.0, 20.0)]).shapes();
    assert_eq!(few, [Shape::Plane; 8]);
}

#[test]
fn a_ball_is_one_face() {
    for steps in [12, 40] {
        let meridian: Vec<(f64, f64)> = (1..steps)
            .map(|i| PI * i as f64 / steps as f64)
            .map(|angle| (10.0 * angle.sin(), -10.0 * angle.cos()))
            .collect();
        let shapes = turned(2 * steps, &meridian).shapes();
        assert!(shapes.contains(&Shape::Sphere) && shapes.len() <= 3, "{shapes:?}");
    }
}

#[test]
fn a_fillet_parts_from_the_flats_beside_it() {
    // a bar with one rounded edge of radius 3, in 8 steps
    let mut outline = vec![(0.0, 0.0), (20.0, 0.0)];
    outline.extend((0..=8).map(|i| {
        let angle = PI / 2.0 * f64::from(i) / 8.0;
        (17.0 + 3.0 * angle.cos(), 7.0 + 3.0 * angle.sin())
    }));
    outline.push((0.0, 10.0));
    let mut bar = Triangles::default();
    let at = |(x, z): (f64, f64), y: f64| Vector::new(x, y, z);
    for i in 0..outline.len() {
        let (p, q) = (outline[i], outline[(i + 1) % outline.len()]);
        bar.quad([at(p, 0.0), at(p, 40.0), at(q, 40.0), at(q, 0.0)]);
        bar.0.push([at(outline[0], 0.0), at(p, 0.0), at(q, 0.0)]);
        bar.0.push([at(outline[0], 40.0), at(q, 40.0), at(p, 40.0)]);
    }
    let mut shapes = bar.shapes();
    shapes.sort_by_key(|shape| format!("{shape:?}"));
    let mut expected = vec![Shape::Cylinder];
    expected.resize(7, Shape::Plane);
    assert_eq!(shapes, expected);
}

#[test]
fn a_shallow_fold_is_a_crease() {
    for angle in [0.5_f64, 3.0, 20.0] {
        let rise = 50.0 * angle.to_radians().tan();
        let roof = field(2, |x, _| rise * (1.0 - (x - 50.0).abs() / 50.0));
        assert_eq!(roof.shapes(), [Shape::Plane; 7], "{angle} degrees");
    }
}

#[test]
fn terrain_is_few_faces() {
    let smooth = |x: f64, y: f64| 5.0 * (0.1 * x).sin() * (0.13 * y).cos();
    let faces = |rough: f64| field(60, |x, y| smooth(x, y) + rough * noise(x, y)).shapes().len();
    let counts = [0.0, 0.02, 0.2, 0.4, 0.6, 0.8, 1.0, 2.0, 6.0].map(faces);
    assert!(counts[..3].iter().all(|count| (6..=12).contains(count)), "{counts:?}");
    // rougher than its cells are wide: still below one face for a hundred triangles
    assert!(counts.iter().all(|count| (6..=72).contains(count)), "{counts:?}");
}

#[test]
fn pins_keep_their_faces() {
    let mut made = block([0.0; 3], [100.0, 100.0, 5.0]);
    for i in 0..8 {
        for j in 0..8 {
            let (x, y) = (5.0 + 12.0 * f64::from(i), 5.0 + 12.0 * f64::from(j));
            made = made.with(block([x, y, 5.0], [x + 4.0, y + 4.0, 15.0]));
        }
    }
    assert_eq!(made.shapes().len(), 6 + 64 * 6);
}

#[test]
fn numbers_do_not_depend_on_the_order_of_triangles() {
    let made = turned(24, &[(8.0, 0.0), (8.0, 5.0), (3.0, 5.0), (3.0, 12.0)]).with(block([20.0; 3], [30.0; 3]));
    let (faces, shapes) = made.mended().faces();
    let mut shuffled: Vec<(f64, usize)> = (0..made.0.len()).map(|t| (noise(t as f64, 0.5), t)).collect();
    shuffled.sort_by(|a, b| a.0.total_cmp(&b.0));
    let other = Triangles(
        shuffled
            .iter()
            .map(|(_, t)| {
                let [a, b, c] = made.0[*t];
                [b, c, a]
            })
            .collect(),
    );
    let (found, same) = other.mended().faces();
    assert_eq!(shapes, same);
    for (number, (_, t)) in found.iter().zip(&shuffled) {
        assert_eq!(*number, faces[*t]);
    }
}

#[test]
fn sides_on_which_corners_of_others_lie_are_cut_there() {
    let mut cube = cube();
    // along the edge from (0, 0, 10) to (10, 0, 10): the top has corners at 0.002 and 4, the front at 7
    let [a, b] = [Vector::new(0.0, 0.0, 10.0), Vector::new(10.0, 0.0, 10.0)];
    for (low, places) in [(false, vec![0.002, 4.0]), (true, vec![7.0])] {
        let at = |t: &[Vector; 3]| t.contains(&a) && t.contains(&b) && (t.iter().any(|p| p.z < 5.0) == low);
        let triangle = cube.0.remove(cube.0.iter().position(at).unwrap());
        let k = (0..3).find(|k| ![a, b].contains(&triangle[*k])).unwrap();
        let (apex, from, to) = (triangle[k], triangle[(k + 1) % 3], triangle[(k + 2) % 3]);
        let mut stops: Vec<Vector> = places.iter().map(|x| Vector::new(*x, 0.0, 10.0)).collect();
        stops.extend([from, to]);
        stops.sort_by(|p, q| (p - from).norm().total_cmp(&(q - from).norm()));
        cube.0.extend(stops.windows(2).map(|pair| [apex, pair[0], pair[1]]));
    }
    let soup = cube.mended();
    assert!(soup.mending.closed && soup.mending.unclear.is_none());
    assert_eq!((soup.mending.cut, soup.mending.moved, soup.triangles.len()), (3, 0.0, 18));
}

#[test]
fn a_border_beside_another_is_not_cut() {
    // two squares that touch in a corner of one and the middle of a side of the other, in a plane and across it
    for tip in [Vector::new(5.0, 3.0, 0.0), Vector::new(0.0, 5.0, 3.0)] {
        let mut squares = Triangles::default();
        let at = |x: f64, y: f64| Vector::new(x, y, 0.0);
        squares.quad([at(-10.0, -5.0), at(0.0, -5.0), at(0.0, 5.0), at(-10.0, 5.0)]);
        squares.0.push([at(0.0, 0.0), at(5.0, -3.0), tip]);
        assert_eq!(squares.mended().mending.cut, 0);
    }
}

/// A cup with 12 sides, in which each triangle is less than a tenth of the surface.
fn cup() -> Triangles {
    turned(12, &[(10.0, 0.0), (10.0, 15.0), (6.0, 15.0), (6.0, 5.0)])
}

/// A mesh's triangles by their corners' coordinates, each from its lowest corner on.
fn corners(soup: &Soup) -> Vec<[u32; 3]> {
    let lowest_first = |[a, b, c]: &[u32; 3]| match a.min(b).min(c) {
        lowest if lowest == a => [*a, *b, *c],
        lowest if lowest == b => [*b, *c, *a],
        _ => [*c, *a, *b],
    };
    let mut found: Vec<[u32; 3]> = soup.triangles.iter().map(lowest_first).collect();
    found.sort_unstable();
    found
}

#[test]
fn a_missing_triangle_is_made_again() {
    let whole = cup().mended();
    for i in 0..cup().0.len() {
        let mut made = cup();
        let lost = made.0.remove(i);
        let soup = made.mended();
        let filled = soup.mending.filled.clone().unwrap();
        assert_eq!((filled.holes, filled.triangles, soup.mending.closed), (1, 1, true));
        assert_eq!((&soup.vertices, corners(&soup)), (&whole.vertices, corners(&whole)));
        let (low, high) = bounds(lost.into_iter());
        assert!((filled.widest - (high - low).norm()).abs() < 1e-12);
        assert!((Vector::from(filled.at) - 0.5 * (low + high)).norm() < 1e-12);
    }
}

#[test]
fn an_edge_that_a_hole_crosses_is_made_again() {
    let (whole, count) = (cup().mended(), cup().0.len());
    let mut holes = [0; 2];
    for i in 0..count {
        for j in 0..i {
            let mut made = cup();
            made.0.remove(i);
            made.0.remove(j);
            let soup = made.mended();
            assert!(soup.mending.closed);
            assert!((volume(&soup) - volume(&whole)).abs() < 1e-9, "triangles {j} and {i}");
            holes[soup.mending.filled.unwrap().holes - 1] += 1;
        }
    }
    assert_eq!(holes, [3 * count / 2, count * (count - 1) / 2 - 3 * count / 2], "side by side, and apart");
}

#[test]
fn many_holes_are_closed() {
    let meridian: Vec<(f64, f64)> =
        (1..40).map(|i| PI * f64::from(i) / 40.0).map(|a| (50.0 * a.sin(), -50.0 * a.cos())).collect();
    let whole = turned(80, &meridian);
    let mut made = whole.clone();
    made.0.retain(|t| noise(t[0].x + t[1].x, t[2].y + t[1].z) > -0.9);
    let (whole, soup) = (whole.mended(), made.mended());
    let filled = soup.mending.filled.clone().unwrap();
    assert!(soup.mending.closed && filled.holes > 100 && filled.triangles > filled.holes, "{filled:?}");
    assert_eq!(soup.triangles.len(), whole.triangles.len());
    assert!((volume(&soup) / volume(&whole) - 1.0).abs() < 2e-3);
}

#[test]
fn slits_are_closed() {
    // along an upright edge of the cup, whose lower end one side has 3 um aside, and a corner has been torn open
    let whole = cup();
    let corner = Vector::new(10.0, 0.0, 0.0);
    let mut made = whole.clone();
    for triangle in made.0.iter_mut().filter(|t| t.iter().any(|p| p.y < -1.0)) {
        triangle.iter_mut().filter(|p| (**p - corner).norm() < 1e-9).for_each(|p| p.z += 0.003);
    }
    let soup = made.mended();
    let filled = soup.mending.filled.clone().unwrap();
    assert!(soup.mending.closed && filled.holes == 1, "{:?}", soup.mending);
    assert!((volume(&soup) - volume(&whole.mended())).abs() < 0.1);
}

#[test]
fn slits_round_a_face_are_closed_and_nothing_is_turned() {
    // the middles of the walls' upper edges are 1 um higher than the top
    let at = |x: f64, y: f64, z: f64| Vector::new(x, y, z);
    let foot = [at(0.0, 0.0, 0.0), at(10.0, 0.0, 0.0), at(10.0, 10.0, 0.0), at(0.0, 10.0, 0.0)];
    for turn in 0..4 {
        let mut made = Triangles::default();
        made.quad([0, 3, 2, 1].map(|i| foot[i]));
        made.quad([0, 1, 2, 3].map(|i: usize| foot[(i + turn) % 4] + at(0.0, 0.0, 10.0)));
        for i in 0..4 {
            let (p, q) = (foot[i], foot[(i + 1) % 4]);
            let (r, s) = (q + at(0.0, 0.0, 10.0), p + at(0.0, 0.0, 10.0));
            let middle = 0.5 * (r + s) + at(0.0, 0.0, 0.001);
            made.0.extend([[p, q, r], [p, r, middle], [p, middle, s]]);
        }
        let soup = made.mended();
        let mending = &soup.mending;
        assert_eq!((mending.inside_out, mending.turned, mending.closed), (0, 0, true), "{mending:?}");
        assert_eq!(mending.filled.as_ref().map(|filled| filled.holes), Some(4));
        assert!((volume(&soup) - 1000.0).abs() < 0.1);
    }
}

#[test]
fn holes_that_meet_at_a_corner_are_closed_each_by_itself() {
    // a triangle of which all neighbours are missing: its corners have two ways on
    let mut made = field(10, |_, _| 0.0);
    let whole = made.mended();
    let is = |t: &[Vector; 3], corners: [[f64; 2]; 3]| {
        corners.iter().all(|[x, y]| t.iter().any(|p| (p.x - x).abs() + (p.y - y).abs() < 1e-9)) && t[0].z > -1.0
    };
    let island = [[20.0, 20.0], [30.0, 20.0], [30.0, 30.0]];
    let around =
        |t: &[Vector; 3]| t.iter().all(|p| (10.0..=40.0).contains(&p.x) && (10.0..=40.0).contains(&p.y) && p.z > -1.0);
    let beside = |t: &[Vector; 3]| {
        let shared = t.iter().filter(|p| island.iter().any(|[x, y]| (p.x - x).abs() + (p.y - y).abs() < 1e-9)).count();
        around(t) && shared == 2
    };
    made.0.retain(|t| is(t, island) || !beside(t));
    let soup = made.mended();
    assert_eq!((soup.triangles.len(), soup.mending.closed), (whole.triangles.len(), true), "{:?}", soup.mending);
    assert_eq!(corners(&soup), corners(&whole));
}

#[test]
fn openings_that_are_meant_stay() {
    let is_kept = |made: Triangles| {
        let soup = made.mended();
        assert_eq!((soup.mending.filled.clone(), soup.mending.closed), (None, false));
        assert_eq!(soup.triangles.len(), made.0.len());
    };
    let mut open_box = cube();
    open_box.0.retain(|t| t.iter().any(|p| p.z < 10.0));
    is_kept(open_box);
    // a plate with a triangular window
    let mut plate = field(8, |_, _| 0.0);
    plate.0.retain(|t| t.iter().all(|p| p.z > -1.0));
    plate.0.remove(60);
    is_kept(plate);
    // skins of a square and of a round tube
    for sides in [4, 8] {
        let mut tube = turned(sides, &[(5.0, 0.0), (5.0, 60.0)]);
        tube.0.retain(|t| t.iter().any(|p| (p.z - t[0].z).abs() > 1.0));
        is_kept(tube);
    }
    let mut one = Triangles::default();
    one.0.push([Vector::zeros(), Vector::x(), Vector::y()]);
    is_kept(one);
    // a hole, and another that is too large
    let mut made = field(20, |_, _| 0.0);
    let middle = Vector::new(50.0, 50.0, 0.0);
    made.0.retain(|t| !t.iter().all(|p| (p - middle).amax() < 10.1));
    made.0.remove(700);
    is_kept(made);
}
