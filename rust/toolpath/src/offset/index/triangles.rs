//! The triangles in the order of the index.

use styluscam_geometry::Vector;

/// Triangles by number in the index's order.
#[derive(Clone, Debug, Default)]
pub struct Triangles {
    /// Indices of the corners in `points`.
    pub corners: Vec<[u32; 3]>,
    /// The corners, in the order in which the triangles first use them.
    pub points: Vec<Vector>,
}

impl Triangles {
    /// The corners of a triangle.
    #[inline]
    pub fn at(&self, triangle: u32) -> [Vector; 3] {
        let [a, b, c] = self.corners[triangle as usize];
        [self.points[a as usize], self.points[b as usize], self.points[c as usize]]
    }
}
