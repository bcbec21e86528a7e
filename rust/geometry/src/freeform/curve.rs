//! B-spline curves, rational or not, with two derivatives (Piegl and Tiller, The NURBS Book, A3.1, A4.2 and equation 3.8).

use nalgebra::Vector4;

use super::nurbs::Direction;
use crate::{Frame, GeometryError, Vector};

/// A point of a curve and its derivatives, mm, mm per unit of the parameter and mm per its square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// Where.
    pub point: Vector,
    /// First derivative.
    pub first: Vector,
    /// Second derivative.
    pub second: Vector,
}

/// A B-spline curve. Outside the knots its end polynomials continue.
#[derive(Clone, Debug)]
pub struct NurbsCurve {
    curve: Spline,
    /// Its derivative in homogeneous coordinates; none of polylines, whose pieces have none.
    rate: Option<Spline>,
}

/// A spline in homogeneous coordinates.
#[derive(Clone, Debug)]
struct Spline {
    direction: Direction,
    /// Poles times their weights, and the weights.
    poles: Vec<Vector4<f64>>,
}

impl NurbsCurve {
    /// `degree`, flat `knots`, and `poles` (mm) with their weights.
    ///
    /// # Errors
    /// Degrees over 25, knots that fall, counts that do not fit, weights that are not positive, numbers that are not finite.
    pub fn new(degree: usize, knots: Vec<f64>, poles: &[[f64; 4]]) -> Result<Self, GeometryError> {
        let direction = Direction::new(degree, knots)?;
        if poles.len() != direction.poles() {
            return Err(GeometryError::Length { what: "poles", count: poles.len(), expected: direction.poles() });
        }
        let is_sound = |pole: &[f64; 4]| pole.iter().all(|x| x.is_finite()) && pole[3] > 0.0;
        if let Some(index) = poles.iter().position(|pole| !is_sound(pole)) {
            return Err(GeometryError::NotFinite { what: "pole or weight", index });
        }
        let poles = poles.iter().map(|[x, y, z, w]| Vector4::new(x * w, y * w, z * w, *w)).collect();
        let curve = Spline { direction, poles };
        let rate = if degree > 1 { Some(curve.derivative()?) } else { None };
        Ok(Self { curve, rate })
    }

    /// The same curve where a frame puts it.
    #[must_use]
    pub fn placed(&self, frame: &Frame) -> Self {
        let shift = frame.point(Vector::zeros());
        let moved = |pole: &Vector4<f64>| (frame.direction(pole.xyz()) + shift * pole.w).push(pole.w);
        Self { curve: self.curve.with(moved), rate: self.rate.as_ref().map(|rate| rate.with(moved)) }
    }

    /// The same curve the other way round.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let backwards = |rate: &Spline| rate.reversed().with(|pole| -pole);
        Self { curve: self.curve.reversed(), rate: self.rate.as_ref().map(backwards) }
    }

    /// First and last parameter.
    #[must_use]
    pub fn domain(&self) -> [f64; 2] {
        self.curve.direction.domain()
    }

    /// The curve at a parameter.
    #[must_use]
    pub fn at(&self, parameter: f64) -> CurvePoint {
        let (whole, first) = self.curve.at(parameter);
        let second = self.rate.as_ref().map_or_else(Vector4::zeros, |rate| rate.at(parameter).1);
        let point = whole.xyz() / whole.w;
        let along = (first.xyz() - first.w * point) / whole.w;
        let bent = (second.xyz() - 2.0 * first.w * along - second.w * point) / whole.w;
        CurvePoint { point, first: along, second: bent }
    }
}

impl Spline {
    /// Its value and derivative.
    fn at(&self, parameter: f64) -> (Vector4<f64>, Vector4<f64>) {
        let (span, basis, slopes) = self.direction.basis(parameter);
        let first = span - self.direction.degree();
        let poles = self.poles[first..=span].iter().zip(basis.iter().zip(&slopes));
        poles.fold((Vector4::zeros(), Vector4::zeros()), |(value, rate), (pole, (basis, slope))| {
            (value + *basis * pole, rate + *slope * pole)
        })
    }

    fn with(&self, pole: impl Fn(&Vector4<f64>) -> Vector4<f64>) -> Self {
        Self { direction: self.direction.clone(), poles: self.poles.iter().map(pole).collect() }
    }

    fn reversed(&self) -> Self {
        Self { direction: self.direction.reversed(), poles: self.poles.iter().rev().copied().collect() }
    }

