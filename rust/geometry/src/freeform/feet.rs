//! The feet of points on a surface, by Gauss-Newton from parameters near them.

use super::SurfacePoint;
use crate::Vector;

/// Steps of a search at most.
const ROUNDS: usize = 40;
/// Where the derivatives' plane is less of one, as a share of their squares, a step goes along one of them only:
/// [parallel, one of them vanishes].
const FLAT: [f64; 2] = [1e-14, 1e-20];

/// A bound of the parameters that is one point of the surface: there the other parameter has no effect.
#[derive(Clone, Debug)]
pub struct Pole {
    /// Which of the parameters is fixed there.
    pub fixed: usize,
    /// Its value.
    pub value: f64,
    /// A foot stands on the pole within this of the value.
    pub near: f64,
    /// Values of the other parameter, and the unit direction off the pole at each.
    pub ways: Vec<(f64, Vector)>,
}

/// How feet are sought.
#[derive(Clone, Debug)]
pub struct FootSearch {
    /// Parameters stay between these.
    pub limits: [[f64; 2]; 2],
    /// After how much of it the surface is the same again, by parameter; none where it does not close: what leaves the limits
    /// comes in again on the other side.
    pub periods: [Option<f64>; 2],
    /// Poles among the bounds.
    pub poles: Vec<Pole>,
    /// A search ends when a step moves the foot by less, mm: the distance is then off by its square over twice the radius
    /// of curvature.
    pub step: f64,
}

/// The foot of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    /// Its parameters.
    pub parameters: [f64; 2],
    /// The surface just before the last step.
    pub surface: SurfacePoint,
}

impl FootSearch {
    /// The feet of `points`, sought from parameters `near` them; `surface` evaluates many parameters at a time.
    ///
    /// # Errors
    /// Those of `surface`.
    pub fn feet<E>(
        &self,
        surface: impl Fn(&[[f64; 2]]) -> Result<Vec<SurfacePoint>, E>,
        points: &[Vector],
        near: &[[f64; 2]],
    ) -> Result<Vec<Foot>, E> {
        let mut feet: Vec<[f64; 2]> = near.to_vec();
        self.leave_poles(points, &mut feet, &surface)?;
        let mut found: Vec<Foot> = surface(&feet)?.into_iter().zip(&feet).map(Foot::new).collect();
        let mut active: Vec<usize> = (0..points.len()).collect();
        for round in 0..ROUNDS {
            if round > 0 {
                let mut moved: Vec<[f64; 2]> = active.iter().map(|i| found[*i].parameters).collect();
                let targets: Vec<Vector> = active.iter().map(|i| points[*i]).collect();
                self.leave_poles(&targets, &mut moved, &surface)?;
                for ((i, at), parameters) in active.iter().zip(surface(&moved)?).zip(&moved) {
                    found[*i] = Foot::new((at, parameters));
                }
            }
            active.retain(|i| self.advance(&points[*i], &mut found[*i]) > self.step);
            if active.is_empty() {
                break;
            }
        }
        Ok(found)
    }

    /// One step; how far it moves the foot, mm.
    fn advance(&self, point: &Vector, foot: &mut Foot) -> f64 {
        let SurfacePoint { point: at, along } = foot.surface;
        let step = tangent_step(&(point - at), &along);
        let mut length = 0.0;
        for k in 0..2 {
            let (before, [low, high]) = (foot.parameters[k], [self.limits[0][k], self.limits[1][k]]);
            let after = before + step[k];
            let (after, moved) = match self.periods[k] {
                Some(period) if !(low..=high).contains(&after) => (low + (after - low).rem_euclid(period), step[k]),
                _ => (after.max(low).min(high), after.max(low).min(high) - before),
            };
            foot.parameters[k] = after;
            length += moved.abs() * along[k].amax();
        }
        length
    }

    /// Turns feet that stand on a pole to the side on which their points lie.
    fn leave_poles<E>(
        &self,
        points: &[Vector],
        feet: &mut [[f64; 2]],
        surface: &impl Fn(&[[f64; 2]]) -> Result<Vec<SurfacePoint>, E>,
    ) -> Result<(), E> {
        for pole in &self.poles {
            let stands = |foot: &[f64; 2]| (foot[pole.fixed] - pole.value).abs() <= pole.near;
            let standing: Vec<usize> = (0..feet.len()).filter(|i| stands(&feet[*i])).collect();
            let parameters: Vec<[f64; 2]> = standing.iter().map(|i| feet[*i]).collect();
            for (i, at) in standing.into_iter().zip(surface(&parameters)?) {
                let away = points[i] - at.point;
                let best = pole.ways.iter().max_by(|a, b| away.dot(&a.1).total_cmp(&away.dot(&b.1)));
                feet[i][1 - pole.fixed] = best.map_or(feet[i][1 - pole.fixed], |(value, _)| *value);
            }
        }
        Ok(())
    }
}

