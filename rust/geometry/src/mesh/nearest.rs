//! The point of a mesh that is nearest to another point.

use super::{Bvh, Mesh};
use crate::Vector;

impl Bvh {
    /// The point of the indexed mesh that is nearest to `point`, and its triangle; the lower number of equals.
    #[must_use]
    pub fn nearest(&self, mesh: &Mesh, point: Vector) -> (Vector, usize) {
        let mut found = (point, 0);
        let visit = |triangle: u32, best: f64| {
            let on = nearest_on(&mesh.corners(triangle as usize), point);
            let near = -(on - point).norm_squared();
            let wins = near > best || near.to_bits() == best.to_bits() && (triangle as usize) < found.1;
            if wins {
                found = (on, triangle as usize);
            }
            near.max(best)
        };
        self.maximise(f64::NEG_INFINITY, |node| -node.distance_squared(point), visit);
        found
    }
}

/// The point of a triangle that is nearest to `point`.
///
/// Source: C. Ericson, "Real-Time Collision Detection", 2005, section 5.1.5: the region of the triangle's corners, edges or
/// inside in which the point lies determines what is nearest.
pub(crate) fn nearest_on([a, b, c]: &[Vector; 3], point: Vector) -> Vector {
    let (ab, ac) = (b - a, c - a);
    let from = |corner: &Vector| [ab.dot(&(point - corner)), ac.dot(&(point - corner))];
    let [d1, d2] = from(a);
    if d1 <= 0.0 && d2 <= 0.0 {
        return *a;
    }
    let [d3, d4] = from(b);
    if d3 >= 0.0 && d4 <= d3 {
        return *b;
    }
    let [d5, d6] = from(c);
    if d6 >= 0.0 && d5 <= d6 {
        return *c;
    }
    let (of_a, of_b, of_c) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    if of_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    if of_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let (along, back) = (d4 - d3, d5 - d6);
    if of_a <= 0.0 && along >= 0.0 && back >= 0.0 {
        return b + (c - b) * (along / (along + back));
    }
    let whole = of_a + of_b + of_c;
    a + ab * (of_b / whole) + ac * (of_c / whole)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn any_point() -> impl Strategy<Value = Vector> {
        (-9.0..9.0_f64, -9.0..9.0_f64, -9.0..9.0_f64).prop_map(|(x, y, z)| Vector::new(x, y, z))
    }

    proptest! {
        #[test]
        fn no_point_of_any_triangle_is_nearer(
            corners in prop::collection::vec(any_point(), 12),
            point in any_point(),
            shares in (0.0..1.0_f64, 0.0..1.0_f64),
            triangle in 0..4_usize,
        ) {
            let triangles: Vec<[i64; 3]> = (0..4).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
            let Ok(mesh) = Mesh::new(corners, &triangles, &[]) else { return Ok(()) };
            prop_assume!(mesh.triangles().len() == 4);
            let (on, number) = Bvh::new(&mesh).nearest(&mesh, point);
            let [a, b, c] = mesh.corners(triangle);
            let other = a + (b - a) * shares.0 + (c - a) * (1.0 - shares.0) * shares.1;
            prop_assert!((on - point).norm() <= (other - point).norm() + 1e-12);
            let [a, b, c] = mesh.corners(number);
            prop_assert!((on - a).dot(&(b - a).cross(&(c - a)).normalize()).abs() < 1e-9);
        }
    }
}
