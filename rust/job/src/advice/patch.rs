//! A triangle with what advice asks of it.

use styluscam_geometry::{bend, Bend, Mesh, Vector};

/// A triangle of a selected face, in work coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Patch {
    /// Corners, mm.
    pub corners: [Vector; 3],
    /// Unit normals of the model there.
    pub normals: [Vector; 3],
    /// Their mean, of length 1.
    pub middle: Vector,
    /// mm^2.
    pub area: f64,
    /// How the model curves.
    pub bend: Bend,
    /// Number of the face.
    pub face: u32,
}

impl Patch {
    /// Of a triangle that faces up; none of another.
    pub fn facing_up(mesh: &Mesh, triangle: usize) -> Option<Self> {
        let (corners, normals) = (mesh.corners(triangle), mesh.corner_normals(triangle));
        let middle = unit(normals.iter().sum::<Vector>() / 3.0);
        (middle.z > 0.0).then(|| Self {
            corners,
            normals,
            middle,
            area: mesh.area(triangle),
            bend: bend(&corners, &normals, middle),
            face: mesh.faces()[triangle],
        })
    }
}

/// A vector of length 1, or one too short to be made so.
pub fn unit(vector: Vector) -> Vector {
    vector / vector.norm().max(1e-12)
}
