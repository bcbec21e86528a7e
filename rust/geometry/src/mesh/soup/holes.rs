//! Small holes in what is closed but for them, as where a file lacks triangles: closed by triangles between their corners,
//! those that bend least from their neighbours.
//!
//! Source: P. Liepa, "Filling Holes in Meshes", Eurographics Symposium on Geometry Processing 2003, section 3.1, with the sum
//! of bend angles times lengths as weight: the largest angle, as in the paper, would cut off an edge that a hole crosses.

use std::collections::{BTreeMap, HashSet};

use super::edges::{ends, Edges};
use super::mending::{Filled, Mending};
use super::triangles::area_vector;
use super::union_find::Union;
use crate::Vector;

/// A hole of more sides stays open: an opening that is meant, perhaps.
const MOST_SIDES: usize = 12;
/// A surface of which the triangles in its holes would be more than this share is open, and no body with holes.
const SMALL: f64 = 0.1;
/// Triangles that lean by more from a neighbour fold back on it, rad: 150 degrees.
const FOLDED: f64 = 2.618;
/// Triangles that are less high over their longest side are slits, whose normals say nothing, mm.
const SLIT: f64 = 0.01;
/// A triangle's height over its longest side is no less than this share of that, or it is flat.
const FLAT: f64 = 1e-6;

/// Closes the holes of those connected surfaces that are closed then, where neighbours agree in their winding; returns the
/// edges after it.
pub fn fill(
    vertices: &[Vector],
    triangles: &mut Vec<[u32; 3]>,
    edges: Edges,
    patches: &mut Vec<u32>,
    mending: &mut Mending,
) -> Edges {
    if edges.odd.is_empty() {
        return edges;
    }
    let count = patches.iter().max().map_or(0, |last| *last as usize + 1);
    let (mut together, mut is_open) = (Union::new(count), vec![false; count]);
    let patch_of = |half: u32| patches[half as usize / 3];
    let (loops, others) = loops(triangles, &edges);
    let others = others
        .into_iter()
        .chain(edges.odd.iter().filter(|edge| edge.len() % 2 == 1 && edge.len() > 1).flatten().copied());
    others.for_each(|half| is_open[patch_of(half) as usize] = true);
    let rims = Rims { vertices, triangles, sides: rim_sides(triangles, &edges) };
    let mut filled: Vec<(u32, Vec<[u32; 3]>)> = Vec::new();
    for sides in loops {
        let patch = patch_of(sides[0]);
        sides.iter().for_each(|half| together.join(patch, patch_of(*half)));
        match rims.filled(&sides) {
            Some(made) => filled.push((patch, made)),
            None => is_open[patch as usize] = true,
        }
    }
    let mut areas = vec![[0.0; 2]; count];
    for (corners, patch) in triangles.iter().zip(&*patches) {
        areas[together.root(*patch) as usize][0] += area_vector(vertices, *corners).norm();
    }
    for (patch, made) in &filled {
        let area: f64 = made.iter().map(|corners| area_vector(vertices, *corners).norm()).sum();
        areas[together.root(*patch) as usize][1] += area;
    }
    let mut stays: Vec<bool> = areas.iter().map(|[surface, holes]| *holes > SMALL * surface).collect();
    (0..count as u32)
        .filter(|patch| is_open[*patch as usize])
        .for_each(|patch| stays[together.root(patch) as usize] = true);
    for (patch, made) in filled {
        if !stays[together.root(patch) as usize] {
            mending.filled.get_or_insert_default().add(vertices, &made);
            patches.extend(std::iter::repeat_n(patch, made.len()));
            triangles.extend(made);
        }
    }
    if mending.filled.is_some() {
        Edges::of(triangles)
    } else {
        edges
    }
}

/// The rings of open sides, and what open sides make none. Each ring passes a corner once, and runs against the triangles.
fn loops(triangles: &[[u32; 3]], edges: &Edges) -> (Vec<Vec<u32>>, Vec<u32>) {
    let mut from: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for half in edges.odd.iter().filter(|edge| edge.len() == 1).flatten() {
        from.entry(ends(triangles, *half).1).or_default().push(*half);
    }
    from.values_mut().for_each(|sides| sides.sort_by_key(|half| ends(triangles, *half).0));
    let (mut found, mut others) = (Vec::new(), Vec::new());
    while let Some((start, _)) = from.first_key_value() {
        let (mut at, mut path) = (*start, Vec::new());
        while let Some(half) = take(&mut from, at) {
            path.push(half);
            at = ends(triangles, half).0;
            if let Some(first) = path.iter().position(|side| ends(triangles, *side).1 == at) {
                found.push(path.split_off(first));
                if path.is_empty() {
                    break;
                }
            }
        }
        others.extend(path);
    }
    (found, others)
}

fn take(from: &mut BTreeMap<u32, Vec<u32>>, at: u32) -> Option<u32> {
    let sides = from.get_mut(&at)?;
    let half = sides.pop();
    if sides.is_empty() {
        from.remove(&at);
    }
    half
}

