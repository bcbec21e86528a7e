//! A point of a curve at a given radius or height, between two points known.

use super::jet::Jet;
use super::sample::Sample;

/// The knots around a coordinate, and where it stands between them.
pub(super) struct Bracket {
    /// Index of the knot before; the one after follows.
    pub index: usize,
    /// The other coordinate at both.
    pub ends: [f64; 2],
    /// Where the other coordinate is, nearly.
    pub guess: f64,
    /// The size of the numbers that the other coordinate is computed from: rounding is a part of it.
    pub scale: f64,
}

/// The bracket of `value` in coordinate `axis` (0: r, 1: z), along which the knots rise.
pub(super) fn bracket(knots: &[Sample], axis: usize, value: f64, scale: f64) -> Option<Bracket> {
    let after = knots.partition_point(|knot| knot.point[axis] < value).clamp(1, knots.len().checked_sub(1)?);
    let (low, high) = (knots.get(after - 1)?, knots.get(after)?);
    let width = high.point[axis] - low.point[axis];
    let other = 1 - axis;
    let rise = high.point[other] - low.point[other];
    let [left, right] = [low, high].map(|knot| knot.d[other] / knot.d[axis] * width);
    let x = (value - low.point[axis]) / width;
    let cubic = x * (left + x * ((3.0 * rise - 2.0 * left - right) + x * (left + right - 2.0 * rise)));
    let moved = if cubic.is_finite() && cubic > 0.0 && cubic < rise { cubic } else { x.clamp(0.0, 1.0) * rise };
    Some(Bracket {
        index: after - 1,
        ends: [low.point[other], high.point[other]],
        guess: low.point[other] + if moved.is_finite() { moved } else { 0.0 },
        scale,
    })
}

/// After a Newton step this small, in parts of the bracket, its square is left.
const SMALL_STEP: f64 = 1e-9;
/// Most steps: halving a bracket down to rounding takes sixty.
const MOST_STEPS: usize = 80;
/// What rounding in a formula can leave of a Newton step.
const NOISE: f64 = 1e-9;

/// Where `f`, rising in `sign` direction along coordinate `axis`, is zero; the jet there too.
///
/// Newton kept in the bracket. Where `f` is not a number the coordinate is taken as too large. None where the bracket
/// closes and `f` is not zero.
pub(super) fn solve(bracket: &Bracket, axis: usize, sign: f64, f: impl Fn(f64) -> Jet) -> Option<(f64, Jet)> {
    let [first, last] = bracket.ends;
    let width = (last - first).abs();
    let rounding = 2.0 * f64::EPSILON * bracket.scale;
    let slack = 1e-12 * width + 4.0 * rounding;
    let (mut low, mut high) = (first.min(last) - slack, first.max(last) + slack);
    let mut x = bracket.guess;
    for _ in 0..MOST_STEPS {
        let jet = f(x);
        if sign * jet.value < 0.0 {
            low = x;
        } else {
            high = x;
        }
        let step = jet.value / jet.first[axis];
        let newton = x - step;
        if step.abs() <= rounding {
            return Some((newton, jet));
        }
        if step.abs() <= SMALL_STEP * width {
            return Some((newton, f(newton)));
        }
        if high - low <= rounding {
            return (step.abs() <= NOISE * (width + bracket.scale)).then_some((x, jet));
        }
        x = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
    }
    None
}
