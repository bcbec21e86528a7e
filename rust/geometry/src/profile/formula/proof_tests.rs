//! What interval arithmetic proves convex, and what passes between the points that are looked at and is refused by it.

use std::f64::consts::{FRAC_PI_2, PI};
use std::time::Instant;

use super::*;
use crate::profile::Meridian;

fn explicit(z: &str, diameter: f64) -> FormulaDocument {
    FormulaDocument { z: Some(z.to_owned()), diameter: Some(diameter), ..FormulaDocument::default() }
}

fn parametric(r: &str, z: &str, t: [f64; 2]) -> FormulaDocument {
    FormulaDocument { r: Some(r.to_owned()), z: Some(z.to_owned()), t: Some(t), ..FormulaDocument::default() }
}

fn implicit(f: &str, start: [f64; 2], diameter: Option<f64>) -> FormulaDocument {
    FormulaDocument { implicit: Some(f.to_owned()), start: Some(start), diameter, ..FormulaDocument::default() }
}

/// The proof by intervals alone.
fn proved(document: &FormulaDocument) -> Result<convexity::Proof, GeometryError> {
    let route = route(document)?;
    convexity::prove(route.source.as_ref(), &route.stretches, &[], route.size())
}

fn refused(document: &FormulaDocument) -> String {
    trace(document).map_or_else(|error| error.to_string(), |traced| format!("not refused: {:?}", traced.notes))
}

/// A curve of each form that is convex but for what is added to its height, of r or t.
fn with_added(added: &str) -> [FormulaDocument; 3] {
    let by_t = added.replace('r', "t").replace("expt", "exp").replace("expr", "exp");
    [
        explicit(&format!("r^2/16 + {added}"), 8.0),
        parametric("t", &format!("t^2/16 + {by_t}"), [0.0, 4.0]),
        implicit(&format!("z - r^2/16 - ({added})"), [0.0, 0.0], Some(8.0)),
    ]
}

/// The number in `r = ..` or `t = ..`.
fn position(message: &str) -> f64 {
    let number = message.split([' ', ',', ':']).nth(2);
    number.and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("{message}"))
}

#[test]
fn a_bump_between_the_points_that_are_looked_at_is_refused_with_its_place() {
    for width in ["1e-4", "3e-6"] {
        for document in with_added(&format!("1e-6*exp(-((r - 1.2345)/{width})^2)")) {
            let message = refused(&document);
            let named = message.contains("concave") || message.contains("z falls");
            assert!(named && (position(&message) - 1.2345).abs() < 3e-4, "{document:?}: {message}");
        }
    }
    // so high that z falls behind it
    for document in with_added("0.04*exp(-((r - 2.5597)/3e-6)^2)") {
        let message = refused(&document);
        let named = message.contains("concave") || message.contains("z falls");
        assert!(named && (position(&message) - 2.5597).abs() < 1e-4, "{document:?}: {message}");
    }
    // seen neither by the points of the route nor by those of the polynomials
    for document in with_added("1e-11*exp(-((r - 1.2345)/3e-6)^2)") {
        proof::prove(&route(&document).unwrap()).unwrap();
        let message = refused(&document);
        assert!(message.contains("concave") && (position(&message) - 1.2345).abs() < 1e-5, "{document:?}: {message}");
    }
}

#[test]
fn a_fast_small_sine_is_refused() {
    for document in with_added("1e-9*sin(20000*r)") {
        let message = refused(&document);
        assert!(message.contains("the curve is concave"), "{document:?}: {message}");
    }
    // its curvature vanishes wherever the route is looked at: at multiples of a 2048th of the range
    let hidden = parametric("t", "t^2/16 + 1e-7*sin(1608.495438637974*t)", [0.0, 4.0]);
    proof::prove(&route(&hidden).unwrap()).unwrap();
    assert!(refused(&hidden).contains("the curve is concave"), "{}", refused(&hidden));
}

#[test]
fn what_is_convex_with_its_bump_is_accepted() {
    for added in ["1e-13*exp(-((r - 1.2345)/1e-4)^2)", "1e-13*sin(300*r)", "1e-9*exp(-((r - 1.2345)/1e-2)^2)"] {
        for document in with_added(added) {
            let traced = trace(&document).unwrap_or_else(|error| panic!("{document:?}: {error}"));
            assert!(traced.notes.iter().any(|note| note.contains("proved convex by interval arithmetic")));
        }
    }
}

