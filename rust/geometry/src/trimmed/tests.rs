use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

use super::*;
use crate::{Axes, ElementaryKind};

const DEVIATION: f64 = 0.001;

/// Beside the border, and where a sphere's rows are out of step, triangles are larger than the lattice's.
const LARGEST: f64 = 1.7;

fn surface(kind: ElementaryKind) -> ElementarySurface {
    let axes = Axes::new(Vector::new(5.0, -3.0, 2.0), Vector::z(), [Vector::x(), Vector::y()]).unwrap();
    ElementarySurface::new(kind, axes, 1.0).unwrap()
}

/// Points along an edge that is straight in the parameters.
struct Edge {
    points: Vec<Vector>,
    fractions: Vec<f64>,
    guides: [[f64; 2]; GUIDES],
}

impl Edge {
    fn new(surface: &ElementarySurface, from: [f64; 2], to: [f64; 2], count: usize) -> Self {
        let at = |share: f64| [0, 1].map(|k| from[k] + share * (to[k] - from[k]));
        let fractions: Vec<f64> = (0..=count).map(|i| i as f64 / count as f64).collect();
        let guides = [0, 1, 2, 3, 4].map(|i| at(f64::from(i) / 4.0));
        let full = (to[0] - from[0] - TAU).abs() < 1e-12;
        let point = |share: f64| surface.point(if full && share >= 1.0 { at(0.0) } else { at(share) });
        Self { points: fractions.iter().map(|share| point(*share)).collect(), fractions, guides }
    }

    fn used(&self) -> EdgeUse<'_> {
        EdgeUse { points: &self.points, fractions: &self.fractions, guides: self.guides }
    }
}

/// The edges of a rectangle of parameters, with `counts` segments along u and v.
fn rectangle(surface: &ElementarySurface, low: [f64; 2], high: [f64; 2], counts: [usize; 2]) -> [Edge; 4] {
    [
        Edge::new(surface, low, [high[0], low[1]], counts[0]),
        Edge::new(surface, [high[0], low[1]], high, counts[1]),
        Edge::new(surface, [low[0], high[1]], high, counts[0]),
        Edge::new(surface, low, [low[0], high[1]], counts[1]),
    ]
}

fn meshed(surface: &ElementarySurface, edges: &[Edge]) -> FaceTriangles {
    let used: Vec<_> = edges.iter().map(Edge::used).collect();
    mesh_trimmed(surface, &used, DEVIATION).unwrap()
}

fn corners(mesh: &FaceTriangles, triangle: [u32; 3]) -> [Vector; 3] {
    triangle.map(|i| mesh.nodes[i as usize])
}

fn area(mesh: &FaceTriangles) -> f64 {
    let of = |[a, b, c]: [Vector; 3]| 0.5 * (b - a).cross(&(c - a)).norm();
    mesh.triangles.iter().map(|triangle| of(corners(mesh, *triangle))).sum()
}

/// How far the triangles leave the surface, by a grid of samples on each.
fn off(surface: &ElementarySurface, mesh: &FaceTriangles) -> f64 {
    let grid = (0..=6).flat_map(|i| (0..=6 - i).map(move |j| [f64::from(i) / 6.0, f64::from(j) / 6.0]));
    let grid: Vec<[f64; 2]> = grid.collect();
    let of = |[a, b, c]: [Vector; 3]| {
        grid.iter().map(|[s, t]| surface.distance(a * *s + b * *t + c * (1.0 - s - t)).abs()).fold(0.0, f64::max)
    };
    mesh.triangles.iter().map(|triangle| of(corners(mesh, *triangle))).fold(0.0, f64::max)
}

fn segments(radius: f64, angle: f64) -> usize {
    (angle / (2.0 * libm::acos(1.0 - 0.7 * DEVIATION / radius))).ceil() as usize
}

#[test]
fn a_whole_sphere_with_seam_and_poles() {
    let sphere = surface(ElementaryKind::Sphere { radius: 10.0 });
    let n = segments(10.0, PI);
    let seam = |u: f64| Edge::new(&sphere, [u, -FRAC_PI_2], [u, FRAC_PI_2], n);
    let pole = |v: f64| Edge::new(&sphere, [0.0, v], [TAU, v], 1);
    let mut edges = [seam(0.0), seam(TAU), pole(-FRAC_PI_2), pole(FRAC_PI_2)];
    edges[1].points = edges[0].points.clone();
    for edge in &mut edges[2..] {
        edge.points[1] = edge.points[0];
    }
    for (pole, end) in [(2, 0), (3, n)] {
        let point = edges[0].points[end];
        edges[pole].points.fill(point);
    }
    let mesh = meshed(&sphere, &edges);
    assert!((area(&mesh) / (4.0 * PI * 100.0) - 1.0).abs() < 2e-4);
    assert!(off(&sphere, &mesh) < LARGEST * DEVIATION, "{}", off(&sphere, &mesh));
    let equilateral = 0.75 * 3.0_f64.sqrt() * 2.0 * 10.0 * DEVIATION; // inscribed in a circle of sagitta DEVIATION
    let fewest = 4.0 * PI * 100.0 / equilateral;
    assert!((mesh.triangles.len() as f64) < 1.1 * fewest, "{} of {fewest}", mesh.triangles.len());
}

