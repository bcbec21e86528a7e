//! A number with its first and second derivatives in two variables: what a formula is evaluated on.

use std::str::FromStr;

/// Value, gradient and second derivatives, carried exactly through every operation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Jet {
    /// The value.
    pub value: f64,
    /// Derivatives by the first and the second variable.
    pub first: [f64; 2],
    /// Second derivatives: first-first, first-second, second-second.
    pub second: [f64; 3],
    /// A number, whatever the variables: its derivatives are zero and stay so, also where a function's are infinite.
    fixed: bool,
}

impl Jet {
    /// A number that depends on neither variable.
    pub fn constant(value: f64) -> Self {
        Self { value, fixed: true, ..Self::default() }
    }

    /// The first (0) or second (1) variable itself.
    pub fn variable(value: f64, index: usize) -> Self {
        let first = if index == 0 { [1.0, 0.0] } else { [0.0, 1.0] };
        Self { value, first, ..Self::default() }
    }

    /// Where something that cannot happen happened: refused as not finite.
    pub fn nan() -> Self {
        Self::constant(f64::NAN)
    }

    pub fn add(self, other: Self) -> Self {
        self.combine(other, 1.0)
    }

    pub fn sub(self, other: Self) -> Self {
        self.combine(other, -1.0)
    }

    fn combine(self, other: Self, sign: f64) -> Self {
        Self {
            value: self.value + sign * other.value,
            first: std::array::from_fn(|i| self.first[i] + sign * other.first[i]),
            second: std::array::from_fn(|i| self.second[i] + sign * other.second[i]),
            fixed: self.fixed && other.fixed,
        }
    }

    fn scale(self, factor: f64) -> Self {
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
        let first: [f64; 2] = std::array::from_fn(|i| (self.first[i] - value * other.first[i]) / other.value);
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
            let (value, log) = (libm::pow(self.value, exponent.value), libm::log(self.value));
            return exponent.chain(value, value * log, value * log * log);
        }
        exponent.mul(self.ln()).exp()
    }

    /// x^n with a constant n: exact also at x = 0 and, for whole n, below.
    fn power(self, n: f64) -> Self {
        let x = self.value;
        let term = |factor: f64, n: f64| if factor == 0.0 { 0.0 } else { factor * real_power(x, n) };
        self.chain(real_power(x, n), term(n, n - 1.0), term(n * (n - 1.0), n - 2.0))
    }

    /// f(x), given f, f' and f'' at the value.
    fn chain(self, value: f64, d: f64, dd: f64) -> Self {
        if self.fixed {
            return Self::constant(value);
        }
        Self {
            value,
            first: self.first.map(|x| d * x),
            second: std::array::from_fn(|k| {
                let (i, j) = PAIRS[k];
                d * self.second[k] + dd * (self.first[i] * self.first[j])
            }),
            fixed: false,
        }
    }

    pub fn neg(self) -> Self {
        self.scale(-1.0)
    }

    pub fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root, -0.25 / (root * self.value))
    }

    pub fn exp(self) -> Self {
        let e = libm::exp(self.value);
        self.chain(e, e, e)
    }

    pub fn ln(self) -> Self {
        let inverse = 1.0 / self.value;
        self.chain(libm::log(self.value), inverse, -inverse * inverse)
    }

    pub fn log10(self) -> Self {
        let inverse = 1.0 / self.value;
        let d = inverse * std::f64::consts::LOG10_E;
        self.chain(libm::log10(self.value), d, -d * inverse)
    }

    pub fn sin(self) -> Self {
        let (sin, cos) = libm::sincos(angle(self.value));
        self.chain(sin, cos, -sin)
    }

    pub fn cos(self) -> Self {
        let (sin, cos) = libm::sincos(angle(self.value));
        self.chain(cos, -sin, -cos)
    }

    pub fn tan(self) -> Self {
        let tan = libm::tan(angle(self.value));
        let d = 1.0 + tan * tan;
        self.chain(tan, d, 2.0 * tan * d)
    }

    pub fn asin(self) -> Self {
        let (d, dd) = arc_sine_derivatives(self.value);
        self.chain(libm::asin(self.value), d, dd)
    }

    pub fn acos(self) -> Self {
        let (d, dd) = arc_sine_derivatives(self.value);
        self.chain(libm::acos(self.value), -d, -dd)
    }

    pub fn atan(self) -> Self {
        let d = 1.0 / (1.0 + self.value * self.value);
        self.chain(libm::atan(self.value), d, -2.0 * self.value * d * d)
    }

    pub fn sinh(self) -> Self {
        let (sinh, cosh) = (libm::sinh(self.value), libm::cosh(self.value));
        self.chain(sinh, cosh, sinh)
    }

    pub fn cosh(self) -> Self {
        let (sinh, cosh) = (libm::sinh(self.value), libm::cosh(self.value));
        self.chain(cosh, sinh, cosh)
    }

    pub fn tanh(self) -> Self {
        let tanh = libm::tanh(self.value);
        let d = 1.0 - tanh * tanh;
        self.chain(tanh, d, -2.0 * tanh * d)
    }
}

/// Which two variables each second derivative is by.
const PAIRS: [(usize, usize); 3] = [(0, 0), (0, 1), (1, 1)];

/// Whole powers up to here are multiplied out: quicker than `pow`, and the same everywhere.
const MULTIPLIED_OUT: f64 = 32.0;

/// An angle that has a sine worth the name: beyond a million radians rounding eats it, and the reduction takes long.
fn angle(x: f64) -> f64 {
    if x.abs() <= 1e6 {
        x
    } else {
        f64::NAN
    }
}

fn real_power(x: f64, n: f64) -> f64 {
    let size = n.abs();
    if size > MULTIPLIED_OUT || size.fract() != 0.0 {
        return libm::pow(x, n);
    }
    let (mut square, mut rest, mut product) = (x, size as u32, 1.0);
    while rest > 0 {
        if rest & 1 == 1 {
            product *= square;
        }
        square *= square;
        rest >>= 1;
    }
    if n < 0.0 {
        1.0 / product
    } else {
        product
    }
}

fn arc_sine_derivatives(x: f64) -> (f64, f64) {
    let square = (1.0 - x) * (1.0 + x);
    let d = 1.0 / square.sqrt();
    (d, x * d / square)
}

impl FromStr for Jet {
    type Err = std::num::ParseFloatError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        text.parse().map(Self::constant)
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
