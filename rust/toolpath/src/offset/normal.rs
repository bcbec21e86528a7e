//! Normals of triangles, of slivers too.

use styluscam_geometry::Vector;

/// Triangles thinner than this share of their length have a normal that plain products would tilt: by rounding / thinness.
const SLIVER: f64 = 1e-3;
/// A triangle is level when it rises by no more than this share of its coordinates.
const LEVEL: f64 = 8.0 * f64::EPSILON;
/// And when its normal rises by more than this: slivers may stand upright.
const NOT_UPRIGHT: f64 = 0.5;
/// Units in the last place that products of rounded differences are wrong by.
const UNITS: f64 = 2.0;

/// Normal of a triangle, as long as twice its area; each coordinate is good to a few units in the last place, if the
/// triangle is a sliver.
///
/// A plane through one corner leaves the others by the tilt times the length: 1e-16 L^2 / h with plain products, which is
/// micrometres for a sliver 10 mm long and 1e-8 mm wide.
pub fn of([a, b, c]: [Vector; 3]) -> Vector {
    let (p, q) = (b - a, c - a);
    let plain = p.cross(&q);
    if plain.norm_squared() > SLIVER * SLIVER * p.norm_squared() * q.norm_squared() {
        return plain;
    }
    Vector::new(
        difference([p.y, q.z], [p.z, q.y]),
        difference([p.z, q.x], [p.x, q.z]),
        difference([p.x, q.y], [p.y, q.x]),
    )
}

/// Unit normal on the triangle's upper side: a tool from above meets the upper side of the point set. NaN where three
/// corners stand in a line.
pub fn upward(corners: [Vector; 3]) -> Vector {
    let normal = of(corners);
    let normal = normal / normal.norm();
    if normal.z < 0.0 {
        -normal
    } else {
        normal
    }
}

/// As [`upward`], of a triangle that is level but for rounding of its corners' coordinates: straight up.
pub fn upward_or_level(corners: [Vector; 3]) -> Vector {
    let normal = upward(corners);
    let [a, b, c] = corners.map(|corner| corner.z);
    let size = corners.iter().fold(0.0_f64, |size, corner| size.max(corner.amax()));
    let is_level = a.max(b).max(c) - a.min(b).min(c) <= LEVEL * size;
    if is_level && normal.z > NOT_UPRIGHT {
        Vector::z()
    } else {
        normal
    }
}

/// What rounding of its corners' differences makes of a triangle's unit normal, at most about.
pub fn rounding([a, b, c]: [Vector; 3]) -> f64 {
    let (p, q) = (b - a, c - a);
    UNITS * f64::EPSILON * p.norm() * q.norm() / of([a, b, c]).norm()
}

/// a b - c d to 1.5 units in the last place (Kahan; Jeannerod, Louvet and Muller 2013).
fn difference([a, b]: [f64; 2], [c, d]: [f64; 2]) -> f64 {
    let product = c * d;
    libm::fma(a, b, -product) + libm::fma(-c, d, product)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sliver_has_the_normal_of_its_corners() {
        // whole numbers: the exact products are known
        let corners = [
            Vector::zeros(),
            Vector::new(94_906_267.0, 94_906_266.0, 1.0),
            Vector::new(94_906_266.0, 94_906_265.0, 1.0),
        ];
        assert_eq!(of(corners), Vector::new(1.0, -1.0, -1.0));
    }
}
