//! Triangles small enough to follow a change of shape: they are split where the moved surface leaves their planes, down to the
//! size below which the map is not known; between corners that are so near it is taken as linear.
//!
//! Edges are tested and split by their ends alone, so neighbours agree and no gap opens; a split triangle is split at its longest
//! side first (Rivara, 1984), which keeps its angles from becoming arbitrarily sharp.

use std::collections::{HashMap, HashSet};

use rayon::prelude::*;

use crate::{GeometryError, Mesh, Vector};

/// Most triangles: their index takes some 2 GB.
const MOST: usize = 4_000_000;
/// Positions that are tested along a side and across a triangle at most: where the map is known finer, smaller sides follow.
const ALONG: f64 = 32.0;
const ACROSS: f64 = 12.0;

/// Where a point goes.
pub type Map<'a> = &'a (dyn Fn(Vector) -> Vector + Sync);

/// A side: its ends by their numbers, the smaller first.
type Side = (u32, u32);

/// A triangle with the model's normals at its corners, if they are known.
#[derive(Clone, Copy)]
pub struct Piece {
    pub corners: [u32; 3],
    pub normals: Option<[Vector; 3]>,
    pub face: u32,
    is_settled: bool,
}

/// A mesh in pieces, at rest and moved.
pub struct Pieces<'a> {
    map: Map<'a>,
    /// How far a moved piece may lie off the moved surface, mm.
    tolerance: f64,
    /// Distance within which the map is not known, mm: sides are not split below it.
    spacing: f64,
    pub vertices: Vec<Vector>,
    pub moved: Vec<Vector>,
    pub triangles: Vec<Piece>,
    settled: HashSet<Side>,
    /// Most that the linear map within a piece was found to differ from the map, mm.
    pub linear: f64,
}

impl<'a> Pieces<'a> {
    /// Small enough pieces of a mesh.
    ///
    /// # Errors
    /// It takes too many.
    pub fn of(mesh: &Mesh, map: Map<'a>, tolerance: f64, spacing: f64) -> Result<Self, GeometryError> {
        let (vertices, triangles) = joined(mesh);
        let moved = vertices.par_iter().map(|point| map(*point)).collect();
        let settled = HashSet::new();
        let mut pieces = Self { map, tolerance, spacing, vertices, moved, triangles, settled, linear: 0.0 };
        loop {
            let mut marked = pieces.coarse_sides();
            pieces.mark_coarse_insides(&mut marked);
            if marked.is_empty() {
                return Ok(pieces);
            }
            pieces.mark_longest(&mut marked);
            pieces.split(&marked);
            if pieces.triangles.len() > MOST {
                return Err(GeometryError::TooFine { most: MOST, deviation: tolerance });
            }
        }
    }

    fn length(&self, (a, b): Side) -> f64 {
        (self.vertices[b as usize] - self.vertices[a as usize]).norm()
    }

    /// The longest of a piece's sides, by its place; of equal ones the one with the smaller ends.
    fn longest(&self, piece: &Piece) -> usize {
        let sides = sides(piece.corners);
        let longer = |a: &usize, b: &usize| {
            self.length(sides[*a]).total_cmp(&self.length(sides[*b])).then(sides[*b].cmp(&sides[*a]))
        };
        (0..3).max_by(longer).unwrap_or(0)
    }

    /// In how many parts to test a length.
    fn count(&self, length: f64, least: f64, most: f64) -> u32 {
        (length / self.spacing).ceil().clamp(least, most) as u32
    }

    /// The sides whose moved chord misses the moved surface; the others are settled.
    fn coarse_sides(&mut self) -> HashSet<Side> {
        let open = self.triangles.iter().filter(|piece| !piece.is_settled).flat_map(|piece| sides(piece.corners));
        let mut open: Vec<Side> = open.filter(|side| !self.settled.contains(side)).collect();
        open.sort_unstable();
        open.dedup();
        let errors: Vec<f64> = open.par_iter().map(|side| self.side_error(*side)).collect();
        let mut coarse = HashSet::new();
        for (side, error) in open.into_iter().zip(errors) {
            if error > self.tolerance && self.length(side) > self.spacing {
                coarse.insert(side);
            } else {
                self.settled.insert(side);
                self.linear = self.linear.max(error);
            }
        }
        coarse
    }

    /// Distance of the moved surface from a side's moved chord.
    fn side_error(&self, side: Side) -> f64 {
        let [from, to] = [side.0, side.1].map(|i| self.vertices[i as usize]);
        let [start, end] = [side.0, side.1].map(|i| self.moved[i as usize]);
        let along = (end - start).try_normalize(0.0).unwrap_or_default();
        let count = self.count(self.length(side), 2.0, ALONG);
        let error = |i: u32| {
            let off = (self.map)(from.lerp(&to, f64::from(i) / f64::from(count))) - start;
            (off - along * off.dot(&along)).norm()
        };
        (1..count).map(error).fold(0.0, f64::max)
    }

    /// Marks the longest side of pieces whose sides are fine and whose inside is not; the others are settled.
    fn mark_coarse_insides(&mut self, marked: &mut HashSet<Side>) {
        let is_open = |piece: &Piece| !piece.is_settled && !sides(piece.corners).iter().any(|s| marked.contains(s));
        let open: Vec<usize> = (0..self.triangles.len()).filter(|i| is_open(&self.triangles[*i])).collect();
        let errors: Vec<f64> = open.par_iter().map(|i| self.inside_error(&self.triangles[*i])).collect();
        for (index, error) in open.into_iter().zip(errors) {
            let piece = self.triangles[index];
            let longest = sides(piece.corners)[self.longest(&piece)];
            if error > self.tolerance && self.length(longest) > self.spacing {
                marked.insert(longest);
            } else {
                self.triangles[index].is_settled = true;
                self.linear = self.linear.max(error);
            }
        }
    }

