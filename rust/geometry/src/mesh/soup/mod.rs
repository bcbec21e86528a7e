//! A file's triangles made a part: corners joined, copies dropped, wound outward, parted into faces.
//!
//! What is done to the triangles is counted: the reader says it. Nothing depends on the order in which a file has them,
//! except the order of what is handed back.

mod copies;
mod edges;
mod faces;
mod seams;
mod shapes;
mod weld;
mod winding;

use serde::Serialize;

use crate::{GeometryError, Vector};
pub use shapes::Shape;

/// What was done to a file's triangles.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Mending {
    /// Corners that were joined though they do not agree to the last bit.
    pub joined: usize,
    /// Within what distance corners are joined, mm.
    pub join_distance: f64,
    /// How far a corner moved at most, mm.
    pub moved: f64,
    /// Triangles without area that were dropped, or removed by cutting their neighbour at their middle corner.
    pub degenerate: usize,
    /// Cuts of triangles at corners of others that lie on their sides.
    pub cut: usize,
    /// Triangles that were there already, wound alike.
    pub duplicate: usize,
    /// Triangles that lay back to back between two bodies, both of each pair dropped.
    pub back_to_back: usize,
    /// Triangles of which a copy wound the other way was dropped: a surface that has two sides in the file.
    pub double_sided: usize,
    /// Triangles turned over since their neighbours wind the other way.
    pub turned: usize,
    /// Triangles of bodies that were inside out as a whole, turned over.
    pub inside_out: usize,
    /// Whether each edge is run as often in one direction as in the other.
    pub closed: bool,
    /// A place where triangles cannot be made to agree, mm.
    pub unclear: Option<[f64; 3]>,
}

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
        winding::turn_outward(vertices, &mut triangles, &mut mending);
        let (vertices, triangles) = weld::used(vertices, triangles);
        Self { vertices, triangles, mending }
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

/// Keeps the triangles whose numbers satisfy; returns how many go.
fn retain(triangles: &mut Vec<[u32; 3]>, stays: impl Fn(usize) -> bool) -> usize {
    let (before, mut t) = (triangles.len(), 0);
    triangles.retain(|_| {
        t += 1;
        stays(t - 1)
    });
    before - triangles.len()
}

/// Twice the area of a triangle along its normal.
fn area_vector(vertices: &[Vector], [a, b, c]: [u32; 3]) -> Vector {
    let [a, b, c] = [a, b, c].map(|i| vertices[i as usize]);
    (b - a).cross(&(c - a))
}

/// Lower and upper corner of the box around some points.
fn bounds(points: impl Iterator<Item = Vector>) -> (Vector, Vector) {
    let infinite = Vector::repeat(f64::INFINITY);
    points.fold((infinite, -infinite), |(low, high), p| (low.inf(&p), high.sup(&p)))
}

/// Sets that grow together.
struct Union(Vec<u32>);

impl Union {
    fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    fn root(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            let above = self.0[self.0[i as usize] as usize];
            self.0[i as usize] = above;
            i = above;
        }
        i
    }

    /// The smaller root stays: who is whose does not depend on the order of joining.
    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}

#[cfg(test)]
mod tests;
