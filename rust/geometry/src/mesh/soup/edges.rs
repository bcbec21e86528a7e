//! Which triangles meet at an edge.

use rayon::prelude::*;

/// No half-edge.
pub const NONE: u32 = u32::MAX;

/// The sides of triangles: side k of triangle t, from corner k to corner k + 1, is half-edge 3 t + k.
pub struct Edges {
    /// For each half-edge the other one of its edge, where there are exactly two; else [`NONE`].
    pub twins: Vec<u32>,
    /// The half-edges of each edge that has another number of them.
    pub odd: Vec<Vec<u32>>,
}

impl Edges {
    pub fn of(triangles: &[[u32; 3]]) -> Self {
        let sides = |(t, corners): (usize, &[u32; 3])| {
            let sides = (3 * t as u32..).zip(sides_of(*corners));
            sides.map(|(half, (low, high))| ((u64::from(low) << 32) | u64::from(high), half))
        };
        let mut half: Vec<(u64, u32)> = triangles.par_iter().enumerate().flat_map_iter(sides).collect();
        half.par_sort_unstable();
        let mut edges = Self { twins: vec![NONE; half.len()], odd: Vec::new() };
        for edge in half.chunk_by(|a, b| a.0 == b.0) {
            if let [(_, one), (_, other)] = edge {
                edges.twins[*one as usize] = *other;
                edges.twins[*other as usize] = *one;
            } else {
                edges.odd.push(edge.iter().map(|(_, half)| *half).collect());
            }
        }
        edges
    }

    /// The half-edges at which there is no other triangle.
    pub fn open(&self) -> impl Iterator<Item = u32> + '_ {
        self.odd.iter().filter(|edge| edge.len() == 1).flatten().copied()
    }

    /// The triangle beyond a side, where exactly one other is there.
    pub fn beyond(&self, half: u32) -> Option<u32> {
        Some(self.twins[half as usize]).filter(|twin| *twin != NONE).map(|twin| twin / 3)
    }
}

/// The sides of a triangle in the order of its half-edges, each with its lower vertex first.
pub fn sides_of([a, b, c]: [u32; 3]) -> [(u32, u32); 3] {
    [(a, b), (b, c), (c, a)].map(|(from, to)| (from.min(to), from.max(to)))
}

/// First and last vertex of a half-edge.
pub fn ends(triangles: &[[u32; 3]], half: u32) -> (u32, u32) {
    let (corners, k) = (triangles[half as usize / 3], half as usize % 3);
    (corners[k], corners[(k + 1) % 3])
}

/// Whether each edge is run as often in one direction as in the other.
pub fn is_closed(triangles: &[[u32; 3]], edges: &Edges) -> bool {
    !triangles.is_empty() && gap(triangles, edges).is_none()
}

/// A half-edge of the first edge that is not.
pub fn gap(triangles: &[[u32; 3]], edges: &Edges) -> Option<u32> {
    let agrees = |half: u32, twin: u32| twin == NONE || ends(triangles, half).0 == ends(triangles, twin).1;
    let apart = (0..).zip(&edges.twins).find(|(half, twin)| !agrees(*half, **twin)).map(|(half, _)| half);
    let uneven = || edges.odd.iter().find(|edge| !is_balanced(triangles, edge));
    apart.or_else(|| uneven().and_then(|edge| edge.first().copied()))
}

/// Whether an edge is run as often in one direction as in the other.
pub fn is_balanced(triangles: &[[u32; 3]], edge: &[u32]) -> bool {
    2 * edge.iter().filter(|half| is_forward(triangles, **half)).count() == edge.len()
}

fn is_forward(triangles: &[[u32; 3]], half: u32) -> bool {
    let (a, b) = ends(triangles, half);
    a < b
}
