//! Enclosure, tightness and domains of interval arithmetic.

use proptest::prelude::*;

use super::super::jet::Jet;
use super::*;

/// Two numbers of any size and sign, and one from the first to the second, both ends among them.
fn intervals() -> impl Strategy<Value = (f64, f64, f64)> {
    let number = prop_oneof![
        -3.0..3.0f64,
        -1e3..1e3f64,
        prop_oneof![Just(0.0), Just(1.0), Just(-1.0), Just(FRAC_PI_2), Just(PI), Just(0.5)],
        (-12..4i32, -9.0..9.0f64).prop_map(|(e, m)| m * libm::pow(10.0, f64::from(e))),
    ];
    let width = prop_oneof![Just(0.0), 0.0..1e-9f64, 0.0..1.0f64, 0.0..30.0f64];
    let share = prop_oneof![Just(0.0), Just(1.0), 0.0..1.0f64];
    (number, width, share).prop_map(|(a, width, share)| (a, a + width, (a + share * width).clamp(a, a + width)))
}

/// A function of intervals, and what it ought to give.
struct Function {
    name: &'static str,
    over: fn(Interval) -> Interval,
    at: fn(f64) -> f64,
    /// It has a value everywhere in an interval; none so near to a pole that either answer is right.
    is_defined: fn(Interval) -> Option<bool>,
    /// Least and most value of any, where results are cut.
    range: [f64; 2],
    /// Values at its extremes inside an interval, if there are any.
    extremes: fn(Interval) -> Vec<f64>,
    /// How far its results are rounded outwards, in parts of the value's size, epsilons: at least, and at most.
    rounding: [f64; 2],
}

/// What libm may be wrong by (of sinh, cosh and tanh), and a few ulps for what an enclosure has to be.
const BY_LIBM: [f64; 2] = [2.0, 6.0];
const ANY: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
const ALL: fn(Interval) -> Option<bool> = |_| Some(true);
const NONE: fn(Interval) -> Vec<f64> = |_| Vec::new();

/// A function by libm that is defined everywhere, with values of any size and no extremes; fields set what differs.
const fn function(name: &'static str, over: fn(Interval) -> Interval, at: fn(f64) -> f64) -> Function {
    Function { name, over, at, is_defined: ALL, range: ANY, extremes: NONE, rounding: BY_LIBM }
}

const FUNCTIONS: [Function; 15] = [
    Function { rounding: [0.0, 0.0], ..function("neg", Interval::neg, f64::neg) },
    Function {
        range: [0.0, f64::INFINITY],
        extremes: |x| at_zero(x, 0.0),
        rounding: [0.0, 1.0],
        ..function("square", Interval::square, |x| x * x)
    },
    Function {
        is_defined: |x| Some(x.lo >= 0.0),
        range: [0.0, f64::INFINITY],
        rounding: [0.5, 1.0],
        ..function("sqrt", Interval::sqrt, f64::sqrt)
    },
    Function { range: [0.0, f64::INFINITY], ..function("exp", Interval::exp, libm::exp) },
    Function { is_defined: |x| Some(x.lo > 0.0), ..function("ln", Interval::ln, libm::log) },
    Function { is_defined: |x| Some(x.lo > 0.0), ..function("log10", Interval::log10, libm::log10) },
    Function {
        range: [-1.0, 1.0],
        extremes: |x| turning_points(x, FRAC_PI_2),
        ..function("sin", |x| x.sin_cos().0, libm::sin)
    },
    Function {
        range: [-1.0, 1.0],
        extremes: |x| turning_points(x, 0.0),
        ..function("cos", |x| x.sin_cos().1, libm::cos)
    },
    Function { is_defined: has_no_pole, ..function("tan", Interval::tan, libm::tan) },
    Function {
        is_defined: |x| Some(x.size() <= 1.0),
        range: [-FRAC_PI_2.next_up(), FRAC_PI_2.next_up()],
        ..function("asin", Interval::asin, libm::asin)
    },
    Function {
        is_defined: |x| Some(x.size() <= 1.0),
        range: [0.0, PI.next_up()],
        ..function("acos", Interval::acos, libm::acos)
    },
    function("atan", Interval::atan, libm::atan),
    function("sinh", Interval::sinh, libm::sinh),
    Function {
        range: [1.0, f64::INFINITY],
        extremes: |x| at_zero(x, 1.0),
        ..function("cosh", Interval::cosh, libm::cosh)
    },
    Function { range: [-1.0, 1.0], ..function("tanh", Interval::tanh, libm::tanh) },
];

