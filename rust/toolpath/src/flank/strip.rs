//! A ruled surface between two rails, and the side of it on which the tool moves.

use styluscam_geometry::{CurvePoint, NurbsCurve, Vector};

use super::cutter::Flank;
use super::FlankError;

/// Positions along the strip at which it is looked at before anything is planned.
const LOOKED_AT: usize = 256;
/// Positions along a ruling for that.
const ACROSS: usize = 5;
/// Lengths below this, beside the longest of their kind, are none.
const NONE: f64 = 1e-9;

/// Coordinates and rails at most, and rails at least, mm.
const FARTHEST: f64 = 1e6;
const SHORTEST: f64 = 1e-3;
/// A corner turns by more than 1 deg: its cosine; a gap is so many times as long as the speed makes it. Both stay where the rail
/// is halved so often.
const CORNER: f64 = 0.999_847_7;
const GAP: f64 = 3.0;
const HALVINGS: usize = 26;

/// The side of the strip on which the tool moves, seen from its second rail down to the first, looking along the rails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// To the left.
    Left,
    /// To the right.
    Right,
}

/// A ruled surface: straight lines between points of equal parameter of two rails.
#[derive(Clone, Debug)]
pub struct RuledStrip {
    rails: [NurbsCurve; 2],
    side: Side,
    /// Where it begins and ends, as shares of the rails: beyond 0 and 1 their end polynomials go on.
    ends: [f64; 2],
}

impl RuledStrip {
    /// The strip between two rails, each from its first parameter to its last.
    ///
    /// # Errors
    /// Rails that meet, cusps, rulings along a rail.
    pub fn new(rails: [NurbsCurve; 2], side: Side) -> Result<Self, FlankError> {
        Self { rails, side, ends: [0.0, 1.0] }.checked()
    }

    /// The same strip, longer at both ends by about a length, mm: its rails go on as they end.
    ///
    /// # Errors
    /// As those of a strip, of what is longer.
    pub fn extended(self, length: f64) -> Result<Self, FlankError> {
        let share = |u: f64| {
            let speed = 0.5 * (0..2).map(|rail| self.rail(rail, u).first.norm()).sum::<f64>();
            length / speed.max(NONE)
        };
        let ends = [-share(0.0), 1.0 + share(1.0)];
        Self { ends, ..self }.checked()
    }

    fn checked(self) -> Result<Self, FlankError> {
        let strip = self;
        let at = |i: usize| i as f64 / LOOKED_AT as f64;
        strip.is_of_this_world()?;
        let longest = |of: &dyn Fn(f64) -> f64| (0..=LOOKED_AT).map(|i| of(at(i))).fold(0.0, f64::max);
        let ruling = |u: f64| (strip.rail(1, u).point - strip.rail(0, u).point).norm();
        let widest = longest(&ruling);
        if let Some(i) = (0..=LOOKED_AT).find(|i| ruling(at(*i)) <= NONE * widest.max(NONE)) {
            return Err(FlankError::NoRuling { u: at(i) });
        }
        for rail in 0..2 {
            let speed = |u: f64| strip.rail(rail, u).first.norm();
            let fastest = longest(&speed);
            for i in 0..=LOOKED_AT {
                let u = at(i);
                let first = strip.rail(rail, u).first;
                let turns_back = i > 0 && strip.rail(rail, at(i - 1)).first.dot(&first) < 0.0;
                if speed(u) <= NONE * fastest.max(NONE) || turns_back {
                    return Err(FlankError::Cusp { rail, u });
                }
                strip.follows(rail, [at(i.saturating_sub(1)), u])?;
                let across = first.cross(&(strip.rail(1, u).point - strip.rail(0, u).point)).norm();
                if across <= 1e-6 * first.norm() * ruling(u) {
                    return Err(FlankError::NoNormal { rail, u });
                }
            }
        }
        let is_back = |i: &usize| strip.rail(0, at(*i)).first.dot(&strip.rail(1, at(*i)).first) < 0.0;
        if (0..=LOOKED_AT).filter(is_back).count() > LOOKED_AT / 2 {
            return Err(FlankError::Opposite);
        }
        Ok(strip)
    }

