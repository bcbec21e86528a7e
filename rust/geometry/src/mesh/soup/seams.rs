//! Seams at which the corners of one side do not meet those of the other: triangles are cut at corners of others that lie
//! on their sides, so that both sides have the same edges.

use std::collections::HashMap;

use super::edges::{ends, Edges};
use super::mending::Mending;
use super::triangles::bounds;
use super::weld::join_distance;
use crate::Vector;

/// A side is cut at the corner nearest to its middle, and its parts in the next round.
const ROUNDS: usize = 32;
/// A corner lies aside of a side by at most this share of its distance to the side's ends: else it belongs to another edge there.
const ASIDE: f64 = 0.1;
/// And by at most this share of the triangle's height over that side.
const LOW: f64 = 0.5;

/// Cuts triangles with an open side on which open corners of others lie, as far as those continue along it.
pub fn cut(vertices: &[Vector], triangles: &mut Vec<[u32; 3]>, mending: &mut Mending) {
    let distance = join_distance(vertices);
    for _ in 0..ROUNDS {
        let edges = Edges::of(triangles);
        let open: Vec<u32> = edges.open().collect();
        if open.is_empty() || !distance.is_finite() {
            return;
        }
        let border = Border::new(vertices, open.iter().map(|half| ends(triangles, *half)), distance);
        let mut is_cut = vec![false; triangles.len()];
        let before = mending.cut;
        for half in open {
            let (triangle, k) = (half as usize / 3, half as usize % 3);
            if is_cut[triangle] {
                continue;
            }
            let corners = triangles[triangle];
            let Some((middle, aside)) = border.middle(corners, k) else { continue };
            let [from, to, apex] = [0, 1, 2].map(|i| corners[(k + i) % 3]);
            triangles[triangle] = [from, middle, apex];
            triangles.push([middle, to, apex]);
            is_cut[triangle] = true;
            mending.cut += 1;
            mending.moved = mending.moved.max(aside);
        }
        if mending.cut == before {
            return;
        }
    }
}

/// The corners at open edges, found by position.
struct Border<'a> {
    vertices: &'a [Vector],
    /// The other ends of the open edges at a corner.
    beside: HashMap<u32, Vec<u32>>,
    cells: HashMap<[i64; 3], Vec<u32>>,
    cell: f64,
    distance: f64,
}

impl<'a> Border<'a> {
    fn new(vertices: &'a [Vector], open: impl Iterator<Item = (u32, u32)>, distance: f64) -> Self {
        let mut beside: HashMap<u32, Vec<u32>> = HashMap::new();
        for (from, to) in open {
            beside.entry(from).or_default().push(to);
            beside.entry(to).or_default().push(from);
        }
        let mut corners: Vec<u32> = beside.keys().copied().collect();
        corners.sort_unstable();
        let (low, high) = bounds(corners.iter().map(|i| vertices[*i as usize]));
        // about one corner a cell, and none that `distance` reaches beyond
        let cell = ((high - low).amax() / libm::cbrt(corners.len() as f64)).max(2.0 * distance);
        let mut border = Self { vertices, beside, cells: HashMap::new(), cell, distance };
        for corner in corners {
            border.cells.entry(border.cell_of(border.at(corner))).or_default().push(corner);
        }
        border
    }

    fn at(&self, vertex: u32) -> Vector {
        self.vertices[vertex as usize]
    }

    fn cell_of(&self, point: Vector) -> [i64; 3] {
        point.map(|x| (x / self.cell).floor() as i64).into()
    }

    /// The corner on side `k` of a triangle nearest to that side's middle, and how far aside it lies, mm.
    fn middle(&self, corners: [u32; 3], k: usize) -> Option<(u32, f64)> {
        let [from, to, apex] = [0, 1, 2].map(|i| corners[(k + i) % 3]);
        let (start, span) = (self.at(from), self.at(to) - self.at(from));
        let length = span.norm();
        let line = Line::through(start, self.at(to));
        let others = [from, to].map(|end| Line::through(self.at(end), self.at(apex)));
        // cut there, neither part is turned over
        let flattest = LOW * line.along_and_aside(self.at(apex)).1;
        let mut best: Option<(f64, u32, f64)> = None;
        for corner in self.near(start, span).filter(|corner| !corners.contains(corner)) {
            let (at, aside) = line.along_and_aside(self.at(corner));
            let is_inside = aside <= self.distance.min(ASIDE * at.min(length - at)).min(flattest);
            let is_inside = is_inside && others.iter().all(|other| aside <= other.along_and_aside(self.at(corner)).1);
            if is_inside && self.goes_on(corner, (from, to), &line) {
                let found = ((at - 0.5 * length).abs(), corner, aside);
                best = best.filter(|best| (best.0, best.1) <= (found.0, found.1)).or(Some(found));
            }
        }
        best.map(|(_, corner, aside)| (corner, aside))
    }

    /// Whether an open edge at a corner runs along a side.
    fn goes_on(&self, corner: u32, (from, to): (u32, u32), line: &Line) -> bool {
        let on_line = |end: &u32| *end == from || *end == to || line.along_and_aside(self.at(*end)).1 <= self.distance;
        self.beside.get(&corner).is_some_and(|ends| ends.iter().any(on_line))
    }

    /// The corners in the cells along a segment, some of them more than once.
    fn near(&self, start: Vector, span: Vector) -> impl Iterator<Item = u32> + '_ {
        let steps = (span.amax() / self.cell).ceil().max(1.0) as usize;
        let on_span = (0..=steps).map(move |i| start + span * (i as f64 / steps as f64));
        let around = on_span.flat_map(|point| {
            let [x, y, z] = self.cell_of(point);
            (0..27).map(move |i| [x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1])
        });
        around.filter_map(|cell| self.cells.get(&cell)).flatten().copied()
    }
}

struct Line {
    start: Vector,
    /// Of length 1.
    along: Vector,
}

impl Line {
    fn through(start: Vector, end: Vector) -> Self {
        Self { start, along: (end - start).normalize() }
    }

    /// Where a point lies along the line, and how far aside, mm.
    fn along_and_aside(&self, point: Vector) -> (f64, f64) {
        let offset = point - self.start;
        let at = offset.dot(&self.along);
        (at, (offset - at * self.along).norm())
    }
}
