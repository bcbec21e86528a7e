//! B-spline surfaces, rational or not (Piegl and Tiller, The NURBS Book, A2.2 and A4.3).

use std::convert::Infallible;

use nalgebra::Vector4;
use rayon::prelude::*;

use super::{Foot, FootSearch, SurfacePoint};
use crate::{GeometryError, Vector};

/// Points that a thread is given at a time.
const CHUNK: usize = 256;

/// The highest degree: that of the CAD kernels.
const HIGHEST: usize = 25;

/// Basis functions or their derivatives on one span.
type Basis = [f64; HIGHEST + 1];

/// A B-spline surface. Outside the knots its end polynomials continue.
#[derive(Clone, Debug)]
pub struct NurbsSurface {
    directions: [Direction; 2],
    /// Poles times their weights, and the weights; row by row of u.
    poles: Vec<Vector4<f64>>,
}

/// Knots along u or v.
#[derive(Clone, Debug)]
pub(super) struct Direction {
    degree: usize,
    /// Flat: multiplicities written out; not periodic.
    knots: Vec<f64>,
    /// Where spans that are not empty begin, by index.
    spans: Vec<usize>,
}

impl NurbsSurface {
    /// `degrees` and flat `knots` along u and v; `poles` (mm) with their weights, row by row of u.
    ///
    /// # Errors
    /// Degrees over 25, knots that fall, counts that do not fit, weights that are not positive, numbers that are not finite.
    pub fn new(degrees: [usize; 2], knots: [Vec<f64>; 2], poles: &[[f64; 4]]) -> Result<Self, GeometryError> {
        let [u, v] = knots;
        let directions = [Direction::new(degrees[0], u)?, Direction::new(degrees[1], v)?];
        let expected = directions.iter().map(Direction::poles).product();
        if poles.len() != expected {
            return Err(GeometryError::Length { what: "poles", count: poles.len(), expected });
        }
        let is_sound = |pole: &[f64; 4]| pole.iter().all(|x| x.is_finite()) && pole[3] > 0.0;
        if let Some(index) = poles.iter().position(|pole| !is_sound(pole)) {
            return Err(GeometryError::NotFinite { what: "pole or weight", index });
        }
        let poles = poles.iter().map(|[x, y, z, w]| Vector4::new(x * w, y * w, z * w, *w)).collect();
        Ok(Self { directions, poles })
    }

    /// The surface at many parameters, in parallel.
    #[must_use]
    pub fn points(&self, parameters: &[[f64; 2]]) -> Vec<SurfacePoint> {
        parameters.par_iter().with_min_len(CHUNK).map(|at| self.at(*at)).collect()
    }

    /// The feet of points, sought from parameters near them, in parallel.
    #[must_use]
    pub fn feet(&self, search: &FootSearch, points: &[Vector], near: &[[f64; 2]]) -> Vec<Foot> {
        let at = |parameters: &[[f64; 2]]| Ok::<_, Infallible>(parameters.iter().map(|at| self.at(*at)).collect());
        let of_chunk = |(points, near)| {
            let Ok(feet) = search.feet(at, points, near);
            feet
        };
        points.par_chunks(CHUNK).zip(near.par_chunks(CHUNK)).flat_map_iter(of_chunk).collect()
    }

    /// The surface at parameters u and v.
    #[must_use]
    pub fn at(&self, parameters: [f64; 2]) -> SurfacePoint {
        let [u, v] = &self.directions;
        let [(span_u, basis_u, slope_u), (span_v, basis_v, slope_v)] =
            [(u, parameters[0]), (v, parameters[1])].map(|(direction, at)| direction.basis(at));
        let (mut whole, mut along_u, mut along_v) = (Vector4::zeros(), Vector4::zeros(), Vector4::zeros());
        let columns = v.poles();
        for i in 0..=u.degree {
            let first = (span_u - u.degree + i) * columns + span_v - v.degree;
            let row = &self.poles[first..=first + v.degree];
            let (mut sum, mut slope) = (Vector4::zeros(), Vector4::zeros());
            for (j, pole) in row.iter().enumerate() {
                sum += basis_v[j] * pole;
                slope += slope_v[j] * pole;
            }
            whole += basis_u[i] * sum;
            along_u += slope_u[i] * sum;
            along_v += basis_u[i] * slope;
        }
        let point = whole.xyz() / whole.w;
        SurfacePoint { point, along: [along_u, along_v].map(|rate| (rate.xyz() - rate.w * point) / whole.w) }
    }
}

