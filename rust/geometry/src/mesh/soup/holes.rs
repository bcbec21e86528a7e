//! Small holes in what is closed but for them, as where a file lacks triangles: closed by triangles between their corners,
//! those that bend least from their neighbours.
//!
//! Source: P. Liepa, "Filling Holes in Meshes", Eurographics Symposium on Geometry Processing 2003, section 3.1, with the sum
//! of bend angles times lengths as weight: the largest angle, as in the paper, would cut off an edge that a hole crosses.

use std::collections::HashSet;

use super::edges::{ends, is_balanced, sides_of, Edges};
use super::mending::{Filled, Mending};
use super::rings::Open;
use super::triangles::{area_vector, bounds};
use super::union_find::Union;
use crate::Vector;

/// A hole of more sides stays open: an opening that is meant, perhaps.
const MOST_SIDES: usize = 12;
/// A surface of which the triangles in its holes would be more than this share is open, and no body with holes.
const SMALL: f64 = 0.1;
/// Triangles that lean by more from a neighbour fold back on it, rad: 150 degrees.
const FOLDED: f64 = 2.618;
/// What leans by more from its neighbours on all sides is a face of its own, and an opening there may be meant, rad: 40 degrees.
const CREASE: f64 = 0.7;
/// Triangles that are less high over their longest side, as a share of the diagonal of the mesh's box, are slits: their normals say
/// nothing.
const SLIT: f64 = 1e-4;
/// A triangle's height over its longest side is no less than this share of that, or it is flat.
const FLAT: f64 = 1e-6;

/// Closes the holes of those connected surfaces that are closed then, where neighbours agree in their winding; returns the
/// edges after it. Surfaces between which a hole is closed become one patch.
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
    let patch_of = |half: u32| patches[half as usize / 3];
    let mut together = Union::new(count);
    let (found, open) = closed(vertices, triangles, &edges);
    for Hole { ring, .. } in &found {
        ring.iter().for_each(|half| together.join(patch_of(ring[0]), patch_of(*half)));
    }
    let uneven = edges.odd.iter().filter(|edge| edge.len() > 1 && !is_balanced(triangles, edge)).flatten().copied();
    let mut stays_open = vec![false; count];
    open.into_iter().chain(uneven).for_each(|half| stays_open[together.root(patch_of(half)) as usize] = true);
    // of each surface, and of what its holes would be closed with
    let mut areas = vec![[0.0; 2]; count];
    for (corners, patch) in triangles.iter().zip(&*patches) {
        areas[together.root(*patch) as usize][0] += area_vector(vertices, *corners).norm();
    }
    for Hole { ring, made } in &found {
        let area: f64 = made.iter().map(|corners| area_vector(vertices, *corners).norm()).sum();
        areas[together.root(patch_of(ring[0])) as usize][1] += area;
    }
    let is_filled = |root: usize| !stays_open[root] && areas[root][1] <= SMALL * areas[root][0];
    let mut added: Vec<([u32; 3], u32)> = Vec::new();
    for Hole { ring, made } in &found {
        let root = together.root(patch_of(ring[0]));
        if is_filled(root as usize) {
            mending.filled.get_or_insert_default().add(vertices, made);
            added.extend(made.iter().map(|corners| (*corners, root)));
        }
    }
    if added.is_empty() {
        return edges;
    }
    for patch in patches.iter_mut() {
        let root = together.root(*patch);
        if is_filled(root as usize) {
            *patch = root;
        }
    }
    triangles.extend(added.iter().map(|(corners, _)| *corners));
    patches.extend(added.iter().map(|(_, patch)| *patch));
    Edges::of(triangles)
}

/// A ring of open sides, and the triangles that close it.
struct Hole {
    ring: Vec<u32>,
    made: Vec<[u32; 3]>,
}

/// All rings that can be closed, those of fewer sides first, and the open sides that are left.
fn closed(vertices: &[Vector], triangles: &[[u32; 3]], edges: &Edges) -> (Vec<Hole>, Vec<u32>) {
    let mut open = Open::of(triangles, edges);
    let mut rims = Rims { vertices, triangles, sides: open.sides_between_corners(), slit: slit(vertices) };
    let mut found: Vec<Hole> = Vec::new();
    for count in 3..=MOST_SIDES {
        for half in open.sides() {
            let Some(ring) = open.ring(half, count) else { continue };
            let Some(made) = rims.filled(&ring) else { continue };
            open.remove(&ring);
            rims.sides.extend(made.iter().flat_map(|corners| sides_of(*corners)));
            found.push(Hole { ring, made });
        }
    }
    (found, open.sides())
}

fn slit(vertices: &[Vector]) -> f64 {
    let (low, high) = bounds(vertices.iter().copied());
    SLIT * (high - low).norm()
}

