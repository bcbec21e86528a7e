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
    let sides = sides(mesh);
    let pairs = sides.chunk_by(Side::is_beside).filter_map(|run| match run {
        [first, second] => Some(first.meeting(second)),
        [] | [_] | [_, _, _, ..] => None,
    });
    pairs.collect()
}

/// Every two triangles that meet in an edge, by its vertices: of more than two, each with the next.
pub fn meetings(mesh: &Mesh) -> Vec<Edge> {
    let sides = sides(mesh);
    let pairs = sides.windows(2).filter_map(|pair| match pair {
        [first, second] if first.is_beside(second) => Some(first.meeting(second)),
        _ => None,
    });
    pairs.collect()
}

/// One side of a triangle.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    ends: [u32; 2],
    triangle: u32,
}

impl Side {
    fn is_beside(&self, other: &Self) -> bool {
        self.ends == other.ends
    }

    fn meeting(&self, other: &Self) -> Edge {
        Edge { ends: self.ends, triangles: [self.triangle, other.triangle] }
    }
}

/// All sides of all triangles, those of one edge together.
fn sides(mesh: &Mesh) -> Vec<Side> {
    let of_triangle = |(t, [a, b, c]): (usize, &[u32; 3])| {
        [[a, b], [b, c], [c, a]].map(|[i, j]| Side { ends: [*i.min(j), *i.max(j)], triangle: t as u32 })
    };
    let mut sides: Vec<Side> = mesh.triangles().iter().enumerate().flat_map(of_triangle).collect();
    sides.sort_unstable();
    sides
}
