//! The position of a cylinder or a cone that touches both rails.
//!
//! `P_i` is the contact with rail i, `q_i` the unit vector from there to the axis, across the rail and across the flank; the axis
//! passes `M_i = P_i + r_i q_i`, the centre of the ball of radius `r_i` that touches the flank from inside. On a cylinder all have
//! one radius, in a cone of half angle g they grow along the axis. With `a = M_2 - M_1`, `l = |a|`:
//! `a . q_1 = l sin g`, `a . q_2 = l sin g` and `r_2 - r_1 = l sin g`, three equations
//! for the angles of both `q` about the rails and for `r_2`, solved by Newton's steps with exact derivatives. The angles are counted
//! from where `q` is, so that no frame can flip at an inflection or along a straight rail.

use nalgebra::{Matrix3, Vector3};
use styluscam_geometry::{CurvePoint, Vector};

use super::cutter::Flank;
use super::swept::Station;
use super::{FlankError, RuledStrip};

/// Steps at most; five are usual.
const STEPS: usize = 40;
/// Turn at most in one step, rad: the equations have solutions on the rails' other sides too.
const FARTHEST: f64 = 0.3;
/// A turn below this ends the search, rad: what is left after it is its square.
const SETTLED: f64 = 1e-9;
/// A radius is grown in so many steps where one is too much; a tenth of them is too small.
const FOLLOWED: f64 = 8.0;
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
    fn of(at: &CurvePoint) -> Self {
        let speed = at.first.norm();
        let tangent = at.first / speed;
        let turn = (at.second - tangent * tangent.dot(&at.second)) / speed;
        Self { point: at.point, rate: at.first, tangent, turn }
    }
}

/// A position on its way to touching: contacts, ways from there to the axis, and the second ball's radius.
struct Trial {
    q: [Vector; 2],
    radii: [f64; 2],
}

impl Trial {
    fn axis(&self, rails: &[Rail; 2]) -> [Vector; 2] {
        [0, 1].map(|i| rails[i].point + self.q[i] * self.radii[i])
    }

    /// Where each way turns to when its angle grows.
    fn aside(&self, rails: &[Rail; 2]) -> [Vector; 2] {
        [0, 1].map(|i| rails[i].tangent.cross(&self.q[i]))
    }

    fn equations(&self, rails: &[Rail; 2], growth: f64) -> Vector3<f64> {
        let [m1, m2] = self.axis(rails);
        let a = m2 - m1;
        let grown = a.norm() * growth;
        Vector3::new(a.dot(&self.q[0]) - grown, a.dot(&self.q[1]) - grown, self.radii[1] - self.radii[0] - grown)
    }

    /// Their derivatives by both angles and the second radius.
    fn slopes(&self, rails: &[Rail; 2], growth: f64) -> Matrix3<f64> {
        let ([m1, m2], [t1, t2], [q1, q2]) = (self.axis(rails), self.aside(rails), self.q);
        let a = m2 - m1;
        let along = a.normalize() * growth;
        let [moved1, moved2] = [t1 * self.radii[0], t2 * self.radii[1]];
        let [grown1, grown2, grown] = [-along.dot(&moved1), along.dot(&moved2), along.dot(&q2)];
        Matrix3::new(
            a.dot(&t1) - grown1,
            moved2.dot(&q1) - grown2,
            q2.dot(&q1) - grown,
            -moved1.dot(&q2) - grown1,
            a.dot(&t2) - grown2,
            1.0 - grown,
            -grown1,
            -grown2,
            1.0 - grown,
        )
    }
}

/// What a position is looked for beside: the rails at the contacts, and the surface's normals there.
struct Contacts {
    rails: [Rail; 2],
    normals: [Vector; 2],
    ruling: f64,
}

impl Contacts {
    fn at(strip: &RuledStrip, u: [f64; 2]) -> Self {
        let ends = u.map(|u| strip.ends(u));
        let rails = [0, 1].map(|i| Rail::of(&ends[i][i]));
        let normals = [0, 1].map(|i| strip.normal_between(&ends[i], i as f64));
        let ruling = (rails[1].point - rails[0].point).norm();
        Self { rails, normals, ruling }
    }

