//! How many passes lie between the border of the selected faces and each node of a lattice: distances in the metric of
//! [`Spacing`], over the triangles between the nodes.
//!
//! Each triangle is laid flat by the lengths of its sides, and the distance of a corner is the least over the opposite side,
//! along which that of its ends is interpolated (the update of R. Kimmel, J. A. Sethian, "Computing geodesic paths on manifolds",
//! PNAS 95, 1998). Sides that are stretched make obtuse triangles, over which fronts do not come in the order of their
//! distances: a node whose distance falls is asked again until none does (F. Bornemann, C. Rasch, "Finite-element
//! discretization of static Hamilton-Jacobi equations based on a local variational principle", Computing and Visualization in
//! Science 9, 2006).

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use styluscam_motion::{Cancelled, Watch};

use super::net::Net;
use super::stations::{Spacing, Station};

/// A distance that falls by less has not changed, passes.
const SAME: f64 = 1e-9;
/// Nodes between two questions whether to go on.
const ASKED: usize = 4096;

/// The distance of a station from the nearer of two others or what lies between them, whose distances are given.
pub fn reached(spacing: &Spacing, station: &Station, ends: [(&Station, f64); 2]) -> f64 {
    let [(first, near), (second, far)] = ends;
    let sides = [spacing.between(first, second), spacing.between(first, station)];
    over_side(sides, spacing.between(second, station), [near, far])
}

impl Net {
    /// The distance of each node from the nearest of the `sources`, nodes whose distance is known; infinite where none is
    /// reached, and beyond `most` passes perhaps too large.
    ///
    /// # Errors
    /// `Cancelled` when `watch` is cancelled.
    pub fn distances(&self, sources: &[(usize, f64)], most: f64, watch: &Watch) -> Result<Vec<f64>, Cancelled> {
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
            if distance > distances[node] || distance > most {
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

    /// How steep a field is around a node: passes crossed over passes gone. 1 where a front goes over it, the cosine of half the angle
    /// between two that meet there; none where the field ends.
    pub fn slope(&self, values: &[f64], node: usize) -> Option<f64> {
        self.step(values, node).map(|(_, slope)| slope)
    }

    /// The way in plan to the next pass from a node, mm, and how steep the field is there.
    pub fn step(&self, values: &[f64], node: usize) -> Option<([f64; 2], f64)> {
        let width = self.lattice.columns + 1;
        let [column, row] = self.place(node);
        if column == 0 || row == 0 || column == self.lattice.columns || row == self.lattice.rows {
            return None;
        }
        let lengths = [1, width].map(|step| 0.5 * (self.length(node, node + step) + self.length(node - step, node)));
        let (diagonal, sign) = match self.is_falling([column, row]) {
            true => (self.length(node + 1, node + width), -1.0),
            false => (self.length(node, node + width + 1), 1.0),
        };
        // the cosine between both directions in the metric, from the diagonal between their ends
        let [right, up] = [self.length(node, node + 1), self.length(node, node + width)];
        let cos = sign * (diagonal * diagonal - right * right - up * up) / (2.0 * right * up);
        let rises = [1, width].map(|step| 0.5 * (values[node + step] - values[node - step]));
        let [along, across] = [0, 1].map(|i| rises[i] / lengths[i]);
        let sin = 1.0 - cos * cos;
        let steepest = [(along - cos * across) / sin, (across - cos * along) / sin];
        let slope = (along * steepest[0] + across * steepest[1]).sqrt();
        let step = [0, 1].map(|i| steepest[i] / slope / lengths[i] * self.lattice.cell);
        Some((step, slope)).filter(|(step, slope)| slope.is_finite() && step.iter().all(|part| part.is_finite()))
    }

    /// The distance of a node through the side between two others.
    fn through(&self, side: [usize; 2], to: usize, distances: &[f64]) -> f64 {
        let [near, far] = side.map(|node| distances[node]);
        let first = self.length(side[0], to);
        if far.is_infinite() {
            return near + first;
        }
        over_side([self.length(side[0], side[1]), first], self.length(side[1], to), [near, far])
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
