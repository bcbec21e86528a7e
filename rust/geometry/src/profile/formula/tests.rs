//! Formulas against the closed forms of the same shapes, and everything that is refused.

use std::f64::consts::{FRAC_PI_2, PI};
use std::time::Instant;

use proptest::prelude::*;

use super::*;
use crate::profile::Meridian;

fn explicit(z: &str, diameter: f64) -> FormulaDocument {
    FormulaDocument { z: Some(z.to_owned()), diameter: Some(diameter), ..FormulaDocument::default() }
}

fn parametric(r: &str, z: &str, t: [f64; 2]) -> FormulaDocument {
    FormulaDocument { r: Some(r.to_owned()), z: Some(z.to_owned()), t: Some(t), ..FormulaDocument::default() }
}

fn implicit(f: &str, start: [f64; 2]) -> FormulaDocument {
    FormulaDocument { implicit: Some(f.to_owned()), start: Some(start), ..FormulaDocument::default() }
}

fn with(mut document: FormulaDocument, parameters: &[(&str, f64)]) -> FormulaDocument {
    document.parameters = parameters.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    document
}

fn curve(document: &FormulaDocument) -> (Fitted, Vec<String>) {
    let traced = trace(document).unwrap_or_else(|error| panic!("{document:?}: {error}"));
    match traced.parts.into_iter().next().unwrap() {
        TracedPart::Curve { curve, .. } => (curve, traced.notes),
        straight => panic!("{straight:?}"),
    }
}

fn refused(document: &FormulaDocument) -> String {
    trace(document).map_or_else(|error| error.to_string(), |traced| format!("not refused: {:?}", traced.notes))
}

/// r, z and radius of curvature at a slope.
type Shape<'a> = &'a dyn Fn(f64) -> (f64, f64, f64);

/// Compares over slopes [0, to], to 1e-9 relative (r and z: to the size).
fn agrees(document: &FormulaDocument, to: f64, shape: Shape) {
    let (curve, notes) = curve(document);
    let size = shape(to).0.max(shape(to).1);
    for k in 1..1000 {
        let slope = to * f64::from(k) / 1000.0;
        let (r, z, rho) = shape(slope);
        let found = curve.point_at(slope);
        let off_by = (found.0 - r).abs().max((found.1 - z).abs());
        assert!(off_by <= 1e-9 * size, "{document:?} {notes:?} at {slope}: {found:?} {r} {z}: {off_by:e}");
        let radius = curve.curvature_radius_at(slope);
        assert!((radius - rho).abs() <= 1e-9 * rho, "{document:?} {notes:?} at {slope}: {radius} {rho}");
        assert!((curve.height_at_radius(r, [0.0, 1.6]) - z).abs() <= 1e-9 * size * (1.0 + slope.tan()), "{slope}");
        let back = curve.point_at(curve.slope_at_radius(r, [0.0, 1.6]));
        assert!((back.0 - r).abs() <= 1e-9 * size, "{slope}: {back:?} {r}");
    }
    let end = curve.point_at(curve.slopes().1);
    assert!((curve.slopes().1 - to).abs() < 1e-7, "{document:?}: ends at {}, not {to}", curve.slopes().1);
    assert!((end.0 - shape(to).0).abs() < 1e-9 * size && (end.1 - shape(to).1).abs() < 1e-9 * size, "{end:?}");
    assert_eq!(curve.point_at(0.0), (0.0, 0.0));
}

fn ellipse(a: f64, b: f64, slope: f64) -> (f64, f64, f64) {
    let (sin, cos) = if slope >= FRAC_PI_2 { (1.0, 0.0) } else { slope.sin_cos() };
    let h = (a * a * sin * sin + b * b * cos * cos).sqrt();
    (a * a * sin / h, b * a * a * sin * sin / (h * (h + b * cos)), (a * b / h).powi(2) / h)
}

