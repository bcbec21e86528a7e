//! The curvature of the model in a triangle, from how its normals turn along the triangle's edges.

use crate::Vector;
use nalgebra::{Matrix3, Vector3};

/// Determinant below which three edges do not determine a curvature: their squared directions are too much alike.
const SOUND: f64 = 1e-6;
/// Length of a horizontal part of a normal from which the wall has an uphill direction.
const LEVEL: f64 = 1e-9;

/// Curvature of a surface in the axes of its wall, 1/mm; positive where it is convex.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bend {
    /// Up the wall.
    pub up: f64,
    /// How much the directions up and level turn into each other.
    pub twist: f64,
    /// Along the level line.
    pub level: f64,
}

impl Bend {
    /// The normal curvature in a direction, 1/mm, by cos and sin of its angle from up the wall towards level.
    #[must_use]
    pub fn along(&self, [cos, sin]: [f64; 2]) -> f64 {
        self.up * cos * cos + 2.0 * self.twist * cos * sin + self.level * sin * sin
    }

    /// The smaller principal curvature, 1/mm, and cos and sin of its direction from up the wall towards level; up where all
    /// directions curve alike.
    #[must_use]
    pub fn most_hollow(&self) -> (f64, [f64; 2]) {
        let smaller = 0.5 * (self.up + self.level) - libm::hypot(0.5 * (self.up - self.level), self.twist);
        let (sin, cos) = libm::sincos(0.5 * libm::atan2(-2.0 * self.twist, self.level - self.up));
        (smaller, [cos, sin])
    }
}

/// Up the wall and along the level line: unit vectors in a surface with this normal.
#[must_use]
pub fn wall_axes(normal: Vector) -> [Vector; 2] {
    let level = Vector::new(-normal.y, normal.x, 0.0);
    let size = level.norm();
    let level = if size > LEVEL { level / size } else { Vector::x() };
    [level.cross(&normal), level]
}

/// The curvature that makes the model's normals turn as they do; none where the triangle is too slender to know.
#[must_use]
pub fn bend(corners: &[Vector; 3], normals: &[Vector; 3], middle: Vector) -> Bend {
    let [up, level] = wall_axes(middle);
    let (mut rows, mut turns) = (Matrix3::zeros(), Vector3::zeros());
    for side in 0..3 {
        let next = (side + 1) % 3;
        let (edge, turn) = (corners[next] - corners[side], normals[next] - normals[side]);
        let (u, v, length) = (edge.dot(&up), edge.dot(&level), edge.norm_squared().max(1e-18));
        rows.set_row(side, &(Vector3::new(u * u, 2.0 * u * v, v * v) / length).transpose());
        turns[side] = edge.dot(&turn) / length;
    }
    if rows.determinant().abs() <= SOUND {
        return Bend::default();
    }
    let found = rows.lu().solve(&turns).unwrap_or_default();
    Bend { up: found.x, twist: found.y, level: found.z }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle on a cylinder of radius 5 around the X axis, seen from inside: its normals point to the axis.
    fn hollow(angles: [f64; 3], along: [f64; 3]) -> ([Vector; 3], [Vector; 3]) {
        let normals = angles.map(|a| Vector::new(0.0, -a.sin(), a.cos()));
        let corners = std::array::from_fn(|i| Vector::new(along[i], 0.0, 5.0) - 5.0 * normals[i]);
        (corners, normals)
    }

    #[test]
    fn a_hollow_cylinder_curves_by_its_radius_up_the_wall_alone() {
        let (corners, normals) = hollow([0.299, 0.301, 0.3], [0.0, 0.003, 0.01]);
        let middle = normals.iter().sum::<Vector>().normalize();
        let found = bend(&corners, &normals, middle);
        assert!((found.up + 0.2).abs() < 1e-6 && found.twist.abs() < 1e-6 && found.level.abs() < 1e-6, "{found:?}");
    }

    #[test]
    fn the_most_hollow_direction_is_that_of_the_smaller_eigenvalue() {
        let turned = |angle: f64, k: [f64; 2]| {
            let (s, c) = angle.sin_cos();
            Bend { up: k[0] * c * c + k[1] * s * s, twist: (k[0] - k[1]) * s * c, level: k[0] * s * s + k[1] * c * c }
        };
        for angle in [-1.2, -0.3, 0.0, 0.7, 1.5] {
            let (bend, [cos, sin]) = turned(angle, [-0.3, 0.1]).most_hollow();
            assert!((bend + 0.3).abs() < 1e-15, "{bend}");
            assert!((cos * angle.cos() + sin * angle.sin()).abs() > 1.0 - 1e-15, "{angle}: {cos} {sin}");
        }
        assert_eq!(Bend { up: -0.2, twist: 0.0, level: -0.2 }.most_hollow(), (-0.2, [1.0, 0.0]));
    }
}
