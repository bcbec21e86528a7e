//! What contours leave where their fronts meet: passes along the ridges of the field.

use std::collections::BTreeSet;

use rayon::prelude::*;
use styluscam_geometry::Vector;
use styluscam_motion::{Cancelled, Watch};

use super::creases::Creases;
use super::distances::reached;
use super::net::{Net, Triangle};
use super::stations::Station;
use super::thinning::middle_lines;
use crate::lattice::Node;

/// From a pass to what is not covered by it, passes: five hundredths more than half of what lies between two.
const HALF: f64 = 0.525;
/// Slope of the field below which two fronts meet, by whose angle it is less than 1: 25 degrees, at which they leave a tenth more.
const MEET: f64 = 0.9;
/// Ridges are followed so far around what is not covered, passes.
const AROUND: f64 = 0.8;
/// As far from a node as it is to the next, passes.
const NEAR: f64 = 0.1;
/// Distances to either side, in cells, between which the slope on a side of a ridge is measured.
const SIDES: [f64; 2] = [1.0, 2.0];
/// By so many cells lines are shorter than the strips whose middles they are, at each end.
const ENDS: f64 = 2.5;
/// Points back to which the direction of an end is taken.
const TANGENT: usize = 4;
/// Times that a line is smoothed.
const SMOOTHED: usize = 3;

/// Lines in plan along the ridges of `values`, wherever passes at whole values and along creases leave more than asked for.
///
/// # Errors
/// `Cancelled` when `watch` is cancelled.
pub fn lines(net: &Net, values: &[f64], creases: &Creases<'_>, watch: &Watch) -> Result<Vec<Vec<[f64; 2]>>, Cancelled> {
    let left = net.distances(&sources(net, values, creases), f64::INFINITY, watch)?;
    // an edge over which the tool rolls is covered from both sides
    let counts = |node: &usize| values[*node].is_finite() && net.stations[*node].is_some_and(|station| !station.rolls);
    let meets = |node: &usize| counts(node) && net.slope(values, *node).is_some_and(|slope| slope < MEET);
    let ridges: Vec<usize> = (0..left.len()).into_par_iter().filter(meets).collect();
    let open: Vec<usize> = (0..left.len()).filter(|node| left[*node] > HALF && counts(node)).collect();
    let on_ridges = ridges.iter().filter(|node| is_open(net, values, **node));
    let from_open = net.distances(&at(open.iter().chain(on_ridges)), AROUND, watch)?;
    let mut strip: BTreeSet<usize> = ridges.into_iter().filter(|node| from_open[*node] <= AROUND).collect();
    // where no ridge is seen what is not covered is followed itself
    let from_ridges = net.distances(&at(strip.iter()), AROUND, watch)?;
    strip.extend(open.into_iter().filter(|node| from_ridges[*node] > AROUND));
    let strip = strip.into_iter().map(|node| net.place(node)).collect();
    Ok(middle_lines(strip).into_iter().map(|line| Ridge { net, values }.line(&line)).collect())
}

/// Nodes from which distances count.
fn at<'a>(nodes: impl Iterator<Item = &'a usize>) -> Vec<(usize, f64)> {
    nodes.map(|node| (*node, 0.0)).collect()
}

/// Whether there is a point near a node of a ridge that the passes on both sides leave open: where the slope is s, it is 1 / s
/// times as far away along the ridge from the pass on the higher side as it is by its value.
fn is_open(net: &Net, values: &[f64], node: usize) -> bool {
    let Some(slope) = net.slope(values, node) else { return false };
    let pass = values[node].floor();
    let share = values[node] - pass;
    (share > HALF - NEAR || pass < 1.0) && share < 1.0 - HALF * slope + NEAR
}

/// The nodes beside passes, with their distances from these.
fn sources(net: &Net, values: &[f64], creases: &Creases<'_>) -> Vec<(usize, f64)> {
    let mut sources = Vec::new();
    let mut add = |triangle: Triangle, ends: [&Station; 2]| {
        for node in triangle {
            let Some(station) = net.stations[node] else { continue };
            sources.push((node, reached(&net.spacing, &station, ends.map(|end| (end, 0.0)))));
        }
    };
    for triangle in net.lattice.cells().iter().flat_map(|cell| net.triangles(cell)) {
        let corners = triangle.map(|node| values[node]);
        if corners.iter().any(|value| value.is_infinite()) {
            continue;
        }
        let (low, high) = corners.iter().fold((corners[0], corners[0]), |(a, b), v| (a.min(*v), b.max(*v)));
        let mut level = low.ceil().max(1.0);
        while level <= high {
            let crossings: Vec<Station> =
                (0..3).filter_map(|i| crossing(net, values, level, [triangle[i], triangle[(i + 1) % 3]])).collect();
            if let [first, .., second] = &crossings[..] {
                add(triangle, [first, second]);
            }
            level += 1.0;
        }
    }
    for (triangle, [first, second]) in creases.pieces() {
        for node in triangle {
            let Some(station) = net.stations[node] else { continue };
            let ends = [first, second].map(|crossing| (crossing.beside(&station), 0.0));
            sources.push((node, reached(&net.spacing, &station, ends)));
        }
    }
    sources
}

