//! The order of passes: a number at every position of the tip, equal all along a pass (a level's height, a row's position
//! across) or moving on by a step a turn (a spiral's height).
//!
//! A new order is one implementation of [`Scalar`]: its value and its gradient. All checks of passes ask the scalar, and
//! none of them asks which one it is. Where contact lines cross a facet, the value is taken for linear between the facet's
//! edges: a scalar that curves (a distance from a point) needs facets that are small against its radius.

use std::f64::consts::FRAC_1_SQRT_2;
use std::fmt::Debug;

use styluscam_geometry::Vector;

use crate::tolerances::{SAME_LEVEL, WIDE};

/// Rows that differ by less are one, mm: positions on them are rounded to a machine's last digit.
const SAME_ROW: f64 = 5e-3;
/// Planes that slope by less, a sine, are level: a tenth of a millimetre over a metre.
const LEVEL: f64 = 1e-4;
/// Below this share of its length a gradient across a plane is beyond all measure.
const FLAT: f64 = 1e-6;
/// On ground as gentle as this, a sine, the tolerance moves a level far, or leaves none.
const GENTLE: f64 = 0.15;
/// On walls as steep as this, a cosine, rows climb.
const STEEP: f64 = 0.1;
/// The last level may be this many steps above the lowest height at which the tool can touch.
const REST: f64 = 0.25;
/// What levels miss is reported from this share of the step in height on: a wall may be lower than the smallest loop is wide.
const LOW: f64 = 0.5;
/// What passes side by side miss, narrower than the smallest feature, is reported from this share of it on, where it is so
/// many times as long: a groove, and no corner of a valley.
const NARROW: f64 = 0.2;
const LONG: f64 = 4.0;

/// A number at every position of the tip: the order of the passes.
///
/// What follows from value and gradient alone is provided; an implementation overrides it where its passes are planned by
/// another rule. Normals are unit vectors, lengths mm.
pub trait Scalar: Debug + Send + Sync {
    /// The value at a position of the tip, mm.
    fn value(&self, tip: Vector) -> f64;

    /// How the value changes with the tip; zero where it has no direction.
    fn gradient(&self, tip: Vector) -> Vector;

    /// Passes whose values differ by no more are one, mm.
    fn same(&self) -> f64 {
        SAME_ROW
    }

    /// From a tip that touches a plane of normal `up`, the shift on that plane to the next pass; none where that is beyond
    /// all measure.
    fn next(&self, tip: Vector, up: Vector, step: f64) -> Option<Vector> {
        let across = self.on_plane(tip, up);
        let square = across.norm_squared();
        (square > FLAT * FLAT).then(|| across * (step / square))
    }

    /// The shift off a plane of normal `up`, until it is 1 mm away, by which a tool stays on its pass; none where it cannot.
    fn aside(&self, tip: Vector, up: Vector) -> Option<Vector> {
        let direction = self.gradient(tip).try_normalize(FLAT)?;
        let off = up - up.dot(&direction) * direction;
        (off.norm() > LEVEL).then(|| off / off.norm_squared())
    }

    /// Whether passes are to touch a plane of normal `up`.
    fn crosses(&self, tip: Vector, up: Vector) -> bool {
        self.on_plane(tip, up).norm() > LEVEL
    }

    /// Whether a plane of normal `up` shows where passes touch it: not where the tolerance moves them far.
    fn shows_on(&self, tip: Vector, up: Vector) -> bool {
        self.on_plane(tip, up).norm() > GENTLE
    }

    /// What a pass is to its neighbours.
    fn kind(&self) -> PassKind {
        PassKind::Row
    }

    /// Steps by which the tool may be able to touch beyond the first and the last pass.
    fn rest(&self) -> [f64; 2] {
        [WIDE, WIDE]
    }

    /// Lengths across and along the passes, mm: a position is worth a pass where the tool can touch as far in one of these
    /// combinations. `feature` is the smallest that counts, `step` the distance to the next pass on the surface.
    fn features(&self, feature: f64, _step: f64) -> Vec<[f64; 2]> {
        let [narrow, long] = [NARROW * feature, LONG * feature];
        vec![[feature, feature], [long, narrow], [narrow, long]]
    }

