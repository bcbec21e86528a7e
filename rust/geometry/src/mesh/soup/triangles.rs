//! Triangles by their corners' indices: area, box, and which of them stay.

use crate::Vector;

/// Keeps the triangles whose indices satisfy `stays`; returns how many it removed.
pub fn retain(triangles: &mut Vec<[u32; 3]>, stays: impl Fn(usize) -> bool) -> usize {
    let (before, mut t) = (triangles.len(), 0);
    triangles.retain(|_| {
        t += 1;
        stays(t - 1)
    });
    before - triangles.len()
}

/// Twice the area of a triangle along its normal.
pub fn area_vector(vertices: &[Vector], [a, b, c]: [u32; 3]) -> Vector {
    let [a, b, c] = [a, b, c].map(|i| vertices[i as usize]);
    (b - a).cross(&(c - a))
}

/// Lower and upper corner of the box around some points.
pub fn bounds(points: impl Iterator<Item = Vector>) -> (Vector, Vector) {
    let infinite = Vector::repeat(f64::INFINITY);
    points.fold((infinite, -infinite), |(low, high), p| (low.inf(&p), high.sup(&p)))
}
