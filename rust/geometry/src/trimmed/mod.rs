//! Triangles of a face: an elementary surface within the edges around it.
//!
//! The face is laid out in the plane by its parameters, scaled so that triangles which are near to equilateral there leave the
//! surface equally far everywhere ([`chart`]). Its border and a lattice of points inside are joined by a constrained Delaunay
//! triangulation (L. P. Chew, Constrained Delaunay triangulations, Algorithmica 4, 1989), which takes the fewest triangles
//! that the deviation allows within a few percent. Described in docs/concepts/meshing.md.

mod border;
mod chart;
mod fault;
mod lattice;
mod rows;
mod triangulation;

pub use border::{EdgeUse, GUIDES};
pub use fault::TrimmedFault;

use crate::{ElementarySurface, Vector};

/// Triangles of a face. Where the face meets itself, at a seam or a pole, its points are there more than once.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceTriangles {
    /// Their corners, mm.
    pub nodes: Vec<Vector>,
    /// Indexes into `nodes`, all turning the same way on the surface.
    pub triangles: Vec<[u32; 3]>,
}

/// Triangles of the part of `surface` within `edges`, whose insides leave the surface by about `deviation` mm.
///
/// The points on edges are corners of the triangles, and no others lie on the border: neighbours that are given the same
/// points fit together.
///
/// # Errors
/// See [`TrimmedFault`].
pub fn mesh_trimmed(
    surface: &ElementarySurface,
    edges: &[EdgeUse<'_>],
    deviation: f64,
) -> Result<FaceTriangles, TrimmedFault> {
    let border = border::laid_out(surface, edges);
    let chart = chart::Chart::of(surface, deviation, border.range(1));
    let border = border.merged(&chart);
    let inside = lattice::points(surface, &chart, &border)?;
    let mut nodes = border.points;
    let mut flat = border.flat;
    nodes.extend(inside.iter().map(|parameters| surface.point(*parameters)));
    flat.extend(inside.iter().map(|parameters| chart.flat(*parameters)));
    let mut triangles = triangulation::within(&flat, &border.segments)?;
    let collapses = |[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [a, b, c].map(|i| nodes.get(*i as usize));
        a == b || b == c || c == a
    };
    triangles.retain(|triangle| !collapses(triangle));
    if triangles.is_empty() {
        return Err(TrimmedFault::Empty);
    }
    Ok(FaceTriangles { nodes, triangles })
}

#[cfg(test)]
mod tests;
