//! A straight move of a body.

use styluscam_geometry::Vector;

/// A straight move of the body's tip.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stroke {
    pub from: Vector,
    pub to: Vector,
}

impl Stroke {
    /// A body that stays where it is.
    pub fn still(at: Vector) -> Self {
        Self { from: at, to: at }
    }

    pub fn at(&self, share: f64) -> Vector {
        self.from + share * (self.to - self.from)
    }

    pub fn length(&self) -> f64 {
        (self.to - self.from).norm()
    }

    /// A share of the stroke at which the body is about nearest to a point.
    pub fn share_near(&self, p: Vector) -> f64 {
        let along = self.to - self.from;
        let plan = along.x * along.x + along.y * along.y;
        if plan > 0.0 {
            ((along.x * (p.x - self.from.x) + along.y * (p.y - self.from.y)) / plan).clamp(0.0, 1.0)
        } else {
            f64::from(u8::from(along.z < 0.0))
        }
    }
}
