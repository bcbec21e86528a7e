//! f(r, z), zero on the curve, with its derivatives in the tool's coordinates.

use super::expression::Expression;
use super::interval::Interval;
use super::jet::Jet;
use super::number::Number;
use super::sample::short;

/// The field f in the tool's coordinates, and positions as the user knows them.
pub(super) struct Field {
    pub f: Expression,
    /// z of the tip in the formula's coordinates.
    pub origin: f64,
    /// -1 where z falls from the tip.
    pub upwards: f64,
}

impl Field {
    pub fn jet(&self, [r, z]: [f64; 2]) -> Jet {
        let mut jet = self.f.at(r, self.origin + self.upwards * z);
        jet.first[1] *= self.upwards;
        jet.second[1] *= self.upwards;
        jet
    }

    /// As [`jet`](Self::jet), everywhere in a box.
    pub fn over(&self, [r, z]: [Interval; 2]) -> Jet<Interval> {
        let upwards = Interval::exact(self.upwards);
        let mut jet = self.f.over(r, Interval::exact(self.origin) + upwards * z);
        jet.first[1] = jet.first[1] * upwards;
        jet.second[1] = jet.second[1] * upwards;
        jet
    }

    pub fn position(&self, [r, z]: [f64; 2]) -> String {
        format!("r = {}, z = {}", short(r), short(self.origin + self.upwards * z))
    }
}

/// t' H t: how f bends along a direction.
pub(super) fn bending<T: Number>(jet: &Jet<T>, [r, z]: [T; 2]) -> T {
    jet.second[0] * r.square() + T::exact(2.0) * jet.second[1] * r * z + jet.second[2] * z.square()
}
