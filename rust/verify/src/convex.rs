//! The lowest value of a convex function on [0, 1], by tangents.
//!
//! J. E. Kelley, "The cutting-plane method for solving convex programs", Journal of the SIAM 8, 1960: in one dimension, with
//! Newton's steps between the cuts. See docs/concepts/verifier.md.

/// A convex function at one position.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tangent {
    /// The function's value.
    pub value: f64,
    /// Its derivative.
    pub rate: f64,
    /// Its second derivative; 0 where it is unknown or infinite.
    pub bend: f64,
}

/// Distances that differ by less are equal, mm.
pub(crate) const EQUAL: f64 = 1e-10;
/// A Newton step this short leaves less than [`EQUAL`], mm.
const SHORT: f64 = 1e-7;
/// Evaluations at most: bisection alone needs half as many.
const PATIENCE: usize = 80;

/// Calls `at` until nothing below the lowest value seen (or below `best`) can be left.
///
/// `length` is the mm that [0, 1] stands for. Every tangent of a convex function is below it: that
/// decides when to stop, and it stops at the first call when the tangent there stays above `best`.
pub(crate) fn lower(first: f64, length: f64, best: f64, mut at: impl FnMut(f64) -> Tangent) {
    let (mut low, mut high) = (End { t: 0.0, tangent: None }, End { t: 1.0, tangent: None });
    let (mut t, mut lowest) = (first.clamp(0.0, 1.0), best);
    // the rate from which a short step of Newton's was made, and whether the bend can be trusted
    let (mut short, mut smooth) = (None, true);
    // the last two steps: Newton's may swing for ever between two ends where the bend jumps
    let mut steps = [1.0, 1.0];
    for turn in 0..PATIENCE {
        let here = at(t);
        lowest = lowest.min(here.value);
        match short {
            Some(before) if here.rate.abs() <= 0.5 * before => return,
            // beside a kink, or near the axis, the function bends sharply in one position only
            Some(_) => smooth = false,
            None => {}
        }
        let side = if here.rate > 0.0 { &mut high } else { &mut low };
        *side = End { t, tangent: Some(here) };
        let (crossing, floor) = meet(&low, &high);
        if floor >= lowest - EQUAL {
            return;
        }
        let newton = t - here.rate / here.bend;
        let shrinks = (newton - t).abs() <= 0.5 * steps[0];
        let curved = smooth && here.bend > 0.0 && newton > low.t && newton < high.t && shrinks;
        let next = if curved { newton } else { guess(&low, &high, crossing, turn % 2 == 0) };
        let moved = (next - t).abs() * length;
        if moved < EQUAL && !curved {
            at(next);
            return;
        }
        short = (curved && moved < SHORT).then_some(here.rate.abs());
        steps = [steps[1], (next - t).abs()];
        t = next;
    }
}

/// One end of the interval that holds the minimum; its tangent once it has been visited.
#[derive(Clone, Copy)]
struct End {
    t: f64,
    tangent: Option<Tangent>,
}

/// Where the tangents of the ends meet, and how low: nothing between the ends is lower.
fn meet(low: &End, high: &End) -> (f64, f64) {
    let width = high.t - low.t;
    match (low.tangent, high.tangent) {
        (Some(a), Some(b)) => {
            let fall = b.rate - a.rate;
            let x = if fall > 0.0 { ((a.value - b.value + b.rate * width) / fall).clamp(0.0, width) } else { 0.0 };
            (low.t + x, (a.value + a.rate * x).min(b.value - b.rate * (width - x)))
        }
        (Some(a), None) => (high.t, a.value + a.rate * width),
        (None, Some(b)) => (low.t, b.value - b.rate * width),
        (None, None) => (low.t, f64::NEG_INFINITY),
    }
}

/// Where to look without a second derivative: an end that is new, else by turns where the derivative would vanish if it
/// were linear (a smooth minimum) and where the tangents meet (a kink).
fn guess(low: &End, high: &End, crossing: f64, smooth: bool) -> f64 {
    match (low.tangent, high.tangent) {
        (Some(a), Some(b)) if smooth && b.rate > a.rate => {
            let share = -a.rate / (b.rate - a.rate);
            low.t + (high.t - low.t) * share.clamp(0.05, 0.95)
        }
        _ => crossing,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Lowest value met, and how often the function was asked.
    fn lowest(first: f64, best: f64, at: impl Fn(f64) -> Tangent) -> (f64, usize) {
        let (mut value, mut calls) = (best, 0);
        lower(first, 1.0, best, |t| {
            calls += 1;
            value = value.min(at(t).value);
            at(t)
        });
        (value, calls)
    }

    proptest! {
        #[test]
        fn a_parabola_takes_one_newton_step(first in 0.0..1.0_f64, at in -0.5..1.5_f64) {
            let parabola = |t: f64| Tangent { value: (t - at).powi(2), rate: 2.0 * (t - at), bend: 2.0 };
            let (value, calls) = lowest(first, f64::INFINITY, parabola);
            prop_assert!((value - parabola(at.clamp(0.0, 1.0)).value).abs() < 1e-10);
            prop_assert!(calls <= 4, "{calls}");
        }

        #[test]
        fn a_jump_of_the_bend_is_no_trap(first in 0.0..1.0_f64, at in 0.05..0.95_f64, steep in 1.0..100.0_f64,
                                         kink in 0.0..1.0_f64) {
            // two parabolas that meet smoothly at the kink, one much more bent than the other
            let bends = |t: f64| if t < kink { 1.0 } else { steep };
            let rate = |t: f64| (t - kink) * bends(t) - (at - kink) * bends(at);
            let value = |t: f64| 0.5 * (t - kink).powi(2) * bends(t) - (at - kink) * bends(at) * (t - kink);
            let (found, calls) = lowest(first, f64::INFINITY, |t| Tangent { value: value(t), rate: rate(t), bend: bends(t) });
            prop_assert!((found - value(at)).abs() < 1e-9, "{found} {} after {calls}", value(at));
            prop_assert!(calls < 40, "{calls}");
        }

        #[test]
        fn a_kink_is_found_without_second_derivatives(first in 0.0..1.0_f64, at in 0.0..1.0_f64, steep in 0.1..10.0_f64) {
            let kink = |t: f64| if t < at {
                Tangent { value: at - t, rate: -1.0, bend: 0.0 }
            } else {
                Tangent { value: steep * (t - at), rate: steep, bend: 0.0 }
            };
            prop_assert!(lowest(first, f64::INFINITY, kink).0 < 1e-8);
        }
    }

    #[test]
    fn one_tangent_is_enough_where_nothing_can_be_lower() {
        let line = |t: f64| Tangent { value: 1.0 + t, rate: 1.0, bend: 0.0 };
        let (value, calls) = lowest(0.5, 0.9, line);
        assert_eq!((value, calls), (0.9, 1));
    }
}
