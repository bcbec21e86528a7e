//! Which triangles meet in an edge.

use styluscam_geometry::Mesh;

/// An edge between two triangles.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    /// Its vertices.
    pub ends: [u32; 2],
    /// Its triangles.
    pub triangles: [u32; 2],
}

/// Edges that have two triangles, by their vertices.
pub fn edges(mesh: &Mesh) -> Vec<Edge> {
    let sides = mesh
        .triangles()
        .iter()
        .enumerate()
        .flat_map(|(t, [a, b, c])| [[a, b], [b, c], [c, a]].map(|[i, j]| (*i.min(j), *i.max(j), t as u32)));
    let mut sides: Vec<(u32, u32, u32)> = sides.collect();
    sides.sort_unstable();
    let pairs = sides.chunk_by(|p, q| (p.0, p.1) == (q.0, q.1)).filter_map(|run| match run {
        [first, second] => Some(Edge { ends: [first.0, first.1], triangles: [first.2, second.2] }),
        [] | [_] | [_, _, _, ..] => None,
    });
    pairs.collect()
}
