//! Taylor series of a function of one variable, with intervals as coefficients.
//!
//! About a point, or about every point of an interval at once: what is computed holds the k-th derivative over k! for
//! each of them. The recurrences are those of Moore, Interval Analysis (1966), chapter 11.

use std::str::FromStr;

use super::interval::Interval;
use super::number::{multiplied_out, small_whole, Number};

/// Highest power.
pub(super) const ORDER: usize = 10;

/// Coefficients, lowest first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Series {
    pub terms: [Interval; ORDER + 1],
    /// A number: all terms but the first are zero and stay so, whatever a function's derivatives.
    fixed: bool,
}

impl Series {
    /// A number that does not depend on the variable.
    pub fn constant(value: Interval) -> Self {
        let mut terms = [Interval::default(); ORDER + 1];
        terms[0] = value;
        Self { terms, fixed: true }
    }

    /// What has these coefficients.
    pub fn new(terms: [Interval; ORDER + 1]) -> Self {
        Self { terms, fixed: false }
    }

    /// `at` + `rate` times the variable.
    pub fn linear(at: Interval, rate: f64) -> Self {
        let mut terms = [Interval::default(); ORDER + 1];
        (terms[0], terms[1]) = (at, Interval::exact(rate));
        Self::new(terms)
    }

    /// Nothing is known of it.
    pub fn undecided() -> Self {
        Self::new([Interval::UNDECIDED; ORDER + 1])
    }

    fn value(&self) -> Interval {
        self.terms[0]
    }

    /// Terms one after the other, each from those before; of a number only the first.
    fn built(self, value: Interval, next: impl Fn(&[Interval; ORDER + 1], usize) -> Interval) -> Self {
        if self.fixed {
            return Self::constant(value);
        }
        let mut terms = [Interval::default(); ORDER + 1];
        terms[0] = value;
        for k in 1..=ORDER {
            terms[k] = next(&terms, k);
        }
        Self::new(terms)
    }

    /// The k-th term of the function whose derivative is that of this one times `factor`.
    fn integrated(&self, factor: &[Interval; ORDER + 1], k: usize) -> Interval {
        let mut sum = Interval::default();
        for j in (1..=k).filter(|j| !self.terms[*j].is_zero()) {
            sum = sum + Interval::exact(j as f64) * self.terms[j] * factor[k - j];
        }
        sum / Interval::exact(k as f64)
    }

    fn each(self, f: impl Fn(Interval) -> Interval) -> Self {
        Self { terms: self.terms.map(f), fixed: self.fixed }
    }

    fn both(self, other: Self, f: impl Fn(Interval, Interval) -> Interval) -> Self {
        let terms = std::array::from_fn(|k| f(self.terms[k], other.terms[k]));
        Self { terms, fixed: self.fixed && other.fixed }
    }

    pub fn add(self, other: Self) -> Self {
        self.both(other, |a, b| a + b)
    }

    pub fn sub(self, other: Self) -> Self {
        self.both(other, |a, b| a - b)
    }

    pub fn neg(self) -> Self {
        self.each(|x| -x)
    }

    fn scaled(self, factor: Interval) -> Self {
        if self.fixed {
            return Self::constant(self.value() * factor);
        }
        self.each(|x| x * factor)
    }

    pub fn mul(self, other: Self) -> Self {
        if self.fixed {
            return other.scaled(self.value());
        }
        if other.fixed {
            return self.scaled(other.value());
        }
        let mut terms = [Interval::default(); ORDER + 1];
        for j in (0..=ORDER).filter(|j| !self.terms[*j].is_zero()) {
            for (term, factor) in terms[j..].iter_mut().zip(&other.terms) {
                *term = *term + self.terms[j] * *factor;
            }
        }
        Self::new(terms)
    }

    fn square(self) -> Self {
        if self.fixed {
            return Self::constant(self.value().square());
        }
        let mut product = self.mul(self);
        product.terms[0] = self.value().square();
        product
    }

    pub fn div(self, other: Self) -> Self {
        let divisor = other.value();
        if other.fixed {
            let fixed = self.fixed;
            return Self { fixed, ..self.each(|x| x / divisor) };
        }
        let mut terms = [Interval::default(); ORDER + 1];
        for k in 0..=ORDER {
            let mut rest = self.terms[k];
            for j in (1..=k).filter(|j| !other.terms[*j].is_zero()) {
                rest = rest - other.terms[j] * terms[k - j];
            }
            terms[k] = rest / divisor;
        }
        Self::new(terms)
    }

    pub fn pow(self, exponent: Self) -> Self {
        if exponent.fixed {
            return self.power(exponent.value());
        }
        exponent.mul(self.ln()).exp()
    }

