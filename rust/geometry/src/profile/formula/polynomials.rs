//! Proof that the polynomials, which answer for a formula, are convex themselves.

use super::convexity::{self, Joint, Proof};
use super::interval::Interval;
use super::number::Number;
use super::sample::{short, Enclosure, Sample, Source};
use crate::profile::fitted::{self, Fitted, TERMS};
use crate::GeometryError;

/// Terms of r' and z'.
const RATES: usize = TERMS - 1;
/// What an enclosure costs, as operators of a formula would.
const OPERATIONS: usize = 100;

/// The pieces of a curve, each a stretch by its own u from -1 to 1.
struct Polynomials<'a> {
    pieces: &'a [fitted::Interval],
}

/// Proves polynomials convex, their joints too; what is allowed is as for the formula.
pub(super) fn prove(curve: &Fitted, size: f64) -> Result<Proof, GeometryError> {
    let source = Polynomials { pieces: curve.intervals() };
    let stretches: Vec<[Sample; 2]> = (0..source.pieces.len()).map(|k| [-1.0, 1.0].map(|u| source.at(k, u))).collect();
    let joints: Vec<Joint> = stretches.windows(2).map(|pair| source.joint(&pair[0][1], &pair[1][0])).collect();
    convexity::prove(&source, &stretches, &joints, size)
}

impl Polynomials<'_> {
    fn joint(&self, end: &Sample, start: &Sample) -> Joint {
        let gap = [0, 1].map(|i| (start.point[i] - end.point[i]).abs());
        // the cross product of the two directions, by intervals: negative where the slope falls
        let [a, b] = [end, start].map(|sample| self.enclosed(sample.stretch, sample.p, sample.p));
        let turn = (a.d[0] * b.d[1] - a.d[1] * b.d[0]) / (a.speed() * b.speed());
        // an arc is at most so much longer than its sine
        let fall = if turn.lo >= -0.1 { 1.01 * (-turn.lo).max(0.0) } else { f64::INFINITY };
        Joint { fall, gap: gap[0] + gap[1] }
    }

    fn enclosed(&self, piece: usize, from: f64, to: f64) -> Enclosure {
        let middle = 0.5 * (from + to);
        let half = (to - middle).max(middle - from);
        let [r, z] = self.pieces[piece].rate_polynomials().map(|rates| shifted(rates, middle));
        let [d_r, d_z] = [derivative(&r), derivative(&z)];
        let mut turning = [Interval::default(); 2 * RATES];
        for i in 0..RATES {
            for k in 0..RATES {
                turning[i + k] = turning[i + k] + (r[i] * d_z[k] - z[i] * d_r[k]);
            }
        }
        let over = |polynomial: &[Interval]| over_both_sides(polynomial, half);
        Enclosure {
            width: (to - from).next_up(),
            d: [over(&r), over(&z)],
            dd: [over(&d_r), over(&d_z)],
            turning: over(&turning),
        }
    }
}

impl Source for Polynomials<'_> {
    fn at(&self, stretch: usize, u: f64) -> Sample {
        let piece = &self.pieces[stretch];
        let ((r, z), (d, dd)) = (piece.point(u), piece.rates(u));
        Sample { stretch, p: u, point: [r, z], d, dd }
    }

    fn enclose(&self, from: &Sample, to: &Sample) -> Option<Enclosure> {
        Some(self.enclosed(from.stretch, from.p, to.p))
    }

    fn is_given(&self) -> bool {
        false
    }

    fn operations(&self) -> usize {
        OPERATIONS
    }

    fn position(&self, sample: &Sample) -> String {
        format!("r = {}", short(sample.point[0]))
    }
}

/// The polynomial by x - `middle`.
fn shifted(rates: [f64; RATES], middle: f64) -> [Interval; RATES] {
    let mut shifted = rates.map(Interval::exact);
    let middle = Interval::exact(middle);
    for i in 0..RATES {
        for k in (i..RATES - 1).rev() {
            shifted[k] = shifted[k] + middle * shifted[k + 1];
        }
    }
    shifted
}

fn derivative(polynomial: &[Interval; RATES]) -> [Interval; RATES] {
    let mut derivative = [Interval::default(); RATES];
    for (k, coefficient) in polynomial.iter().enumerate().skip(1) {
        derivative[k - 1] = Interval::exact(k as f64) * *coefficient;
    }
    derivative
}

/// A polynomial's values from `-half` to `half`: its odd terms on either side of zero, its even ones on one.
fn over_both_sides(polynomial: &[Interval], half: f64) -> Interval {
    let (mut sum, mut power) = (Interval::default(), Interval::exact(1.0));
    for (k, coefficient) in polynomial.iter().enumerate() {
        let sides = match k {
            0 => power,
            _ if k % 2 == 0 => Interval::new(0.0, power.hi),
            _ => Interval::around_zero(power.hi),
        };
        sum = sum + *coefficient * sides;
        power = power * Interval::exact(half);
    }
    sum
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_4;

    use super::*;

    /// r = 1 + u and z'' = (u - 0.375)^2 - `hollow`: concave between u = 0.333 and 0.417 only, if there at all.
    fn piece(hollow: f64) -> fitted::Interval {
        let (mut r, mut z) = ([0.0; TERMS], [0.0; TERMS]);
        (r[0], r[1]) = (1.0, 1.0);
        (z[1], z[2], z[3], z[4]) = (2.0, 0.5 * (0.140_625 - hollow), -0.125, 1.0 / 12.0);
        fitted::Interval::new(r, z, [FRAC_PI_4, 1.3])
    }

    fn curve(pieces: Vec<fitted::Interval>) -> Fitted {
        let ends = [(0, -1.0), (pieces.len() - 1, 1.0)].map(|(k, u)| pieces[k].point(u));
        Fitted::new(pieces, ends[0], ends[1])
    }

    #[test]
    fn a_hollow_between_two_places_is_refused_and_one_that_is_nothing_is_not() {
        let message = prove(&curve(vec![piece(1e-3)]), 2.0).unwrap_err().to_string();
        assert!(message.contains("r = 1.3") && message.contains("concave"), "{message}");
        let proof = prove(&curve(vec![piece(1e-7)]), 2.0).unwrap();
        // 4/3 hollow^1.5 is the fall's exact size, over its square root's length
        assert!(proof.hollow > 1e-12 && proof.hollow <= 2e-9 && proof.fall > 4e-11, "{proof}");
    }

    #[test]
    fn a_joint_that_falls_or_gapes_counts() {
        let shifted = |dr: f64, turn: f64| {
            let (mut r, mut z) = ([0.0; TERMS], [0.0; TERMS]);
            let end = piece(0.0).point(1.0);
            let (d, _) = piece(0.0).rates(1.0);
            (r[0], r[1]) = (end.0 + d[0] + dr, d[0] + turn);
            (z[0], z[1], z[2]) = (end.1 + d[1] + 0.1, d[1] + 0.2, 0.1);
            curve(vec![piece(0.0), fitted::Interval::new(r, z, [1.3, 1.4])])
        };
        let smooth = prove(&shifted(0.0, 0.0), 4.0).unwrap();
        assert!(smooth.hollow < 1e-9 && smooth.fall < 1e-6, "{smooth}");
        let gaping = prove(&shifted(1e-9, 0.0), 4.0).unwrap();
        assert!(gaping.hollow >= smooth.hollow + 0.9e-9, "{gaping}");
        assert!(prove(&shifted(1e-6, 0.0), 4.0).is_err());
        let message = prove(&shifted(0.0, 1e-3), 4.0).unwrap_err().to_string();
        assert!(message.contains("cannot be proved convex"), "{message}");
    }
}