impl Function {
    /// Its least and most value on an interval, as libm has them.
    fn values_on(&self, x: Interval) -> [f64; 2] {
        let mut values = (self.extremes)(x);
        values.extend([(self.at)(x.lo), (self.at)(x.hi)]);
        ends(&values).into()
    }

    /// An upper end encloses the value that libm gives, and lies no further from it than a few ulps.
    fn is_end(&self, value: f64, end: f64, most: f64) -> bool {
        // of what overflows, only that it is beyond the largest number is known
        if value.is_infinite() {
            return if value > 0.0 { end >= value } else { end.is_finite() && end <= f64::MIN };
        }
        let [least, furthest] = self.rounding.map(|parts| parts * f64::EPSILON * value.abs());
        (value + least).min(most) <= end && end <= value + furthest + 1e-323
    }
}

/// The least and the most of numbers.
fn ends(numbers: &[f64]) -> (f64, f64) {
    numbers.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| (lo.min(*x), hi.max(*x)))
}

fn at_zero(x: Interval, value: f64) -> Vec<f64> {
    if x.holds_zero() {
        vec![value]
    } else {
        Vec::new()
    }
}

/// 1 where one of the angles is `top` but for whole turns, -1 where one is half a turn from it.
fn turning_points(x: Interval, top: f64) -> Vec<f64> {
    let holds = |at: f64| ((x.lo - at) / (2.0 * PI)).ceil() <= ((x.hi - at) / (2.0 * PI)).floor();
    [(top, 1.0), (top + PI, -1.0)].into_iter().filter(|(at, _)| holds(*at)).map(|(_, value)| value).collect()
}

/// No pole of the tangent lies among angles; unknown where one is almost at an end.
fn has_no_pole(x: Interval) -> Option<bool> {
    let [lo, hi] = [x.lo, x.hi].map(|angle| (angle / PI) - 0.5);
    let is_clear = |halves: f64| (halves - halves.round()).abs() > 1e-8;
    (is_clear(lo) && is_clear(hi)).then(|| lo.floor() >= hi.floor())
}

impl Interval {
    fn overlaps(self, other: Self) -> bool {
        self.lo <= other.hi && other.lo <= self.hi
    }
}

type Binary = fn(Jet<Interval>, Jet<Interval>) -> Jet<Interval>;
type BinaryOnNumbers = fn(Jet, Jet) -> Jet;
type Unary = fn(Jet<Interval>) -> Jet<Interval>;
type UnaryOnNumbers = fn(Jet) -> Jet;

