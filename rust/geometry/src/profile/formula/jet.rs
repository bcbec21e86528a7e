//! A number with its first and second derivatives in two variables: what a formula is evaluated on.

use std::str::FromStr;

use super::number::Number;

/// Value, gradient and second derivatives, carried exactly through every operation: at a point, or as intervals that
/// hold them all over a box.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Jet<T = f64> {
    /// The value.
    pub value: T,
    /// Derivatives by the first and the second variable.
    pub first: [T; 2],
    /// Second derivatives: first-first, first-second, second-second.
    pub second: [T; 3],
    /// A number, whatever the variables: its derivatives are zero and stay so, also where a function's are infinite.
    fixed: bool,
}

impl<T: Number> Jet<T> {
    /// A number that depends on neither variable.
    pub fn constant(value: T) -> Self {
        Self { value, fixed: true, ..Self::default() }
    }

    /// The first (0) or second (1) variable itself.
    pub fn variable(value: T, index: usize) -> Self {
        let (one, zero) = (T::exact(1.0), T::default());
        let first = if index == 0 { [one, zero] } else { [zero, one] };
        Self { value, first, ..Self::default() }
    }

    /// Where something that cannot happen happened: refused as not finite.
    pub fn nan() -> Self {
        Self::constant(T::exact(f64::NAN))
    }

    pub fn add(self, other: Self) -> Self {
        self.combine(other, |a, b| a + b)
    }

    pub fn sub(self, other: Self) -> Self {
        self.combine(other, |a, b| a - b)
    }

    fn combine(self, other: Self, by: impl Fn(T, T) -> T) -> Self {
        Self {
            value: by(self.value, other.value),
            first: std::array::from_fn(|i| by(self.first[i], other.first[i])),
            second: std::array::from_fn(|i| by(self.second[i], other.second[i])),
            fixed: self.fixed && other.fixed,
        }
    }

    fn scale(self, factor: T) -> Self {
        if self.fixed {
            return Self::constant(self.value * factor);
        }
        Self {
            value: self.value * factor,
            first: self.first.map(|d| d * factor),
            second: self.second.map(|d| d * factor),
            fixed: false,
        }
    }

    pub fn mul(self, other: Self) -> Self {
        if self.fixed {
            return other.scale(self.value);
        }
        if other.fixed {
            return self.scale(other.value);
        }
        let (x, y) = (self, other);
        Self {
            value: x.value * y.value,
            first: std::array::from_fn(|i| x.first[i] * y.value + x.value * y.first[i]),
            second: std::array::from_fn(|k| {
                let (i, j) = PAIRS[k];
                x.second[k] * y.value + (x.first[i] * y.first[j] + x.first[j] * y.first[i]) + x.value * y.second[k]
            }),
            fixed: false,
        }
    }

    pub fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        if other.fixed {
            let mut quotient = self;
            quotient.value = value;
            quotient.first = self.first.map(|d| d / other.value);
            quotient.second = self.second.map(|d| d / other.value);
            return if self.fixed { Self::constant(value) } else { quotient };
        }
        let first: [T; 2] = std::array::from_fn(|i| (self.first[i] - value * other.first[i]) / other.value);
        let second = std::array::from_fn(|k| {
            let (i, j) = PAIRS[k];
            let cross = first[i] * other.first[j] + first[j] * other.first[i];
            (self.second[k] - cross - value * other.second[k]) / other.value
        });
        Self { value, first, second, fixed: false }
    }

    pub fn pow(self, exponent: Self) -> Self {
        if exponent.fixed {
            return self.power(exponent.value);
        }
        if self.fixed {
            let (value, log) = (self.value.pow(exponent.value), self.value.ln());
            return exponent.chain(value, value * log, value * log * log);
        }
        exponent.mul(self.ln()).exp()
    }

    /// x^n with a constant n: exact also at x = 0 and, for whole n, below.
    fn power(self, n: T) -> Self {
        let (x, one) = (self.value, T::exact(1.0));
        let term = |factor: T, n: T| if factor.is_zero() { factor } else { factor * x.power(n) };
        self.chain(x.power(n), term(n, n - one), term(n * (n - one), n - T::exact(2.0)))
    }

    /// f(x), given f, f' and f'' at the value.
    fn chain(self, value: T, d: T, dd: T) -> Self {
        if self.fixed {
            return Self::constant(value);
        }
        Self {
            value,
            first: self.first.map(|x| d * x),
            second: std::array::from_fn(|k| {
                let (i, j) = PAIRS[k];
                let both = if i == j { self.first[i].square() } else { self.first[i] * self.first[j] };
                d * self.second[k] + dd * both
            }),
            fixed: false,
        }
    }

    pub fn neg(self) -> Self {
        self.scale(T::exact(-1.0))
    }

    pub fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, T::exact(0.5) / root, T::exact(-0.25) / (root * self.value))
    }

    pub fn exp(self) -> Self {
        let e = self.value.exp();
        self.chain(e, e, e)
    }

    pub fn ln(self) -> Self {
        let inverse = T::exact(1.0) / self.value;
        self.chain(self.value.ln(), inverse, -inverse.square())
    }

    pub fn log10(self) -> Self {
        let inverse = T::exact(1.0) / self.value;
        let d = inverse * T::nearest(std::f64::consts::LOG10_E);
        self.chain(self.value.log10(), d, -d * inverse)
    }

    pub fn sin(self) -> Self {
        let (sin, cos) = self.value.sin_cos();
        self.chain(sin, cos, -sin)
    }

    pub fn cos(self) -> Self {
        let (sin, cos) = self.value.sin_cos();
        self.chain(cos, -sin, -cos)
    }

    pub fn tan(self) -> Self {
        let tan = self.value.tan();
        let d = T::exact(1.0) + tan.square();
        self.chain(tan, d, T::exact(2.0) * tan * d)
    }

    pub fn asin(self) -> Self {
        let (d, dd) = arc_sine_derivatives(self.value);
        self.chain(self.value.asin(), d, dd)
    }

    pub fn acos(self) -> Self {
        let (d, dd) = arc_sine_derivatives(self.value);
        self.chain(self.value.acos(), -d, -dd)
    }

    pub fn atan(self) -> Self {
        let d = T::exact(1.0) / (T::exact(1.0) + self.value.square());
        self.chain(self.value.atan(), d, T::exact(-2.0) * self.value * d * d)
    }

    pub fn sinh(self) -> Self {
        let (sinh, cosh) = (self.value.sinh(), self.value.cosh());
        self.chain(sinh, cosh, sinh)
    }

    pub fn cosh(self) -> Self {
        let (sinh, cosh) = (self.value.sinh(), self.value.cosh());
        self.chain(cosh, sinh, cosh)
    }

    pub fn tanh(self) -> Self {
        let tanh = self.value.tanh();
        let d = T::exact(1.0) - tanh.square();
        self.chain(tanh, d, T::exact(-2.0) * tanh * d)
    }
}

