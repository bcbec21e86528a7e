//! Where the tool stands when it touches what was selected.

use rayon::prelude::*;
use styluscam_geometry::Vector;

use crate::Surface;

/// Walls whose normal rises by less have no one height at which the tool touches them.
const WALL: f64 = 1e-9;

/// Tips of the tool that touches the corners of the selected facets, facet by facet; walls have none.
///
/// Something else may keep the tool from standing there.
pub(super) fn stances(surface: &Surface<'_>) -> Vec<[Vector; 3]> {
    let triangles: Vec<usize> = surface.triangles().collect();
    stances_of(surface, &triangles).into_iter().map(|(_, stands)| stands).collect()
}

/// The same of some of the mesh's triangles, each with its number.
pub(super) fn stances_of(surface: &Surface<'_>, triangles: &[usize]) -> Vec<(usize, [Vector; 3])> {
    let mesh = surface.envelope().mesh();
    stances_by(surface, triangles, |triangle| [mesh.normal(triangle); 3])
}

/// The same on the model behind the triangles: each corner is touched by its own normal.
pub(super) fn smooth_stances_of(surface: &Surface<'_>, triangles: &[usize]) -> Vec<(usize, [Vector; 3])> {
    let mesh = surface.envelope().mesh();
    stances_by(surface, triangles, |triangle| mesh.corner_normals(triangle))
}

fn stances_by(
    surface: &Surface<'_>,
    triangles: &[usize],
    normals: impl Fn(usize) -> [Vector; 3] + Sync,
) -> Vec<(usize, [Vector; 3])> {
    let (envelope, mesh) = (surface.envelope(), surface.envelope().mesh());
    let stances = triangles.par_iter().filter_map(|triangle| {
        let (corners, normals) = (mesh.corners(*triangle), normals(*triangle));
        // at the origin the tool touches a plane of this normal there
        let touching = |normal: Vector| envelope.touching_point(Vector::zeros(), normal);
        let stands = normals.iter().all(|normal| normal.z > WALL);
        stands.then(|| {
            let first = touching(normals[0]);
            let touching = |normal: Vector| if normal == normals[0] { first } else { touching(normal) };
            (*triangle, std::array::from_fn(|i| corners[i] - touching(normals[i])))
        })
    });
    stances.collect()
}