    /// x^n with a constant n.
    fn power(self, n: Interval) -> Self {
        if self.fixed {
            return Self::constant(self.value().power(n));
        }
        if let Some(whole) = small_whole(n.lo).filter(|_| n.lo >= n.hi) {
            let size = self.multiplied_out(whole);
            return if n.lo < 0.0 { Self::constant(Interval::exact(1.0)).div(size) } else { size };
        }
        let x = self.value();
        self.built(x.power(n), |terms, k| {
            // x y' = n x' y
            let mut sum = Interval::default();
            for j in (1..=k).filter(|j| !self.terms[*j].is_zero()) {
                let factor = n * Interval::exact(j as f64) - Interval::exact((k - j) as f64);
                sum = sum + factor * self.terms[j] * terms[k - j];
            }
            sum / x / Interval::exact(k as f64)
        })
    }

    fn multiplied_out(self, n: u32) -> Self {
        let (mut square, mut rest, mut product) = (self, n, Self::constant(Interval::exact(1.0)));
        while rest > 0 {
            if rest & 1 == 1 {
                product = product.mul(square);
            }
            rest >>= 1;
            if rest > 0 {
                square = square.square();
            }
        }
        product.terms[0] = multiplied_out_value(self.value(), n);
        product
    }

    pub fn sqrt(self) -> Self {
        let root = self.power(Interval::exact(0.5));
        let mut terms = root.terms;
        terms[0] = self.value().sqrt();
        Self { terms, ..root }
    }

    pub fn exp(self) -> Self {
        self.built(self.value().exp(), |terms, k| self.integrated(terms, k))
    }

    /// The function of this one with a derivative f'(x).
    fn with_derivative(self, value: Interval, derivative: impl Fn(Self) -> Self) -> Self {
        if self.fixed {
            return Self::constant(value);
        }
        let factor = derivative(self);
        self.built(value, |_, k| self.integrated(&factor.terms, k))
    }

    pub fn ln(self) -> Self {
        self.with_derivative(self.value().ln(), |x| one().div(x))
    }

    pub fn log10(self) -> Self {
        let scale = Self::constant(Interval::nearest(std::f64::consts::LOG10_E));
        self.with_derivative(self.value().log10(), |x| scale.div(x))
    }

    /// Sine and cosine, or with `sign` = 1 the hyperbolic ones, from their values.
    fn waves(self, sine: Interval, cosine: Interval, sign: f64) -> [Self; 2] {
        if self.fixed {
            return [sine, cosine].map(Self::constant);
        }
        let (mut s, mut c) = ([Interval::default(); ORDER + 1], [Interval::default(); ORDER + 1]);
        (s[0], c[0]) = (sine, cosine);
        for k in 1..=ORDER {
            (s[k], c[k]) = (self.integrated(&c, k), Interval::exact(sign) * self.integrated(&s, k));
        }
        [s, c].map(Self::new)
    }

    pub fn sin(self) -> Self {
        let (sine, cosine) = self.value().sin_cos();
        self.waves(sine, cosine, -1.0)[0]
    }

    pub fn cos(self) -> Self {
        let (sine, cosine) = self.value().sin_cos();
        self.waves(sine, cosine, -1.0)[1]
    }

    pub fn sinh(self) -> Self {
        self.waves(self.value().sinh(), self.value().cosh(), 1.0)[0]
    }

    pub fn cosh(self) -> Self {
        self.waves(self.value().sinh(), self.value().cosh(), 1.0)[1]
    }

    /// y of y' = (1 + `sign` y^2) x'.
    fn tangent(self, value: Interval, sign: f64) -> Self {
        let sign = Interval::exact(sign);
        self.built(value, |terms, k| {
            let mut factor = [Interval::default(); ORDER + 1];
            for (m, f) in factor.iter_mut().enumerate().take(k) {
                let square = (0..=m).fold(Interval::default(), |sum, i| sum + terms[i] * terms[m - i]);
                *f = sign * if m == 0 { terms[0].square() } else { square };
            }
            factor[0] = factor[0] + Interval::exact(1.0);
            self.integrated(&factor, k)
        })
    }

    pub fn tan(self) -> Self {
        self.tangent(self.value().tan(), 1.0)
    }

    pub fn tanh(self) -> Self {
        self.tangent(self.value().tanh(), -1.0)
    }

    pub fn asin(self) -> Self {
        self.with_derivative(self.value().asin(), |x| one().div(one().sub(x).mul(one().add(x)).sqrt()))
    }

    pub fn acos(self) -> Self {
        self.with_derivative(self.value().acos(), |x| one().neg().div(one().sub(x).mul(one().add(x)).sqrt()))
    }

    pub fn atan(self) -> Self {
        self.with_derivative(self.value().atan(), |x| one().div(one().add(x.square())))
    }
}

fn one() -> Series {
    Series::constant(Interval::exact(1.0))
}

