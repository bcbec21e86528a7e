//! The part as triangles, checked once, with the index that searches it.

mod bvh;
mod nearest;
mod soup;

pub use bvh::{Bvh, Node};
pub(crate) use nearest::nearest_on;
pub(crate) use soup::weld_exact;
pub use soup::{Filled, Mending, Shape, Soup};

use crate::{Frame, GeometryError, Vector};

/// Normals that rise or fall by less than this belong to upright walls: files of single precision, and parts tilted by
/// rounding, lean by as much. Over 100 mm it is 0.01 mm.
const UPRIGHT: f64 = 1e-4;

/// So do those of triangles that lean by less than this over their own height, mm, and rise or fall by less than this:
/// round walls are twisted where the corners of their two ends do not lie above each other.
const TWISTED: f64 = 5e-3;
const MOST_TWISTED: f64 = 1e-3;

/// Largest coordinate accepted, mm: beyond it units are wrong.
const LIMIT: f64 = 1e6;

/// A triangle mesh with a face of the model behind each triangle.
///
/// Triangles are wound so that their normals point out of the material.
#[derive(Clone, Debug)]
pub struct Mesh {
    vertices: Vec<Vector>,
    triangles: Vec<[u32; 3]>,
    faces: Vec<u32>,
    /// By triangle and corner, of length 1; empty where none were given.
    normals: Vec<[Vector; 3]>,
    dropped: usize,
}

impl Mesh {
    /// Checks and takes arrays: `vertices` in mm, `triangles` of vertex indices, `faces` the model's face number of
    /// each triangle (empty: all 1). Triangles without area are dropped and counted.
    ///
    /// # Errors
    /// Numbers that are not finite or absurd, indices out of range, lengths that do not match, nothing left.
    pub fn new(vertices: Vec<Vector>, triangles: &[[i64; 3]], faces: &[u32]) -> Result<Self, GeometryError> {
        Self::with_normals(vertices, triangles, faces, &[])
    }