#[test]
fn a_kink_is_not_proved() {
    let message = proved(&parametric("t", "2*t - ((t - 0.3)^4)^0.25", [0.0, 1.0])).unwrap_err().to_string();
    assert!(message.contains("t = 0.3: "), "{message}");
}

#[test]
fn loops_between_the_points_that_are_looked_at_are_refused() {
    // turns once between every two of them, always to the same side
    let text = format!("t + 1e-3*sin({}*t)", 2048.0 * 2.0 * PI);
    let document = parametric(&text, &format!("t^2 + 1e-3*(1 - cos({}*t))", 2048.0 * 2.0 * PI), [0.0, 1.0]);
    let message = refused(&document);
    assert!(!message.contains("not refused"), "{message}");
}

/// Shapes that must be proved, each with the words of its message.
fn shapes() -> Vec<(&'static str, FormulaDocument)> {
    vec![
        ("circle z(r)", explicit("5 - sqrt(25 - r^2)", 10.0)),
        ("circle z(r), rounded", explicit("6.35 - sqrt(40.3225 - r^2)", 12.7)),
        ("circle r(t), z(t)", parametric("5*sin(t)", "5 - 5*cos(t)", [0.0, FRAC_PI_2])),
        ("circle f(r, z)", implicit("r^2 + (z - 5)^2 - 25", [0.0, 0.0], None)),
        ("circle, rational", parametric("10*t/(1 + t^2)", "10*t^2/(1 + t^2)", [0.0, 1.0])),
        ("ellipse z(r)", explicit("4 - 4*sqrt(1 - (r/6)^2)", 12.0)),
        ("ellipse f(r, z)", implicit("(r/6)^2 + (z/4)^2 - 1", [0.0, -4.0], None)),
        ("ellipse f(r, z), multiplied out", implicit("16*r^2 + 36*z^2 - 288*z", [0.0, 0.0], None)),
        ("the patent's", parametric("sin(t)", "2*cos(t)", [0.0, FRAC_PI_2])),
        ("parabola", explicit("r^2/16", 16.0)),
        ("parabola f(r, z)", implicit("r^2 - 16*z", [4.0, 1.0], Some(16.0))),
        ("chain line", explicit("4*(cosh(r/4) - 1)", 16.0)),
        ("chain line by exp", explicit("2*(exp(r/4) + exp(-r/4)) - 4", 16.0)),
        ("r^1.5", explicit("r^1.5/3", 8.0)),
        ("r^4", explicit("r^4/500", 16.0)),
        ("exp", explicit("exp(r/3) - 1", 12.0)),
        ("exp less its line", explicit("exp(r/3) - 1 - r/3", 12.0)),
        ("-ln cos", explicit("-3*ln(cos(r/4))", 10.0)),
        ("r tan", explicit("r*tan(r/8)", 10.0)),
        ("r sinh", explicit("r*sinh(r/6)/4", 12.0)),
        ("hyperbola", explicit("sqrt(4 + r^2) - 2", 12.0)),
        ("cycloid", parametric("5*(t + sin(t))", "5*(1 - cos(t))", [0.0, PI])),
        (
            "clothoid's first terms",
            parametric("6*(t - t^5/40 + t^9/3456)", "6*(t^3/6 - t^7/336 + t^11/42240)", [0.0, 1.7]),
        ),
        ("involute", parametric("2*(cos(t) + t*sin(t) - 1)", "2*(sin(t) - t*cos(t))", [0.0, FRAC_PI_2])),
        ("superellipse", implicit("r^4 + z^4 - 16", [0.0, -2.0], None)),
        ("superellipse of 2.5", implicit("(r/6)^2.5 + (1 - z/4)^2.5 - 1", [0.0, 0.0], None)),
        ("egg", implicit("r^2/9 + (z - 4)^2/16*(1 + 0.05*z) - 1", [0.0, 0.0], None)),
        ("a quartic that just turns", explicit("r^4/100 - r^3/25 + 0.06*r^2", 8.0)),
    ]
}

