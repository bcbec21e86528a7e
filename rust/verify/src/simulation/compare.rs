//! What was left of the material over the part, or taken out of it.

use rayon::prelude::*;
use styluscam_geometry::{Bvh, Mesh, Node, Vector};
use styluscam_motion::{Cancelled, Watch};

use super::grid::Grid;
use super::stock::Simulation;

/// What a triangle reaches beyond its sides, as a share of it: a node on an edge belongs to both.
const EDGE: f64 = 1e-9;

impl Simulation {
    /// Signed distance of every node to the part, mm: negative where it lies below the part's upper surface, positive where
    /// it lies above it or beside the part.
    ///
    /// # Errors
    /// `Cancelled` when the watch is cancelled.
    pub fn distances(&self, mesh: &Mesh, bvh: &Bvh, watch: &Watch) -> Result<Vec<f64>, Cancelled> {
        let [width, depth] = self.grid.nodes;
        watch.begin("comparing", depth);
        let under = heights_of(mesh, &self.grid);
        let row = |row: usize| {
            watch.advance(1)?;
            let node = |column: usize| {
                let (index, [x, y]) = (row * width + column, self.grid.at(column, row));
                let point = Vector::new(x, y, self.heights[index]);
                let gap = point.z - under[index];
                let away = distance(mesh, bvh, point, gap.abs());
                if gap < 0.0 {
                    -away
                } else {
                    away
                }
            };
            Ok((0..width).map(node).collect::<Vec<f64>>())
        };
        let rows: Result<Vec<Vec<f64>>, Cancelled> = (0..depth).into_par_iter().map(row).collect();
        Ok(rows?.concat())
    }
}

/// Height of the part's highest surface at every node, mm; minus infinity where there is none.
fn heights_of(mesh: &Mesh, grid: &Grid) -> Vec<f64> {
    let mut heights = vec![f64::NEG_INFINITY; grid.count()];
    for triangle in 0..mesh.triangles().len() {
        raise(&mut heights, mesh.corners(triangle), grid);
    }
    heights
}

/// Raises the nodes under a triangle to it.
fn raise(heights: &mut [f64], [a, b, c]: [Vector; 3], grid: &Grid) {
    let (ab, ac) = (b - a, c - a);
    let area = ab.x * ac.y - ab.y * ac.x;
    if area == 0.0 {
        return;
    }
    let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
    let range = |axis: usize| {
        let index = |at: f64| (at - grid.origin[axis]) / grid.step[axis];
        let last = grid.nodes[axis] - 1;
        let from = (index(low[axis]) - EDGE).ceil().clamp(0.0, last as f64 + 1.0) as usize;
        let to = (index(high[axis]) + EDGE).floor().clamp(-1.0, last as f64);
        from..(to + 1.0) as usize
    };
    for y in range(1) {
        for x in range(0) {
            let [along, across] = grid.at(x, y);
            let (dx, dy) = (along - a.x, across - a.y);
            let second = (dx * ac.y - dy * ac.x) / area;
            let third = (ab.x * dy - ab.y * dx) / area;
            if second >= -EDGE && third >= -EDGE && second + third <= 1.0 + EDGE {
                let height = &mut heights[y * grid.nodes[0] + x];
                *height = height.max(a.z + second * ab.z + third * ac.z);
            }
        }
    }
}

/// Distance from a point to the nearest triangle, mm, if it is below `most`.
fn distance(mesh: &Mesh, bvh: &Bvh, point: Vector, most: f64) -> f64 {
    let bound = |node: &Node| -(node.low - point).sup(&(point - node.high)).sup(&Vector::zeros()).norm_squared();
    let visit = |triangle: u32, best: f64| best.max(-nearest(mesh.corners(triangle as usize), point).norm_squared());
    (-bvh.maximise(-(most * most), bound, visit)).sqrt()
}

/// The shift from a point to the nearest one of a triangle: on its plane if that is inside, else on a side.
fn nearest([a, b, c]: [Vector; 3], point: Vector) -> Vector {
    let (ab, ac) = (b - a, c - a);
    let share = |along: Vector, from: Vector| (along.dot(&(point - from)) / along.norm_squared()).clamp(0.0, 1.0);
    let normal = ab.cross(&ac);
    let inside = |from: Vector, along: Vector| normal.dot(&along.cross(&(point - from))) >= 0.0;
    if inside(a, ab) && inside(b, c - b) && inside(c, a - c) {
        return normal * (normal.dot(&(a - point)) / normal.norm_squared());
    }
    let sides = [(a, ab), (b, c - b), (c, a - c)].map(|(from, along)| from + share(along, from) * along - point);
    let shorter = |x: Vector, y: Vector| if y.norm_squared() < x.norm_squared() { y } else { x };
    shorter(shorter(sides[0], sides[1]), sides[2])
}