    /// As [`new`](Self::new), with the model's `normals` at the corners of each triangle (empty: none are known). Those
    /// without length, as at a pole, become the facet's.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_normals(
        vertices: Vec<Vector>,
        triangles: &[[i64; 3]],
        faces: &[u32],
        normals: &[[Vector; 3]],
    ) -> Result<Self, GeometryError> {
        check_vertices(&vertices)?;
        for (what, count) in [("face ids", faces.len()), ("corner normals", normals.len())] {
            if count != 0 && count != triangles.len() {
                return Err(GeometryError::Length { what, count, expected: triangles.len() });
            }
        }
        if let Some(index) = normals.iter().position(|corners| !corners.iter().flatten().all(|x| x.is_finite())) {
            return Err(GeometryError::NotFinite { what: "normal of triangle", index });
        }
        let mut mesh = Self {
            vertices,
            triangles: Vec::with_capacity(triangles.len()),
            faces: Vec::with_capacity(triangles.len()),
            normals: Vec::with_capacity(normals.len()),
            dropped: 0,
        };
        for (i, triangle) in triangles.iter().enumerate() {
            let corners = mesh.checked_indices(i, *triangle)?;
            let area = mesh.area_vector(corners);
            if area.norm() > 0.0 {
                mesh.triangles.push(corners);
                mesh.faces.push(faces.get(i).copied().unwrap_or(1));
                let unit = |n: Vector| if is_unit(n) { Some(n) } else { n.try_normalize(0.0) };
                let given = normals.get(i).map(|given| given.map(|n| unit(n).unwrap_or(area.normalize())));
                mesh.normals.extend(given);
            } else {
                mesh.dropped += 1;
            }
        }
        if mesh.triangles.is_empty() {
            return Err(GeometryError::EmptyMesh);
        }
        Ok(mesh)
    }

    fn checked_indices(&self, i: usize, triangle: [i64; 3]) -> Result<[u32; 3], GeometryError> {
        let count = self.vertices.len();
        let mut corners = [0; 3];
        for (corner, vertex) in corners.iter_mut().zip(triangle) {
            *corner = u32::try_from(vertex)
                .ok()
                .filter(|v| (*v as usize) < count)
                .ok_or(GeometryError::NoSuchVertex { triangle: i, vertex, count })?;
        }
        Ok(corners)
    }

    fn area_vector(&self, [a, b, c]: [u32; 3]) -> Vector {
        let [a, b, c] = [a, b, c].map(|i| self.vertices[i as usize]);
        (b - a).cross(&(c - a))
    }

    /// Corner points.
    #[must_use]
    pub fn vertices(&self) -> &[Vector] {
        &self.vertices
    }

    /// Vertex indices of each triangle.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The model's face behind each triangle.
    #[must_use]
    pub fn faces(&self) -> &[u32] {
        &self.faces
    }

    /// How many triangles without area were left out.
    #[must_use]
    pub fn dropped(&self) -> usize {
        self.dropped
    }

    /// The corners of a triangle.
    #[inline]
    #[must_use]
    pub fn corners(&self, triangle: usize) -> [Vector; 3] {
        let [a, b, c] = self.triangles[triangle];
        [self.vertices[a as usize], self.vertices[b as usize], self.vertices[c as usize]]
    }

    /// Unit normal of a triangle, out of the material.
    #[must_use]
    pub fn normal(&self, triangle: usize) -> Vector {
        self.area_vector(self.triangles[triangle]).normalize()
    }

    /// Whether a triangle is a part of an upright wall.
    #[must_use]
    pub fn is_upright(&self, triangle: usize) -> bool {
        let rise = self.rise(triangle).abs();
        rise <= UPRIGHT || rise <= MOST_TWISTED && rise * self.height(triangle) <= TWISTED
    }

    /// Whether a triangle faces down: no tool from above touches its inside.
    #[must_use]
    pub fn looks_down(&self, triangle: usize) -> bool {
        self.rise(triangle) < 0.0 && !self.is_upright(triangle)
    }

    /// From a triangle's lowest corner to its highest, mm.
    fn height(&self, triangle: usize) -> f64 {
        let [a, b, c] = self.corners(triangle).map(|corner| corner.z);
        a.max(b).max(c) - a.min(b).min(c)
    }

    /// The Z of a triangle's normal, by the model's where those are known: triangles of an upright wall lean by their deviation.
    fn rise(&self, triangle: usize) -> f64 {
        self.corner_normals(triangle).iter().map(|normal| normal.z).sum::<f64>() / 3.0
    }

    /// Whether the model's normals at the corners are known.
    #[must_use]
    pub fn has_corner_normals(&self) -> bool {
        !self.normals.is_empty()
    }

    /// Unit normals at the corners of a triangle: the model's where they are known, else the facet's.
    #[must_use]
    pub fn corner_normals(&self, triangle: usize) -> [Vector; 3] {
        self.normals.get(triangle).copied().unwrap_or_else(|| [self.normal(triangle); 3])
    }

    /// Unit normal of a triangle: the mean of the model's at its corners where those are known, else the facet's, which leans by
    /// the triangle's deviation.
    #[must_use]
    pub fn model_normal(&self, triangle: usize) -> Vector {
        if self.normals.is_empty() {
            return self.normal(triangle);
        }
        self.corner_normals(triangle)
            .iter()
            .sum::<Vector>()
            .try_normalize(f64::EPSILON)
            .unwrap_or_else(|| self.normal(triangle))
    }

    /// Area of a triangle, mm^2.
    #[must_use]
    pub fn area(&self, triangle: usize) -> f64 {
        0.5 * self.area_vector(self.triangles[triangle]).norm()
    }

    /// Lower and upper corner of the box around all triangles.
    #[must_use]
    pub fn bounds(&self) -> (Vector, Vector) {
        self.bounds_in(&Frame::identity())
    }

    /// Lower and upper corner of the box around all triangles, in another frame.
    #[must_use]
    pub fn bounds_in(&self, frame: &Frame) -> (Vector, Vector) {
        let infinite = Vector::repeat(f64::INFINITY);
        let used = self.triangles.iter().flatten().map(|i| frame.point(self.vertices[*i as usize]));
        used.fold((infinite, -infinite), |(low, high), p| (low.inf(&p), high.sup(&p)))
    }

    /// Some of its triangles alone.
    ///
    /// # Errors
    /// [`GeometryError::EmptyMesh`] where none is kept.
    pub fn part_of(&self, keep: impl Fn(usize) -> bool) -> Result<Self, GeometryError> {
        let kept: Vec<usize> = (0..self.triangles.len()).filter(|triangle| keep(*triangle)).collect();
        if kept.is_empty() {
            return Err(GeometryError::EmptyMesh);
        }
        Ok(Self {
            vertices: self.vertices.clone(),
            triangles: kept.iter().map(|t| self.triangles[*t]).collect(),
            faces: kept.iter().map(|t| self.faces[*t]).collect(),
            normals: kept.iter().filter_map(|t| self.normals.get(*t).copied()).collect(),
            dropped: self.dropped,
        })
    }

    /// The other side of some of its triangles: what faces up there faces down here.
    ///
    /// # Errors
    /// [`GeometryError::EmptyMesh`] where none is kept.
    pub fn other_side(&self, keep: impl Fn(usize) -> bool) -> Result<Self, GeometryError> {
        let kept: Vec<usize> = (0..self.triangles.len()).filter(|triangle| keep(*triangle)).collect();
        let triangles = kept.iter().map(|t| {
            let [a, b, c] = self.triangles[*t];
            [a, c, b]
        });
        let normals = kept.iter().filter_map(|t| {
            let [a, b, c] = *self.normals.get(*t)?;
            Some([-a, -c, -b])
        });
        let (triangles, normals): (Vec<_>, Vec<_>) = (triangles.collect(), normals.collect());
        if triangles.is_empty() {
            return Err(GeometryError::EmptyMesh);
        }
        Ok(Self {
            vertices: self.vertices.clone(),
            faces: kept.iter().map(|t| self.faces[*t]).collect(),
            triangles,
            normals,
            dropped: self.dropped,
        })
    }

    /// The same mesh in another frame.
    #[must_use]
    pub fn placed(&self, frame: &Frame) -> Self {
        Self {
            vertices: self.vertices.iter().map(|p| frame.point(*p)).collect(),
            normals: self.normals.iter().map(|corners| corners.map(|n| frame.direction(n))).collect(),
            triangles: self.triangles.clone(),
            faces: self.faces.clone(),
            dropped: self.dropped,
        }
    }
}

