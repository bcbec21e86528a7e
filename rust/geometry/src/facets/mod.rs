//! Surfaces as triangles that share their corners: what pictures of a sheet, its holders and its die are made of.

mod creased;
mod divided;
mod simplified;

#[cfg(test)]
mod tests;

use std::collections::HashMap;

pub use creased::Creased;

use crate::mesh::weld_exact;
use crate::{Frame, Mesh, Vector};

/// Most by which a shift is longer than the sheet is thick, so that a sharp edge keeps it on both sides.
const MITRE: f64 = 2.0;

/// Triangles, wound counterclockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Facets {
    /// Corners, mm.
    pub points: Vec<Vector>,
    /// Numbers of their corners.
    pub triangles: Vec<[u32; 3]>,
}

impl Facets {
    /// Some triangles of a mesh; corners at one point are one.
    #[must_use]
    pub fn of(mesh: &Mesh, keep: impl Fn(usize) -> bool) -> Self {
        let kept: Vec<usize> = (0..mesh.triangles().len()).filter(|triangle| keep(*triangle)).collect();
        let corners: Vec<Vector> = kept.iter().flat_map(|triangle| mesh.corners(*triangle)).collect();
        let (points, numbers) = weld_exact(&corners);
        Self { points, triangles: numbers.as_chunks::<3>().0.to_vec() }
    }

    /// The sides that one triangle alone has, in its sense.
    #[must_use]
    pub fn borders(&self) -> Vec<[u32; 2]> {
        let sides = || self.triangles.iter().flat_map(|triangle| sides(*triangle));
        let mut times: HashMap<[u32; 2], u32> = HashMap::new();
        sides().for_each(|[a, b]| *times.entry([a.min(b), a.max(b)]).or_default() += 1);
        sides().filter(|[a, b]| times.get(&[*a.min(b), *a.max(b)]) == Some(&1)).collect()
    }

    /// For each point the shift by which both it and the triangles around it move by 1 mm along their normals; as near as one
    /// shift can where more than three planes meet.
    #[must_use]
    pub fn outward(&self) -> Vec<Vector> {
        let mut sums = vec![Vector::zeros(); self.points.len()];
        self.at_corners(|_, point, normal, angle| sums[point as usize] += normal * angle);
        let units: Vec<Vector> = sums.iter().map(|sum| sum.try_normalize(0.0).unwrap_or_default()).collect();
        let mut shares = vec![(0.0, 0.0); self.points.len()];
        self.at_corners(|_, point, normal, angle| {
            let (share, whole) = &mut shares[point as usize];
            *share += angle * normal.dot(&units[point as usize]);
            *whole += angle;
        });
        let longer = |(share, whole): &(f64, f64)| if *share > 0.0 { (whole / share).min(MITRE) } else { 1.0 };
        units.iter().zip(&shares).map(|(unit, shares)| unit * longer(shares)).collect()
    }

    /// The same triangles at points moved, each by its own shift.
    #[must_use]
    pub fn moved(&self, by: impl Fn(usize) -> Vector) -> Self {
        let points = self.points.iter().enumerate().map(|(i, point)| point + by(i)).collect();
        Self { points, triangles: self.triangles.clone() }
    }

    /// The body between this surface and the same one moved to `other`, which lies behind it: both, and walls along the border.
    #[must_use]
    pub fn body_to(&self, other: &Self) -> Self {
        let first = self.points.len() as u32;
        let back = other.triangles.iter().map(|[a, b, c]| [*a + first, *c + first, *b + first]);
        let wall = |[a, b]: [u32; 2]| [[b, a, a + first], [b, a + first, b + first]];
        let walls = self.borders().into_iter().flat_map(wall);
        Self {
            points: self.points.iter().chain(&other.points).copied().collect(),
            triangles: self.triangles.iter().copied().chain(back).chain(walls).collect(),
        }
    }

    /// The same in another frame.
    #[must_use]
    pub fn placed(&self, frame: &Frame) -> Self {
        Self { points: self.points.iter().map(|p| frame.point(*p)).collect(), triangles: self.triangles.clone() }
    }

    /// Lower and upper corner of the box around all points.
    #[must_use]
    pub fn bounds(&self) -> (Vector, Vector) {
        let infinite = Vector::repeat(f64::INFINITY);
        self.points.iter().fold((infinite, -infinite), |(low, high), p| (low.inf(p), high.sup(p)))
    }

    /// Volume of a closed body, mm^3.
    #[must_use]
    pub fn volume(&self) -> f64 {
        let cone = |triangle: &[u32; 3]| {
            let [a, b, c] = self.corners(triangle);
            a.dot(&b.cross(&c)) / 6.0
        };
        self.triangles.iter().map(cone).sum()
    }

    fn corners(&self, triangle: &[u32; 3]) -> [Vector; 3] {
        triangle.map(|corner| self.points[corner as usize])
    }

    /// Twice a triangle's area along its normal.
    fn doubled(&self, triangle: &[u32; 3]) -> Vector {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(&(c - a))
    }

    /// Calls for every corner of every triangle that has an area: with the triangle's number, the point's, the triangle's unit
    /// normal and the angle there, rad.
    fn at_corners(&self, mut call: impl FnMut(usize, u32, Vector, f64)) {
        for (number, triangle) in self.triangles.iter().enumerate() {
            let Some(normal) = self.doubled(triangle).try_normalize(0.0) else { continue };
            for k in 0..3 {
                let [at, next, last] = [k, (k + 1) % 3, (k + 2) % 3].map(|i| self.points[triangle[i] as usize]);
                let (u, v) = (next - at, last - at);
                call(number, triangle[k], normal, libm::atan2(u.cross(&v).norm(), u.dot(&v)));
            }
        }
    }
}

/// A triangle's sides in its sense.
fn sides([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}