#[test]
fn the_ellipse_is_itself_by_all_three_forms() {
    for (a, b) in [(1.0, 2.0), (6.0, 4.0), (5.0, 5.0), (0.3, 0.3), (4.1, 4.1), (2.0, 9.0), (10.0, 1.0)] {
        let half_axes = [("a", a), ("b", b)];
        for document in [
            explicit("b - b*sqrt(1 - (r/a)^2)", 2.0 * a),
            explicit("b*sqrt(1 - r^2/a^2)", 2.0 * a),
            parametric("a*sin(t)", "b*(1 - cos(t))", [0.0, FRAC_PI_2]),
            parametric("a*cos(t)", "b*sin(t)", [FRAC_PI_2, 0.0]),
            implicit("(r/a)^2 + (z/b)^2 - 1", [0.0, -b]),
            implicit("(r/a)^2 + (z/b)^2 - 1", [0.0, b]),
            implicit("(r/a)^2 + (z/b)^2 - 1", [a, 0.0]),
            implicit("1 - (r/a)^2 - (z/b)^2", [0.7 * a, -0.7 * b]),
            FormulaDocument { diameter: Some(2.0 * a), ..implicit("(r/a)^2 + (z/b)^2 - 1", [0.7 * a, 0.7 * b]) },
        ] {
            agrees(&with(document, &half_axes), FRAC_PI_2, &|slope| ellipse(a, b, slope));
        }
    }
}

#[test]
fn an_ellipse_cut_by_the_diameter_ends_there() {
    let half_axes = [("a", 6.0), ("b", 4.0)];
    let to = (4.0f64 * 3.0 / (36.0 * (1.0f64 - 0.25).sqrt())).atan();
    for document in [
        explicit("b - b*sqrt(1 - (r/a)^2)", 6.0),
        FormulaDocument { diameter: Some(6.0), ..parametric("a*sin(t)", "b*(1 - cos(t))", [0.0, PI]) },
        FormulaDocument { diameter: Some(6.0), ..implicit("(r/a)^2 + (z/b)^2 - 1", [0.0, -4.0]) },
        FormulaDocument { diameter: Some(6.0), ..implicit("(r/a)^2 + (z/b)^2 - 1", [6.0, 0.0]) },
    ] {
        agrees(&with(document, &half_axes), to, &|slope| ellipse(6.0, 4.0, slope));
    }
}

#[test]
fn the_patents_example_is_moved_and_mirrored() {
    let document = parametric("sin(t)", "2*cos(t)", [0.0, FRAC_PI_2]);
    agrees(&document, FRAC_PI_2, &|slope| ellipse(1.0, 2.0, slope));
    let (_, notes) = curve(&document);
    assert_eq!(notes[0], "moved by -2 mm in z: the r = 0 end is the tip, at z = 0");
    assert_eq!(notes[1], "mirrored: z falls from its r = 0 end");
    assert!(notes[2].contains("follow the formula to"), "{notes:?}");
}

#[test]
fn parabola_power_law_and_cycloid_are_their_closed_forms() {
    let to = (8.0f64 / 8.0).atan();
    let parabola = |slope: f64| {
        let tan = slope.tan();
        (8.0 * tan, 4.0 * tan * tan, 8.0 / slope.cos().powi(3))
    };
    agrees(&explicit("r^2/16", 16.0), to, &parabola);
    agrees(&explicit("r*r/(2*8)", 16.0), to, &parabola);
    agrees(&parametric("t", "t^2/16 - 3", [0.0, 8.0]), to, &parabola);
    agrees(&FormulaDocument { diameter: Some(16.0), ..implicit("r^2 - 16*z", [4.0, 1.0]) }, to, &parabola);
    for power in [2.5, 3.0, 4.0, 6.0] {
        let power_law = |slope: f64| {
            let r = (60.0 * slope.tan() / power).powf(1.0 / (power - 1.0));
            let rho = (1.0 + slope.tan().powi(2)).powf(1.5) * 60.0 / (power * (power - 1.0) * r.powf(power - 2.0));
            (r, r.powf(power) / 60.0, rho)
        };
        let to = (power * 3f64.powf(power - 1.0) / 60.0).atan();
        agrees(&with(explicit("r^p/60", 6.0), &[("p", power)]), to, &power_law);
        agrees(&with(parametric("t", "t^p/60", [0.0, 3.0]), &[("p", power)]), to, &power_law);
    }
    let cycloid = |slope: f64| {
        let t = 2.0 * slope;
        (5.0 * (t + t.sin()), 10.0 * slope.sin().powi(2), 20.0 * slope.cos())
    };
    let document = parametric("5*(t + sin(t))", "5*(1 - cos(t))", [0.0, 3.0]);
    agrees(&document, 1.5, &cycloid);
}