const BINARY: [(&str, Binary, BinaryOnNumbers); 5] = [
    ("+", Jet::add, Jet::add),
    ("-", Jet::sub, Jet::sub),
    ("*", Jet::mul, Jet::mul),
    ("/", Jet::div, Jet::div),
    ("^", Jet::pow, Jet::pow),
];
const UNARY: [(&str, Unary, UnaryOnNumbers); 14] = [
    ("neg", Jet::neg, Jet::neg),
    ("sqrt", Jet::sqrt, Jet::sqrt),
    ("exp", Jet::exp, Jet::exp),
    ("ln", Jet::ln, Jet::ln),
    ("log10", Jet::log10, Jet::log10),
    ("sin", Jet::sin, Jet::sin),
    ("cos", Jet::cos, Jet::cos),
    ("tan", Jet::tan, Jet::tan),
    ("asin", Jet::asin, Jet::asin),
    ("acos", Jet::acos, Jet::acos),
    ("atan", Jet::atan, Jet::atan),
    ("sinh", Jet::sinh, Jet::sinh),
    ("cosh", Jet::cosh, Jet::cosh),
    ("tanh", Jet::tanh, Jet::tanh),
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(debug_assertions) { 1000 } else { 20_000 }))]

    #[test]
    fn arithmetic_holds_its_numbers_and_no_more(a in intervals(), b in intervals()) {
        let (x, y) = (Interval::new(a.0, a.1), Interval::new(b.0, b.1));
        let corners = |f: fn(f64, f64) -> f64| [f(a.0, b.0), f(a.0, b.1), f(a.1, b.0), f(a.1, b.1)];
        for (name, found, exact, corners) in [
            ("+", x + y, a.2 + b.2, corners(f64::add)),
            ("-", x - y, a.2 - b.2, corners(f64::sub)),
            ("*", x * y, a.2 * b.2, corners(f64::mul)),
            ("/", x / y, a.2 / b.2, corners(f64::div)),
        ] {
            prop_assert_eq!(found.is_undecided(), name == "/" && y.holds_zero(), "{} {:?} {:?}", name, x, y);
            if !found.is_undecided() {
                let (lo, hi) = ends(&corners);
                prop_assert!(found.holds(exact), "{name} {x:?} {y:?}: {found:?} {exact}");
                prop_assert!(lo.next_down() <= found.lo && found.hi <= hi.next_up(), "{name} {x:?} {y:?}: {found:?}");
            }
        }
        prop_assert!(x.square().holds(a.2 * a.2) && x.square().lo >= 0.0);
    }

    #[test]
    fn functions_hold_their_values_and_no_more(a in intervals()) {
        for function in FUNCTIONS {
            let (x, name) = (Interval::new(a.0, a.1), function.name);
            let found = (function.over)(x);
            if let Some(defined) = (function.is_defined)(x) {
                prop_assert_eq!(!found.is_undecided(), defined, "{} {:?}", name, x);
            }
            if !found.is_undecided() {
                let [least, most] = function.values_on(x);
                prop_assert!(function.is_end(-least, -found.lo, -function.range[0]), "{name} {x:?}: {found:?} {least:e}");
                prop_assert!(function.is_end(most, found.hi, function.range[1]), "{name} {x:?}: {found:?} {most:e}");
                let value = (function.at)(a.2);
                prop_assert!(found.holds(value), "{name} {x:?} at {}: {found:?} {value:e}", a.2);
            }
        }
    }

    #[test]
    fn identities_hold(a in intervals(), b in intervals()) {
        let (x, y, one) = (Interval::new(a.0, a.1), Interval::new(b.0, b.1), Interval::exact(1.0));
        let half = Interval::exact(0.5);
        let (sin, cos) = x.sin_cos();
        prop_assert!(sin.square().overlaps(one - cos.square()), "{sin:?} {cos:?}");
        if x.lo > -300.0 && x.hi < 300.0 && y.lo > -300.0 && y.hi < 300.0 {
            let (rising, falling) = (x.exp(), (-x).exp());
            prop_assert!((rising * falling).holds(1.0), "exp {x:?}");
            prop_assert!((x + y).exp().overlaps(rising * y.exp()), "exp {x:?} {y:?}");
            prop_assert!(x.sinh().overlaps((rising - falling) * half), "sinh {x:?}");
            prop_assert!(x.cosh().overlaps((rising + falling) * half), "cosh {x:?}");
            prop_assert!((x.tanh() * x.cosh()).overlaps(x.sinh()), "tanh {x:?}");
            prop_assert!(x.is_within(rising.ln()), "ln of exp {x:?}");
        }
        if x.lo > 0.0 {
            prop_assert!(x.is_within(x.sqrt().square()) && x.is_within(x.ln().exp()), "{x:?}");
            prop_assert!((x.log10() * Interval::exact(10.0).ln()).overlaps(x.ln()), "log10 {x:?}");
        }
        if !x.tan().is_undecided() {
            prop_assert!((x.tan() * cos).overlaps(sin), "tan {x:?}");
        }
        if x.size() < 1e8 {
            prop_assert!(x.is_within(x.atan().tan()) || x.atan().tan().is_undecided(), "atan {x:?}");
        }
        if x.size() <= 1.0 {
            prop_assert!((x.asin() + x.acos()).holds(FRAC_PI_2), "{x:?}");
            prop_assert!(Interval::exact(x.lo).asin().sin_cos().0.holds(x.lo), "asin {x:?}");
            prop_assert!(Interval::exact(x.lo).acos().sin_cos().1.holds(x.lo), "acos {x:?}");
        }
    }

    #[test]
    fn powers_hold_their_values_and_no_more(
        a in intervals(), n in prop_oneof![-40..40i32, -3..5i32], share in 0.01..0.99f64,
    ) {
        let x = Interval::new(a.0, a.1);
        for n in [f64::from(n), f64::from(n) + share] {
            let (found, exact) = (x.power(Interval::exact(n)), libm::pow(a.2, n));
            let defined = if n.fract() == 0.0 { n >= 0.0 || !x.holds_zero() } else { x.lo > 0.0 || (x.lo == 0.0 && n > 0.0) };
            let ends = ends(&[libm::pow(a.0, n), libm::pow(a.1, n), if x.holds_zero() && n > 0.0 { 0.0 } else { exact }]);
            // the power below the line is lost under the smallest f64, or its reciprocal over the largest
            let is_lost = n < 0.0 && ends.0.abs().max(ends.1.abs()) > 1e300;
            prop_assert!(found.is_undecided() != defined || is_lost, "{x:?} ^ {n}: {found:?}");
            if !found.is_undecided() && !is_lost {
                // multiplied out, the f64 power is less near than the interval's ends
                let slack = |x: f64| (8.0 + 3.0 * n.abs()) * f64::EPSILON * x.abs() + 1e-300;
                prop_assert!(
                    ends.0 - slack(ends.0) <= found.lo && found.hi <= ends.1 + slack(ends.1)
                        && found.lo <= exact + slack(exact) && found.hi >= exact - slack(exact),
                    "{x:?} ^ {n} at {}: {found:?} {exact} {ends:?}", a.2
                );
            }
        }
        let (exponents, at) = (Interval::new(share, share + 2.0), share + a.2.abs() % 2.0);
        let found = x.power(exponents);
        prop_assert_eq!(found.is_undecided(), x.lo < 0.0);
        prop_assert!(found.is_undecided() || found.holds(libm::pow(a.2, at)), "{:?} ^ {}: {:?}", x, at, found);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(debug_assertions) { 100 } else { 2000 }))]

    #[test]
    fn derivatives_hold_theirs(a in intervals(), b in intervals()) {
        let (x, y) = (Jet::variable(Interval::new(a.0, a.1), 0), Jet::variable(Interval::new(b.0, b.1), 1));
        let (px, py) = (Jet::variable(a.2, 0), Jet::variable(b.2, 1));
        for (name, over, at) in BINARY {
            for (inner, over_inner, at_inner) in UNARY {
                let found = over(over_inner(x), over_inner(y).mul(x));
                let exact = at(at_inner(px), at_inner(py).mul(px));
                let is_single = a.0 >= a.1 && b.0 >= b.1;
                // of a tangent almost at its pole nothing is known
                let is_moderate = exact.value.is_finite()
                    && [at_inner(px).value, at_inner(py).value].iter().all(|inner| inner.abs() < 1e8)
                    && exact.first.iter().chain(&exact.second).all(|d| d.abs() < 1e12);
                let pairs = std::iter::once((found.value, exact.value))
                    .chain(found.first.into_iter().zip(exact.first))
                    .chain(found.second.into_iter().zip(exact.second));
                for (k, (interval, number)) in pairs.enumerate() {
                    // cancellation leaves rounding of the larger terms in the number
                    let slack = 1e-9 * (1.0 + number.abs() + interval.size() * 1e-3);
                    prop_assert!(
                        !(is_single && is_moderate && interval.is_undecided()),
                        "{name} {inner} {a:?} {b:?} derivative {k} of single numbers is undecided: {number}"
                    );
                    prop_assert!(
                        interval.is_undecided() || number.is_nan() || !slack.is_finite()
                            || (interval.lo - slack <= number && number <= interval.hi + slack),
                        "{name} {inner} {a:?} {b:?} derivative {k}: {interval:?} {number}"
                    );
                }
            }
        }
    }
}

