//! Intervals that enclose: whatever the numbers in the operands, the result's interval holds the exact result.
//!
//! Bounds are rounded outwards: sums and the products of single numbers only where they are not exact, other operations
//! by one step of f64, elementary functions by [`ULPS`]. Where an operand may lie out of a function's domain, or at a
//! pole, the result is [`Interval::UNDECIDED`], which stays so through every operation: nothing can be proved by it.
//!
//! Ours, because the crates with elementary functions (inari) stand on MPFR, a C library, and the ones in pure Rust have
//! arithmetic only.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, PI};
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::number::{angle, multiplied_out, small_whole, Number};

/// What libm's functions may be wrong by, with a margin: its authors state less than 1, of sinh, cosh and tanh 2.
const ULPS: f64 = 4.0;
/// An extremum or pole this near to an interval of angles counts as in it, quarter turns.
const QUARTER_ROUNDING: f64 = 1e-9;
/// Below this the error of a product may be lost itself.
const ERROR_IS_A_NUMBER: f64 = 1e-250;

/// All numbers from `lo` to `hi`; both NaN where nothing is known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Interval {
    pub lo: f64,
    pub hi: f64,
}

impl Interval {
    /// What is not known, or not a number somewhere.
    pub const UNDECIDED: Self = Self { lo: f64::NAN, hi: f64::NAN };

    /// From `lo` to `hi`; undecided where that is none.
    pub fn new(lo: f64, hi: f64) -> Self {
        if lo <= hi {
            Self { lo, hi }
        } else {
            Self::UNDECIDED
        }
    }

    /// The numbers between two, in either order.
    pub fn between(a: f64, b: f64) -> Self {
        if a <= b {
            Self::new(a, b)
        } else {
            Self::new(b, a)
        }
    }

    /// From `-x` to `x`.
    pub fn around_zero(x: f64) -> Self {
        Self::new(-x, x)
    }

    /// It holds `x`.
    #[cfg(test)]
    pub fn holds(self, x: f64) -> bool {
        self.lo <= x && x <= self.hi
    }

    /// It lies within another one.
    pub fn is_within(self, other: Self) -> bool {
        other.lo <= self.lo && self.hi <= other.hi
    }

    /// Its numbers and those of another, and all between.
    pub fn joined(self, other: Self) -> Self {
        if self.is_undecided() || other.is_undecided() {
            return Self::UNDECIDED;
        }
        Self::new(self.lo.min(other.lo), self.hi.max(other.hi))
    }

    /// The largest size of its numbers; NaN where undecided.
    pub fn size(self) -> f64 {
        if self.is_undecided() {
            f64::NAN
        } else {
            self.lo.abs().max(self.hi.abs())
        }
    }

    fn is_undecided(self) -> bool {
        self.lo.is_nan() || self.hi.is_nan()
    }

    fn is_single(self) -> bool {
        self.lo >= self.hi
    }

    fn holds_zero(self) -> bool {
        self.lo <= 0.0 && self.hi >= 0.0
    }

    /// A rising function, by values that libm rounds.
    fn rising(self, f: impl Fn(f64) -> f64) -> Self {
        Self::new(below(f(self.lo)), above(f(self.hi)))
    }

    fn clamped(self, lo: f64, hi: f64) -> Self {
        Self::new(self.lo.clamp(lo, hi), self.hi.clamp(lo, hi))
    }

    /// x^n of positive numbers, and of 0 where n is positive.
    fn positive_power(self, n: Self) -> Self {
        if self.lo < 0.0 || (self.lo == 0.0 && n.lo <= 0.0) || n.is_undecided() {
            return Self::UNDECIDED;
        }
        // rising or falling in either alone: its extremes lie at corners
        let corners = [(self.lo, n.lo), (self.lo, n.hi), (self.hi, n.lo), (self.hi, n.hi)];
        let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
        for (x, n) in corners {
            let power = libm::pow(x, n);
            if power.is_nan() {
                return Self::UNDECIDED;
            }
            (lo, hi) = (lo.min(power), hi.max(power));
        }
        Self::new(if lo == 0.0 { 0.0 } else { below(lo).max(0.0) }, if self.hi == 0.0 { 0.0 } else { above(hi) })
    }