    /// Of passes, with their values and lengths, the values of those that are to touch wherever the part shows them; `step`
    /// is the expected distance between them, mm, where it is everywhere alike.
    fn throughout(&self, passes: Vec<[f64; 2]>, _step: Option<f64>) -> Vec<f64> {
        passes.into_iter().map(|[value, _]| value).collect()
    }

    /// Whether each pass lies below the one before it: a sheet is formed by them, step by step downwards.
    fn descends(&self) -> bool {
        false
    }

    /// Whether the last pass is to be followed all around at the lowest value that it comes to.
    fn ends_all_around(&self) -> bool {
        false
    }

    /// The gradient's part in a plane of normal `up`.
    fn on_plane(&self, tip: Vector, up: Vector) -> Vector {
        let gradient = self.gradient(tip);
        gradient - gradient.dot(&up) * up
    }
}

/// What a pass is to its neighbours: by this a gap between passes is reported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PassKind {
    /// It lies above or below them.
    Level,
    /// It lies beside them.
    Row,
}

/// Height of the tip: levels, and spirals that go down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Height;

impl Scalar for Height {
    fn value(&self, tip: Vector) -> f64 {
        tip.z
    }

    fn gradient(&self, _tip: Vector) -> Vector {
        Vector::z()
    }

    fn same(&self) -> f64 {
        SAME_LEVEL
    }

    fn next(&self, _tip: Vector, up: Vector, step: f64) -> Option<Vector> {
        let steep = (up.x * up.x + up.y * up.y).sqrt();
        (steep > FLAT).then(|| {
            let (run, rise) = (step * up.z / (steep * steep), -step);
            Vector::new(run * up.x, run * up.y, rise)
        })
    }

    fn aside(&self, _tip: Vector, up: Vector) -> Option<Vector> {
        let steep = up.xy().norm();
        (steep > LEVEL).then(|| Vector::new(up.x, up.y, 0.0) / (steep * steep))
    }

    /// Levels have no line on a level plane, which needs rows.
    fn crosses(&self, _tip: Vector, up: Vector) -> bool {
        up.xy().norm() > LEVEL
    }

    fn shows_on(&self, _tip: Vector, up: Vector) -> bool {
        up.xy().norm() > GENTLE
    }

    fn kind(&self) -> PassKind {
        PassKind::Level
    }

    fn rest(&self) -> [f64; 2] {
        [REST, WIDE]
    }

    fn features(&self, feature: f64, step: f64) -> Vec<[f64; 2]> {
        vec![[feature.min(LOW * step), feature]]
    }

    fn descends(&self) -> bool {
        true
    }

    fn ends_all_around(&self) -> bool {
        true
    }
}

/// How far out and down the tip is, in equal shares: the turns of a meridian that falls outwards, flat, sloping or upright.
///
/// A step along the meridian is never more in this number, and at least 1/sqrt(2) of it: on a slope a it is sin(a + 45 deg) of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outwards;

impl Scalar for Outwards {
    fn value(&self, tip: Vector) -> f64 {
        FRAC_1_SQRT_2 * (tip.xy().norm() - tip.z)
    }

    fn gradient(&self, tip: Vector) -> Vector {
        let out = tip.xy().try_normalize(FLAT).unwrap_or_default();
        FRAC_1_SQRT_2 * Vector::new(out.x, out.y, -1.0)
    }

    fn kind(&self) -> PassKind {
        PassKind::Level
    }

    fn descends(&self) -> bool {
        true
    }
}

/// Position across straight rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Across {
    /// Direction of the rows in plan, rad from X.
    pub direction_rad: f64,
}

impl Scalar for Across {
    fn value(&self, tip: Vector) -> f64 {
        let (sin, cos) = libm::sincos(self.direction_rad);
        -sin * tip.x + cos * tip.y
    }

    fn gradient(&self, _tip: Vector) -> Vector {
        let (sin, cos) = libm::sincos(self.direction_rad);
        Vector::new(-sin, cos, 0.0)
    }