    fn derivative(&self) -> Result<Self, GeometryError> {
        let (degree, knots) = (self.direction.degree(), self.direction.knots());
        let pole = |i: usize| {
            let span = knots[i + degree + 1] - knots[i + 1];
            // poles of a span that is empty count nowhere
            if span > 0.0 {
                (self.poles[i + 1] - self.poles[i]) * (degree as f64 / span)
            } else {
                Vector4::zeros()
            }
        };
        let poles = (0..self.poles.len() - 1).map(pole).collect();
        let direction = Direction::new(degree - 1, knots[1..knots.len() - 1].to_vec())?;
        Ok(Self { direction, poles })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_is_placed_and_reversed_with_its_derivatives() {
        let poles = [[0.0, 0.0, 0.0, 1.0], [10.0, 5.0, 2.0, 0.5], [20.0, 0.0, 4.0, 2.0], [30.0, 1.0, 0.0, 1.0]];
        let curve = NurbsCurve::new(2, vec![0.0, 0.0, 0.0, 0.3, 1.0, 1.0, 1.0], &poles).unwrap();
        let frame = Frame::turning_up(Vector::new(0.6, 0.0, 0.8), 1.0).shifted(Vector::new(1.0, 2.0, 3.0));
        let (placed, reversed) = (curve.placed(&frame), curve.reversed());
        for u in [0.0, 0.2, 0.3, 0.77, 1.0] {
            let (from, to, back) = (curve.at(u), placed.at(u), reversed.at(1.0 - u));
            assert!((frame.point(from.point) - to.point).norm() < 1e-12 && (from.point - back.point).norm() < 1e-12);
            assert!(
                (frame.direction(from.first) - to.first).norm() < 1e-11 && (from.first + back.first).norm() < 1e-11
            );
            // at the inner knot the second derivative jumps
            let is_smooth = (u - 0.3).abs() > 0.01;
            let bent = (frame.direction(from.second) - to.second).norm() + (from.second - back.second).norm();
            assert!(!is_smooth || bent < 1e-9, "{u} {bent}");
        }
    }

    #[test]
    fn a_rational_quarter_of_a_circle_has_its_derivatives() {
        let w = 0.5_f64.sqrt();
        let poles = [[5.0, 0.0, 1.0, 1.0], [5.0, 5.0, 1.0, w], [0.0, 5.0, 1.0, 1.0]];
        let curve = NurbsCurve::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], &poles).unwrap();
        assert_eq!(curve.domain().map(f64::to_bits), [0.0_f64, 1.0].map(f64::to_bits));
        for u in [0.0, 0.3, 0.71, 1.0] {
            let CurvePoint { point, first, second } = curve.at(u);
            assert!((point.xy().norm() - 5.0).abs() < 1e-12 && (point.z - 1.0).abs() < 1e-12);
            // on a circle p . p' = 0 and p . p'' = -p' . p'
            assert!(point.xy().dot(&first.xy()).abs() < 1e-11);
            assert!((point.xy().dot(&second.xy()) + first.norm_squared()).abs() < 1e-9);
        }
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let knots = vec![0.0, 0.0, 0.0, 0.0, 0.4, 0.4, 1.0, 1.0, 1.0, 1.0];
        let poles: Vec<[f64; 4]> = (0..6)
            .map(f64::from)
            .map(|i| [10.0 * i, (7.0 * i) % 5.0, (3.0 * i) % 4.0, 1.0 + 0.2 * ((2.0 * i) % 3.0)])
            .collect();
        let curve = NurbsCurve::new(3, knots, &poles).unwrap();
        for u in [0.1, 0.39, 0.41, 0.8] {
            let h = 1e-5;
            let (a, b) = (curve.at(u - h), curve.at(u + h));
            let here = curve.at(u);
            assert!(((b.point - a.point) / (2.0 * h) - here.first).norm() < 1e-5);
            assert!(((b.first - a.first) / (2.0 * h) - here.second).norm() < 1e-3);
        }
    }

    #[test]
    fn a_polyline_has_no_second_derivative() {
        let poles = [[0.0, 0.0, 0.0, 1.0], [3.0, 4.0, 0.0, 1.0]];
        let curve = NurbsCurve::new(1, vec![0.0, 0.0, 2.0, 2.0], &poles).unwrap();
        let CurvePoint { point, first, second } = curve.at(1.0);
        assert!((point - Vector::new(1.5, 2.0, 0.0)).norm() < 1e-14);
        assert!((first - Vector::new(1.5, 2.0, 0.0)).norm() < 1e-14 && second.norm() == 0.0);
    }

    #[test]
    fn what_is_no_curve_is_refused() {
        let ends = [[0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0]];
        assert!(NurbsCurve::new(1, vec![0.0, 0.0, 1.0, 1.0], &ends).is_err());
        assert!(NurbsCurve::new(1, vec![0.0, 0.0, 0.0, 1.0, 1.0], &ends).is_err());
    }
}