struct Rims<'a> {
    vertices: &'a [Vector],
    triangles: &'a [[u32; 3]],
    /// Sides that are there already between corners at open sides, lower corner first.
    sides: HashSet<(u32, u32)>,
    /// Below this height a triangle is a slit, mm.
    slit: f64,
}

/// The best triangles between the corners of a stretch of a ring.
#[derive(Clone, Copy)]
struct Best {
    /// Sum of lengths times bend angles, mm rad.
    bend: f64,
    /// The third corner of the triangle over the stretch, among the ring's; none of a side of the ring.
    corner: Option<usize>,
    /// Of that triangle, or of the one beyond a side of the ring; none of a slit.
    normal: Option<Vector>,
}

impl Rims<'_> {
    /// Triangles that close a ring; none where they would fold back, or lean from all neighbours. The ring's corners are where its sides begin
    /// on the hole's side: there each runs against its triangle.
    fn filled(&self, ring: &[u32]) -> Option<Vec<[u32; 3]>> {
        let count = ring.len();
        let corners: Vec<u32> = ring.iter().map(|half| ends(self.triangles, *half).1).collect();
        let beyond: Vec<Option<Vector>> =
            ring.iter().map(|half| self.normal_of(self.triangles[*half as usize / 3]).flatten()).collect();
        // by first and last corner of a stretch
        let mut best: Vec<Vec<Option<Best>>> = vec![vec![None; count]; count];
        for i in 0..count - 1 {
            best[i][i + 1] = Some(Best { bend: 0.0, corner: None, normal: beyond[i] });
        }
        for span in 2..count {
            for first in 0..count - span {
                let last = (span == count - 1).then_some(beyond[count - 1]);
                best[first][first + span] = self.over(&corners, &best, [first, first + span], last);
            }
        }
        let mut made = Vec::new();
        let (mut goes_on, mut stretches) = (false, vec![[0, count - 1]]);
        while let Some([first, end]) = stretches.pop() {
            let Best { corner, normal, .. } = best[first][end]?;
            let Some(corner) = corner else { continue };
            let sides = [(first, corner), (corner, end), (end, first)];
            let outer = sides.into_iter().filter(|(from, to)| (from + 1) % count == *to);
            goes_on |= outer.map(|(from, _)| angle(normal, beyond[from])).any(|angle| angle < CREASE);
            made.push([first, corner, end].map(|i| corners[i]));
            stretches.extend([[first, corner], [corner, end]]);
        }
        goes_on.then_some(made)
    }

    /// The best triangle over a stretch of a ring of which all shorter stretches are known; `beyond` is the normal on the
    /// other side of the line between its ends, where that is a side of the ring.
    fn over(
        &self,
        ring: &[u32],
        best: &[Vec<Option<Best>>],
        [first, end]: [usize; 2],
        beyond: Option<Option<Vector>>,
    ) -> Option<Best> {
        let at = |i: usize| self.vertices[ring[i] as usize];
        if beyond.is_none() && self.sides.contains(&(ring[first].min(ring[end]), ring[first].max(ring[end]))) {
            return None;
        }
        let with = |corner: usize| {
            let normal = self.normal_of([first, corner, end].map(|i| ring[i]))?;
            let bent = |from: usize, to: usize, other: Option<Vector>| {
                let angle = angle(normal, other);
                (angle < FOLDED).then(|| angle * (at(to) - at(from)).norm())
            };
            let [before, after] = [best[first][corner]?, best[corner][end]?];
            let bend =
                before.bend + after.bend + bent(first, corner, before.normal)? + bent(corner, end, after.normal)?;
            let bend = bend + beyond.map_or(Some(0.0), |beyond| bent(first, end, beyond))?;
            Some(Best { bend, corner: Some(corner), normal })
        };
        (first + 1..end).filter_map(with).min_by(|a, b| a.bend.total_cmp(&b.bend))
    }

    /// The normal of a triangle, if it is no slit; none of a flat one.
    fn normal_of(&self, corners: [u32; 3]) -> Option<Option<Vector>> {
        let [a, b, c] = corners.map(|i| self.vertices[i as usize]);
        let twice = area_vector(self.vertices, corners);
        let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
        let height = twice.norm() / longest;
        (height > FLAT * longest).then(|| (height > self.slit).then(|| twice.normalize()))
    }
}

/// Angle between two normals, rad; 0 where one is unknown.
fn angle(normal: Option<Vector>, other: Option<Vector>) -> f64 {
    normal.zip(other).map_or(0.0, |(normal, other)| normal.angle(&other))
}

impl Filled {
    fn add(&mut self, vertices: &[Vector], made: &[[u32; 3]]) {
        self.holes += 1;
        self.triangles += made.len();
        let (low, high) = bounds(made.iter().flatten().map(|i| vertices[*i as usize]));
        let width = (high - low).norm();
        if width > self.widest {
            (self.widest, self.at) = (width, (0.5 * (low + high)).into());
        }
    }
}