impl Foot {
    fn new((surface, parameters): (SurfacePoint, &[f64; 2])) -> Self {
        Self { parameters: *parameters, surface }
    }
}

/// The step of the parameters that removes the tangential part of what is left, to first order.
fn tangent_step(rest: &Vector, [along_u, along_v]: &[Vector; 2]) -> [f64; 2] {
    let (uu, uv, vv) = (along_u.norm_squared(), along_u.dot(along_v), along_v.norm_squared());
    let (ru, rv) = (rest.dot(along_u), rest.dot(along_v));
    let determinant = uu * vv - uv * uv;
    if determinant > f64::max(FLAT[0] * uu * vv, FLAT[1] * uu.max(vv) * uu.max(vv)) {
        return [(ru * vv - rv * uv) / determinant, (rv * uu - ru * uv) / determinant];
    }
    // where one derivative vanishes, as at a pole, the other one is followed
    match (uu > 0.0, uu >= vv) {
        (true, true) => [ru / uu, 0.0],
        (_, false) => [0.0, rv / vv],
        (false, true) => [0.0; 2],
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::*;

    const RADIUS: f64 = 5.0;

    /// A sphere by longitude u and latitude v, with a pole at each end of v.
    fn sphere(parameters: &[[f64; 2]]) -> Result<Vec<SurfacePoint>, Infallible> {
        let at = |[u, v]: &[f64; 2]| {
            let ((sin_u, cos_u), (sin_v, cos_v)) = (libm::sincos(*u), libm::sincos(*v));
            SurfacePoint {
                point: RADIUS * Vector::new(cos_u * cos_v, sin_u * cos_v, sin_v),
                along: [
                    RADIUS * Vector::new(-sin_u * cos_v, cos_u * cos_v, 0.0),
                    RADIUS * Vector::new(-cos_u * sin_v, -sin_u * sin_v, cos_v),
                ],
            }
        };
        Ok(parameters.iter().map(at).collect())
    }

    fn search() -> FootSearch {
        let quarter = std::f64::consts::FRAC_PI_2;
        let direction = |i: i32| {
            (0.2 * f64::from(i), Vector::new(libm::cos(0.2 * f64::from(i)), libm::sin(0.2 * f64::from(i)), 0.0))
        };
        let pole = Pole { fixed: 1, value: quarter, near: 1e-9, ways: (0..32).map(direction).collect() };
        FootSearch {
            limits: [[0.0, -quarter], [std::f64::consts::TAU, quarter]],
            poles: vec![pole],
            periods: [Some(std::f64::consts::TAU), None],
            step: 2e-5,
        }
    }

    #[test]
    fn feet_are_found_from_the_pole_to_every_side() {
        let pole = [0.3, std::f64::consts::FRAC_PI_2];
        for i in 1..60 {
            let (sin, cos) = libm::sincos(0.1 * f64::from(i));
            let lifted = 1.1 * RADIUS * Vector::new(0.2 * cos, 0.2 * sin, libm::sqrt(0.96));
            let Ok(feet) = search().feet(sphere, &[lifted], &[pole]);
            assert!((feet[0].surface.point - lifted / 1.1).norm() < 1e-4, "{i}: {feet:?}");
            assert!((lifted - feet[0].surface.point).norm() - 0.1 * RADIUS < 1e-8);
        }
    }

    #[test]
    fn a_seam_is_crossed() {
        let lifted = 1.2 * RADIUS * Vector::new(libm::cos(0.4), libm::sin(0.4), 0.0);
        let Ok(feet) = search().feet(sphere, &[lifted], &[[std::f64::consts::TAU, 0.1]]);
        assert!((feet[0].surface.point - lifted / 1.2).norm() < 1e-4, "{feet:?}");
    }

    #[test]
    fn the_pole_is_its_own_foot() {
        let Ok(feet) = search().feet(sphere, &[Vector::new(0.0, 0.0, 6.0)], &[[0.3, 1.2]]);
        assert!((feet[0].surface.point - Vector::new(0.0, 0.0, RADIUS)).norm() < 1e-4, "{feet:?}");
    }
}
