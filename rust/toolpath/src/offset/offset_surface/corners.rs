//! The points of the part for which positions are asked: the corners of its triangles, each once.

use styluscam_geometry::{Mesh, Vector};

use super::super::patches::Patches;

/// Normals of one corner within this are one, mm per mm.
const SAME_NORMAL: f64 = 1e-6;
/// Points of one corner that are compared with a new one at most: fans of thousands of facets have as many normals.
const COMPARED: usize = 64;

/// A point of the part with its normal.
pub struct Corner {
    pub point: Vector,
    pub normal: Vector,
    /// The first triangle that has it.
    pub triangle: u32,
}

/// Corners of triangles made one where vertex, patch and normal agree, and the triangles of them.
pub fn welded(mesh: &Mesh, patches: &Patches, triangles: &[u32]) -> (Vec<Corner>, Vec<[u32; 3]>) {
    const LAST: u32 = u32::MAX;
    let mut corners: Vec<Corner> = Vec::with_capacity(mesh.vertices().len());
    // the last corner at each vertex, and before each corner the one before it at the same vertex
    let mut heads = vec![LAST; mesh.vertices().len()];
    let mut before: Vec<u32> = Vec::with_capacity(mesh.vertices().len());
    let mut connection = Vec::with_capacity(triangles.len());
    for triangle in triangles {
        let names = mesh.triangles()[*triangle as usize];
        let normals = mesh.corner_normals(*triangle as usize);
        let patch = patches.of_triangle(*triangle);
        connection.push(std::array::from_fn(|k| {
            let (vertex, normal) = (names[k] as usize, normals[k]);
            let known = std::iter::successors(Some(heads[vertex]), |at| before.get(*at as usize).copied());
            let same = known.take(COMPARED).find(|at| {
                corners.get(*at as usize).is_some_and(|c| {
                    (c.normal - normal).norm() < SAME_NORMAL && patches.of_triangle(c.triangle) == patch
                })
            });
            same.unwrap_or_else(|| {
                corners.push(Corner { point: mesh.vertices()[vertex], normal, triangle: *triangle });
                before.push(heads[vertex]);
                heads[vertex] = corners.len() as u32 - 1;
                heads[vertex]
            })
        }));
    }
    (corners, connection)
}
