//! How many passes lie between the border of the selected faces and each node of a lattice: distances in the metric of
//! [`Spacing`], over the triangles between the nodes.
//!
//! Each triangle is laid flat by the lengths of its sides, and the distance of a corner is the least over the opposite side,
//! along which that of its ends is interpolated (the update of R. Kimmel, J. A. Sethian, "Computing geodesic paths on manifolds",
//! PNAS 95, 1998). Sides that are stretched make obtuse triangles, over which fronts do not come in the order of their
//! distances: a node whose distance falls is asked again until none does (F. Bornemann, C. Rasch, "Finite-element
//! discretization of static Hamilton-Jacobi equations based on a local variational principle", Comput. Vis. Sci. 9, 2006).

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use styluscam_motion::{Cancelled, Watch};

use super::stations::{Spacing, Station};
use crate::lattice::Node;
use crate::Lattice;

/// A distance that falls by less has not changed, passes.
const SAME: f64 = 1e-9;
/// Nodes between two questions whether to go on.
const ASKED: usize = 4096;

/// Stations at the nodes of a lattice, and triangles between them.
pub struct Net {
    pub lattice: Lattice,
    /// By node; none where nothing selected is touched.
    pub stations: Vec<Option<Station>>,
    /// By cell: whether it is divided from its lower right to its upper left.
    falling: Vec<bool>,
    spacing: Spacing,
}

/// Three nodes, counterclockwise.
pub type Triangle = [usize; 3];

impl Net {
    /// Cells are divided along the shorter of their diagonals.
    pub fn new(lattice: Lattice, stations: Vec<Option<Station>>, spacing: Spacing) -> Self {
        let falls = |cell: Node| {
            let corners = lattice.corner_numbers(cell).map(|number| stations[number]);
            match corners {
                [Some(a), Some(b), Some(c), Some(d)] => spacing.between(&b, &d) < spacing.between(&a, &c),
                [_, Some(_), _, Some(_)] => true,
                _ => false,
            }
        };
        let falling = lattice.cells().iter().map(falls).collect();
        Self { lattice, stations, falling, spacing }
    }

    /// The triangles of a cell whose corners all have a station.
    pub fn triangles(&self, cell: Node) -> impl Iterator<Item = Triangle> + '_ {
        let [a, b, c, d] = self.lattice.corner_numbers(cell);
        let halves =
            if self.falling[self.lattice.number(cell)] { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] };
        halves.into_iter().filter(|half| half.iter().all(|node| self.stations[*node].is_some()))
    }

    /// The cells around a node.
    fn around(&self, node: usize) -> impl Iterator<Item = Node> + '_ {
        let width = self.lattice.columns + 1;
        let (column, row) = (node % width, node / width);
        let columns = column.saturating_sub(1)..(column + 1).min(self.lattice.columns);
        let rows = row.saturating_sub(1)..(row + 1).min(self.lattice.rows);
        rows.flat_map(move |row| columns.clone().map(move |column| [column, row]))
    }

    /// The distance of a station from the nearer of two others or what lies between them, whose distances are given.
    pub fn reached(&self, station: &Station, ends: [(&Station, f64); 2]) -> f64 {
        let [(first, near), (second, far)] = ends;
        let sides = [self.spacing.between(first, second), self.spacing.between(first, station)];
        over_side(sides, self.spacing.between(second, station), [near, far])
    }

    /// The distance of each node from the nearest of the `sources`, nodes whose distance is known; infinite where none is
    /// reached.
    ///
    /// # Errors
    /// `Cancelled` when `watch` is cancelled.
    pub fn distances(&self, sources: &[(usize, f64)], watch: &Watch) -> Result<Vec<f64>, Cancelled> {
        let mut distances = vec![f64::INFINITY; self.stations.len()];
        let mut open = BinaryHeap::new();
        for (node, distance) in sources {
            if *distance < distances[*node] {
                distances[*node] = *distance;
                open.push(Reverse((Ordered(*distance), *node)));
            }
        }
        let mut passed = 0;
        while let Some(Reverse((Ordered(distance), node))) = open.pop() {
            if distance > distances[node] {
                continue;
            }
            passed += 1;
            if passed % ASKED == 0 {
                watch.advance(0)?;
            }
            for triangle in self.around(node).flat_map(|cell| self.triangles(cell)) {
                let Some(own) = triangle.iter().position(|corner| *corner == node) else { continue };
                let [second, third] = [triangle[(own + 1) % 3], triangle[(own + 2) % 3]];
                for (other, to) in [(second, third), (third, second)] {
                    let found = self.through([node, other], to, &distances);
                    if found < distances[to] - SAME {
                        distances[to] = found;
                        open.push(Reverse((Ordered(found), to)));
                    }
                }
            }
        }
        Ok(distances)
    }

    /// The distance of a node through the side between two others.
    fn through(&self, side: [usize; 2], to: usize, distances: &[f64]) -> f64 {
        let [Some(first), Some(second), Some(station)] = [side[0], side[1], to].map(|node| self.stations[node]) else {
            return f64::INFINITY;
        };
        let [near, far] = side.map(|node| distances[node]);
        if far.is_infinite() {
            return near + self.spacing.between(&first, &station);
        }
        self.reached(&station, [(&first, near), (&second, far)])
    }
}

/// The least distance of the corner of a triangle over its opposite side, at whose ends the distances are known.
///
/// `sides` are the lengths of that side and of the one from its first end to the corner; `third` of the last.
fn over_side([side, first]: [f64; 2], third: f64, [near, far]: [f64; 2]) -> f64 {
    let at_ends = (near + first).min(far + third);
    let rise = (far - near) / side;
    // the corner over the side laid flat
    let along = (first * first + side * side - third * third) / (2.0 * side);
    let over = (first * first - along * along).sqrt();
    let steep = (1.0 - rise * rise).sqrt();
    // not a number where the front comes from beyond an end, or where three lengths make no triangle
    let from = along - rise * over / steep;
    if (0.0..=side).contains(&from) {
        at_ends.min(near + rise * along + steep * over)
    } else {
        at_ends
    }
}

/// A distance by which nodes wait.
#[derive(Clone, Copy, PartialEq)]
struct Ordered(f64);

impl Eq for Ordered {}

impl PartialOrd for Ordered {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Ordered {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_front_goes_over_a_triangle_exactly() {
        // the corner (0.3, 0.4) over the side from (0, 0) to (1, 0), and a front at 30 degrees to that
        let (sin, cos) = 0.5_f64.sin_cos();
        let front = |x: f64, y: f64| 2.0 + x * sin + y * cos;
        let third = (0.7_f64 * 0.7 + 0.16).sqrt();
        let found = over_side([1.0, 0.5], third, [front(0.0, 0.0), front(1.0, 0.0)]);
        assert!((found - front(0.3, 0.4)).abs() < 1e-15, "{found}");
        // one that comes in from beyond an end goes along a side
        assert!((over_side([1.0, 0.5], third, [0.0, 0.95]) - 0.5).abs() < 1e-15);
    }
}
