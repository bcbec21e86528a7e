//! The part of a tool that mills with its side: a cylinder, or a cone that widens upwards.

use super::FlankError;

/// A cone is at most this wide: half its angle, rad (80 deg). Wider ones stand on a ruling rather than lie along it.
const WIDEST: f64 = 1.4;

/// A flank. It is the envelope of balls along the axis, each touching it in one circle; their radii grow by the sine of the
/// half angle for every mm of the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flank {
    radius: f64,
    sine: f64,
    cosine: f64,
}

impl Flank {
    /// A flank that touches the first rail where it has this radius, mm, across the axis; it widens from there by the half angle,
    /// rad, 0 for a cylinder.
    ///
    /// # Errors
    /// [`FlankError::Radius`], [`FlankError::Taper`].
    pub fn new(radius: f64, half_angle: f64) -> Result<Self, FlankError> {
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(FlankError::Radius(radius));
        }
        if !(0.0..=WIDEST).contains(&half_angle) {
            return Err(FlankError::Taper(half_angle.to_degrees()));
        }
        let (sine, cosine) = libm::sincos(half_angle);
        Ok(Self { radius: radius / cosine, sine, cosine })
    }

    /// A smaller one of the same taper.
    pub(super) fn of_share(&self, share: f64) -> Self {
        Self { radius: self.radius * share, ..*self }
    }

    /// Radius of the ball that touches where the first rail is touched, mm.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// How much that grows for each mm of the axis.
    #[must_use]
    pub fn growth(&self) -> f64 {
        self.sine
    }

    /// The ball's radius on the way from the first point of an axis of this length, mm, to the second.
    #[must_use]
    pub fn radius_at(&self, length: f64, share: f64) -> f64 {
        self.radius + self.sine * length * share
    }

    /// How much farther balls are apart that touch at two places of a line of the flank, mm per mm.
    pub(super) fn growth_along_line(&self) -> f64 {
        self.sine / self.cosine
    }

    /// Distance of a point from the flank, mm, below 0 inside: `along` the axis from the first ball's centre, and `beside` it.
    #[must_use]
    pub fn distance(&self, along: f64, beside: f64) -> f64 {
        beside * self.cosine - along * self.sine - self.radius
    }

    /// Where a line meets the flank first, in lengths of its way; infinite where it does not. Both its start and its way are
    /// given along the axis from the first ball's centre; of what is beside, the three products.
    pub(super) fn met(&self, [start, way]: [f64; 2], [starts, mixed, ways]: [f64; 3]) -> f64 {
        let taper = self.growth_along_line();
        let (wide, wider) = (self.radius / self.cosine + start * taper, way * taper);
        let (a, b, c) = (ways - wider * wider, mixed - wide * wider, starts - wide * wide);
        let root = b * b - a * c;
        if a > 0.0 && root > 0.0 {
            (-b - root.sqrt()) / a
        } else {
            f64::INFINITY
        }
    }
}
