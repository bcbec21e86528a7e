//! A profile by formula: z(r); r(t), z(t); or f(r, z) = 0.
//!
//! The text is checked and parsed ([`tokens`], [`expression`]) and evaluated with exact derivatives ([`jet`]). Each
//! form becomes a [`sample::Route`]: points by the formula's own parameter, from tip to base. The route is looked at point by
//! point for what is no profile ([`proof`]), proved convex between the points by interval arithmetic ([`convexity`],
//! [`interval`]) and followed by polynomials ([`fit`]), which answer by slope, are proved to be near it ([`closeness`],
//! [`series`]) and proved convex too ([`polynomials`]).

mod closeness;
mod convexity;
mod explicit;
mod expression;
mod field;
mod fit;
mod implicit;
mod interval;
mod jet;
mod number;
mod parametric;
mod polynomials;
mod proof;
mod refusal;
mod sample;
mod series;
mod solve;
mod tokens;
mod trace;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::fitted::Fitted;
use crate::error::positive_length;
use crate::GeometryError;
use expression::Expression;
use refusal::refusal;
use sample::Route;
use tokens::{Names, CONSTANTS, FUNCTIONS};

/// Most parameters of a formula.
const MOST_PARAMETERS: usize = 32;
/// A curve this near to its chord, in parts of the size, is straight.
const STRAIGHT: f64 = 1e-13;

/// A profile by formula; r and z in mm, angles in rad.
///
/// One of three forms: `z` (of r), with `diameter`; `r` and `z` (of t) and `t` = [from, to]; `implicit` (of r and z,
/// zero on the curve) and `start` = [r, z], a point on it. Formulas take numbers, + - * / ^ ( ), pi, e,
/// sqrt exp ln log10 sin cos tan asin acos atan sinh cosh tanh, and the parameters.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(description = "A curve by formula: explicit, parametric or implicit.")]
pub struct FormulaDocument {
    /// Height: of r when it stands alone, of t beside `r`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "formula"))]
    pub z: Option<String>,
    /// Radius as a function of t.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "formula"))]
    pub r: Option<String>,
    /// Range of t; either end may be the tip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "formula"))]
    pub t: Option<[f64; 2]>,
    /// A function of r and z that is zero on the curve.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "formula"))]
    pub implicit: Option<String>,
    /// A point [r, z] of the curve that `implicit` describes, or near it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "formula"))]
    pub start: Option<[f64; 2]>,
    /// Numbers by name, for use in the formulas.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(extend("x-unit" = "formula"))]
    pub parameters: BTreeMap<String, f64>,
    /// Diameter of the base, mm, where the curve ends; `z` alone needs it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm"))]
    pub diameter: Option<f64>,
    /// Flat at the tip: its radius, mm.
    #[serde(default)]
    #[schemars(extend("x-unit" = "mm"))]
    pub tip_flat: f64,
}

/// What a formula became.
#[derive(Clone, Debug, PartialEq)]
pub struct Traced {
    /// Its parts from the tip, which is at the origin, to the base.
    pub parts: Vec<TracedPart>,
    /// What was done to it and how exactly it is followed, in words.
    pub notes: Vec<String>,
}

/// A part of a profile: a curve, or a straight line.
#[derive(Clone, Debug, PartialEq)]
pub enum TracedPart {
    /// A curve between two slopes, rad.
    Curve {
        /// The curve.
        curve: Fitted,
        /// Slope at its lower end.
        from: f64,
        /// Slope at its upper end.
        to: f64,
    },
    /// A straight line.
    Straight {
        /// Its slope, rad.
        slope: f64,
        /// Its lower end: radius and height, mm.
        from: (f64, f64),
        /// Its upper end.
        to: (f64, f64),
    },
}

/// Traces a formula from its tip to its base; the tip flat is the caller's.
///
/// # Errors
/// A formula that cannot be read, keys that do not go together, or a curve that is not a profile, with the position.
pub fn trace(document: &FormulaDocument) -> Result<Traced, GeometryError> {
    let mut route = route(document)?;
    proof::prove(&route)?;
    let size = route.size();
    let source = route.source.as_ref();
    if let Some((part, slope)) = straight(&route) {
        let proof = convexity::prove_straight(source, &route.stretches, slope, size)?;
        route.notes.push(format!("the formula is a straight line, by interval arithmetic with {proof}"));
        return Ok(Traced { parts: vec![part], notes: route.notes });
    }
    let formula = convexity::prove(source, &route.stretches, &[], size)?;
    let (curve, bound) = fit::fit(&route)?;
    let followed = polynomials::prove(&curve, size)?;
    route.notes.push(bound);
    route.notes.push(format!(
        "proved convex by interval arithmetic: the formula with {formula}; the polynomials with {followed}"
    ));
    let (from, to) = curve.slopes();
    Ok(Traced { parts: vec![TracedPart::Curve { curve, from, to }], notes: route.notes })
}