#[test]
fn a_cycloid_to_its_cusp_ends_upright() {
    let (curve, notes) = curve(&parametric("5*(t + sin(t))", "5*(1 - cos(t))", [0.0, PI]));
    assert!((curve.slopes().1 - FRAC_PI_2).abs() < 1e-12, "{notes:?}");
    for k in 0..=100 {
        let slope = FRAC_PI_2 * f64::from(k) / 100.0;
        let (r, z) = curve.point_at(slope);
        assert!((r - 5.0 * (2.0 * slope + (2.0 * slope).sin())).abs() < 1e-9, "{slope}");
        assert!((z - 10.0 * slope.sin().powi(2)).abs() < 1e-9, "{slope}");
    }
}

#[test]
fn a_singular_tip_holds_in_radius_and_height() {
    let (curve, notes) = curve(&explicit("r^1.5/3", 8.0));
    assert!(notes.iter().any(|note| note.contains("no limit at an end")), "{notes:?}");
    for k in 1..=200 {
        let slope = curve.slopes().1 * f64::from(k) / 200.0;
        let r = (2.0 * slope.tan()).powi(2);
        let found = curve.point_at(slope);
        assert!(
            (found.0 - r).abs() < 1e-9 * 4.0 && (found.1 - r.powf(1.5) / 3.0).abs() < 1e-9 * 4.0,
            "{slope} {found:?}"
        );
    }
}

#[test]
fn a_sphere_with_a_rounded_square_is_upright_at_its_equator() {
    for radius in [0.3, 1.1, 3.7, 4.1, 5.0, 6.35, 7.3] {
        let text = format!("{radius} - sqrt({} - r^2)", radius * radius);
        let document = explicit(&text, 2.0 * radius);
        agrees(&document, FRAC_PI_2, &|slope| ellipse(radius, radius, slope));
    }
}

#[test]
fn a_superellipse_is_flat_at_its_tip_and_its_equator() {
    for document in [implicit("r^4 + z^4 - 16", [0.0, -2.0]), implicit("r^4 + z^4 - 16", [2.0, 0.0])] {
        let (curve, notes) = curve(&document);
        for k in 1..100 {
            let slope = FRAC_PI_2 * f64::from(k) / 100.0;
            // r^3 / z^3 = tan
            let tan = slope.tan().cbrt();
            let z = -2.0 / (1.0 + tan.powi(4)).sqrt().sqrt();
            let found = curve.point_at(slope);
            assert!(
                (found.0 + z * tan).abs() < 1e-9 && (found.1 - z - 2.0).abs() < 1e-9,
                "{slope} {found:?} {notes:?}"
            );
        }
        let end = curve.point_at(FRAC_PI_2);
        assert!((end.0 - 2.0).abs() < 1e-12 && (end.1 - 2.0).abs() < 1e-4, "{end:?} {notes:?}");
    }
}

#[test]
fn a_tip_that_stands_still_has_the_slope_it_starts_with() {
    let parabola = |slope: f64| (0.5 * slope.tan(), 0.25 * slope.tan().powi(2), 0.5 / slope.cos().powi(3));
    agrees(&parametric("t^2", "t^4", [0.0, 2.0]), 8f64.atan(), &parabola);
}

