//! The position of a cylinder that touches both rails.
//!
//! `P_i` is the contact with rail i, `q_i` the unit vector from there to the axis, across the rail; the axis passes
//! `M_i = P_i + r q_i`. That the cylinder touches there means `(M_2 - M_1) . q_1 = 0` and `(M_2 - M_1) . q_2 = 0`, two equations
//! for the angles of both `q` about the rails, solved by Newton's steps with exact derivatives. The angles are counted from where
//! `q` is, so that no frame can flip at an inflection or along a straight rail.

use nalgebra::{Matrix2, Vector2};
use styluscam_geometry::Vector;

use super::{FlankError, RuledStrip};

/// Steps at most; five are usual.
const STEPS: usize = 40;
/// Turn at most in one step, rad: the equations have solutions on the rails' other sides too.
const FARTHEST: f64 = 0.3;
/// A turn below this ends the search, rad.
const SETTLED: f64 = 1e-15;
/// What may be left of the equations, as a share of the axis' length.
const RESIDUAL: f64 = 1e-13;

/// A position of the tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stand {
    /// Two points of the axis: beside the contact with the first rail and beside that with the second, mm.
    pub axis: [Vector; 2],
    /// The contacts, mm.
    pub contacts: [Vector; 2],
}

impl Stand {
    /// Unit vector along the axis, from the first rail to the second.
    #[must_use]
    pub fn direction(&self) -> Vector {
        (self.axis[1] - self.axis[0]).normalize()
    }
}

/// A rail at a contact.
struct Rail {
    point: Vector,
    /// Derivative of the point.
    rate: Vector,
    /// Unit tangent and its derivative.
    tangent: Vector,
    turn: Vector,
}

impl Rail {
    fn of(strip: &RuledStrip, number: usize, u: f64) -> Self {
        let at = strip.rail(number, u);
        let speed = at.first.norm();
        let tangent = at.first / speed;
        let turn = (at.second - tangent * tangent.dot(&at.second)) / speed;
        Self { point: at.point, rate: at.first, tangent, turn }
    }
}

/// The position with contacts at shares `u` of both rails, and how the two points of its axis move when the contacts move at
/// `rates`, mm per unit.
///
/// # Errors
/// [`FlankError::NoPosition`].
pub fn stand(
    strip: &RuledStrip,
    radius: f64,
    u: [f64; 2],
    rates: [f64; 2],
) -> Result<(Stand, [Vector; 2]), FlankError> {
    let none = || FlankError::NoPosition { u: 0.5 * (u[0] + u[1]), radius };
    let rails = [0, 1].map(|i| Rail::of(strip, i, u[i]));
    let mut q = [0, 1].map(|i| strip.normal([u[i], i as f64]));
    let aside = |q: &[Vector; 2]| [0, 1].map(|i| rails[i].tangent.cross(&q[i]));
    let axis = |q: &[Vector; 2]| [0, 1].map(|i| rails[i].point + q[i] * radius);
    let slopes = |q: &[Vector; 2]| {
        let ([m1, m2], [t1, t2]) = (axis(q), aside(q));
        let a = m2 - m1;
        Matrix2::new(a.dot(&t1), radius * t2.dot(&q[0]), -radius * t1.dot(&q[1]), a.dot(&t2))
    };
    let equations = |q: &[Vector; 2]| {
        let [m1, m2] = axis(q);
        Vector2::new((m2 - m1).dot(&q[0]), (m2 - m1).dot(&q[1]))
    };
    for _ in 0..STEPS {
        let step = slopes(&q).try_inverse().ok_or_else(none)? * -equations(&q);
        let step = step.map(|angle| angle.clamp(-FARTHEST, FARTHEST));
        let t = aside(&q);
        for i in 0..2 {
            let (sin, cos) = libm::sincos(step[i]);
            q[i] = (q[i] * cos + t[i] * sin).normalize();
        }
        if step.amax() <= SETTLED {
            break;
        }
    }
    let [m1, m2] = axis(&q);
    let length = (m2 - m1).norm();
    let is_beside = (0..2).all(|i| q[i].dot(&strip.normal([u[i], i as f64])) > 0.0);
    if !(equations(&q).amax() <= RESIDUAL * length.max(radius) && is_beside) {
        return Err(none());
    }
    // both contacts move, each q is carried along across its rail, and turns as the equations ask
    let carried = [0, 1].map(|i| -rails[i].tangent * q[i].dot(&rails[i].turn) * rates[i]);
    let moved = [0, 1].map(|i| rails[i].rate * rates[i] + carried[i] * radius);
    let along = moved[1] - moved[0];
    let change = [0, 1].map(|i| along.dot(&q[i]) + (m2 - m1).dot(&carried[i]));
    let turns = slopes(&q).try_inverse().ok_or_else(none)? * -Vector2::from(change);
    let t = aside(&q);
    let rates = [0, 1].map(|i| moved[i] + t[i] * (radius * turns[i]));
    Ok((Stand { axis: [m1, m2], contacts: [rails[0].point, rails[1].point] }, rates))
}
