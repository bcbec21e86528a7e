//! Between pieces at depth: through what is cleared, the shortest way found on a lattice and pulled tight.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

use super::material::Material;
use super::pieces::SHALLOWEST;
use super::polygons::Point;

/// How far out of the positions that walls leave it may be, mm: pieces' chords are as much off.
const SLACK: f64 = 5e-4;
/// Positions of a line that are looked at where it passes near to material, in tool radii.
const STRIDE: f64 = 0.05;
/// Lattice positions that are looked at, at most.
const MOST: usize = 60_000;

/// What links have to keep clear of.
#[derive(Clone, Copy, Debug)]
pub struct Ground<'a> {
    pub material: &'a Material,
    /// The positions that the walls leave to the tool's centre.
    pub free: &'a Material,
    pub radius: f64,
}

impl Ground<'_> {
    /// How far the tool may go from a position in any direction, mm; below 0 it may not be there.
    fn room(&self, point: Point) -> f64 {
        let wall = self.free.distance(point) + SLACK;
        if wall > 2.0 * SLACK && !self.free.holds(point) {
            return -wall;
        }
        let room = wall.min(self.material.distance(point) - self.radius + SHALLOWEST);
        if room > 0.0 && self.material.holds(point) {
            return -room;
        }
        room
    }

    /// Whether the straight line keeps clear: from position to position as far as the last one is clear.
    fn is_straight_clear(&self, a: Point, b: Point) -> bool {
        let length = libm::hypot(b[0] - a[0], b[1] - a[1]);
        let mut travelled = 0.0;
        loop {
            let share = if length > 0.0 { travelled / length } else { 1.0 };
            let room = self.room([0, 1].map(|k| a[k] + share * (b[k] - a[k])));
            if room <= 0.0 || travelled >= length {
                return room > 0.0;
            }
            travelled = (travelled + room.max(STRIDE * self.radius)).min(length);
        }
    }

    /// Positions from a to b at depth; None where there is no way.
    pub fn way(&self, a: Point, b: Point) -> Option<Vec<Point>> {
        if self.is_straight_clear(a, b) {
            return Some(vec![a, b]);
        }
        let lattice = self.lattice_way(a, b)?;
        Some(self.pulled(&lattice))
    }

    fn lattice_way(&self, a: Point, b: Point) -> Option<Vec<Point>> {
        let size = 0.25 * self.radius;
        let at = |cell: [i32; 2]| [a[0] + f64::from(cell[0]) * size, a[1] + f64::from(cell[1]) * size];
        let goal = [0, 1].map(|i| libm::round((b[i] - a[i]) / size) as i32);
        let guess = |cell: [i32; 2]| libm::hypot(f64::from(cell[0] - goal[0]), f64::from(cell[1] - goal[1]));
        let mut best: HashMap<[i32; 2], (f64, [i32; 2])> = HashMap::from([([0, 0], (0.0, [0, 0]))]);
        let mut open = BinaryHeap::from([Reverse((ordered(guess([0, 0])), [0, 0]))]);
        let mut looked = 0;
        while let Some(Reverse((_, cell))) = open.pop() {
            looked += 1;
            if looked > MOST {
                return None;
            }
            let near = (cell[0] - goal[0]).abs() <= 1 && (cell[1] - goal[1]).abs() <= 1;
            if near && self.is_straight_clear(at(cell), b) {
                return Some(self.traced(&best, cell, at, b));
            }
            let cost = best.get(&cell)?.0;
            for (dx, dy) in [(1, 0), (0, 1), (-1, 0), (0, -1), (1, 1), (-1, 1), (-1, -1), (1, -1)] {
                let next = [cell[0] + dx, cell[1] + dy];
                let new = cost + libm::hypot(f64::from(dx), f64::from(dy));
                if best.get(&next).is_some_and(|(old, _)| *old <= new + 1e-9)
                    || !self.is_straight_clear(at(cell), at(next))
                {
                    continue;
                }
                best.insert(next, (new, cell));
                open.push(Reverse((ordered(new + guess(next)), next)));
            }
        }
        None
    }

    fn traced(
        &self,
        best: &HashMap<[i32; 2], (f64, [i32; 2])>,
        from: [i32; 2],
        at: impl Fn([i32; 2]) -> Point,
        end: Point,
    ) -> Vec<Point> {
        let mut points = vec![end];
        let mut cell = from;
        while let Some((_, before)) = best.get(&cell) {
            points.push(at(cell));
            if *before == cell {
                break;
            }
            cell = *before;
        }
        points.reverse();
        points
    }

    /// The way with all positions left out that need not be there.
    fn pulled(&self, points: &[Point]) -> Vec<Point> {
        let mut kept: Vec<Point> = points.iter().take(1).copied().collect();
        let mut from = 0;
        while from + 1 < points.len() {
            let (mut near, mut far) = (from + 1, points.len());
            while far - near > 1 {
                let middle = (near + far) / 2;
                match (points.get(from), points.get(middle)) {
                    (Some(a), Some(b)) if self.is_straight_clear(*a, *b) => near = middle,
                    _ => far = middle,
                }
            }
            kept.extend(points.get(near));
            from = near;
        }
        kept
    }
}

/// A length that orders: lattice lengths in millionths.
fn ordered(length: f64) -> u64 {
    (length * 1e6) as u64
}
