//! Which planes lie on an edge or on a corner of a mesh and over all that meets there: gradients of a line or of a convex polygon.
//!
//! The tool touches an edge or a corner only along such a plane, else what meets there rises into it. So the gradients are the Gauss
//! image of edge or corner, under the central projection in which great circles are straight.

use styluscam_geometry::Vector;

use super::super::features::NO_NEIGHBOUR;
use super::super::index::Index;
use super::frame::{cross, dot, length};

/// Steeper planes count as upright.
pub const STEEPEST: f64 = 1e4;
/// Steeper edges do not bound the planes on a corner: what is left out is small before [`STEEPEST`].
const STEEP: f64 = STEEPEST / 40.0;
/// How much flatter or steeper planes may be than what meets there lets them, for rounding.
const SLACK: f64 = 1e-9;
/// Rounding of a difference of two coordinates and of what is made of it, as a share.
const ROUNDING: f64 = 1e-15;
/// Triangles around a corner that are looked at: with fewer there are more planes.
const FAN: usize = 64;

/// The planes on an edge by what they rise across it, from and to; none where facets meet in a valley. `along` and `across` are unit
/// vectors in plan, `steep` is the edge's rise along it, `beyond` the third corners of the triangles that meet there, seen from the
/// edge's beginning.
pub fn on_edge(beyond: impl Iterator<Item = Vector>, [along, across]: [[f64; 2]; 2], steep: f64) -> Option<[f64; 2]> {
    let [mut low, mut high] = [f64::NEG_INFINITY, f64::INFINITY];
    for corner in beyond {
        let plan = [corner.x, corner.y];
        let aside = dot(across, plan);
        let length = corner.norm();
        if aside.abs() <= 1e-12 * length {
            continue;
        }
        let rise = (corner.z - steep * dot(along, plan)) / aside;
        let slack = (1.0 + steep.abs() + rise.abs()) * (SLACK + ROUNDING * length / aside.abs());
        if aside > 0.0 {
            low = low.max(rise - slack);
        } else {
            high = high.min(rise + slack);
        }
    }
    (low <= high).then_some([low, high])
}

/// Memory for polygons.
#[derive(Default)]
pub struct Polygon {
    pub corners: Vec<[f64; 2]>,
    next: Vec<[f64; 2]>,
}

impl Polygon {
    /// The gradients of planes on a corner of a triangle; without corners where there are none.
    pub fn on_corner(&mut self, index: &Index, triangle: u32, number: usize) {
        self.corners.clear();
        self.corners
            .extend([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|c: [f64; 2]| c.map(|x| STEEPEST * x)));
        let (mut at, mut corner, mut leaving, mut turned) = (triangle, number, number, false);
        let name = index.triangles().corners[triangle as usize][number];
        for _ in 0..FAN {
            let corners = index.triangles().at(at);
            // the edge over which the triangle is left is the one from `leaving` to the next corner
            let end = if leaving == corner { (corner + 1) % 3 } else { leaving };
            self.cut(corners[end] - corners[corner]);
            if self.corners.is_empty() {
                return;
            }
            let next = index.neighbours(at)[leaving];
            if next == triangle {
                return;
            }
            if next == NO_NEIGHBOUR {
                if turned {
                    return;
                }
                // the other way round, from the other edge of the first triangle
                (at, corner, leaving, turned) = (triangle, number, (number + 2) % 3, true);
                continue;
            }
            let shared = index.triangles().corners[at as usize][end];
            let names = index.triangles().corners[next as usize];
            let Some(number) = names.iter().position(|n| *n == name) else { return };
            // edges of the next triangle at the corner: from it, and to it
            leaving = if names[(number + 1) % 3] == shared { (number + 2) % 3 } else { number };
            (at, corner) = (next, number);
        }
    }

    /// Keeps the planes under which an edge from the corner lies.
    fn cut(&mut self, edge: Vector) {
        let run = length([edge.x, edge.y]);
        if edge.z.abs() > STEEP * run || run == 0.0 {
            return;
        }
        let (direction, rise) = ([edge.x / run, edge.y / run], edge.z / run);
        let over = |gradient: [f64; 2]| dot(direction, gradient) - rise + SLACK * (1.0 + rise.abs());
        self.next.clear();
        let count = self.corners.len();
        for i in 0..count {
            let (a, b) = (self.corners[i], self.corners[(i + 1) % count]);
            let (from, to) = (over(a), over(b));
            if from >= 0.0 {
                self.next.push(a);
            }
            if (from < 0.0) != (to < 0.0) {
                let share = from / (from - to);
                self.next.push([0, 1].map(|axis| a[axis] + share * (b[axis] - a[axis])));
            }
        }
        std::mem::swap(&mut self.corners, &mut self.next);
    }
}

/// Least and greatest distance of a segment from the origin.
pub fn distances([a, b]: [[f64; 2]; 2]) -> [f64; 2] {
    let along = [b[0] - a[0], b[1] - a[1]];
    let [first, last] = [a, b].map(|p| length([p[0], p[1]]));
    let (before, behind) = (dot(along, a), dot(along, b));
    let least =
        if before < 0.0 && behind > 0.0 { cross(a, b).abs() / length([along[0], along[1]]) } else { first.min(last) };
    [least, first.max(last)]
}