/// Whether a vector was made of length 1 before: so it stays, to the last bit, in a part that is taken apart and put together.
fn is_unit(vector: Vector) -> bool {
    (vector.norm_squared() - 1.0).abs() <= 8.0 * f64::EPSILON
}

fn check_vertices(vertices: &[Vector]) -> Result<(), GeometryError> {
    for (index, vertex) in vertices.iter().enumerate() {
        if !vertex.iter().all(|x| x.is_finite()) {
            return Err(GeometryError::NotFinite { what: "vertex", index });
        }
        let reach = vertex.amax();
        if reach > LIMIT {
            return Err(GeometryError::Huge { reach, limit: LIMIT });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_models_normals_decide_whether_a_leaning_triangle_faces_down() {
        let vertices = vec![Vector::new(0.0, 0.0, 0.0), Vector::new(0.0, 1.0, 0.0), Vector::new(0.01, 0.0, 2.0)];
        let alone = Mesh::new(vertices.clone(), &[[0, 1, 2]], &[]).unwrap();
        assert!(alone.normal(0).x > 0.99 && alone.looks_down(0));
        let upright = Mesh::with_normals(vertices, &[[0, 1, 2]], &[], &[[Vector::x(); 3]]).unwrap();
        assert!(!upright.looks_down(0) && upright.is_upright(0) && !alone.is_upright(0));
    }

    #[test]
    fn triangles_that_are_twisted_by_less_than_a_hair_are_upright() {
        let leaning = |aside: f64, height: f64| {
            let vertices = vec![Vector::zeros(), Vector::new(0.0, 1.0, 0.0), Vector::new(aside, 0.0, height)];
            Mesh::new(vertices, &[[0, 1, 2]], &[]).unwrap()
        };
        assert!(leaning(0.004, 15.0).is_upright(0) && !leaning(0.004, 15.0).looks_down(0));
        assert!(leaning(0.006, 15.0).looks_down(0));
        // a small one of an undercut
        assert!(leaning(0.004, 1.0).looks_down(0));
    }
}