#[test]
fn a_pointed_curve_begins_at_its_slope_and_a_cone_is_straight() {
    let (pointed, _) = curve(&explicit("r + r^2/10", 8.0));
    assert!((pointed.slopes().0 - PI / 4.0).abs() < 1e-15);
    assert_eq!(pointed.point_at(0.1), (0.0, 0.0));
    let slope = (1.0f64 + 0.4).atan();
    assert!((pointed.point_at(slope).0 - 2.0).abs() < 1e-12);
    for document in [
        explicit("0.5*r", 8.0),
        explicit("3 - r/2", 8.0),
        parametric("2*t^2", "t^2", [0.0, 2f64.sqrt()]),
        FormulaDocument { diameter: Some(8.0), ..implicit("r - 2*z", [2.0, 1.0]) },
    ] {
        let traced = trace(&document).unwrap_or_else(|error| panic!("{document:?}: {error}"));
        let [TracedPart::Straight { slope, from, to }] = traced.parts[..] else { panic!("{traced:?}") };
        assert!((slope - 0.5f64.atan()).abs() < 1e-15 && from == (0.0, 0.0), "{slope}");
        assert!((to.0 - 4.0).abs() < 1e-14 && (to.1 - 2.0).abs() < 1e-14, "{to:?}");
    }
}

