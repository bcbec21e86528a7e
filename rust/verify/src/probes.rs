//! Points spread over chosen triangles, each for the same area.

use styluscam_geometry::{Mesh, Vector};

/// Steps of a sequence that fills the unit square evenly: powers of the plastic number's inverse.
/// Source: M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018.
const STEPS: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];

/// A point of the part.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Probe {
    pub point: Vector,
    /// The triangle that it lies on.
    pub triangle: usize,
}

/// Points of some triangles, in their order: `count` of them.
pub(crate) fn spread(mesh: &Mesh, triangles: &[usize], count: usize) -> Vec<Probe> {
    let each = triangles.iter().map(|t| mesh.area(*t)).sum::<f64>() / count as f64;
    let mut points = Vec::with_capacity(count);
    let mut passed = 0.0;
    for triangle in triangles {
        passed += mesh.area(*triangle);
        while (points.len() as f64 + 0.5) * each < passed {
            let shares = STEPS.map(|step| (0.5 + step * (points.len() + 1) as f64).fract());
            points.push(Probe { point: within(mesh.corners(*triangle), shares), triangle: *triangle });
        }
    }
    points
}

/// The point of a triangle for one of the unit square, whose far half is folded back.
fn within([a, b, c]: [Vector; 3], [s, t]: [f64; 2]) -> Vector {
    let [s, t] = if s + t > 1.0 { [1.0 - s, 1.0 - t] } else { [s, t] };
    a + (b - a) * s + (c - a) * t
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_of_an_area_has_its_share() {
        let corners = [[0.0, 0.0], [10.0, 0.0], [10.0, 4.0], [0.0, 4.0]].map(|[x, y]| Vector::new(x, y, 1.0));
        let mesh = Mesh::new(corners.to_vec(), &[[0, 1, 2], [0, 2, 3]], &[]).unwrap();
        let points = spread(&mesh, &[0, 1], 4000);
        assert_eq!(points.len(), 4000);
        for cell in 0..40 {
            let (x, y) = (f64::from(cell % 10), f64::from(cell / 10));
            let inside = |p: &&Probe| (p.point.x - x - 0.5).abs() < 0.5 && (p.point.y - y - 0.5).abs() < 0.5;
            let count = points.iter().filter(inside).count();
            assert!((85..=115).contains(&count), "{x} {y}: {count}");
        }
        assert_eq!(spread(&mesh, &[1], 7).len(), 7);
    }
}
