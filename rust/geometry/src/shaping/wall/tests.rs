//! Walls around edges with known answers.

use super::*;

/// A pyramid's lower part upside down: a dish over a regular polygon, its edge at heights that `height` states.
fn dish(corners: u32, radius: f64, height: impl Fn(f64) -> f64) -> Mesh {
    let at = |i: u32| {
        let turn = std::f64::consts::TAU * f64::from(i) / f64::from(corners);
        Vector::new(radius * libm::cos(turn), radius * libm::sin(turn), height(turn))
    };
    let vertices: Vec<Vector> = (0..corners).map(at).chain([Vector::new(0.0, 0.0, -20.0)]).collect();
    let count = i64::from(corners);
    let triangles: Vec<[i64; 3]> = (0..count).map(|i| [i, (i + 1) % count, count]).collect();
    Mesh::new(vertices, &triangles, &[]).unwrap()
}

fn shape(angle_deg: f64, radius: f64, height: f64) -> WallShape {
    let angle = angle_deg.to_radians();
    let end = WallEnd::Height(height);
    WallShape { angle, radius, blended: false, end, margin: 5.0, tolerance: 0.002, goes_down: false }
}

fn built(part: &Mesh, shape: &WallShape) -> Walled {
    walled(part, &vec![true; part.triangles().len()], shape).unwrap()
}

/// Triangles of the wall, and their corners.
fn of_wall(walled: &Walled) -> impl Iterator<Item = [Vector; 3]> + '_ {
    let faces = walled.mesh.faces().iter().enumerate();
    faces.filter(|(_, face)| **face == walled.wall).map(|(triangle, _)| walled.mesh.corners(triangle))
}

#[test]
fn a_wall_around_a_circle_is_a_cone_with_an_arc() {
    let part = dish(720, 30.0, |_| 0.0);
    let found = built(&part, &shape(50.0, 4.0, 12.0));
    let corner = Corner::new(50_f64.to_radians(), 12.0, 4.0);
    let mut area = 0.0;
    for corners in of_wall(&found) {
        for point in [corners[0], corners.iter().sum::<Vector>() / 3.0] {
            let radius = libm::hypot(point.x, point.y);
            let exact = corner.height(corner.slope() * (radius - 30.0));
            assert!((point.z - exact).abs() < 0.005, "{point} {exact}");
        }
        area += 0.5 * (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).z;
    }
    let outer = 30.0 + 12.0 / corner.slope() + 4.0 * libm::tan(25_f64.to_radians());
    assert!((area - std::f64::consts::PI * (outer * outer - 900.0)).abs() < 1.0, "{area}");
    assert!((found.extent[1][0] - outer - 5.0).abs() < 1e-3 && found.deviation <= 0.002);
    assert!(found.mesh.triangles().len() < 60_000, "{}", found.mesh.triangles().len());
}

#[test]
fn a_square_gets_four_planes_and_four_cones() {
    let part = dish(4, 20.0, |_| 0.0);
    let found = built(&part, &shape(45.0, 0.0, 10.0));
    let half = 20.0 * std::f64::consts::FRAC_1_SQRT_2;
    let turned = |p: Vector| [(p.x + p.y), (p.y - p.x)].map(|x| (x * std::f64::consts::FRAC_1_SQRT_2).abs() - half);
    for corners in of_wall(&found) {
        let middle = corners.iter().sum::<Vector>() / 3.0;
        let [x, y] = turned(middle).map(|beyond| beyond.max(0.0));
        assert!((middle.z - libm::hypot(x, y)).abs() < 0.003, "{middle}");
    }
    assert_eq!((found.wall, found.blank), (2, 3));
}

#[test]
fn over_an_uneven_edge_no_wall_is_steeper_and_all_of_the_edge_is_met() {
    let part = dish(360, 30.0, |turn| 2.0 * libm::sin(2.0 * turn));
    let found = built(&part, &shape(40.0, 3.0, 8.0));
    let least = libm::cos(40.3_f64.to_radians());
    for [a, b, c] in of_wall(&found) {
        let area = (b - a).cross(&(c - a));
        assert!(area.norm() < 1e-3 || area.normalize().z > least, "{a} {b} {c}");
    }
    assert!((found.plane - 10.0).abs() < 1e-12);
    let on_wall: HashSet<[u64; 3]> = of_wall(&found).flatten().map(|p| <[u64; 3]>::from(p.map(f64::to_bits))).collect();
    assert!(found.edges[0].iter().all(|p| on_wall.contains(&<[u64; 3]>::from(p.map(f64::to_bits)))));
    assert_eq!(found.edges[0].len(), 360);
}