/// `cargo test --release -p styluscam-geometry usual_shapes -- --nocapture` prints times and evaluations.
#[test]
fn usual_shapes_are_proved() {
    let mut wrong = String::new();
    for (name, document) in shapes() {
        let begun = Instant::now();
        let traced = trace(&document);
        let (built, proof) = (begun.elapsed(), proved(&document));
        match (traced, proof) {
            (Ok(_), Ok(proof)) => {
                assert!(proof.hollow <= 1e-9 * 16.0 && proof.evaluations < 5000, "{name}: {proof}");
                println!("{name}: built in {built:?}, {proof}");
            }
            (traced, proof) => wrong += &format!("{name}: {:?} {:?}\n", traced.err(), proof.err()),
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// r, z and slope of an explicit formula by a radius.
fn exact(z: impl Fn(f64) -> f64, slope: impl Fn(f64) -> f64, r: f64) -> (f64, f64, f64) {
    (r, z(r), slope(r))
}

#[test]
fn a_smooth_bump_between_all_points_that_are_compared_is_followed() {
    let (height, at, width) = (5.0625e-5, 3.60063, 0.03);
    let bump = |r: f64| height * (-((r - at) / width) * ((r - at) / width)).exp();
    let z = |r: f64| r * r / 16.0 + bump(r);
    let slope = |r: f64| (r / 8.0 - 2.0 * (r - at) / (width * width) * bump(r)).atan();
    let text = "r^2/16+5.0625e-05*exp(-((r-3.60063)/0.03)^2)";
    for document in [
        explicit(text, 12.0),
        parametric("t", &text.replace("-((r", "-((t").replace("r^2", "t^2"), [0.0, 6.0]),
        implicit(&format!("z - ({text})"), [0.0, 0.0], Some(12.0)),
    ] {
        let curve = fitted(&document);
        for k in 1..4000 {
            let (r, z, slope) = exact(z, slope, 6.0 * f64::from(k) / 4000.0);
            assert!((curve.height_at_radius(r, [0.0, 1.6]) - z).abs() < 6e-9, "{document:?} at {r}");
            let found = curve.point_at(slope);
            assert!((found.0 - r).abs() < 6e-9 && (found.1 - z).abs() < 6e-9, "{document:?} at {r}: {found:?}");
        }
    }
}

#[test]
fn flat_tips_have_their_radius_by_slope() {
    for power in [3, 4, 6, 10, 20] {
        let curve = fitted(&explicit(&format!("r^{power}/6^{}/4", power - 1), 12.0));
        for digits in 2..16 {
            let slope = libm::pow(10.0, -f64::from(digits));
            let r = 6.0 * libm::pow(slope.tan() * 4.0 / f64::from(power), 1.0 / f64::from(power - 1));
            let found = curve.point_at(slope).0;
            assert!((found - r).abs() < 1.2e-8, "r^{power} at {slope}: {found} {r}");
        }
    }
}

fn fitted(document: &FormulaDocument) -> Fitted {
    let traced = trace(document).unwrap_or_else(|error| panic!("{document:?}: {error}"));
    println!("{:?}", traced.notes);
    match traced.parts.into_iter().next().unwrap() {
        TracedPart::Curve { curve, .. } => curve,
        straight => panic!("{straight:?}"),
    }
}

#[test]
fn what_was_refused_for_rounding_is_accepted() {
    for document in [
        explicit("r^1.05", 6.0),
        parametric("exp(t)", "exp(2*t)", [-30.0, 1.0]),
        parametric("5*sin(t)", "1e6-5*cos(t)", [0.0, FRAC_PI_2]),
    ] {
        fitted(&document);
    }
    // a circle but for the rounding of 1e6
    let curve = fitted(&parametric("5*sin(t)", "1e6-5*cos(t)", [0.0, FRAC_PI_2]));
    let (r, z) = curve.point_at(1.0);
    assert!((r - 5.0 * 1f64.sin()).abs() < 1e-9 && (z - 5.0 + 5.0 * 1f64.cos()).abs() < 1e-9, "{r} {z}");
}

#[test]
fn what_stays_refused_has_its_true_reason() {
    let cube = "(r/5)^3+((5-z)/5)^3-1";
    for (document, expected) in [
        (parametric("5*sin(t)", "1e8-5*cos(t)", [0.0, FRAC_PI_2]), "large terms cancel"),
        (parametric("sqrt(t)", "t", [0.0, 4.0]), "t = 0: r or z has no finite derivative at the tip; use a parameter"),
        (explicit("sin(r)/r", 2.0), "its series has"),
        (
            explicit("5-5*(1-(r/5)^4)^(1/4)", 10.0),
            "r = 5: the curve cannot be proved convex here: it is so nearly upright",
        ),
        (implicit(cube, [0.0, 0.0], None), "the slope comes near 90 degrees here and falls again"),
    ] {
        let message = refused(&document);
        assert!(message.contains(expected), "{document:?}: {message}");
    }
}
