//! Parabola and ellipse: closed forms throughout.

use super::Meridian;

/// z = r^2 / 2 R0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parabola {
    apex_radius: f64,
}

impl Parabola {
    /// A parabola whose radius of curvature at the tip is `apex_radius` (R0), mm.
    #[must_use]
    pub fn new(apex_radius: f64) -> Self {
        Self { apex_radius }
    }
}

impl Meridian for Parabola {
    fn point_at(&self, slope: f64) -> (f64, f64) {
        let tan = libm::tan(slope);
        (self.apex_radius * tan, 0.5 * self.apex_radius * tan * tan)
    }

    fn curvature_radius_at(&self, slope: f64) -> f64 {
        let cos = libm::cos(slope);
        self.apex_radius / (cos * cos * cos)
    }

    fn slope_at_radius(&self, radius: f64, within: [f64; 2]) -> f64 {
        libm::atan(radius / self.apex_radius).clamp(within[0], within[1])
    }

    fn height_at_radius(&self, radius: f64, _within: [f64; 2]) -> f64 {
        0.5 * radius * radius / self.apex_radius
    }
}

/// A quarter of an ellipse, from the tip on its axis to its equator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    radial: f64,
    axial: f64,
}

impl Ellipse {
    /// An ellipse by its semi-axes across and along the tool's axis, mm.
    #[must_use]
    pub fn new(radial: f64, axial: f64) -> Self {
        Self { radial, axial }
    }

    /// sqrt(a^2 sin^2 + b^2 cos^2): the support function about the ellipse's centre, mm.
    fn support(&self, sin: f64, cos: f64) -> f64 {
        let (a, b) = (self.radial * sin, self.axial * cos);
        (a * a + b * b).sqrt()
    }
}

impl Meridian for Ellipse {
    fn point_at(&self, slope: f64) -> (f64, f64) {
        let (sin, cos) = libm::sincos(slope);
        let support = self.support(sin, cos);
        let (a, b) = (self.radial, self.axial);
        (a * a * sin / support, b * (a * sin) * (a * sin) / (support * (support + b * cos)))
    }

    fn curvature_radius_at(&self, slope: f64) -> f64 {
        let (sin, cos) = libm::sincos(slope);
        let support = self.support(sin, cos);
        (self.radial * self.axial / support) * (self.radial * self.axial / support) / support
    }

    fn slope_at_radius(&self, radius: f64, within: [f64; 2]) -> f64 {
        let rest = (self.radial * self.radial - radius * radius).max(0.0).sqrt();
        libm::atan2(self.axial * radius, self.radial * rest).clamp(within[0], within[1])
    }

    fn height_at_radius(&self, radius: f64, _within: [f64; 2]) -> f64 {
        let share = radius / self.radial;
        self.axial * share * share / (1.0 + (1.0 - share * share).max(0.0).sqrt())
    }
}
