//! A file's triangles made a part: corners joined, copies dropped, wound outward, parted into faces.
//!
//! What is done to the triangles is counted, and the reader reports it. Nothing depends on the order in which a file has them,
//! except the order of what is handed back.

mod copies;
mod edges;
mod faces;
mod holes;
mod mending;
mod rings;
mod seams;
mod shapes;
mod triangles;
mod union_find;
mod weld;
mod winding;

use crate::{GeometryError, Vector};
pub use mending::{Filled, Mending};
pub use shapes::Shape;
pub(crate) use weld::exact as weld_exact;

/// Triangles that make a part.
#[derive(Clone, Debug)]
pub struct Soup {
    /// Corner points, mm, in the order of their coordinates.
    pub vertices: Vec<Vector>,
    /// Vertex indices, in the file's order.
    pub triangles: Vec<[u32; 3]>,
    /// What was done.
    pub mending: Mending,
}

impl Soup {
    /// Mends triangles: `points` in mm, and the numbers of each triangle's corners.
    ///
    /// # Errors
    /// Numbers that are not finite, corners out of range, no triangle.
    pub fn new(points: &[Vector], triangles: &[[i64; 3]]) -> Result<Self, GeometryError> {
        if let Some(index) = points.iter().position(|point| !point.iter().all(|x| x.is_finite())) {
            return Err(GeometryError::NotFinite { what: "vertex", index });
        }
        let (vertices, index) = weld::exact(points);
        let triangles = numbered(triangles, &index)?;
        // corners joined to the wrong ones, or cut into the wrong triangles, make neighbours of triangles that are none:
        // better a seam than that
        let mut soup = Self::mended(&vertices, triangles.clone(), Joins::NearAndSeams);
        for (less, done) in [(Joins::Near, soup.mending.cut), (Joins::None, soup.mending.joined)] {
            if done > 0 && soup.mending.unclear.is_some() {
                soup = Self::mended(&vertices, triangles.clone(), less);
            }
        }
        if soup.triangles.is_empty() {
            return Err(GeometryError::EmptyMesh);
        }
        Ok(soup)
    }

    fn mended(vertices: &[Vector], mut triangles: Vec<[u32; 3]>, joins: Joins) -> Self {
        let mut mending = Mending::default();
        drop_collapsed(&mut triangles, &mut mending);
        copies::drop_alike(&mut triangles, &mut mending);
        if joins != Joins::None {
            weld::near(vertices, &mut triangles, &mut mending);
        }
        if mending.joined > 0 {
            drop_collapsed(&mut triangles, &mut mending);
            copies::drop_alike(&mut triangles, &mut mending);
        }
        copies::drop_opposite(vertices, &mut triangles, &mut mending);
        weld::cut_at_flat(vertices, &mut triangles, &mut mending);
        if joins == Joins::NearAndSeams {
            seams::cut(vertices, &mut triangles, &mut mending);
        }
        let (mut patches, edges) = winding::agree(vertices, &mut triangles, &mut mending);
        let edges = holes::fill(vertices, &mut triangles, edges, &mut patches, &mut mending);
        winding::turn_outward(vertices, &mut triangles, &edges, &patches, &mut mending);
        let (vertices, triangles) = weld::used(vertices, triangles);
        Self { vertices, triangles, mending }
    }

    /// A corner of an edge that is not run as often in one direction as in the other; none of what is closed.
    #[must_use]
    pub fn gap(&self) -> Option<[f64; 3]> {
        let edges = edges::Edges::of(&self.triangles);
        let half = edges::gap(&self.triangles, &edges)?;
        self.vertices.get(edges::ends(&self.triangles, half).0 as usize).map(|corner| (*corner).into())
    }

    /// The face of each triangle, from 1, and the shape of each face.
    ///
    /// Faces are numbered from the top down, by the boxes around them: whatever the order of the triangles.
    #[must_use]
    pub fn faces(&self) -> (Vec<u32>, Vec<Shape>) {
        faces::of(&self.vertices, &self.triangles)
    }
}

/// What is joined that does not quite meet.
#[derive(Clone, Copy, PartialEq)]
enum Joins {
    /// Corners within a distance, and sides with the corners of others that lie on them.
    NearAndSeams,
    /// Corners only.
    Near,
    None,
}

/// Triangles by the vertices that their points became.
fn numbered(triangles: &[[i64; 3]], index: &[u32]) -> Result<Vec<[u32; 3]>, GeometryError> {
    let mut found = Vec::with_capacity(triangles.len());
    for (i, triangle) in triangles.iter().enumerate() {
        let mut corners = [0; 3];
        for (corner, vertex) in corners.iter_mut().zip(triangle) {
            let known = usize::try_from(*vertex).ok().and_then(|vertex| index.get(vertex));
            let missing = GeometryError::NoSuchVertex { triangle: i, vertex: *vertex, count: index.len() };
            *corner = *known.ok_or(missing)?;
        }
        found.push(corners);
    }
    Ok(found)
}

fn drop_collapsed(triangles: &mut Vec<[u32; 3]>, mending: &mut Mending) {
    let before = triangles.len();
    triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    mending.degenerate += before - triangles.len();
}

#[cfg(test)]
mod tests;