    /// x^n for a whole n: of even powers none is negative, odd ones rise.
    fn whole_power(self, n: f64) -> Self {
        if n < 0.0 {
            return Self::exact(1.0) / self.whole_power(-n);
        }
        let power = |size: f64| match small_whole(n) {
            Some(whole) => multiplied_out(Self::exact(size), whole),
            None => Self::exact(size).positive_power(Self::exact(n)),
        };
        if n % 2.0 == 0.0 {
            let least = if self.holds_zero() { 0.0 } else { self.lo.abs().min(self.hi.abs()) };
            return Self::new(power(least).lo, power(self.size()).hi);
        }
        let signed = |x: f64| if x < 0.0 { -power(-x) } else { power(x) };
        Self::new(signed(self.lo).lo, signed(self.hi).hi)
    }

    /// An angle in whole quarter turns, the interval they begin and end in; none where it is too large.
    fn quarters(self) -> Option<[f64; 2]> {
        let (lo, hi) = (angle(self.lo) * FRAC_2_PI, angle(self.hi) * FRAC_2_PI);
        let quarters = [(lo - QUARTER_ROUNDING).ceil(), (hi + QUARTER_ROUNDING).floor()];
        (!quarters[0].is_nan() && !quarters[1].is_nan()).then_some(quarters)
    }
}

/// A whole number that is `rest` but for multiples of `of` lies from `first` to `last`.
fn has_multiple([first, last]: [f64; 2], of: f64, rest: f64) -> bool {
    ((first - rest) / of).ceil() * of + rest <= last
}

/// Not above the number that libm gives as `x`.
fn below(x: f64) -> f64 {
    if x == f64::INFINITY {
        return f64::MAX;
    }
    (x - x.abs() * (ULPS * f64::EPSILON)).next_down()
}

/// Not below the number that libm gives as `x`.
fn above(x: f64) -> f64 {
    -below(-x)
}

/// a + b and the exact error of it (Knuth's two-sum); an error of NaN where it overflows.
fn sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    (sum, (a - (sum - b_part)) + (b - b_part))
}

fn sum_below(a: f64, b: f64) -> f64 {
    let (sum, error) = sum(a, b);
    if error >= 0.0 {
        sum
    } else {
        sum.next_down()
    }
}

/// Not above the exact product.
fn product_below(a: f64, b: f64) -> f64 {
    let product = a * b;
    if product == 0.0 && (a == 0.0 || b == 0.0 || (a > 0.0) == (b > 0.0)) {
        return 0.0;
    }
    product.next_down()
}

/// Not below the exact product.
fn product_above(a: f64, b: f64) -> f64 {
    -product_below(-a, b)
}

/// Not above the exact quotient.
fn quotient_below(a: f64, b: f64) -> f64 {
    let quotient = a / b;
    if quotient == 0.0 && (a == 0.0 || (a > 0.0) == (b > 0.0)) {
        return 0.0;
    }
    quotient.next_down()
}

impl Add for Interval {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::new(sum_below(self.lo, other.lo), -sum_below(-self.hi, -other.hi))
    }
}

impl Sub for Interval {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Interval {
    type Output = Self;

    fn neg(self) -> Self {
        Self { lo: -self.hi, hi: -self.lo }
    }
}

impl Mul for Interval {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let (a, b) = (self, other);
        if a.is_single() && b.is_single() {
            let product = a.lo * b.lo;
            if product.abs() > ERROR_IS_A_NUMBER && libm::fma(a.lo, b.lo, -product) == 0.0 {
                return Self::new(product, product);
            }
        }
        if a.lo >= 0.0 {
            let lo = product_below(if b.lo >= 0.0 { a.lo } else { a.hi }, b.lo);
            return Self::new(lo, product_above(if b.hi >= 0.0 { a.hi } else { a.lo }, b.hi));
        }
        if a.hi <= 0.0 {
            return -(-a * b);
        }
        if b.lo >= 0.0 || b.hi <= 0.0 {
            return b * a;
        }
        // both have numbers on either side of zero, or one is undecided
        let below = [product_below(a.lo, b.hi), product_below(a.hi, b.lo)];
        let above = [product_above(a.lo, b.lo), product_above(a.hi, b.hi)];
        if a.is_undecided() || b.is_undecided() || below.iter().chain(&above).any(|x| x.is_nan()) {
            return Self::UNDECIDED;
        }
        Self::new(below[0].min(below[1]), above[0].max(above[1]))
    }
}