/// Where a side has a value.
fn crossing(net: &Net, values: &[f64], level: f64, [a, b]: [usize; 2]) -> Option<Station> {
    let (from, to) = (values[a], values[b]);
    if (from >= level) == (to >= level) {
        return None;
    }
    let share = (level - from) / (to - from);
    let (a, b) = (net.stations[a]?, net.stations[b]?);
    let normal = (a.normal + (b.normal - a.normal) * share).try_normalize(f64::EPSILON)?;
    let between = |from: Vector, to: Vector| from + (to - from) * share;
    let (tip, contact) = (between(a.tip, b.tip), between(a.contact, b.contact));
    Some(Station { tip, normal, contact, rolls: a.rolls && b.rolls })
}

/// Lines of nodes along a ridge of a field.
struct Ridge<'a> {
    net: &'a Net,
    values: &'a [f64],
}

impl Ridge<'_> {
    /// The line in plan along a line of nodes.
    fn line(&self, nodes: &[Node]) -> Vec<[f64; 2]> {
        let lattice = &self.net.lattice;
        let middles: Vec<[f64; 2]> = nodes.iter().map(|node| lattice.point(node.map(|i| i as f64))).collect();
        if let [only] = middles[..] {
            let [x, y] = only;
            return vec![[x - 0.5 * lattice.cell, y], [x + 0.5 * lattice.cell, y]];
        }
        let mut line = smoothed(middles, SMOOTHED);
        line = (0..line.len()).map(|i| self.on_ridge(&line, i)).collect();
        lengthened(smoothed(line, SMOOTHED), ENDS * lattice.cell)
    }

    /// A point of a line, moved across it to where the field is highest: where the slopes on both sides meet.
    fn on_ridge(&self, line: &[[f64; 2]], at: usize) -> [f64; 2] {
        let [from, to] = [line[at.saturating_sub(1)], line[(at + 1).min(line.len() - 1)]];
        let along = [to[0] - from[0], to[1] - from[1]];
        let length = libm::hypot(along[0], along[1]);
        if length <= 0.0 {
            return line[at];
        }
        let cell = self.net.lattice.cell;
        let across = [-along[1] / length * cell, along[0] / length * cell];
        let place = |share: f64| [0, 1].map(|i| line[at][i] + share * across[i]);
        let side = |sign: f64| {
            let [near, far] = SIDES.map(|share| self.value(place(sign * share)));
            let (near, far) = (near?, far?);
            let rate = (near - far) / (SIDES[1] - SIDES[0]);
            // what the slope makes of the field in the middle
            Some((near + rate * SIDES[0], rate))
        };
        match (side(-1.0), side(1.0)) {
            (Some((left, left_rate)), Some((right, right_rate))) if left_rate > 0.0 && right_rate > 0.0 => {
                let shift = (right - left) / (left_rate + right_rate);
                place(shift.clamp(-SIDES[0], SIDES[0]))
            }
            _ => line[at],
        }
    }

    /// The field at a position; none beside the faces.
    fn value(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let lattice = &self.net.lattice;
        let place = [(x - lattice.origin[0]) / lattice.cell, (y - lattice.origin[1]) / lattice.cell];
        let [column, row] = place.map(|share| share.max(0.0) as usize);
        if column >= lattice.columns || row >= lattice.rows {
            return None;
        }
        let [a, b, c, d] = lattice.corner_numbers([column, row]).map(|node| self.values[node]);
        let [u, v] = [place[0] - column as f64, place[1] - row as f64];
        let value = (a * (1.0 - u) + b * u) * (1.0 - v) + (d * (1.0 - u) + c * u) * v;
        value.is_finite().then_some(value)
    }
}

/// A line that goes on straight at both ends, unless it is closed.
fn lengthened(mut line: Vec<[f64; 2]>, by: f64) -> Vec<[f64; 2]> {
    let beyond = |end: [f64; 2], before: [f64; 2]| {
        let along = [end[0] - before[0], end[1] - before[1]];
        let length = libm::hypot(along[0], along[1]).max(f64::MIN_POSITIVE);
        [0, 1].map(|i| end[i] + by / length * along[i])
    };
    let back = TANGENT.min(line.len() - 1);
    if line.first() != line.last() {
        let (first, last) = (beyond(line[0], line[back]), beyond(line[line.len() - 1], line[line.len() - 1 - back]));
        line.insert(0, first);
        line.push(last);
    }
    line
}

/// A line whose inner points are moved to the means around them.
fn smoothed(mut line: Vec<[f64; 2]>, times: usize) -> Vec<[f64; 2]> {
    for _ in 0..times {
        let before = line.clone();
        for i in 1..line.len().saturating_sub(1) {
            line[i] = [0, 1].map(|axis| 0.25 * (before[i - 1][axis] + 2.0 * before[i][axis] + before[i + 1][axis]));
        }
    }
    line
}
