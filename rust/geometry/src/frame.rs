//! The turn and shift from the part's file to work coordinates.

use crate::Vector;

/// A rotation followed by a translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    rotation: nalgebra::Matrix3<f64>,
    translation: Vector,
}

impl Frame {
    /// The frame that changes nothing.
    #[must_use]
    pub fn identity() -> Self {
        Self { rotation: nalgebra::Matrix3::identity(), translation: Vector::zeros() }
    }

    /// Turns `up` to +Z by the smallest angle, then turns by `about_z` radians about +Z.
    ///
    /// A quarter turn comes out exact: zeros and ones, no rounding.
    #[must_use]
    pub fn turning_up(up: Vector, about_z: f64) -> Self {
        let shortest = nalgebra::Rotation3::rotation_between(&up, &Vector::z())
            .unwrap_or_else(|| nalgebra::Rotation3::from_axis_angle(&Vector::x_axis(), std::f64::consts::PI));
        let turned = nalgebra::Rotation3::from_axis_angle(&Vector::z_axis(), about_z) * shortest;
        Self { rotation: turned.into_inner().map(snapped), translation: Vector::zeros() }
    }

    /// The same turn with `shift` added after it.
    #[must_use]
    pub fn shifted(self, shift: Vector) -> Self {
        Self { translation: self.translation + shift, ..self }
    }

    /// This frame and then another.
    #[must_use]
    pub fn then(self, next: &Self) -> Self {
        Self { rotation: next.rotation * self.rotation, translation: next.point(self.translation) }
    }

    /// The frame that leads back.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.transpose();
        Self { rotation, translation: -(rotation * self.translation) }
    }

    /// Where a point of the file lies in work coordinates.
    #[must_use]
    pub fn point(&self, p: Vector) -> Vector {
        self.rotation * p + self.translation
    }

    /// Where a direction of the file points in work coordinates.
    #[must_use]
    pub fn direction(&self, n: Vector) -> Vector {
        self.rotation * n
    }

    /// The rotation's rows, then the translation: twelve numbers.
    #[must_use]
    pub fn rows(&self) -> [[f64; 4]; 3] {
        std::array::from_fn(|i| {
            [self.rotation[(i, 0)], self.rotation[(i, 1)], self.rotation[(i, 2)], self.translation[i]]
        })
    }
}

/// Cleans the rounding that trigonometry leaves on quarter turns.
fn snapped(x: f64) -> f64 {
    let nearest = x.round();
    if (x - nearest).abs() < 1e-15 {
        nearest
    } else {
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_axis_turns_up_exactly() {
        for up in [Vector::x(), -Vector::x(), Vector::y(), -Vector::y(), Vector::z(), -Vector::z()] {
            let frame = Frame::turning_up(up, 0.0);
            assert_eq!(frame.direction(up), Vector::z());
            let p = Vector::new(1.0, 2.0, 3.0);
            assert_eq!(frame.rotation.transpose() * (frame.point(p) - frame.translation), p);
        }
    }
}
