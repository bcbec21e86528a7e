//! Random formulas and points: what is proved convex is so at random chords, and nothing hangs, panics or swells.

use std::time::{Duration, Instant};

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

use super::tests::awkward;
use super::*;
use crate::profile::{kinds, ProfileDocument};

/// Slowest that a profile may be built or refused in the release build.
const SLOWEST: Duration = Duration::from_secs(2);

/// A height by radius that is convex but for a small term of any width, in text; its diameter.
fn nearly_convex() -> impl Strategy<Value = (String, f64)> {
    let body = prop_oneof![
        (0.5..40.0f64).prop_map(|a| format!("r^2/{a}")),
        (1.05..6.0f64, 0.5..50.0f64).prop_map(|(n, a)| format!("r^{n}/{a}")),
        (0.5..9.0f64).prop_map(|a| format!("{a}*cosh(r/{a}) - {a}")),
        (0.5..9.0f64).prop_map(|a| format!("exp(r/{a})")),
        (8.1..30.0f64).prop_map(|a| format!("{a} - sqrt({a}^2 - r^2)")),
        (0.1..2.0f64, 0.5..4.0f64).prop_map(|(a, b)| format!("r^4/100 - {a}*r^3/25 + {b}*r^2/20")),
        (0.1..2.0f64).prop_map(|a| format!("{a}*r")),
    ];
    let size = (-15.0..-1.0f64).prop_map(|e| libm::pow(10.0, e));
    let width = (-7.0..1.0f64).prop_map(|e| libm::pow(10.0, e));
    let added = (0..5u8, size, width, 0.0..8.0f64).prop_map(|(kind, size, width, at)| match kind {
        0 => String::new(),
        1 => format!(" + {size:e}*exp(-((r - {at})/{width:e})^2)"),
        2 => format!(" + {size:e}*sin(r/{width:e})"),
        3 => format!(" - {size:e}/(1 + ((r - {at})/{width:e})^2)"),
        _ => format!(" + {size:e}*tanh((r - {at})/{width:e})"),
    });
    (body, added, 0.5..16.0f64).prop_map(|(body, added, diameter)| (body + &added, diameter))
}

/// Points that may be those of a convex profile, some of them spoilt.
fn points() -> impl Strategy<Value = ProfileDocument> {
    let steps = prop::collection::vec((-0.1..2.0f64, -0.01..0.3f64), 0..60);
    let odd = prop_oneof![
        8 => Just(None),
        1 => prop::sample::select(vec![f64::NAN, f64::INFINITY, 0.0, -1.0, 1e300, 1e-300, 5e-324]).prop_map(Some),
    ];
    (steps, odd, any::<prop::sample::Index>(), 0.0..0.1f64).prop_map(|(steps, odd, index, fit_tolerance)| {
        let (mut at, mut slope) = ([0.0, 0.0], 0.0_f64);
        let mut points = vec![at];
        for (length, turn) in steps {
            slope += turn;
            at = [at[0] + length * slope.cos(), at[1] + length * slope.sin()];
            points.push(at);
        }
        if let Some(odd) = odd {
            let index = index.index(points.len());
            points[index][index % 2] = odd;
        }
        ProfileDocument::from(kinds::Points { points, fit_tolerance, tip_flat: 0.0 })
    })
}

/// The same curve by three forms.
fn forms(text: &str, diameter: f64) -> [FormulaDocument; 3] {
    let base = FormulaDocument { diameter: Some(diameter), ..FormulaDocument::default() };
    let by_t: String = text.replace('r', "t").replace("sqtt", "sqrt");
    [
        FormulaDocument { z: Some(text.to_owned()), ..base.clone() },
        FormulaDocument {
            r: Some("t".to_owned()),
            z: Some(by_t),
            t: Some([0.0, diameter / 2.0]),
            diameter: None,
            ..base.clone()
        },
        FormulaDocument { implicit: Some(format!("z - ({text})")), start: Some([0.0, 1.0]), ..base },
    ]
}