impl Direction {
    pub fn new(degree: usize, knots: Vec<f64>) -> Result<Self, GeometryError> {
        if !(1..=HIGHEST).contains(&degree) {
            let allowed = "1 to 25";
            return Err(GeometryError::OutOfRange { key: "degree", value: degree as f64, allowed });
        }
        let expected = 2 * (degree + 1);
        if knots.len() < expected {
            return Err(GeometryError::Length { what: "knots", count: knots.len(), expected });
        }
        if let Some(index) = knots.windows(2).position(|pair| !(pair[0] <= pair[1] && pair[1].is_finite())) {
            return Err(GeometryError::NotFinite { what: "rising knot", index });
        }
        let spans: Vec<usize> = (degree..knots.len() - degree - 1).filter(|i| knots[*i] < knots[i + 1]).collect();
        if spans.is_empty() {
            return Err(GeometryError::NotFinite { what: "span of knot", index: degree });
        }
        Ok(Self { degree, knots, spans })
    }

    /// The same knots the other way round.
    pub fn reversed(&self) -> Self {
        let [first, last] = self.domain();
        let knots: Vec<f64> = self.knots.iter().rev().map(|knot| first + last - knot).collect();
        let spans = (self.degree..knots.len() - self.degree - 1).filter(|i| knots[*i] < knots[i + 1]).collect();
        Self { degree: self.degree, knots, spans }
    }

    pub fn degree(&self) -> usize {
        self.degree
    }

    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// First and last parameter.
    pub fn domain(&self) -> [f64; 2] {
        [self.knots[self.degree], self.knots[self.knots.len() - 1 - self.degree]]
    }

    /// Poles along this direction.
    pub fn poles(&self) -> usize {
        self.knots.len() - self.degree - 1
    }

    /// The span of a parameter, its basis functions and their derivatives.
    pub fn basis(&self, at: f64) -> (usize, Basis, Basis) {
        let (degree, knots) = (self.degree, &self.knots);
        let span = self.spans[self.spans.partition_point(|i| knots[*i] <= at).saturating_sub(1)];
        let (mut basis, mut slopes) = ([0.0; HIGHEST + 1], [0.0; HIGHEST + 1]);
        basis[0] = 1.0;
        for k in 1..=degree {
            let mut from_left = 0.0;
            for i in 0..k {
                let (left, right) = (knots[span + 1 + i - k], knots[span + 1 + i]);
                let share = basis[i] / (right - left);
                basis[i] = from_left + (right - at) * share;
                from_left = (at - left) * share;
                if k == degree {
                    slopes[i] -= k as f64 * share;
                    slopes[i + 1] += k as f64 * share;
                }
            }
            basis[k] = from_left;
        }
        (span, basis, slopes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter of a cylinder of radius 2 and height 3, as a rational surface.
    fn quarter() -> NurbsSurface {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let knots = [vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], vec![0.0, 0.0, 3.0, 3.0]];
        let poles = [[2.0, 0.0, 1.0], [2.0, 2.0, half], [0.0, 2.0, 1.0]];
        let poles: Vec<[f64; 4]> = poles.iter().flat_map(|[x, y, w]| [[*x, *y, 0.0, *w], [*x, *y, 3.0, *w]]).collect();
        NurbsSurface::new([2, 1], knots, &poles).unwrap()
    }

    #[test]
    fn a_rational_surface_is_a_cylinder() {
        for i in 0..=20 {
            let found = quarter().at([0.05 * f64::from(i), 1.25]);
            assert!((found.point.xy().norm() - 2.0).abs() < 1e-14 && (found.point.z - 1.25).abs() < 1e-14);
            assert!(found.along[0].dot(&found.point.xy().push(0.0)).abs() < 1e-12, "a tangent of the circle");
            assert!((found.along[1] - Vector::z()).norm() < 1e-14);
        }
    }

    #[test]
    fn what_is_no_surface_is_refused() {
        let knots = || [vec![0.0, 0.0, 1.0, 1.0], vec![0.0, 0.0, 1.0, 1.0]];
        let poles = [[0.0, 0.0, 0.0, 1.0]; 4];
        assert!(NurbsSurface::new([1, 1], knots(), &poles).is_ok());
        assert!(NurbsSurface::new([1, 1], knots(), &poles[..3]).is_err());
        assert!(NurbsSurface::new([1, 26], knots(), &poles).is_err());
        assert!(NurbsSurface::new([1, 1], [vec![0.0, 0.0, 1.0, 0.5], knots()[1].clone()], &poles).is_err());
        assert!(NurbsSurface::new([1, 1], [vec![0.0; 4], knots()[1].clone()], &poles).is_err());
        assert!(NurbsSurface::new([1, 1], knots(), &[[0.0, 0.0, 0.0, 0.0]; 4]).is_err());
    }
}