#[test]
fn a_cylinder_with_a_seam_takes_no_points_inside() {
    let cylinder = surface(ElementaryKind::Cylinder { radius: 8.0 });
    let n = segments(8.0, TAU);
    let mut edges = rectangle(&cylinder, [0.0, 0.0], [TAU, 3.0], [n, 1]);
    edges[1].points = edges[3].points.clone();
    let mesh = meshed(&cylinder, &edges);
    assert_eq!(mesh.triangles.len(), 2 * n);
    assert!(off(&cylinder, &mesh) < DEVIATION);
}

#[test]
fn tall_cylinders_cones_and_tori_stay_within_the_deviation() {
    let cases = [
        (ElementaryKind::Cylinder { radius: 8.0 }, [0.2, -20.0], [2.9, 60.0]),
        (ElementaryKind::Cone { radius: 3.0, semi_angle: 0.5 }, [-1.0, 0.0], [1.5, 9.0]),
        (ElementaryKind::Torus { major: 20.0, minor: 2.0 }, [3.0, FRAC_PI_4], [6.0, 3.0]),
        (ElementaryKind::Torus { major: 5.0, minor: 4.0 }, [0.0, -3.0], [1.0, 3.0]),
        (ElementaryKind::Sphere { radius: 30.0 }, [1.0, -0.4], [1.6, 0.3]),
    ];
    for (kind, low, high) in cases {
        let surface = surface(kind);
        let radius = surface.radius_at(low[1]).max(surface.radius_at(high[1])).max(surface.radius_at(0.0));
        let along = match kind {
            ElementaryKind::Torus { minor, .. } => segments(minor, high[1] - low[1]),
            ElementaryKind::Sphere { radius } => segments(radius, high[1] - low[1]),
            _ => 1,
        };
        let mesh = meshed(&surface, &rectangle(&surface, low, high, [segments(radius, high[0] - low[0]), along]));
        assert!(off(&surface, &mesh) < LARGEST * DEVIATION, "{kind:?}: {}", off(&surface, &mesh));
    }
}

#[test]
fn a_plane_with_holes_has_its_area() {
    let plane = surface(ElementaryKind::Plane);
    let mut edges: Vec<Edge> = rectangle(&plane, [0.0, 0.0], [30.0, 20.0], [1, 1]).into();
    for i in 0..5 {
        for j in 0..3 {
            let low = [2.0 + 5.0 * f64::from(i), 3.0 + 5.0 * f64::from(j)];
            edges.extend(rectangle(&plane, low, [low[0] + 2.0, low[1] + 1.0], [1, 1]));
        }
    }
    assert!((area(&meshed(&plane, &edges)) - (600.0 - 15.0 * 2.0)).abs() < 1e-9);
}

#[test]
fn edges_that_cross_or_do_not_close_are_refused() {
    let plane = surface(ElementaryKind::Plane);
    let edges = rectangle(&plane, [0.0, 0.0], [3.0, 2.0], [1, 1]);
    let open: Vec<_> = edges[..3].iter().map(Edge::used).collect();
    assert_eq!(mesh_trimmed(&plane, &open, DEVIATION), Err(TrimmedFault::Border));
    let across = rectangle(&plane, [1.0, 1.0], [5.0, 1.5], [1, 1]);
    let crossing: Vec<_> = edges.iter().chain(&across).map(Edge::used).collect();
    assert_eq!(mesh_trimmed(&plane, &crossing, DEVIATION), Err(TrimmedFault::Border));
    assert!(mesh_trimmed(&plane, &[], DEVIATION).is_err());
}

#[test]
fn an_edge_within_the_face_that_is_run_twice_is_no_border() {
    let plane = surface(ElementaryKind::Plane);
    let mut edges: Vec<Edge> = rectangle(&plane, [0.0, 0.0], [3.0, 2.0], [1, 1]).into();
    edges.push(Edge::new(&plane, [1.0, 1.0], [2.0, 1.0], 1));
    edges.push(Edge::new(&plane, [2.0, 1.0], [1.0, 1.0], 1));
    assert!((area(&meshed(&plane, &edges)) - 6.0).abs() < 1e-12);
}

#[test]
fn the_same_input_gives_the_same_triangles() {
    let sphere = surface(ElementaryKind::Sphere { radius: 30.0 });
    let edges = rectangle(&sphere, [1.0, -0.4], [1.6, 0.3], [30, 30]);
    assert_eq!(meshed(&sphere, &edges), meshed(&sphere, &edges));
}
