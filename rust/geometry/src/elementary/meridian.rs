//! Points seen in the half-plane through an axis.

use crate::Vector;

/// A point on or about the third axis.
#[derive(Clone, Copy, Debug)]
pub struct Meridian {
    /// Its distance from the axis, mm.
    pub radius: f64,
    /// The unit direction from the axis to it; any across the axis where it lies on it.
    pub radial: Vector,
}

impl Meridian {
    /// From coordinates along the axes.
    pub fn of(away: Vector) -> Self {
        let radius = Self::radius_of(away);
        let on_axis = radius <= 1e-12 * (1.0 + away.z.abs());
        let radial = if on_axis { Vector::x() } else { Vector::new(away.x / radius, away.y / radius, 0.0) };
        Self { radius, radial }
    }

    /// The distance from the axis alone.
    pub fn radius_of(away: Vector) -> f64 {
        (away.x * away.x + away.y * away.y).sqrt()
    }
}
