//! The smooth curves that profiles are made of.

use super::{Arc, Clothoid, Cycloid, Ellipse, Fitted, Involute, Meridian, Parabola, Power};

/// A smooth curve of one of the known sorts.
#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    /// One point at all slopes: a kink.
    Point,
    /// Part of a circle.
    Arc(Arc),
    /// Curvature grows linearly with arc length.
    Clothoid(Clothoid),
    /// z = r^2 / 2 R0.
    Parabola(Parabola),
    /// A quarter of an ellipse.
    Ellipse(Ellipse),
    /// Half an arch of a cycloid.
    Cycloid(Cycloid),
    /// z = c r^p.
    Power(Power),
    /// The radius of curvature changes evenly with the slope.
    Involute(Involute),
    /// A formula's curve, as polynomials.
    Fitted(std::sync::Arc<Fitted>),
    /// Another curve, offset by a ball.
    Grown(Box<Grown>),
}

impl Curve {
    /// The curve offset outwards by a ball, relative to its point at the slope at which it begins.
    #[must_use]
    pub fn grown(&self, ball: f64, from: f64) -> Self {
        match self {
            _ if ball == 0.0 => self.clone(),
            Self::Point => Self::Arc(Arc::new(ball, from)),
            Self::Arc(arc) => Self::Arc(arc.grown(ball)),
            Self::Involute(curve) => Self::Involute(curve.grown(ball)),
            other => Self::Grown(Box::new(Grown { curve: other.clone(), ball: Arc::new(ball, from) })),
        }
    }
}

impl std::ops::Deref for Curve {
    type Target = dyn Meridian + Send + Sync;

    fn deref(&self) -> &Self::Target {
        match self {
            Self::Point => &Kink,
            Self::Arc(curve) => curve,
            Self::Clothoid(curve) => curve,
            Self::Parabola(curve) => curve,
            Self::Ellipse(curve) => curve,
            Self::Cycloid(curve) => curve,
            Self::Power(curve) => curve,
            Self::Involute(curve) => curve,
            Self::Fitted(curve) => curve.as_ref(),
            Self::Grown(curve) => curve.as_ref(),
        }
    }
}

/// A point that holds an interval of slopes.
struct Kink;

impl Meridian for Kink {
    fn point_at(&self, _slope: f64) -> (f64, f64) {
        (0.0, 0.0)
    }

    fn curvature_radius_at(&self, _slope: f64) -> f64 {
        0.0
    }

    fn slope_at_radius(&self, _radius: f64, within: [f64; 2]) -> f64 {
        within[0]
    }

    fn slope_at_height(&self, _height: f64, within: [f64; 2]) -> f64 {
        within[1]
    }
}

/// A curve and the ball that it is offset by.
#[derive(Clone, Debug, PartialEq)]
pub struct Grown {
    curve: Curve,
    ball: Arc,
}

impl Meridian for Grown {
    fn point_at(&self, slope: f64) -> (f64, f64) {
        let (bare, ball) = (self.curve.point_at(slope), self.ball.point_at(slope));
        (bare.0 + ball.0, bare.1 + ball.1)
    }

    fn curvature_radius_at(&self, slope: f64) -> f64 {
        self.curve.curvature_radius_at(slope) + self.ball.radius()
    }
}