/// Which two variables each second derivative is by.
const PAIRS: [(usize, usize); 3] = [(0, 0), (0, 1), (1, 1)];

fn arc_sine_derivatives<T: Number>(x: T) -> (T, T) {
    let one = T::exact(1.0);
    let square = (one - x) * (one + x);
    let d = one / square.sqrt();
    (d, x * d / square)
}

impl<T: Number> FromStr for Jet<T> {
    type Err = std::num::ParseFloatError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        text.parse().map(|number| Self::constant(T::exact(number)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// f(x, y) with all the operations; compared with central differences of itself.
    type Case = (fn(Jet, Jet) -> Jet, f64, f64);

    const CASES: [Case; 16] = [
        (|x, y| x.mul(y).add(x.div(y)).sub(y.neg()), 0.7, 1.3),
        (|x, y| x.pow(y), 0.7, 1.3),
        (|x, y| x.pow(Jet::constant(2.5)).mul(y), 0.7, 1.3),
        (|x, y| x.pow(Jet::constant(-3.0)).mul(y), -0.7, 1.3),
        (|x, y| Jet::constant(2.5).pow(x.mul(y)), 0.7, 1.3),
        (|x, y| x.mul(y).sqrt(), 0.7, 1.3),
        (|x, y| x.mul(y).exp(), 0.7, 1.3),
        (|x, y| x.mul(y).ln().mul(x.log10()), 0.7, 1.3),
        (|x, y| x.mul(y).sin().mul(x.cos()), 0.7, 1.3),
        (|x, y| x.mul(y).tan(), 0.7, 1.3),
        (|x, y| x.mul(y).asin(), 0.7, 0.3),
        (|x, y| x.mul(y).acos(), 0.7, 0.3),
        (|x, y| x.mul(y).atan(), 0.7, 1.3),
        (|x, y| x.mul(y).sinh(), 0.7, 1.3),
        (|x, y| x.mul(y).cosh(), 0.7, 1.3),
        (|x, y| x.mul(y).tanh().div(x.add(y)), 0.7, 1.3),
    ];

    fn at(f: fn(Jet, Jet) -> Jet, x: f64, y: f64) -> Jet {
        f(Jet::variable(x, 0), Jet::variable(y, 1))
    }

    #[test]
    fn derivatives_are_those_of_the_function() {
        let h = 1e-5;
        for (case, (f, x, y)) in CASES.into_iter().enumerate() {
            let here = at(f, x, y);
            let (right, left) = (at(f, x + h, y), at(f, x - h, y));
            let (up, down) = (at(f, x, y + h), at(f, x, y - h));
            let near = |exact: f64, difference: f64| {
                assert!((exact - difference).abs() < 1e-7 * (1.0 + exact.abs()), "{case}: {exact} {difference}");
            };
            near(here.first[0], (right.value - left.value) / (2.0 * h));
            near(here.first[1], (up.value - down.value) / (2.0 * h));
            near(here.second[0], (right.first[0] - left.first[0]) / (2.0 * h));
            near(here.second[1], (up.first[0] - down.first[0]) / (2.0 * h));
            near(here.second[2], (up.first[1] - down.first[1]) / (2.0 * h));
        }
    }

    #[test]
    fn powers_are_smooth_at_zero_and_constants_stay_constant() {
        let square = Jet::variable(0.0, 0).pow(Jet::constant(2.0));
        assert_eq!((square.first[0], square.second[0]), (0.0, 2.0));
        let line = Jet::variable(0.0, 0).pow(Jet::constant(1.0));
        assert_eq!((line.first[0], line.second[0]), (1.0, 0.0));
        assert_eq!(Jet::constant(0.0).sqrt(), Jet::constant(0.0));
    }
}
