//! What a formula is evaluated on beneath its derivatives: numbers, or intervals that enclose them.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real number, or an interval of them, with the functions of formulas.
pub(super) trait Number:
    Copy
    + Debug
    + Default
    + PartialEq
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// This very number.
    fn exact(x: f64) -> Self;
    /// A real number that `x` is the nearest f64 of.
    fn nearest(x: f64) -> Self;
    fn is_zero(self) -> bool;
    fn square(self) -> Self;
    /// x^n by `pow`.
    fn pow(self, n: Self) -> Self;
    /// x^n, multiplied out for whole n of little size.
    fn power(self, n: Self) -> Self;
    fn sqrt(self) -> Self;
    fn exp(self) -> Self;
    fn ln(self) -> Self;
    fn log10(self) -> Self;
    fn sin_cos(self) -> (Self, Self);
    fn tan(self) -> Self;
    fn asin(self) -> Self;
    fn acos(self) -> Self;
    fn atan(self) -> Self;
    fn sinh(self) -> Self;
    fn cosh(self) -> Self;
    fn tanh(self) -> Self;
}

impl Number for f64 {
    fn exact(x: f64) -> Self {
        x
    }

    fn nearest(x: f64) -> Self {
        x
    }

    fn is_zero(self) -> bool {
        self == 0.0
    }

    fn square(self) -> Self {
        self * self
    }

    fn pow(self, n: Self) -> Self {
        libm::pow(self, n)
    }

    fn power(self, n: Self) -> Self {
        match small_whole(n) {
            Some(size) if n < 0.0 => 1.0 / multiplied_out(self, size),
            Some(size) => multiplied_out(self, size),
            None => libm::pow(self, n),
        }
    }

    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    fn exp(self) -> Self {
        libm::exp(self)
    }

    fn ln(self) -> Self {
        libm::log(self)
    }

    fn log10(self) -> Self {
        libm::log10(self)
    }

    fn sin_cos(self) -> (Self, Self) {
        libm::sincos(angle(self))
    }

    fn tan(self) -> Self {
        libm::tan(angle(self))
    }

    fn asin(self) -> Self {
        libm::asin(self)
    }

    fn acos(self) -> Self {
        libm::acos(self)
    }

    fn atan(self) -> Self {
        libm::atan(self)
    }

    fn sinh(self) -> Self {
        libm::sinh(self)
    }

    fn cosh(self) -> Self {
        libm::cosh(self)
    }

    fn tanh(self) -> Self {
        libm::tanh(self)
    }
}

/// Whole powers up to here are multiplied out: quicker than `pow`, and the same everywhere.
const MULTIPLIED_OUT: f64 = 32.0;
/// Largest angle whose sine is meaningful: beyond, rounding exceeds it, and the reduction takes long.
const LARGEST_ANGLE: f64 = 1e6;

/// The size of a whole exponent that is multiplied out.
pub(super) fn small_whole(n: f64) -> Option<u32> {
    let size = n.abs();
    (size <= MULTIPLIED_OUT && size.fract() == 0.0).then_some(size as u32)
}

/// x^n.
pub(super) fn multiplied_out<T: Number>(x: T, n: u32) -> T {
    let (mut square, mut rest, mut product) = (x, n, T::exact(1.0));
    while rest > 0 {
        if rest & 1 == 1 {
            product = product * square;
        }
        square = square.square();
        rest >>= 1;
    }
    product
}

/// The angle, or NaN where it is too large.
pub(super) fn angle(x: f64) -> f64 {
    if x.abs() <= LARGEST_ANGLE {
        x
    } else {
        f64::NAN
    }
}