#[test]
fn what_is_not_defined_everywhere_is_undecided_and_stays_so() {
    let whole = Interval::new(-1.0, 2.0);
    for x in [
        whole.sqrt(),
        whole.ln(),
        whole.log10(),
        whole.asin(),
        whole.acos(),
        whole.tan(),
        Interval::exact(1.0) / whole,
        whole.power(Interval::exact(0.5)),
        whole.power(Interval::exact(-2.0)),
        Interval::new(0.0, 1.0).power(Interval::exact(-0.5)),
        Interval::new(0.0, 1e7).sin_cos().0,
    ] {
        assert!(x.is_undecided(), "{x:?}");
        let zero = Interval::exact(0.0);
        for y in [
            x + whole,
            x * zero,
            zero * x,
            zero / x,
            x.tanh(),
            x.sin_cos().1,
            x.square(),
            x.power(zero),
            x.power(Interval::exact(2.0)),
            x.atan(),
            x.cosh(),
            x.exp(),
            x.joined(zero),
            zero.joined(x),
        ] {
            assert!(y.is_undecided(), "{x:?} {y:?}");
        }
        assert!(!x.is_within(whole) && !whole.is_within(x));
    }
}

/// Known numbers, each between the f64 that std has and its neighbour.
#[test]
fn known_values_lie_within_few_ulps() {
    use std::f64::consts::{E, FRAC_PI_4, LN_10, LN_2, LOG10_2, SQRT_2};
    let exact = Interval::exact;
    let half_pi = Interval::new(FRAC_PI_2, FRAC_PI_2.next_up());
    for (found, number) in [
        (exact(1.0).exp(), [E, E.next_up()]),
        (exact(2.0).ln(), [LN_2, LN_2.next_up()]),
        (exact(10.0).ln(), [LN_10.next_down(), LN_10]),
        (exact(2.0).log10(), [LOG10_2.next_down(), LOG10_2]),
        (exact(2.0).sqrt(), [SQRT_2.next_down(), SQRT_2]),
        (exact(1.0).atan(), [FRAC_PI_4, FRAC_PI_4.next_up()]),
        (exact(1.0).asin(), [half_pi.lo, half_pi.hi]),
        (exact(0.0).acos(), [half_pi.lo, half_pi.hi]),
        (exact(-1.0).acos(), [PI, PI.next_up()]),
    ] {
        assert!(found.holds(number[0]) && found.holds(number[1]), "{found:?} {number:?}");
        assert!(found.hi - found.lo <= 12.0 * f64::EPSILON * number[1], "{found:?} {number:?}");
    }
}