/// The value of a power, which none of the products before it lets be negative by its even exponent.
fn multiplied_out_value(x: Interval, n: u32) -> Interval {
    if n.is_multiple_of(2) {
        x.power(Interval::exact(f64::from(n)))
    } else {
        multiplied_out(x, n)
    }
}

impl FromStr for Series {
    type Err = std::num::ParseFloatError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        text.parse().map(|number| Self::constant(Interval::exact(number)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Unary = fn(Series) -> Series;

    /// Functions with their first terms about 0.3, worked out by mpmath 1.3: taylor(f, 0.3, 10), terms 0, 3 and 10.
    const AT_0_3: [(&str, Unary, [f64; 3]); 20] = [
        ("square", |x| x.mul(x), [0.09, 0.0, 0.0]),
        ("x^7", |x| x.pow(number(7.0)), [0.00021869999999999995, 0.2835, 0.0]),
        ("x^-3", |x| x.pow(number(-3.0)), [37.03703703703704, -13717.421124828536, 413968813.0949628]),
        ("x^2.5", |x| x.pow(number(2.5)), [0.049295030175464945, 0.570544330734548, -4.553933716938894]),
        ("x^x", |x| x.pow(x), [0.696845301935949, -1.5283356830017627, 661.2742000755173]),
        ("2^x", |x| number(2.0).pow(x), [1.2311444133449163, 0.06833357330038425, 8.685615028591432e-09]),
        ("sqrt", Series::sqrt, [0.5477225575051661, 1.267876290521218, -860.1874798662355]),
        ("exp", Series::exp, [1.3498588075760032, 0.22497646792933385, 3.719849006768086e-07]),
        ("ln", Series::ln, [-1.2039728043259361, 12.34567901234568, -16935.087808430293]),
        ("log10", Series::log10, [-0.5228787452803376, 5.361660270410517, -7354.815185748311]),
        ("sin", Series::sin, [0.29552020666133955, -0.15922274818760102, -8.143744672104816e-08]),
        ("cos", Series::cos, [0.955336489125606, 0.04925336777688993, -2.632651259715625e-07]),
        ("tan", Series::tan, [0.30933624960962325, 0.4700749222790018, 0.0706236321240147]),
        ("asin", Series::asin, [0.3046926540153975, 0.2489586819892653, 0.3835698455351633]),
        ("acos", Series::acos, [1.2661036727794992, -0.2489586819892653, -0.3835698455351633]),
        ("atan", Series::atan, [0.2914567944778671, -0.1878979801481923, -0.014628628195862971]),
        ("sinh", Series::sinh, [0.3045202934471426, 0.1742230856881434, 8.391762936704767e-08]),
        ("cosh", Series::cosh, [1.0453385141288605, 0.050753382241190435, 2.880672713097609e-07]),
        ("tanh", Series::tanh, [0.2913126124515909, -0.22738435101685395, -0.010005089726990251]),
        ("x / (1 + x)", |x| x.div(one().add(x)), [0.23076923076923075, 0.3501277966457757, -0.05579857714338902]),
    ];

    fn number(x: f64) -> Series {
        Series::constant(Interval::exact(x))
    }

    #[test]
    fn terms_are_those_of_the_functions() {
        for (name, f, expected) in AT_0_3 {
            let found = f(Series::linear(Interval::exact(0.3), 1.0));
            for (k, value) in [0, 3, 10].into_iter().zip(expected) {
                let slack = 1e-15 * value.abs().max(1e-3);
                let term = found.terms[k];
                assert!(term.lo - slack <= value && value <= term.hi + slack, "{name}, term {k}: {term:?} {value}");
                assert!(term.hi - term.lo <= 1e-10 * value.abs().max(1e-6), "{name}, term {k}: {term:?}");
            }
        }
    }

    #[test]
    fn terms_about_an_interval_hold_those_about_its_points() {
        for (name, f, _) in AT_0_3 {
            let wide = f(Series::linear(Interval::new(0.28, 0.33), 1.0));
            for at in [0.28, 0.29, 0.3, 0.317, 0.33] {
                let point = f(Series::linear(Interval::exact(at), 1.0));
                for k in 0..=ORDER {
                    let (w, p) = (wide.terms[k], point.terms[k]);
                    assert!(w.lo <= p.hi && p.lo <= w.hi, "{name} about {at}, term {k}: {w:?} {p:?}");
                }
            }
        }
    }

    #[test]
    fn numbers_stay_numbers_and_what_is_not_smooth_is_not_known() {
        let zero = Series::constant(Interval::exact(0.0));
        assert_eq!(zero.sqrt(), zero);
        let x = Series::linear(Interval::new(0.0, 0.1), 1.0);
        assert!(x.sqrt().terms[1].size().is_nan() && x.sqrt().terms[0].size() < 0.4);
        assert_eq!(x.pow(Series::constant(Interval::exact(2.0))).terms[2], Interval::exact(1.0));
    }
}