impl Div for Interval {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let (a, b) = (self, other);
        if b.hi < 0.0 {
            return -a / -b;
        }
        if a.is_undecided() || b.is_undecided() || b.lo <= 0.0 {
            return Self::UNDECIDED;
        }
        if a.is_single() && b.is_single() && a.lo.abs() > ERROR_IS_A_NUMBER {
            let quotient = a.lo / b.lo;
            if libm::fma(quotient, b.lo, -a.lo) == 0.0 {
                return Self::new(quotient, quotient);
            }
        }
        let lo = quotient_below(a.lo, if a.lo >= 0.0 { b.hi } else { b.lo });
        Self::new(lo, -quotient_below(-a.hi, if a.hi >= 0.0 { b.lo } else { b.hi }))
    }
}

impl Number for Interval {
    fn exact(x: f64) -> Self {
        Self::new(x, x)
    }

    fn nearest(x: f64) -> Self {
        Self::new(x.next_down(), x.next_up())
    }

    fn is_zero(self) -> bool {
        self.lo == 0.0 && self.hi == 0.0
    }

    fn square(self) -> Self {
        if self.lo >= 0.0 || self.hi <= 0.0 {
            return self * self;
        }
        let size = self.size();
        Self::new(0.0, product_above(size, size))
    }

    fn pow(self, n: Self) -> Self {
        self.power(n)
    }

    fn power(self, n: Self) -> Self {
        if self.is_undecided() {
            return Self::UNDECIDED;
        }
        if n.is_single() && n.lo.fract() == 0.0 {
            return self.whole_power(n.lo);
        }
        self.positive_power(n)
    }

    fn sqrt(self) -> Self {
        let below = |x: f64| if x == 0.0 { 0.0 } else { x.sqrt().next_down() };
        let above = |x: f64| if x == 0.0 { 0.0 } else { x.sqrt().next_up() };
        Self::new(below(self.lo), above(self.hi))
    }

    fn exp(self) -> Self {
        let exp = self.rising(libm::exp);
        Self::new(exp.lo.max(0.0), exp.hi)
    }

    fn ln(self) -> Self {
        if self.lo > 0.0 {
            self.rising(libm::log)
        } else {
            Self::UNDECIDED
        }
    }

    fn log10(self) -> Self {
        if self.lo > 0.0 {
            self.rising(libm::log10)
        } else {
            Self::UNDECIDED
        }
    }

    fn sin_cos(self) -> (Self, Self) {
        let Some(quarters) = self.quarters() else { return (Self::UNDECIDED, Self::UNDECIDED) };
        let (a, b) = (libm::sincos(self.lo), libm::sincos(self.hi));
        // the quarter turn at which it is largest; two on it is smallest
        let within = |a: f64, b: f64, top: f64| {
            let lo = if has_multiple(quarters, 4.0, top + 2.0) { -1.0 } else { below(a.min(b)) };
            let hi = if has_multiple(quarters, 4.0, top) { 1.0 } else { above(a.max(b)) };
            Self::new(lo.max(-1.0), hi.min(1.0))
        };
        (within(a.0, b.0, 1.0), within(a.1, b.1, 0.0))
    }

    fn tan(self) -> Self {
        match self.quarters() {
            Some(quarters) if !has_multiple(quarters, 2.0, 1.0) => self.rising(libm::tan),
            _ => Self::UNDECIDED,
        }
    }

    fn asin(self) -> Self {
        if self.size() <= 1.0 {
            self.rising(libm::asin).clamped(-FRAC_PI_2.next_up(), FRAC_PI_2.next_up())
        } else {
            Self::UNDECIDED
        }
    }

    fn acos(self) -> Self {
        if self.size() <= 1.0 {
            (-self).rising(|x| libm::acos(-x)).clamped(0.0, PI.next_up())
        } else {
            Self::UNDECIDED
        }
    }

    fn atan(self) -> Self {
        self.rising(libm::atan)
    }

    fn sinh(self) -> Self {
        self.rising(libm::sinh)
    }

    fn cosh(self) -> Self {
        if self.holds_zero() {
            return Self::new(1.0, above(libm::cosh(self.size())));
        }
        let size = if self.lo > 0.0 { self } else { -self };
        let cosh = size.rising(libm::cosh);
        Self::new(cosh.lo.max(1.0), cosh.hi)
    }

    fn tanh(self) -> Self {
        self.rising(libm::tanh).clamped(-1.0, 1.0)
    }
}

#[cfg(test)]
mod tests;