    /// Whether the rails are of a size that parts have.
    fn is_of_this_world(&self) -> Result<(), FlankError> {
        for rail in 0..2 {
            let points: Vec<_> = (0..=16).map(|i| self.rail(rail, f64::from(i) / 16.0).point).collect();
            let length: f64 = points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
            let farthest = points.iter().map(Vector::amax).fold(0.0, f64::max);
            if !(farthest <= FARTHEST && length <= FARTHEST && (length >= SHORTEST || length == 0.0)) {
                return Err(FlankError::Size { rail, length, farthest });
            }
        }
        Ok(())
    }

    /// Whether a rail goes on from one share to another without a corner or a gap: where its direction changes much, or its point
    /// more than by its speed, it is looked at more closely.
    fn follows(&self, rail: usize, [mut low, mut high]: [f64; 2]) -> Result<(), FlankError> {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let is_broken = |from: f64, to: f64| {
                let [a, b] = [from, to].map(|u| self.rail(rail, u));
                let moved = a.first.norm().max(b.first.norm()) * (to - from);
                let turned = a.first.normalize().dot(&b.first.normalize());
                turned < CORNER || (b.point - a.point).norm() > GAP * moved
            };
            if is_broken(low, middle) {
                high = middle;
            } else if is_broken(middle, high) {
                low = middle;
            } else {
                return Ok(());
            }
        }
        Err(FlankError::Corner { rail, u: low })
    }

    /// A rail at a share of the way along it, 0 to 1; derivatives are per that share.
    #[must_use]
    pub fn rail(&self, number: usize, u: f64) -> CurvePoint {
        let [first, last] = self.rails[number].domain();
        let length = last - first;
        let longer = self.ends[1] - self.ends[0];
        let share = self.ends[0] + u * longer;
        let CurvePoint { point, first: rate, second } = self.rails[number].at(first + share * length);
        let length = length * longer;
        CurvePoint { point, first: rate * length, second: second * (length * length) }
    }

    /// The point at a share of the way along the rails and along the ruling from the first to the second, 0 to 1 each.
    #[must_use]
    pub fn point(&self, [u, v]: [f64; 2]) -> Vector {
        let [a, b] = [0, 1].map(|rail| self.rail(rail, u).point);
        a + (b - a) * v
    }

    /// Both ends of the ruling there.
    pub(super) fn ends(&self, u: f64) -> [CurvePoint; 2] {
        [0, 1].map(|rail| self.rail(rail, u))
    }

    /// Unit normal there, towards the tool.
    #[must_use]
    pub fn normal(&self, [u, v]: [f64; 2]) -> Vector {
        self.normal_between(&self.ends(u), v)
    }

    /// The same where the ends of the ruling are known.
    pub(super) fn normal_between(&self, [a, b]: &[CurvePoint; 2], v: f64) -> Vector {
        let along = a.first + (b.first - a.first) * v;
        let left = (b.point - a.point).cross(&along).normalize();
        match self.side {
            Side::Left => left,
            Side::Right => -left,
        }
    }

    /// Refuses a flank that does not fit where the surface is hollow: by the normal curvature across the rulings.
    ///
    /// # Errors
    /// [`FlankError::TooLarge`].
    pub(super) fn takes(&self, flank: &Flank) -> Result<(), FlankError> {
        // the share of the hollow's radius that the flank fills, and both radii
        let filled = |[u, v]: [f64; 2]| {
            let [a, b] = self.ends(u);
            let (ruling, along) = (b.point - a.point, a.first + (b.first - a.first) * v);
            let (twist, bent) = (b.first - a.first, a.second + (b.second - a.second) * v);
            let share = along.dot(&ruling) / ruling.norm_squared();
            let across = along - ruling * share;
            let curvature =
                (bent - twist * (2.0 * share)).dot(&self.normal_between(&[a, b], v)) / across.norm_squared();
            let radius = flank.radius() + flank.growth_along_line() * ruling.norm() * v;
            (curvature * radius, 1.0 / curvature, radius)
        };
        let positions = (0..=LOOKED_AT).flat_map(|i| (0..ACROSS).map(move |j| [i, j]));
        let (u, (share, hollow, radius)) = positions
            .map(|[i, j]| [i as f64 / LOOKED_AT as f64, j as f64 / (ACROSS - 1) as f64])
            .map(|at| (at[0], filled(at)))
            .fold((0.0, (0.0, 0.0, 0.0)), |worst, other| if other.1 .0 > worst.1 .0 { other } else { worst });
        if share >= 1.0 {
            return Err(FlankError::TooLarge { u, hollow, radius });
        }
        Ok(())
    }
}