/// How high the formula z(r) goes over its chords, in parts of the size; at positions and widths of all sizes.
fn highest_over_chords(text: &str, diameter: f64, random: &mut impl FnMut() -> f64) -> f64 {
    let parameters = BTreeMap::new();
    let names = Names { key: "z", variables: &["r"], parameters: &parameters };
    let z = Expression::new(text, &names).unwrap();
    let base = diameter / 2.0;
    let size = base.max((z.at(base, 0.0).value - z.at(0.0, 0.0).value).abs());
    let mut highest: f64 = 0.0;
    for _ in 0..300 {
        let width = base * libm::pow(10.0, -8.0 * random());
        let a = (base - width) * random();
        let m = a + width * random();
        let [za, zm, zb] = [a, m, a + width].map(|r| z.at(r, 0.0).value);
        let slope = (zb - za) / width;
        highest = highest.max((zm - za - slope * (m - a)) / (1.0 + slope * slope).sqrt());
    }
    highest / size
}

fn check_formula(text: &str, diameter: f64, random: &mut impl FnMut() -> f64) -> usize {
    let mut accepted = 0;
    for document in forms(text, diameter) {
        let begun = Instant::now();
        let traced = trace(&document);
        assert!(cfg!(debug_assertions) || begun.elapsed() < SLOWEST, "{document:?}: {:?}", begun.elapsed());
        if traced.is_ok() {
            accepted += 1;
            let highest = highest_over_chords(text, diameter, random);
            assert!(highest <= 1.1e-9, "{document:?}: {highest:e} over a chord, {:?}", traced.map(|it| it.notes));
        }
    }
    accepted
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(debug_assertions) { 50 } else { 1000 }))]

    #[test]
    fn what_is_proved_convex_is_not_above_its_chords((text, diameter) in nearly_convex(), seed in 0.0..1.0f64) {
        let mut x = seed;
        check_formula(&text, diameter, &mut || {
            x = (x * 997.0 + 0.618_033_988_749_894_9) % 1.0;
            x
        });
    }
}

/// Peak of this process' memory, MB, where the system reports it.
fn peak_memory() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    peak.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok()).unwrap_or(0.0) / 1024.0
}

/// `cargo test --release -p styluscam-geometry ten_minutes -- --ignored --nocapture`
#[test]
#[ignore = "takes ten minutes"]
fn ten_minutes_of_formulas_and_points() {
    let mut runner = TestRunner::default();
    let (awkward, nearly, points) = (awkward(), nearly_convex(), points());
    let mut x = 0.5;
    let (mut counts, mut slowest) = ([0usize; 6], Duration::ZERO);
    let begun = Instant::now();
    let memory = peak_memory();
    while begun.elapsed() < Duration::from_secs(600) {
        let text = awkward.new_tree(&mut runner).unwrap().current();
        for document in forms(&text, 8.0) {
            let begun = Instant::now();
            counts[1] += usize::from(trace(&document).is_ok());
            counts[0] += 1;
            assert!(begun.elapsed() < SLOWEST, "{document:?}: {:?}", begun.elapsed());
            slowest = slowest.max(begun.elapsed());
        }
        let (text, diameter) = nearly.new_tree(&mut runner).unwrap().current();
        let formula = Instant::now();
        counts[3] += check_formula(&text, diameter, &mut || {
            x = (x * 997.0 + 0.618_033_988_749_894_9) % 1.0;
            x
        });
        counts[2] += 3;
        slowest = slowest.max(formula.elapsed());
        let document = points.new_tree(&mut runner).unwrap().current();
        let point = Instant::now();
        counts[5] += usize::from(document.build().is_ok());
        counts[4] += 1;
        assert!(point.elapsed() < SLOWEST, "{document:?}: {:?}", point.elapsed());
    }
    println!(
        "awkward formulas {} (accepted {}), nearly convex ones {} ({}), points {} ({}); slowest {slowest:?}, memory {memory} to {} MB",
        counts[0], counts[1], counts[2], counts[3], counts[4], counts[5], peak_memory()
    );
}