#[test]
fn exact_results_are_single_numbers() {
    let exact = Interval::exact;
    for (found, expected) in [
        (exact(3.0) / exact(2.0), 1.5),
        (exact(6.35) - exact(6.35), 0.0),
        (exact(5.0) * exact(5.0), 25.0),
        (exact(-3.0).power(exact(2.0)), 9.0),
        (exact(0.0) * Interval::new(-1.0, 7.0), 0.0),
    ] {
        assert_eq!(found, exact(expected));
    }
}

#[test]
fn sine_and_cosine_have_their_extremes() {
    for k in -8..8_i32 {
        let at = f64::from(k) * FRAC_PI_2;
        let (sin, cos) = Interval::new(at - 0.1, at + 0.1).sin_cos();
        let turning = if k % 2 == 0 { cos } else { sin };
        let top = f64::from(if k.rem_euclid(4) < 2 { 1 } else { -1 });
        assert!(turning.holds(top) && turning.lo.abs().min(turning.hi.abs()) > 0.99, "{k}: {turning:?}");
    }
    let (sin, cos) = Interval::new(0.0, FRAC_PI_2).sin_cos();
    assert!(sin.lo <= 0.0 && sin.lo > -1e-300 && sin.hi >= 1.0 && cos.lo > 0.0 && cos.hi >= 1.0, "{sin:?} {cos:?}");
    assert_eq!(Interval::new(0.0, 7.0).sin_cos(), (Interval::new(-1.0, 1.0), Interval::new(-1.0, 1.0)));
}
