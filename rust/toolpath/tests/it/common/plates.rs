//! Plates with bosses, triangulated as meshers of meagre tools do: by cutting off ears, which leaves needles and fans.

use styluscam_geometry::{Mesh, Vector};

type PlanPosition = [f64; 2];

/// A prism that stands on a plate.
#[derive(Clone, Debug)]
pub struct Boss {
    pub centre: PlanPosition,
    pub radius: f64,
    pub sides: usize,
    pub height: f64,
}

impl Boss {
    fn outline(&self) -> Vec<PlanPosition> {
        let angle = |i: usize| std::f64::consts::TAU * i as f64 / self.sides as f64;
        let [x, y] = self.centre;
        (0..self.sides).map(|i| [x + self.radius * angle(i).cos(), y + self.radius * angle(i).sin()]).collect()
    }
}

/// The upper side of a plate from the origin to `size`, at height 0, and the bosses on it.
pub fn plate(size: PlanPosition, bosses: &[Boss]) -> Mesh {
    let mut points: Vec<Vector> = Vec::new();
    let mut triangles: Vec<[i64; 3]> = Vec::new();
    let mut ring: Vec<usize> = (0..4).collect();
    points.extend([[0.0, 0.0], [size[0], 0.0], size, [0.0, size[1]]].map(|[x, y]| Vector::new(x, y, 0.0)));
    let mut holes: Vec<Vec<usize>> = Vec::new();
    for boss in bosses {
        let (first, count) = (points.len(), boss.sides);
        points.extend(boss.outline().into_iter().map(|[x, y]| Vector::new(x, y, 0.0)));
        points.extend(boss.outline().into_iter().map(|[x, y]| Vector::new(x, y, boss.height)));
        for i in 0..count {
            let [a, b] = [first + i, first + (i + 1) % count].map(|at| at as i64);
            let up = count as i64;
            triangles.extend([[a, b, b + up], [a, b + up, a + up]]);
        }
        let top: Vec<usize> = (first + count..first + 2 * count).collect();
        triangles.extend(ears(&points, top));
        holes.push((first..first + count).rev().collect());
    }
    // bridged from the right: no bridge crosses a hole that is still to come
    let right = |hole: &[usize]| hole.iter().map(|at| points[*at].x).fold(f64::NEG_INFINITY, f64::max);
    holes.sort_by(|a, b| right(b).total_cmp(&right(a)));
    for hole in holes {
        ring = bridged(&points, &ring, &hole);
    }
    triangles.extend(ears(&points, ring));
    Mesh::new(points, &triangles, &[]).unwrap()
}

fn area(a: Vector, b: Vector, c: Vector) -> f64 {
    (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)
}

/// The ring with a hole put in at its nearest vertex that the hole's rightmost one sees.
fn bridged(points: &[Vector], ring: &[usize], hole: &[usize]) -> Vec<usize> {
    let from = (0..hole.len()).max_by(|a, b| points[hole[*a]].x.total_cmp(&points[hole[*b]].x)).unwrap();
    let start = points[hole[from]];
    let sides: Vec<[usize; 2]> = [ring, hole]
        .iter()
        .flat_map(|loop_| (0..loop_.len()).map(|i| [loop_[i], loop_[(i + 1) % loop_.len()]]))
        .collect();
    let sees = |to: usize| {
        sides.iter().all(|[p, q]| {
            let ends = [points[*p], points[*q]];
            let touches = [*p, *q].iter().any(|end| *end == hole[from] || points[*end] == points[to]);
            touches
                || area(start, points[to], ends[0]) * area(start, points[to], ends[1]) > 0.0
                || area(ends[0], ends[1], start) * area(ends[0], ends[1], points[to]) > 0.0
        })
    };
    let seen = (0..ring.len()).filter(|at| points[ring[*at]].x > start.x - 1e-9 && sees(ring[*at]));
    let at =
        seen.min_by(|a, b| (points[ring[*a]] - start).norm().total_cmp(&(points[ring[*b]] - start).norm())).unwrap();
    let around = (0..=hole.len()).map(|i| hole[(from + i) % hole.len()]);
    ring[..=at].iter().copied().chain(around).chain(ring[at..].iter().copied()).collect()
}

/// Triangles of a simple polygon: the first ear found is cut off, again and again.
fn ears(points: &[Vector], mut ring: Vec<usize>) -> Vec<[i64; 3]> {
    let mut triangles = Vec::new();
    while ring.len() > 2 {
        let count = ring.len();
        let corners = |i: usize| [ring[(i + count - 1) % count], ring[i], ring[(i + 1) % count]];
        let is_ear = |i: &usize| {
            let [a, b, c] = corners(*i).map(|at| points[at]);
            let inside = |p: Vector| area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 && area(c, a, p) >= 0.0;
            area(a, b, c) > 1e-12 && !ring.iter().map(|at| points[*at]).any(|p| p != a && p != b && p != c && inside(p))
        };
        let Some(ear) = (0..count).find(is_ear) else { break };
        triangles.push(corners(ear).map(|at| at as i64));
        ring.remove(ear);
    }
    triangles
}
