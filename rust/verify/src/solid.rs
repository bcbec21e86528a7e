//! The convex solid that is checked: a tool's with its sheet, or that with the stock around it that it is to leave on the part.
//!
//! Stock to leave is a level disc added to the solid (Minkowski sum), and a height by which it is let down: along a normal of slope phi
//! it is thicker by a sin phi + b cos phi.

use styluscam_geometry::{Straight, ToolBody};

/// A solid with the stock to leave around it.
#[derive(Clone, Debug)]
pub(crate) struct Solid {
    body: ToolBody,
    /// Across walls in plan, and in height, mm.
    left: [f64; 2],
    straights: Vec<Straight>,
}

impl Solid {
    pub fn new(body: ToolBody, left: [f64; 2]) -> Self {
        let [by, _] = left;
        let moved = |(radius, height): (f64, f64)| (radius + by, height);
        let own = body.straights().iter().map(|s| Straight { inner: moved(s.inner), outer: moved(s.outer), ..*s });
        let mut straights: Vec<Straight> = own.collect();
        match straights.first_mut().filter(|first| first.slope <= 0.0) {
            Some(flat) => flat.inner = (0.0, 0.0),
            None if by > 0.0 => straights.insert(0, Straight { slope: 0.0, inner: (0.0, 0.0), outer: (by, 0.0) }),
            None => {}
        }
        Self { straights, body, left }
    }

    /// Radius and height at a slope from 0 to a right angle, mm; the outer end of a straight part.
    pub fn point_at(&self, slope: f64) -> (f64, f64) {
        let (radius, height) = self.body.point_at(slope);
        (radius + self.left[0], height)
    }

    pub fn curvature_radius_at(&self, slope: f64) -> f64 {
        self.body.curvature_radius_at(slope)
    }

    pub fn straights(&self) -> &[Straight] {
        &self.straights
    }

    /// The radius of the ball that it ends in, mm, if it ends in one.
    pub fn as_ball(&self) -> Option<f64> {
        self.body.as_ball().filter(|_| self.left[0] <= 0.0)
    }

    pub fn max_radius(&self) -> f64 {
        self.body.max_radius() + self.left[0]
    }

    pub fn max_height(&self) -> f64 {
        self.body.max_height()
    }

    /// Height of the tool's tip over the lowest point, mm.
    pub fn tip_above(&self) -> f64 {
        self.body.tip_above() + self.left[1]
    }

    /// How far a point lies outside the supporting plane of `slope`, mm.
    #[cfg(test)]
    pub fn gap(&self, radius: f64, height: f64, slope: f64) -> f64 {
        let (sin, cos) = libm::sincos(slope);
        let (r, z) = self.point_at(slope);
        (radius - r) * sin - (height - z) * cos
    }
}
