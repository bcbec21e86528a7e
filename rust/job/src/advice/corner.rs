//! Concave corners of a part, sharp or rounded, and which of them are alike.

use std::collections::BTreeMap;

use styluscam_geometry::Vector;

/// Corners whose sides differ by less are one, degrees.
const ALIKE_DEG: f64 = 2.0;
/// So are radii that differ by less than this share, and this in mm.
const ALIKE_RADIUS: f64 = 0.1;
/// A corner that turns more than this is a slot: its two sides have no common middle, degrees.
const STRAIGHT_DEG: f64 = 170.0;

/// A concave corner: two planes between which the surface turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Unit normals of the planes.
    pub sides: [Vector; 2],
    /// Radius of the fillet between them, mm; 0 where they meet in an edge.
    pub radius: f64,
    /// Length along the corner, mm.
    pub length: f64,
}

impl Corner {
    /// How far the surface turns, degrees.
    #[must_use]
    pub fn turn_deg(&self) -> f64 {
        let [a, b] = self.sides;
        libm::acos(a.dot(&b).clamp(-1.0, 1.0)).to_degrees()
    }

    /// Classes of both slopes, of the turn, and of the radius.
    fn class(&self) -> [i64; 4] {
        let slopes = self.sides.map(|side| libm::acos(side.z.clamp(-1.0, 1.0)).to_degrees());
        let class = |value: f64, width: f64| (value / width).round_ties_even() as i64;
        [
            class(slopes[0].min(slopes[1]), ALIKE_DEG),
            class(slopes[0].max(slopes[1]), ALIKE_DEG),
            class(self.turn_deg(), ALIKE_DEG),
            class(libm::log1p(self.radius), ALIKE_RADIUS),
        ]
    }
}

/// Corners between planes of the same slopes, at the same angle and of the same radius, put together: the first of each class
/// with the length of all. Slots are left out.
pub fn alike(found: &[Corner]) -> Vec<Corner> {
    let mut classes: BTreeMap<[i64; 4], Corner> = BTreeMap::new();
    for corner in found {
        let first = classes.entry(corner.class()).or_insert(Corner { length: 0.0, ..*corner });
        first.length += corner.length;
    }
    classes.into_values().filter(|corner| corner.turn_deg() < STRAIGHT_DEG).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(low_deg: f64, high_deg: f64, radius: f64, length: f64) -> Corner {
        let side = |degrees: f64| Vector::new(-degrees.to_radians().sin(), 0.0, degrees.to_radians().cos());
        Corner { sides: [side(low_deg), side(high_deg)], radius, length }
    }

    #[test]
    fn corners_of_one_class_are_one_whichever_side_comes_first() {
        let found = alike(&[
            corner(0.0, 60.4, 2.0, 3.0),
            corner(60.2, 0.1, 2.05, 4.0),
            corner(0.0, 60.4, 0.0, 5.0),
            corner(-88.0, 88.0, 1.0, 9.0),
        ]);
        let seen: Vec<_> = found.iter().map(|corner| (corner.radius, corner.length)).collect();
        assert_eq!(seen, [(0.0, 5.0), (2.0, 7.0)]);
    }
}
