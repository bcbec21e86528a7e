//! The lines in plan on which a field over a net has a value.

use std::collections::{BTreeMap, BTreeSet};

use super::net::Net;

/// Two nodes, in the order of their numbers.
type Side = [usize; 2];

/// Lines on which the values at the nodes, interpolated over the triangles, are `level`: the larger ones on their right. Closed
/// ones repeat their first point.
pub fn level_lines(net: &Net, values: &[f64], level: f64, cells: &[usize]) -> Vec<Vec<[f64; 2]>> {
    let mut next: BTreeMap<Side, Side> = BTreeMap::new();
    for triangle in cells.iter().flat_map(|cell| net.triangles(net.lattice.cell_of(*cell))) {
        if !triangle.iter().all(|node| values[*node].is_finite()) {
            continue;
        }
        let is_above = triangle.map(|node| values[node] >= level);
        let crossing = |rises: bool| {
            let side = (0..3).find(|i| is_above[*i] != rises && is_above[(*i + 1) % 3] == rises)?;
            let [a, b] = [triangle[side], triangle[(side + 1) % 3]];
            Some([a.min(b), a.max(b)])
        };
        if let Some((from, to)) = crossing(true).zip(crossing(false)) {
            next.insert(from, to);
        }
    }
    let reached: BTreeSet<Side> = next.values().copied().collect();
    let begins: Vec<Side> = next.keys().filter(|side| !reached.contains(*side)).copied().collect();
    let point = |side: Side| crossing_of(net, values, level, side);
    let mut lines: Vec<Vec<[f64; 2]>> = begins.into_iter().map(|begin| walk(&mut next, begin, point)).collect();
    while let Some(begin) = next.keys().next().copied() {
        lines.push(walk(&mut next, begin, point));
    }
    lines
}

fn walk(next: &mut BTreeMap<Side, Side>, begin: Side, point: impl Fn(Side) -> [f64; 2]) -> Vec<[f64; 2]> {
    let mut line = vec![point(begin)];
    let mut at = begin;
    while let Some(side) = next.remove(&at) {
        line.push(point(side));
        at = side;
    }
    line
}

fn crossing_of(net: &Net, values: &[f64], level: f64, side: Side) -> [f64; 2] {
    let [a, b] = side.map(|node| net.position(node));
    let [low, high] = side.map(|node| values[node]);
    let share = ((level - low) / (high - low)).clamp(0.0, 1.0);
    [0, 1].map(|i| a[i] + share * (b[i] - a[i]))
}