/// Two dishes side by side.
fn two_dishes() -> Mesh {
    let one = dish(180, 15.0, |_| 0.0);
    let shift = |p: &Vector, x: f64| Vector::new(p.x + x, p.y, p.z);
    let vertices: Vec<Vector> =
        [-22.0, 22.0].iter().flat_map(|x| one.vertices().iter().map(move |p| shift(p, *x))).collect();
    let count = one.vertices().len() as i64;
    let triangles: Vec<[i64; 3]> = [0, count]
        .iter()
        .flat_map(|first| one.triangles().iter().map(move |t| t.map(|i| i64::from(i) + first)))
        .collect();
    Mesh::new(vertices, &triangles, &[]).unwrap()
}

#[test]
fn walls_of_two_dishes_meet_in_a_crease() {
    let part = two_dishes();
    let found = built(&part, &shape(45.0, 2.0, 10.0));
    let corner = Corner::new(45_f64.to_radians(), 10.0, 2.0);
    assert_eq!(found.edges.len(), 2);
    let mut highest_between: f64 = 0.0;
    for corners in of_wall(&found) {
        let middle = corners.iter().sum::<Vector>() / 3.0;
        let away = libm::hypot(middle.x.abs() - 22.0, middle.y) - 15.0;
        assert!((middle.z - corner.height(away)).abs() < 0.006, "{middle} {away}");
        let between = corners.iter().filter(|corner| corner.y.abs() < 1.0 && corner.x.abs() < 4.0);
        highest_between = between.map(|corner| corner.z).fold(highest_between, f64::max);
    }
    assert!((highest_between - 7.0).abs() < 0.1, "{highest_between}");
    assert!(found.mesh.triangles().len() < 120_000, "{}", found.mesh.triangles().len());
}

