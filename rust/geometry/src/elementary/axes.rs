//! Where a surface of a model stands.

use crate::{GeometryError, Vector};

/// An origin and three unit directions square to each other, right-handed or left-handed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    origin: Vector,
    directions: [Vector; 3],
}

impl Axes {
    /// About the direction `axis` through `origin`, with the first axis nearest to `across`, the second one on the side of
    /// `along`. Where these are parallel to `axis`, or none, any directions serve.
    ///
    /// # Errors
    /// `NotFinite`: numbers that are none, or an axis without direction.
    pub fn new(origin: Vector, axis: Vector, across: [Vector; 2]) -> Result<Self, GeometryError> {
        let third = axis.try_normalize(0.0).filter(|axis| axis.iter().all(|x| x.is_finite()));
        let Some(third) = third.filter(|_| origin.iter().all(|x| x.is_finite())) else {
            return Err(GeometryError::NotFinite { what: "axis of a surface", index: 0 });
        };
        let square = |to: Vector| (to - third * to.dot(&third)).try_normalize(1e-9).filter(|to| to.x.is_finite());
        let first = square(across[0]).unwrap_or_else(|| any_across(third));
        let second = third.cross(&first);
        let second = if across[1].dot(&second) < 0.0 { -second } else { second };
        Ok(Self { origin, directions: [first, second, third] })
    }

    /// The coordinates of a point along the axes.
    #[must_use]
    pub fn away(&self, point: Vector) -> Vector {
        let away = point - self.origin;
        Vector::new(away.dot(&self.directions[0]), away.dot(&self.directions[1]), away.dot(&self.directions[2]))
    }

    /// The direction with these coordinates along the axes.
    #[must_use]
    pub fn direction(&self, local: Vector) -> Vector {
        self.directions[0] * local.x + self.directions[1] * local.y + self.directions[2] * local.z
    }

    /// The point with these coordinates along the axes.
    #[must_use]
    pub fn point(&self, local: Vector) -> Vector {
        self.origin + self.direction(local)
    }
}

/// A unit direction square to another one.
fn any_across(axis: Vector) -> Vector {
    let least = if axis.x.abs() <= axis.y.abs() && axis.x.abs() <= axis.z.abs() {
        Vector::x()
    } else if axis.y.abs() <= axis.z.abs() {
        Vector::y()
    } else {
        Vector::z()
    };
    axis.cross(&least).normalize()
}
