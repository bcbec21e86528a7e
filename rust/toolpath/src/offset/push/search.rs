//! The search for the triangle that stops a tool first on its path along a line.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use styluscam_geometry::{Cutter, Vector};

use super::super::index::{Index, WIDTH};
use super::{release, Line, Release};

/// A node still to be opened, or a triangle still to be tried, and a travel before which the tool cannot touch it.
#[derive(Clone, Copy, PartialEq)]
struct Open {
    from: f64,
    /// None: the lane of the first level that is a triangle's.
    level: Option<usize>,
    lane: usize,
}

impl Eq for Open {}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Open {
    /// The nearest is the greatest; of equals the first.
    fn cmp(&self, other: &Self) -> Ordering {
        other.from.total_cmp(&self.from).then_with(|| (other.level, other.lane).cmp(&(self.level, self.lane)))
    }
}

/// Where a cutter with its tip at `z`, coming along `line` from its beginning, first touches, up to `limit` mm: the
/// triangle by its number in the index and the contact, `travel` mm from the beginning.
///
/// A travel below 0: the cutter does not stand free at the beginning. A triangle that it leaves at once, to rounding,
/// does not stop it.
pub fn first(index: &Index, cutter: &Cutter, line: &Line, z: f64, limit: f64) -> Option<(u32, Release)> {
    let corridor = Corridor { index, cutter, line, z };
    let mut open = BinaryHeap::from([Open { from: 0.0, level: Some(index.levels().len() - 1), lane: 0 }]);
    let mut found: Option<(u32, Release)> = None;
    while let Some(next) = open.pop() {
        if next.from > found.as_ref().map_or(limit, |found| found.1.travel) {
            break;
        }
        match next.level {
            Some(level) => corridor.children(level, next.lane, |child| open.push(child)),
            None => {
                let triangle = index.of_piece(next.lane as u32);
                let stop = corridor.stop(triangle).filter(|stop| stop.travel <= limit);
                let is_nearer = |stop: &Release| {
                    let before = found.as_ref().map(|(t, found)| (found.travel, *t));
                    before.is_none_or(|(travel, t)| stop.travel < travel || (stop.travel <= travel && triangle < t))
                };
                found = stop.filter(is_nearer).map(|stop| (triangle, stop)).or(found);
            }
        }
    }
    found
}

/// What a search on one line has in hand.
struct Corridor<'a> {
    index: &'a Index,
    cutter: &'a Cutter,
    line: &'a Line,
    z: f64,
}

impl Corridor<'_> {
    /// Calls `keep` with those of a node's eight children that the tool can touch.
    fn children(&self, level: usize, node: usize, mut keep: impl FnMut(Open)) {
        let lanes = &self.index.levels()[level][node];
        let [low, high, gradient] = [lanes.low, lanes.high, lanes.gradient].map(|row| row.map(|l| l.to_array()));
        let lift = lanes.lift.to_array();
        let centre = self.index.centre();
        for lane in 0..WIDTH {
            let [(x, hx), (y, hy)] = [0, 1].map(|i| {
                let (low, high) = (f64::from(low[i][lane]), f64::from(high[i][lane]));
                (0.5 * (low + high) + centre[i], 0.5 * (high - low))
            });
            let [gx, gy] = gradient.map(|row| f64::from(row[lane].abs()));
            let top = f64::from(lift[lane]) + gx * hx + gy * hy + centre.z;
            if let Some(from) = self.earliest([x, y], [hx, hy], top) {
                let level = level.checked_sub(1);
                keep(Open { from, level, lane: node * WIDTH + lane });
            }
        }
    }

    /// A travel before which the tool touches nothing in a box of the plan up to a height.
    fn earliest(&self, middle: [f64; 2], half: [f64; 2], top: f64) -> Option<f64> {
        let [ux, uy] = self.line.along;
        let (dx, dy) = (middle[0] - self.line.from[0], middle[1] - self.line.from[1]);
        let (along, beside) = (ux * dx + uy * dy, (ux * dy - uy * dx).abs());
        let (half_along, half_beside) =
            (ux.abs() * half[0] + uy.abs() * half[1], uy.abs() * half[0] + ux.abs() * half[1]);
        let beside = (beside - half_beside).max(0.0);
        let reach = self.cutter.max_radius();
        if beside > reach || along + half_along + reach < 0.0 || top <= self.z {
            return None;
        }
        let radius = self.cutter.at_height(top - self.z).0;
        // boxes are rounded outward: what is lost here is less
        (beside <= radius).then(|| (along - half_along - (radius * radius - beside * beside).sqrt()).max(0.0))
    }

    /// Where a triangle stops the tool: it comes free of it there when it goes back. None for one that it has left behind.
    fn stop(&self, triangle: u32) -> Option<Release> {
        let corners: [Vector; 3] = self.index.triangles().at(triangle);
        let entered = release(self.cutter, &corners, &self.line.reversed(), self.z)?;
        let entered = Release { travel: -entered.travel, ..entered };
        if entered.travel >= 0.0 {
            return Some(entered);
        }
        let left = release(self.cutter, &corners, self.line, self.z)?;
        (left.travel > self.index.rounding()).then_some(entered)
    }
}