    /// Distance of the moved surface from a piece's moved plane.
    fn inside_error(&self, piece: &Piece) -> f64 {
        let [a, b, c] = piece.corners.map(|i| self.vertices[i as usize]);
        let [start, second, third] = piece.corners.map(|i| self.moved[i as usize]);
        let normal = (second - start).cross(&(third - start)).try_normalize(0.0).unwrap_or_default();
        let size = self.length(sides(piece.corners)[self.longest(piece)]);
        let count = self.count(size, 3.0, ACROSS);
        let rows = (1..count - 1).flat_map(|i| (1..count - i).map(move |j| (i, j)));
        let error = |(i, j): (u32, u32)| {
            let [u, v] = [i, j].map(|step| f64::from(step) / f64::from(count));
            ((self.map)(a + u * (b - a) + v * (c - a)) - start).dot(&normal).abs()
        };
        rows.map(error).fold(0.0, f64::max)
    }

    /// Marks the longest side of every piece with a marked side, as far as that leads.
    fn mark_longest(&self, marked: &mut HashSet<Side>) {
        loop {
            let known = marked.len();
            for piece in &self.triangles {
                let sides = sides(piece.corners);
                if sides.iter().any(|side| marked.contains(side)) {
                    marked.insert(sides[self.longest(piece)]);
                }
            }
            if marked.len() == known {
                return;
            }
        }
    }

    fn split(&mut self, marked: &HashSet<Side>) {
        let mut order: Vec<Side> = marked.iter().copied().collect();
        order.sort_unstable();
        let first = self.vertices.len() as u32;
        let middle = |(a, b): &Side| 0.5 * (self.vertices[*a as usize] + self.vertices[*b as usize]);
        let middles: Vec<Vector> = order.iter().map(middle).collect();
        self.moved.par_extend(middles.par_iter().map(|point| (self.map)(*point)));
        self.vertices.extend(middles);
        let numbers: HashMap<Side, u32> = order.into_iter().zip(first..).collect();
        let mut split = Vec::with_capacity(self.triangles.len() + 2 * numbers.len());
        for piece in &self.triangles {
            let is_whole = sides(piece.corners).iter().all(|side| !numbers.contains_key(side));
            if is_whole {
                split.push(*piece);
            } else {
                let turned = piece.turned(self.longest(piece));
                halves(turned, &numbers, &mut split);
            }
        }
        self.triangles = split;
    }
}

impl Piece {
    /// The same with its side `first` before the others.
    fn turned(&self, first: usize) -> Self {
        let turn = |i: usize| (first + i) % 3;
        Self {
            corners: [0, 1, 2].map(|i| self.corners[turn(i)]),
            normals: self.normals.map(|normals| [0, 1, 2].map(|i| normals[turn(i)])),
            ..*self
        }
    }

    /// Both halves at the middle of the first side, each with the side that it keeps whole first.
    fn halved(&self, middle: u32) -> [Self; 2] {
        let [a, b, c] = self.corners;
        let between = self.normals.map(|[n, m, _]| (n + m).try_normalize(f64::EPSILON).unwrap_or(n));
        let with = |normals: fn([Vector; 3], Vector) -> [Vector; 3]| {
            self.normals.zip(between).map(|(corners, middle)| normals(corners, middle))
        };
        let open = Self { is_settled: false, ..*self };
        [
            Self { corners: [c, a, middle], normals: with(|[n, _, k], m| [k, n, m]), ..open },
            Self { corners: [b, c, middle], normals: with(|[_, l, k], m| [l, k, m]), ..open },
        ]
    }
}

/// The pieces of one whose first side is split, and its others perhaps.
fn halves(piece: Piece, numbers: &HashMap<Side, u32>, into: &mut Vec<Piece>) {
    match numbers.get(&sides(piece.corners)[0]) {
        Some(middle) => {
            for half in piece.halved(*middle) {
                halves(half, numbers, into);
            }
        }
        None => into.push(piece),
    }
}

/// The sides of a triangle: from each corner to the next.
fn sides([a, b, c]: [u32; 3]) -> [Side; 3] {
    [(a, b), (b, c), (c, a)].map(|(a, b)| (a.min(b), a.max(b)))
}

/// The mesh's corners and pieces; corners at one point are one.
fn joined(mesh: &Mesh) -> (Vec<Vector>, Vec<Piece>) {
    let mut known: HashMap<[u64; 3], u32> = HashMap::new();
    let mut vertices = Vec::with_capacity(mesh.vertices().len());
    let mut numbered = |point: Vector| {
        // + 0: -0 and 0 are one coordinate
        *known.entry(<[f64; 3]>::from(point).map(|x| (x + 0.0).to_bits())).or_insert_with(|| {
            vertices.push(point);
            vertices.len() as u32 - 1
        })
    };
    let mut piece = |triangle: usize| Piece {
        corners: mesh.corners(triangle).map(&mut numbered),
        normals: mesh.has_corner_normals().then(|| mesh.corner_normals(triangle)),
        face: mesh.faces()[triangle],
        is_settled: false,
    };
    let triangles = (0..mesh.triangles().len()).map(&mut piece).collect();
    (vertices, triangles)
}
