//! The convex solid of revolution of which tools are made, each with the sheet that it touches.
//!
//! It is a meridian by slope from the lowest point to a right angle; above that the solid goes straight up. Sheet of constant
//! thickness and margins are balls added to it (Minkowski sum), so a formed sheet needs no algorithm of its own.
//!
//! Planning (drop-cutter, by radius) and verification (support functions, by slope) search the same solid by tables of their
//! own: [`Cutter`](crate::Cutter), and `Body` in the crate `verify`. They share the meridian and no algorithm.

use std::f64::consts::FRAC_PI_2;

use crate::profile::{Profile, Straight};

/// A convex solid of revolution about the tool's axis, open upwards. Its lowest point is the origin, the axis points up.
#[derive(Clone, Debug, PartialEq)]
pub struct ToolBody {
    /// Up to a right angle.
    meridian: Profile,
    straights: Vec<Straight>,
    /// The radius of the ball that it is, if it is one.
    ball: Option<f64>,
    max_radius: f64,
    max_height: f64,
    tip_above: f64,
}

impl ToolBody {
    /// `profile` offset outwards by a ball of radius `ball`, mm, not negative. The tool's tip is its lowest point.
    #[must_use]
    pub fn new(profile: &Profile, ball: f64) -> Self {
        let meridian = profile.grown(ball);
        let (max_radius, max_height) = meridian.point_at(FRAC_PI_2);
        Self {
            straights: meridian.straights().collect(),
            ball: meridian.as_ball(),
            meridian,
            max_radius,
            max_height,
            tip_above: 0.0,
        }
    }

    /// The same offset outwards by a ball of radius `ball`, mm, not negative; the tool's tip stays where it is.
    #[must_use]
    pub fn grown(&self, ball: f64) -> Self {
        Self::new(&self.meridian, ball).with_tip_above(self.tip_above + ball)
    }

    /// The same with the tool's tip `above` mm over its lowest point; negative for what stands above the tip.
    #[must_use]
    pub fn with_tip_above(self, above: f64) -> Self {
        Self { tip_above: above, ..self }
    }

    /// Its meridian from the lowest point to a right angle.
    #[must_use]
    pub(crate) fn meridian(&self) -> &Profile {
        &self.meridian
    }

    /// Height of the tool's tip over the lowest point, mm; negative for what stands above the tip.
    #[must_use]
    pub fn tip_above(&self) -> f64 {
        self.tip_above
    }

    /// Radius and height at a slope from 0 to a right angle, mm; the outer end of a straight part.
    ///
    /// Where the profile ends below a right angle, its rim serves all steeper slopes.
    #[inline]
    #[must_use]
    pub fn point_at(&self, slope: f64) -> (f64, f64) {
        self.meridian.point_at(slope)
    }

    /// Radius of curvature of the meridian, mm.
    #[inline]
    #[must_use]
    pub fn curvature_radius_at(&self, slope: f64) -> f64 {
        self.meridian.curvature_radius_at(slope)
    }

    /// The straight parts: flats, cones, in the order of their slopes.
    #[inline]
    #[must_use]
    pub fn straights(&self) -> &[Straight] {
        &self.straights
    }

    /// The radius of the ball that it ends in, mm, if it ends in one.
    #[inline]
    #[must_use]
    pub fn as_ball(&self) -> Option<f64> {
        self.ball
    }

    /// Radius of the cylinder above the meridian, mm.
    #[inline]
    #[must_use]
    pub fn max_radius(&self) -> f64 {
        self.max_radius
    }

    /// Height at which the cylinder begins, mm.
    #[inline]
    #[must_use]
    pub fn max_height(&self) -> f64 {
        self.max_height
    }

    /// How far a point lies outside the supporting plane of `slope`, mm: a lower bound of its distance.
    #[must_use]
    pub fn gap(&self, radius: f64, height: f64, slope: f64) -> f64 {
        let (sin, cos) = libm::sincos(slope);
        let (r, z) = self.point_at(slope);
        (radius - r) * sin - (height - z) * cos
    }
}