/// All sides between corners at open sides, lower corner first.
fn rim_sides(triangles: &[[u32; 3]], edges: &Edges) -> HashSet<(u32, u32)> {
    let corners = edges.odd.iter().flatten().map(|half| ends(triangles, *half).0);
    let corners: HashSet<u32> =
        corners.chain(edges.odd.iter().flatten().map(|half| ends(triangles, *half).1)).collect();
    let sides = (0..3 * triangles.len() as u32).map(|half| ends(triangles, half));
    sides.filter(|(a, b)| corners.contains(a) && corners.contains(b)).map(|(a, b)| (a.min(b), a.max(b))).collect()
}

struct Rims<'a> {
    vertices: &'a [Vector],
    triangles: &'a [[u32; 3]],
    sides: HashSet<(u32, u32)>,
}

/// The best triangles between the corners of a stretch of a ring.
#[derive(Clone, Copy)]
struct Best {
    /// Sum of lengths times bend angles, mm rad.
    bend: f64,
    /// The third corner of the triangle over the stretch, among the ring's.
    corner: usize,
    /// Of that triangle, or of the one beyond a side of the ring; none of a slit.
    normal: Option<Vector>,
}

impl Rims<'_> {
    /// Triangles that close a ring; none where it has too many sides, or would fold back.
    fn filled(&self, sides: &[u32]) -> Option<Vec<[u32; 3]>> {
        let count = sides.len();
        if !(3..=MOST_SIDES).contains(&count) {
            return None;
        }
        let ring: Vec<u32> = sides.iter().map(|half| ends(self.triangles, *half).1).collect();
        let normal = |half: u32| area_vector(self.vertices, self.triangles[half as usize / 3]).try_normalize(0.0);
        // by first and last corner of a stretch
        let mut best: Vec<Vec<Option<Best>>> = vec![vec![None; count]; count];
        for (i, half) in sides.iter().enumerate().take(count - 1) {
            best[i][i + 1] = Some(Best { bend: 0.0, corner: i, normal: Some(normal(*half)?) });
        }
        let last = normal(sides[count - 1])?;
        for span in 2..count {
            for first in 0..count - span {
                let end = first + span;
                let beyond = (span == count - 1).then_some(last);
                best[first][end] = self.over(&ring, &best, [first, end], beyond);
            }
        }
        let mut made = Vec::new();
        let mut stretches = vec![[0, count - 1]];
        while let Some([first, end]) = stretches.pop() {
            if end - first > 1 {
                let corner = best[first][end]?.corner;
                made.push([first, corner, end].map(|i| ring[i]));
                stretches.extend([[first, corner], [corner, end]]);
            }
        }
        Some(made)
    }

    /// The best triangle over a stretch of a ring of which all shorter stretches are known; `beyond` is the normal on the
    /// other side of the line between its ends, where that is a side of the ring.
    fn over(
        &self,
        ring: &[u32],
        best: &[Vec<Option<Best>>],
        [first, end]: [usize; 2],
        beyond: Option<Vector>,
    ) -> Option<Best> {
        let at = |i: usize| self.vertices[ring[i] as usize];
        if beyond.is_none() && self.sides.contains(&(ring[first].min(ring[end]), ring[first].max(ring[end]))) {
            return None;
        }
        let with = |corner: usize| {
            let normal = normal_of([first, corner, end].map(at))?;
            let bent = |from: usize, to: usize, other: Option<Vector>| {
                let angle = normal.zip(other).map_or(0.0, |(normal, other)| normal.angle(&other));
                (angle < FOLDED).then(|| angle * (at(to) - at(from)).norm())
            };
            let [before, after] = [best[first][corner]?, best[corner][end]?];
            let bend =
                before.bend + after.bend + bent(first, corner, before.normal)? + bent(corner, end, after.normal)?;
            let bend = bend + bent(first, end, beyond)?;
            Some(Best { bend, corner, normal })
        };
        (first + 1..end).filter_map(with).min_by(|a, b| a.bend.total_cmp(&b.bend))
    }
}

/// The normal of a triangle, if it is no slit; none of a flat one.
fn normal_of([a, b, c]: [Vector; 3]) -> Option<Option<Vector>> {
    let twice = (b - a).cross(&(c - a));
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    let height = twice.norm() / longest;
    (height > FLAT * longest).then(|| (height > SLIT).then(|| twice.normalize()))
}

impl Filled {
    fn add(&mut self, vertices: &[Vector], made: &[[u32; 3]]) {
        self.holes += 1;
        self.triangles += made.len();
        let corners = || made.iter().flatten().map(|i| vertices[*i as usize]);
        let (low, high) = super::triangles::bounds(corners());
        let width = (high - low).norm();
        if width > self.widest {
            (self.widest, self.at) = (width, (0.5 * (low + high)).into());
        }
    }
}