#[test]
fn a_hollow_edge_is_met_too() {
    // an L: its inner corner is hollow
    let at = |x: f64, y: f64| Vector::new(x, y, 0.0);
    let vertices = vec![
        at(0.0, 0.0),
        at(40.0, 0.0),
        at(40.0, 20.0),
        at(20.0, 20.0),
        at(20.0, 40.0),
        at(0.0, 40.0),
        Vector::new(10.0, 10.0, -9.0),
    ];
    let triangles: Vec<[i64; 3]> = (0..6).map(|i| [i, (i + 1) % 6, 6]).collect();
    let part = Mesh::new(vertices, &triangles, &[]).unwrap();
    let found = built(&part, &shape(45.0, 0.0, 8.0));
    for corners in of_wall(&found) {
        let p = corners.iter().sum::<Vector>() / 3.0;
        if p.x > 20.0 && p.y > 20.0 && p.x < 28.0 && p.y < 28.0 {
            assert!((p.z - (p.x - 20.0).min(p.y - 20.0)).abs() < 0.004, "{p}");
        }
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let keep = |part: &Mesh| vec![true; part.triangles().len()];
    let level = dish(36, 30.0, |_| 0.0);
    let steep = dish(36, 30.0, |turn| 20.0 * libm::sin(2.0 * turn));
    let refused = |part: &Mesh, shape: &WallShape| walled(part, &keep(part), shape).unwrap_err();
    assert!(matches!(refused(&steep, &shape(30.0, 0.0, 1.0)), WallFault::Steep { .. }));
    assert!(matches!(refused(&level, &shape(45.0, 10.0, 1.0)), WallFault::Arc { .. }));
    let down = WallShape { goes_down: true, ..shape(45.0, 0.0, 1.0) };
    assert!(matches!(refused(&level, &down), WallFault::Beyond { beyond } if (beyond - 19.0).abs() < 1e-9));
    assert_eq!(walled(&level, &[false; 36], &down).unwrap_err(), WallFault::NoEdge);
    let flat = Mesh::new(
        level.vertices().iter().map(|p| Vector::new(p.x, p.y, 0.0)).collect(),
        &level.triangles().iter().map(|t| t.map(i64::from)).collect::<Vec<_>>(),
        &[],
    )
    .unwrap();
    let flange = WallShape { end: WallEnd::Least, ..shape(45.0, 0.0, 0.0) };
    assert_eq!(refused(&flat, &flange), WallFault::Flange);
}

#[test]
fn a_blended_wall_goes_on_by_the_slope_of_the_part() {
    // cones of 63 and of 34 degrees, a wall of 45
    for depth in [60.0, 20.0] {
        let steep = Mesh::new(
            dish(360, 30.0, |_| 0.0).vertices().iter().map(|p| Vector::new(p.x, p.y, p.z * depth / 20.0)).collect(),
            &(0..360).map(|i| [i, (i + 1) % 360, 360]).collect::<Vec<_>>(),
            &[],
        )
        .unwrap();
        let found = built(&steep, &WallShape { blended: true, ..shape(45.0, 6.0, 12.0) });
        let own = libm::atan(depth / 30.0);
        let bend = bend::Bend { from: own, to: 45_f64.to_radians(), radius: 6.0 };
        let corner = Corner::new(45_f64.to_radians(), 12.0, 6.0);
        let (mut nearest, mut least) = (f64::INFINITY, 1.0);
        for corners in of_wall(&found) {
            let middle = corners.iter().sum::<Vector>() / 3.0;
            let away = libm::hypot(middle.x, middle.y) - 30.0;
            let exact = corner.height(bend.height(away.max(0.0)));
            assert!((middle.z - exact).abs() < 0.006, "{middle} {exact}");
            let up = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).normalize().z;
            if away < nearest {
                (nearest, least) = (away, up);
            }
        }
        assert!((libm::acos(least) - own).abs() < 0.06, "{} {own}", libm::acos(least));
    }
}

#[test]
fn a_wall_may_end_within_a_line_and_what_hangs_from_the_edge_gives_way_to_it() {
    let part = dish(360, 30.0, |_| 0.0);
    let square = vec![[-40.0, -40.0], [40.0, -40.0], [40.0, 40.0], [-40.0, 40.0]];
    let within = |line: Vec<[f64; 2]>| WallShape { end: WallEnd::Within(line), ..shape(45.0, 3.0, 0.0) };
    let found = built(&part, &within(square.clone()));
    let reach = found.extent[1][0] - 5.0;
    assert!((reach - 40.0).abs() < 1e-3, "{reach}");
    let small = square.iter().map(|corner| corner.map(|x| 0.5 * x)).collect();
    let fault = walled(&part, &[true; 360], &within(small)).unwrap_err();
    assert!(matches!(fault, WallFault::Outside { beyond } if (beyond - 10.0).abs() < 1e-9), "{fault}");
    // the dish with a skirt that hangs down from its edge
    let mut vertices = part.vertices().to_vec();
    vertices.extend((0..360).map(|i| part.vertices()[i] - Vector::new(0.0, 0.0, 25.0)));
    let mut triangles: Vec<[i64; 3]> = part.triangles().iter().map(|corners| corners.map(i64::from)).collect();
    triangles.extend((0..360).map(|i| [i, i + 361, (i + 1) % 360]));
    let skirted = Mesh::new(vertices, &triangles, &[]).unwrap();
    let keep: Vec<bool> = (0..720).map(|triangle| triangle < 360).collect();
    let plain = walled(&part, &[true; 360], &shape(45.0, 3.0, 8.0)).unwrap();
    let other = walled(&skirted, &keep, &shape(45.0, 3.0, 8.0)).unwrap();
    assert_eq!(other.mesh.triangles().len(), plain.mesh.triangles().len());
    assert_eq!(other.formed, plain.formed);
    let fall = dish(90, 30.0, |_| -30.0);
    let falls = walled(&fall, &[true; 90], &WallShape { blended: true, ..shape(45.0, 3.0, 20.0) });
    assert!(matches!(falls, Err(WallFault::Falls { .. })));
}
