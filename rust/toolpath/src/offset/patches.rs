//! Smooth patches: what of the part hangs together without a crease.

use styluscam_geometry::Mesh;

use super::Envelope;

/// Cosine of the angle from which facets that share an edge make a crease (20 deg): meshers turn by less from facet
/// to facet of a curved surface.
pub const FACET_CREASE: f64 = 0.939_692_620_785_908_4;
/// The same of the model's own normals (2 deg): wider than what files round, narrower than an edge that is meant.
const MODEL_CREASE: f64 = 0.999_390_827_019_095_7;

/// The patch of each triangle.
///
/// Two triangles that share an edge are in one patch if both are of the same face, or if their normals agree along the
/// edge: the model's normals where the mesh knows them, else the facets'. Where all triangles have one face, faces are
/// not known, and normals alone decide.
pub struct Patches {
    of_triangles: Vec<u32>,
}

impl Patches {
    pub fn of(envelope: &Envelope<'_>) -> Self {
        let mesh = envelope.mesh();
        let knows_faces = mesh.faces().iter().any(|face| Some(face) != mesh.faces().first());
        let mut above: Vec<u32> = (0..mesh.triangles().len() as u32).collect();
        for t in 0..mesh.triangles().len() as u32 {
            for (side, other) in envelope.neighbours(t).into_iter().enumerate() {
                // where the mesh ends there is no triangle of that number
                if other > t
                    && mesh.triangles().len() > other as usize
                    && ((knows_faces && mesh.faces()[t as usize] == mesh.faces()[other as usize])
                        || is_smooth(mesh, t as usize, other as usize, side))
                {
                    let (a, b) = (root(&mut above, t), root(&mut above, other));
                    above[a.max(b) as usize] = a.min(b);
                }
            }
        }
        Self { of_triangles: (0..above.len() as u32).map(|t| root(&mut above, t)).collect() }
    }

    /// The patch of a triangle: the number of its first triangle.
    pub fn of_triangle(&self, triangle: u32) -> u32 {
        self.of_triangles[triangle as usize]
    }
}

/// Whether the normals of two triangles agree at both ends of the side that they share.
fn is_smooth(mesh: &Mesh, t: usize, other: usize, side: usize) -> bool {
    if !mesh.has_corner_normals() {
        return mesh.normal(t).dot(&mesh.normal(other)) >= FACET_CREASE;
    }
    let (names, normals) = (mesh.triangles()[t], mesh.corner_normals(t));
    let (others, beyond) = (mesh.triangles()[other], mesh.corner_normals(other));
    [side, (side + 1) % 3].into_iter().all(|i| {
        let k = others.iter().position(|name| *name == names[i]);
        k.is_some_and(|k| normals[i].dot(&beyond[k]) >= MODEL_CREASE)
    })
}

/// The first of a triangle's patch; paths are halved during the search (Tarjan and van Leeuwen).
fn root(above: &mut [u32], triangle: u32) -> u32 {
    let mut t = triangle;
    while above[t as usize] != t {
        above[t as usize] = above[above[t as usize] as usize];
        t = above[t as usize];
    }
    t
}