    /// Straight across in plan, and on the plane in height.
    fn next(&self, _tip: Vector, up: Vector, step: f64) -> Option<Vector> {
        (up.z > FLAT).then(|| {
            let (sin, cos) = libm::sincos(self.direction_rad);
            let (x, y) = (-sin * step, cos * step);
            Vector::new(x, y, -(up.x * x + up.y * y) / up.z)
        })
    }

    fn aside(&self, _tip: Vector, up: Vector) -> Option<Vector> {
        (up.z > LEVEL).then(|| Vector::z() / up.z)
    }

    fn crosses(&self, _tip: Vector, _up: Vector) -> bool {
        true
    }

    fn shows_on(&self, _tip: Vector, up: Vector) -> bool {
        up.z > STEEP
    }

    /// Those that lie whole steps apart: rows that were added for a strip between them are no longer than the strip. Where
    /// steps differ these cannot be distinguished from the others, and none is.
    fn throughout(&self, mut rows: Vec<[f64; 2]>, step: Option<f64>) -> Vec<f64> {
        let Some(step) = step else { return Vec::new() };
        let past = |[value, _]: &[f64; 2]| value.rem_euclid(step);
        rows.sort_by(|a, b| past(a).total_cmp(&past(b)));
        let close = |a: &[f64; 2], b: &[f64; 2]| past(b) - past(a) <= self.same();
        let mut sets: Vec<Vec<[f64; 2]>> = rows.chunk_by(close).map(<[_]>::to_vec).collect();
        // a step on is where the first ones are
        if let [first, .., last] = &mut sets[..] {
            if past(&first[0]) + step - past(&last[last.len() - 1]) <= self.same() {
                first.append(last);
            }
        }
        let length = |set: &Vec<[f64; 2]>| set.iter().map(|[_, length]| length).sum::<f64>();
        let longest = sets.into_iter().max_by(|a, b| length(a).total_cmp(&length(b)));
        longest.into_iter().flatten().map(|[value, _]| value).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_between_others_are_for_strips() {
        let across = Across { direction_rad: 0.0 };
        let regular: Vec<[f64; 2]> = (0..5).map(|row| [-0.6 + 0.3 * f64::from(row), 10.0]).collect();
        let mut rows = vec![[0.1, 25.0], [0.4, 12.0]];
        rows.extend(&regular);
        let mut found = across.throughout(rows, Some(0.3));
        found.sort_by(f64::total_cmp);
        assert_eq!(found, regular.iter().map(|[value, _]| *value).collect::<Vec<_>>());
        assert!(across.throughout(Vec::new(), Some(0.3)).is_empty());
    }

    /// The same scalar by the provided methods alone.
    #[derive(Debug)]
    struct Plain<S>(S);

    impl<S: Scalar> Scalar for Plain<S> {
        fn value(&self, tip: Vector) -> f64 {
            self.0.value(tip)
        }

        fn gradient(&self, tip: Vector) -> Vector {
            self.0.gradient(tip)
        }
    }

    #[test]
    fn shifts_lead_to_the_next_pass_and_along_a_pass() {
        let (tip, step) = (Vector::new(1.0, 2.0, 3.0), 0.3);
        let up = Vector::new(0.3, -0.4, 0.8).normalize();
        let across = Across { direction_rad: 0.7 };
        let plain = Plain(across);
        let scalars: [&dyn Scalar; 4] = [&Height, &across, &Plain(Height), &plain];
        for scalar in scalars {
            let next = scalar.next(tip, up, step).unwrap();
            let change = scalar.value(tip + next) - scalar.value(tip);
            assert!(next.dot(&up).abs() < 1e-12 && (change.abs() - step).abs() < 1e-12, "{scalar:?}: {next}");
            let aside = scalar.aside(tip, up).unwrap();
            let change = scalar.value(tip + aside) - scalar.value(tip);
            assert!((aside.dot(&up) - 1.0).abs() < 1e-12 && change.abs() < 1e-12, "{scalar:?}: {aside}");
            assert!(scalar.crosses(tip, up) && scalar.shows_on(tip, up), "{scalar:?}");
        }
        assert!(Height.next(tip, Vector::z(), step).is_none() && Plain(Height).next(tip, Vector::z(), step).is_none());
        assert!(!Height.crosses(tip, Vector::z()) && !Plain(Height).crosses(tip, Vector::z()));
    }
}