/// The route of whichever form the document has.
fn route(document: &FormulaDocument) -> Result<Route, GeometryError> {
    check_parameters(&document.parameters)?;
    let base = match document.diameter {
        Some(diameter) => Some(positive_length("diameter", diameter)? / 2.0),
        None => None,
    };
    let read = |key: &str, text: &str, variables: &[&str]| {
        Expression::new(text, &Names { key, variables, parameters: &document.parameters })
    };
    match (&document.z, &document.r, document.t, &document.implicit, document.start, base) {
        (Some(z), None, None, None, None, Some(radius)) => explicit::route(read("z", z, &["r"])?, radius),
        (Some(z), Some(r), Some(range), None, None, base) => {
            check_range(range)?;
            parametric::route(read("r", r, &["t"])?, read("z", z, &["t"])?, range, base)
        }
        (None, None, None, Some(implicit), Some(start), base) => {
            check_start(start)?;
            implicit::route(read("implicit", implicit, &["r", "z"])?, start, base)
        }
        (Some(_), None, None, None, None, None) => {
            Err(GeometryError::Keys("a formula z(r) takes a diameter: there the curve ends".to_owned()))
        }
        _ => Err(GeometryError::Keys(
            "a formula takes z and diameter, or r, z and t = [from, to], or implicit and start = [r, z]".to_owned(),
        )),
    }
}

fn check_range([from, to]: [f64; 2]) -> Result<(), GeometryError> {
    if from.is_finite()
        && to.is_finite()
        && (to - from).abs() > 1e-9 * from.abs().max(to.abs())
        && (to - from).is_finite()
    {
        return Ok(());
    }
    let reason = format!("[{from}, {to}] is no range");
    Err(refusal("t".to_owned(), reason, "give two different finite numbers"))
}

fn check_start(start: [f64; 2]) -> Result<(), GeometryError> {
    if start.iter().all(|x| x.abs() <= 1e4) {
        return Ok(());
    }
    Err(refusal("start".to_owned(), "it lies beyond 10000 mm".to_owned(), "give [r, z] in mm, on the curve"))
}

fn check_parameters(parameters: &BTreeMap<String, f64>) -> Result<(), GeometryError> {
    if parameters.len() > MOST_PARAMETERS {
        let reason = format!("there are {}, more than {MOST_PARAMETERS}", parameters.len());
        return Err(refusal("parameters".to_owned(), reason, "put constants into the formula"));
    }
    for (name, value) in parameters {
        let refuse = |reason: String, hint: &str| {
            let shown: String = name.chars().take(24).collect();
            Err(refusal(format!("parameters.{shown}"), reason, hint))
        };
        let mut characters = name.chars();
        let starts = characters.next().is_some_and(|c| c.is_ascii_alphabetic() || c == '_');
        if !starts || name.len() > 64 || !characters.all(|c| c.is_ascii_alphanumeric() || c == '_') {
            return refuse("a name is letters, digits and _, a letter first".to_owned(), "rename it");
        }
        let taken = FUNCTIONS.contains(&name.as_str()) || CONSTANTS.iter().any(|(constant, _)| constant == name);
        if taken || ["r", "z", "t"].contains(&name.as_str()) {
            return refuse("the name has a meaning already".to_owned(), "rename it");
        }
        if !value.is_finite() {
            return refuse(format!("{value} is not a finite number"), "give a number");
        }
    }
    Ok(())
}

/// The line that the route seems to be by its values and by its derivatives, and its slope, rad.
fn straight(route: &Route) -> Option<(TracedPart, f64)> {
    let size = route.size();
    let [r, z] = route.samples.last()?.point;
    let (length, slope) = ((r * r + z * z).sqrt(), libm::atan2(z, r));
    let off = |point: [f64; 2]| ((point[0] * z - point[1] * r) / length).abs();
    let inside = route.samples.get(1..route.samples.len() - 1)?;
    let flat = route.samples.iter().all(|sample| off(sample.point) <= STRAIGHT * size)
        && inside.iter().all(|sample| (sample.slope() - slope).abs() <= 1e-6);
    flat.then_some((TracedPart::Straight { slope, from: (0.0, 0.0), to: (r, z) }, slope))
}

#[cfg(test)]
mod fuzz;
#[cfg(test)]
mod proof_tests;
#[cfg(test)]
mod tests;