    /// The position that Newton's steps reach; none where they reach none beside the surface. As a radius grows, positions vanish
    /// in pairs, where the determinant is 0: the other of a pair, in which it is below 0, is none either.
    fn solved(&self, from: [Vector; 2], flank: &Flank) -> Option<Trial> {
        let Self { rails, normals, ruling } = self;
        let (radius, growth) = (flank.radius(), flank.growth());
        let mut trial = Trial { q: from, radii: [radius, flank.radius_at(*ruling, 1.0)] };
        for _ in 0..STEPS {
            let step = trial.slopes(rails, growth).try_inverse()? * -trial.equations(rails, growth);
            let aside = trial.aside(rails);
            let turns = [step[0], step[1]].map(|angle| angle.clamp(-FARTHEST, FARTHEST));
            for i in 0..2 {
                let (sin, cos) = libm::sincos(turns[i]);
                trial.q[i] = (trial.q[i] * cos + aside[i] * sin).normalize();
            }
            trial.radii[1] = (trial.radii[1] + step[2]).max(0.5 * radius);
            if step[0].abs().max(step[1].abs()).max(step[2].abs() / ruling) <= SETTLED {
                break;
            }
        }
        let [m1, m2] = trial.axis(rails);
        let is_beside = (0..2).all(|i| trial.q[i].dot(&normals[i]) > 0.0);
        let is_first = trial.slopes(rails, growth).determinant() > 0.0;
        let left = trial.equations(rails, growth).amax();
        (left <= RESIDUAL * (m2 - m1).norm().max(radius) && is_beside && is_first).then_some(trial)
    }

    /// The same where Newton's steps from the normals do not lead: from small radii on.
    fn followed(&self, flank: &Flank) -> Option<Trial> {
        let mut from = self.normals;
        let (mut share, mut step) = (0.0_f64, 1.0 / FOLLOWED);
        while share < 1.0 {
            let next = (share + step).min(1.0);
            match self.solved(from, &flank.of_share(next)) {
                Some(trial) if next >= 1.0 => return Some(trial),
                Some(trial) => (share, from) = (next, trial.q),
                None if step * FOLLOWED < 0.1 => return None,
                None => step *= 0.5,
            }
        }
        None
    }
}

/// The position with contacts at shares `u` of both rails, and how its axis moves when the contacts move at `rates`, mm per unit.
///
/// # Errors
/// [`FlankError::NoPosition`].
pub fn stand(strip: &RuledStrip, flank: &Flank, u: [f64; 2], rates: [f64; 2]) -> Result<(Stand, Station), FlankError> {
    let none = || FlankError::NoPosition { u: 0.5 * (u[0] + u[1]), radius: flank.radius() };
    let contacts = Contacts::at(strip, u);
    let found = contacts.solved(contacts.normals, flank).or_else(|| contacts.followed(flank));
    let trial = found.ok_or_else(none)?;
    let (rails, growth) = (&contacts.rails, flank.growth());
    let [m1, m2] = trial.axis(rails);
    // both contacts move, each q is carried along across its rail, and turns as the equations ask
    let carried = [0, 1].map(|i| -rails[i].tangent * trial.q[i].dot(&rails[i].turn) * rates[i]);
    let moved = [0, 1].map(|i| rails[i].rate * rates[i] + carried[i] * trial.radii[i]);
    let apart = moved[1] - moved[0];
    let grown = growth * apart.dot(&(m2 - m1).normalize());
    let [change1, change2] = [0, 1].map(|i| apart.dot(&trial.q[i]) + (m2 - m1).dot(&carried[i]) - grown);
    let change = Vector3::new(change1, change2, -grown);
    let answer = trial.slopes(rails, growth).try_inverse().ok_or_else(none)? * -change;
    let aside = trial.aside(rails);
    let turned = [0, 1].map(|i| moved[i] + aside[i] * (trial.radii[i] * answer[i]));
    let rates = [turned[0], turned[1] + trial.q[1] * answer[2]];
    let stand = Stand { axis: [m1, m2], contacts: [rails[0].point, rails[1].point] };
    Ok((stand, Station { axis: stand.axis, direction: stand.direction(), rates, swell: answer[2] }))
}