#[test]
fn defects_are_refused_with_their_place() {
    let cut = |document: FormulaDocument, diameter| FormulaDocument { diameter: Some(diameter), ..document };
    let mut wrong = String::new();
    for (document, expected) in [
        (explicit("r^2/10 - r^4/1000", 16.0), "r = 4.08248: the curve is concave"),
        (parametric("t", "t^2 - t^4/6", [0.0, 1.5]), "t = 1: the curve is concave"),
        (explicit("r^2/10 - r^3/200", 20.0), "r = 6.66667: the curve is concave"),
        (explicit("r^2 - r/10", 4.0), "z falls"),
        (explicit("sqrt(r)", 4.0), "r = 0: "),
        (explicit("sqrt(r^2)", 4.0), "r = 0: "),
        (explicit("1 - sqrt(1 - r^2)", 2.5), "r = 1: the formula or its derivative is not a finite number"),
        (explicit("1/(r - 1)", 4.0), "r = 1: z falls"),
        (explicit("r/(1 - r)", 4.0), "r = 1: z falls"),
        (explicit("tan(r)", 4.0), "r = 1.5708: z falls"),
        (explicit("tanh(1e300*r)", 4.0), "r = 0: the slope on the axis"),
        (explicit("ln(r)", 4.0), "r = 0: "),
        (explicit("exp(exp(exp(r)))", 40.0), "is not a finite number"),
        (parametric("sin(t)", "1 - cos(t)", [0.0, 3.0]), "t = 1.5708: r falls: the slope passes 90 degrees"),
        (parametric("sin(t)", "1 - cos(t)", [-0.5, 1.5]), "the tip is not on the axis"),
        (parametric("t^3", "t^6", [-1.0, 1.0]), "the tip is not on the axis"),
        (parametric("(t - 1)^3 + 1", "((t - 1)^3 + 1)^2", [0.0, 2.0]), "t = 1: both derivatives are zero"),
        (parametric("ln(t)", "t^2", [1.0, 0.0]), "t = "),
        (parametric("-t", "t^2", [0.0, 1.0]), "r falls"),
        (parametric("t", "2*t + ((t - 0.5)^4)^0.25", [0.0, 1.0]), "t = 0.5: "),
        (parametric("t", "2*t + ((t - 0.3)^4)^0.25", [0.0, 1.0]), "t = 0.3: "),
        (parametric("t", "2*t - ((t - 0.3)^4)^0.25", [0.0, 1.0]), "t = 0.3: "),
        (cut(parametric("sin(t)", "1 - cos(t)", [0.0, 1.5]), 4.0), "the curve reaches r = 0.997495 only"),
        (implicit("r^2 + z^2 + 1", [1.0, 1.0]), "not near the curve"),
        (implicit("r^2 - z", [1.0, 1.0]), "give a diameter"),
        (implicit("(r - 3)^2 + z^2 - 1", [3.0, -1.0]), "does not reach the axis"),
        (implicit("r^2 - z^2", [1.0, 1.0]), "r = 0, z = 0: the derivatives of the formula are both zero"),
        (cut(implicit("(r - 1)*(r - z)", [0.5, 0.5]), 4.0), "r = 1, z = 1: the derivatives of the formula"),
        (cut(implicit("r^2 + z^2 - 4", [0.0, -2.0]), 5.0), "reaches 90 degrees at r = 2, before the base's 2.5"),
        (cut(implicit("z - r^2/10 + r^4/1000", [0.0, 0.0]), 12.0), "r = 4.08248, z = 1.38889: the curve is concave"),
        (parametric("t^3", "t^3 + t^6", [0.0, 2.0]), "t = 0: both derivatives are zero"),
        (parametric("sin(t)", "1 - cos(t)", [0.0, FRAC_PI_2 + 1e-5]), "t = 1.5708: the slope at the base"),
        (explicit("exp(r) - r", 30.0), "the base has a radius of 15 mm and a height of 3269000 mm"),
        (implicit("sqrt(r - 1) - z", [0.0, 0.0]), "not a finite number"),
        (implicit("r - z", [-1.0, -1.0]), "negative r"),
        (implicit("r - z", [f64::NAN, 0.0]), "start: "),
        (parametric("t", "t", [0.0, f64::INFINITY]), "t: "),
        (explicit("r^2", 0.0), "diameter"),
        (FormulaDocument { diameter: None, ..explicit("r^2", 1.0) }, "takes a diameter"),
        (FormulaDocument::default(), "a formula takes"),
        (with(explicit("r^2", 1.0), &[("sin", 1.0)]), "parameters.sin: the name has a meaning already"),
        (with(explicit("r^2", 1.0), &[("t", 1.0)]), "parameters.t: "),
        (with(explicit("r^2", 1.0), &[("2a", 1.0)]), "parameters.2a: "),
        (with(explicit("r^2", 1.0), &[("a", f64::NAN)]), "parameters.a: "),
        (explicit("t^2", 1.0), "z, character 1: `t` is not known here"),
    ] {
        let message = refused(&document);
        if !message.contains(expected) {
            wrong += &format!("{document:?}\n  {message}\n  {expected}\n");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn every_profile_refusal_has_one_code() {
    assert_eq!(trace(&explicit("sqrt(r)", 4.0)).unwrap_err().code(), "profile");
}

#[test]
fn the_document_works_as_a_tagged_variant() {
    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    #[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
    enum Kinds {
        Formula(FormulaDocument),
    }
    let text = r#"{"kind":"formula","z":"a*r^2","parameters":{"a":0.1},"diameter":8.0,"tip_flat":0.0}"#;
    let document: Kinds = serde_json::from_str(text).unwrap();
    assert_eq!(serde_json::to_string(&document).unwrap(), text);
    let unknown = serde_json::from_str::<Kinds>(r#"{"kind":"formula","z":"r","radius":1}"#).unwrap_err().to_string();
    assert!(unknown.contains("unknown field `radius`"), "{unknown}");
}

/// A text that may be a formula: deep, wide, or of powers of powers.
pub(super) fn awkward() -> impl Strategy<Value = String> {
    let atom =
        prop_oneof![Just("r".to_owned()), Just("9".to_owned()), Just("0.5".to_owned()), Just("1e300".to_owned())];
    let nested = atom.prop_recursive(40, 120, 3, |inner| {
        prop_oneof![
            (inner.clone(), "[-+*/^]", inner.clone()).prop_map(|(a, op, b)| format!("({a}{op}{b})")),
            (inner.clone(), "[-+*/^]", inner.clone()).prop_map(|(a, op, b)| format!("{a}{op}{b}")),
            ("(sqrt|exp|ln|sin|tan|asin|cosh|tanh)", inner).prop_map(|(f, a)| format!("{f}({a})")),
        ]
    });
    prop_oneof![4 => nested, 1 => "\\PC{0,300}", 1 => "[-+*/^()r0-9e.]{0,300}"]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(debug_assertions) { 200 } else { 20_000 }))]

    #[test]
    fn any_formula_is_traced_or_refused_soon(text in awkward(), diameter in 0.1..50.0) {
        for document in [
            explicit(&text, diameter),
            parametric("t", &text.replace('r', "t"), [0.0, diameter]),
            FormulaDocument { diameter: Some(diameter), ..implicit(&format!("z - ({text})"), [0.0, 1.0]) },
        ] {
            let begun = Instant::now();
            let _ = trace(&document);
            // some 50 ms in the release build; what hangs takes for ever
            prop_assert!(begun.elapsed().as_secs() < 10, "{document:?}: {:?}", begun.elapsed());
        }
    }

    #[test]
    fn tangents_have_the_slope_that_was_asked_for(a in 0.5..20.0f64, oblong in 0.4..2.5f64, share in 0.01..0.99f64) {
        let document = with(parametric("a*sin(t)", "b*(1 - cos(t))", [0.0, FRAC_PI_2]), &[("a", a), ("b", a * oblong)]);
        let (curve, _) = curve(&document);
        let slope = share * FRAC_PI_2;
        let h = 1e-4;
        let points = [curve.point_at(slope - h), curve.point_at(slope + h), curve.point_at(slope - 2.0 * h), curve.point_at(slope + 2.0 * h)];
        let rate = |f: fn((f64, f64)) -> f64| (8.0 * (f(points[1]) - f(points[0])) - (f(points[3]) - f(points[2]))) / (12.0 * h);
        let (dr, dz) = (rate(|p| p.0), rate(|p| p.1));
        let length = (dr * dr + dz * dz).sqrt();
        prop_assert!((dr * slope.sin() - dz * slope.cos()).abs() < 1e-9 * length, "{dr} {dz}");
        prop_assert!((length - curve.curvature_radius_at(slope)).abs() < 1e-7 * length);
    }
}

#[test]
fn long_and_deep_texts_are_refused_at_once() {
    for text in [
        "(".repeat(1_000_000),
        "9^".repeat(500_000),
        vec!["r^r"; 400].join("^"),
        "-".repeat(1999) + "r",
        "sin(".repeat(400),
    ] {
        let begun = Instant::now();
        let _ = trace(&explicit(&text, 8.0));
        assert!(begun.elapsed().as_secs() < 10, "{:?}", begun.elapsed());
    }
}

/// `cargo test --release -p styluscam-geometry formula_speed -- --ignored --nocapture`
#[test]
#[ignore = "a measurement"]
fn formula_speed() {
    let wide = (0..24).map(|k| format!("r^{}/1e{}", k + 2, 3 * k + 1)).collect::<Vec<_>>().join("+");
    for document in [
        parametric("sin(t)", "2*cos(t)", [0.0, FRAC_PI_2]),
        explicit("5 - sqrt(25 - r^2)", 10.0),
        implicit("(r/6)^2 + (z/4)^2 - 1", [0.0, -4.0]),
        explicit("r^3/60", 20.0),
        explicit("r^1.5/3", 8.0),
        explicit(&wide, 8.0),
        parametric("5*(t + sin(t))", "5*(1 - cos(t))", [0.0, PI]),
        FormulaDocument { diameter: Some(16.0), ..implicit("r^2 - 16*z", [4.0, 1.0]) },
    ] {
        let built = (0..20)
            .map(|_| {
                let begun = Instant::now();
                trace(&document).unwrap();
                begun.elapsed()
            })
            .min();
        let (curve, notes) = curve(&document);
        let (from, to) = curve.slopes();
        let evaluated = (0..5)
            .map(|_| {
                let (mut sum, mut x) = (0.0, 0.5);
                let begun = Instant::now();
                for _ in 0..1_000_000 {
                    // slopes in no order
                    x = (x + 0.618_033_988_749_894_9) % 1.0;
                    let (r, z) = curve.point_at(from + (to - from) * x);
                    sum += r + z;
                }
                assert!(sum > 0.0);
                begun.elapsed()
            })
            .min();
        println!("{document:?}\n  built in {built:?}, 1e6 points in {evaluated:?}; {notes:?}");
    }
}
