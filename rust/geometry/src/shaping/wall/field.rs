//! The height of a wall of constant angle over a position: the lowest of the cones that stand on the edge it rises from.

use rstar::{primitives::GeomWithData, primitives::Line, RTree};

use super::super::cone;
use crate::Vector;

/// The wall's height somewhere, and from where on the edge it rises.
#[derive(Clone, Copy, Debug)]
pub struct Risen {
    /// Height of the wall, without an end, mm.
    pub height: f64,
    /// The point of the edge.
    pub foot: Vector,
}

/// Walls of one angle outside of closed lines.
pub struct Walls {
    sides: Vec<[Vector; 2]>,
    tree: RTree<GeomWithData<Line<[f64; 2]>, usize>>,
    slope: f64,
    low: f64,
}

impl Walls {
    /// `sides` in their order along the lines; `slope` is the wall's rise per length in plan.
    pub fn new(sides: Vec<[Vector; 2]>, slope: f64) -> Self {
        let line =
            |(number, [a, b]): (usize, &[Vector; 2])| GeomWithData::new(Line::new([a.x, a.y], [b.x, b.y]), number);
        let tree = RTree::bulk_load(sides.iter().enumerate().map(line).collect());
        let low = sides.iter().flatten().map(|point| point.z).fold(f64::INFINITY, f64::min);
        Self { sides, tree, slope, low }
    }

    /// The wall that rises from one side, over a position.
    pub fn of_side(&self, side: usize, at: [f64; 2]) -> f64 {
        let [a, b] = self.sides[side];
        cone::lowest(a, b, at, self.slope).0
    }

    /// The wall over a position: the lowest of all cones on the lines, which no other wall with their heights and this slope
    /// exceeds. Sides are looked at from the nearest on, as long as the lowest point of all could rise from there.
    pub fn at(&self, at: [f64; 2]) -> Risen {
        let mut best = (f64::INFINITY, 0, 0.0);
        for (line, squared) in self.tree.nearest_neighbor_iter_with_distance_2(at) {
            if self.low + self.slope * squared.sqrt() > best.0 {
                break;
            }
            let [a, b] = self.sides[line.data];
            let (height, share) = cone::lowest(a, b, at, self.slope);
            if height < best.0 || height <= best.0 && line.data < best.1 {
                best = (height, line.data, share);
            }
        }
        let (height, side, share) = best;
        let [a, b] = self.sides[side];
        Risen { height, foot: a + share * (b - a) }
    }
}
