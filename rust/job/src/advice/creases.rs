//! Sharp concave edges of a mesh.

use styluscam_geometry::{Mesh, Vector};

use super::{corner::Corner, patch::unit};
use crate::body::adjacency::{meetings, Edge};

/// Faces that meet at more than this are not tangent to each other, degrees.
pub const CREASE_DEG: f64 = 2.0;

/// The edges at which two triangles, at least one of them `selected`, meet in a concave corner.
pub fn creases(mesh: &Mesh, selected: &[bool]) -> Vec<Corner> {
    let is_asked = |edge: &Edge| edge.triangles.iter().any(|t| selected[*t as usize]);
    let corners = meetings(mesh).into_iter().filter(is_asked).filter_map(|edge| crease(mesh, &edge));
    corners.collect()
}

fn crease(mesh: &Mesh, edge: &Edge) -> Option<Corner> {
    let [a, b] = edge.triangles.map(|t| t as usize);
    let sides = [normal_beside(mesh, a, edge), normal_beside(mesh, b, edge)];
    let across = middle(mesh, b) - middle(mesh, a);
    let [from, to] = edge.ends.map(|vertex| mesh.vertices()[vertex as usize]);
    let corner = Corner { sides, radius: 0.0, length: (to - from).norm() };
    let is_hollow = across.dot(&(sides[1] - sides[0])) < 0.0;
    (is_hollow && corner.turn_deg() > CREASE_DEG).then_some(corner)
}

/// The model's normal in the middle of one of a triangle's edges.
fn normal_beside(mesh: &Mesh, triangle: usize, edge: &Edge) -> Vector {
    let normals = mesh.corner_normals(triangle);
    let at_ends = mesh.triangles()[triangle].into_iter().zip(normals).filter(|(vertex, _)| edge.ends.contains(vertex));
    unit(at_ends.map(|(_, normal)| normal).sum())
}

fn middle(mesh: &Mesh, triangle: usize) -> Vector {
    mesh.corners(triangle).iter().sum::<Vector>() / 3.0
}
