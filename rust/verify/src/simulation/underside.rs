//! A tool's lower surface, as height over its tip by distance from its axis, and lines that it is nowhere below.

use styluscam_geometry::{Cutter, Sheet, Tool};

/// A slope (tangent) at least which the line at the rim gets where the profile ends less steep.
const RIM_RISE: f64 = 10.0;
/// Rises beyond belong to a vertical tangent.
const UPRIGHT: f64 = 1e6;
/// What rounding may add to a distance on the rim, as a share of it.
const ROUNDING: f64 = 1e-12;

/// A line: height and rise at one distance from the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Line {
    /// mm.
    pub height: f64,
    /// dz/dr.
    pub rise: f64,
}

/// The lower surface of a tool.
#[derive(Clone, Debug)]
pub(super) struct Underside {
    cutter: Cutter,
    /// Height of the cutter's tip over the tool's, mm: what is between them is sheet.
    tip: f64,
    radius: f64,
    /// Where the line of the rim touches, and that line there.
    rim: (f64, Line),
}

impl Underside {
    /// Of a tool, or of the sheet's face under it that the sheet names.
    pub fn new(tool: &Tool, sheet: Option<&Sheet>) -> Self {
        Self::raised(tool.cutter_with(sheet, 0.0), -tool.tip_above(sheet, 0.0))
    }

    /// Of a solid whose lowest point is `tip` mm over the tool's tip.
    pub fn raised(cutter: Cutter, tip: f64) -> Self {
        let radius = cutter.max_radius();
        let rise = libm::tan(cutter.slope_at_radius(radius));
        let rim = if (0.0..UPRIGHT).contains(&rise) {
            (radius, Line { height: tip + cutter.height_at_radius(radius), rise: rise.max(RIM_RISE) })
        } else {
            let line = cutter.supporting_line(radius);
            (line.radius, Line { height: tip + line.height, rise: line.rise })
        };
        Self { cutter, tip, radius, rim }
    }

    /// Radius of the tool, mm.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The radius of the ball that it is, mm, if it is one.
    pub fn as_ball(&self) -> Option<f64> {
        self.cutter.as_ball()
    }

    /// Height over the tool's tip, mm; infinite beyond the radius.
    #[inline]
    pub fn height(&self, distance: f64) -> f64 {
        if self.reaches(distance) {
            self.tip + self.cutter.quick_height_at_radius(distance.min(self.radius))
        } else {
            f64::INFINITY
        }
    }

    /// Whether there is a surface at a distance.
    #[inline]
    pub fn reaches(&self, distance: f64) -> bool {
        distance <= self.radius * (1.0 + ROUNDING)
    }

    /// Rise and its rate at a distance up to the radius; no rate beside kinks and where the rise has no bound.
    pub fn rise(&self, distance: f64) -> (f64, Option<f64>) {
        if let Some(ball) = self.cutter.as_ball() {
            let up = (ball * ball - distance * distance).max(0.0).sqrt();
            return (distance / up, Some(ball * ball / (up * up * up)));
        }
        match self.cutter.height_with_derivatives(distance) {
            Some(height) => (height.rise, Some(height.bend)),
            None => (libm::tan(self.cutter.slope_at_radius(distance.min(self.radius))), None),
        }
    }

    /// A distance near which the surface rises so much, mm.
    pub fn distance_of_rise(&self, rise: f64) -> f64 {
        self.cutter.radius_of_rise(rise)
    }

    /// A line that the surface is nowhere below, given at `distance`, touching there or at the rim.
    pub fn line(&self, distance: f64) -> Line {
        if distance < self.radius {
            let quick = self.cutter.height_with_derivatives(distance);
            let exact = || (self.cutter.height_at_radius(distance), self.rise(distance).0);
            let (height, rise) = quick.map_or_else(exact, |quick| (quick.value, quick.rise));
            if (0.0..UPRIGHT).contains(&rise) {
                return Line { height: self.tip + height, rise };
            }
        }
        let (radius, line) = self.rim;
        Line { height: line.height + line.rise * (distance - radius), rise: line.rise }
    }
}
