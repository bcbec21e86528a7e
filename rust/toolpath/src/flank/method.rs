//! Ways to place the tool along a strip.

use rayon::prelude::*;

use super::course::{Course, STRAIGHT_MOVES};
use super::cutter::Flank;
use super::stand::Stand;
use super::touch::{on_rails, touching};
use super::{FlankError, RuledStrip};

/// Shares of the ruling at which the two-point offset takes its points.
const QUARTERS: [f64; 2] = [0.25, 0.75];

/// Of more positions than straight moves count, so many are compared.
const COMPARED: usize = 161;
/// A change of the spread so many times that of the contacts, or of its mean, is a jump.
const STEADY: f64 = 2.0;

/// How positions are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Both rails touched, the contacts spread so that the moving tool leaves least of the surface and enters it least.
    Swept,
    /// Both rails touched at equal parameters.
    Rails,
    /// Both rails and the ruling touched (J.-M. Redonnet, W. Rubio, G. Dessein: Side milling of ruled surfaces: optimum positioning
    /// of the milling cutter and calculation of interference. International Journal of Advanced Manufacturing Technology 14, 1998).
    ThreePoints,
    /// The axis at the radius along the normals of two points of the ruling, at its quarters (X.-W. Liu: Five-axis NC cylindrical
    /// milling of sculptured surfaces. Computer-Aided Design 27, 1995).
    TwoPoints,
    /// The axis parallel to the ruling, at the radius along the normal of its middle.
    OnePoint,
}

/// `count` positions of a flank, evenly spread over the rails' parameters, the first and the last at their ends.
///
/// # Errors
/// The tool does not fit, or no position touches both rails.
pub fn positions(strip: &RuledStrip, flank: &Flank, count: usize, method: Method) -> Result<Vec<Stand>, FlankError> {
    strip.takes(flank)?;
    if count < 2 {
        return Err(FlankError::Count(count));
    }
    let share = |i: usize| i as f64 / (count - 1) as f64;
    let spreads = match method {
        Method::Swept => least_left(strip, flank, count)?,
        Method::Rails | Method::ThreePoints | Method::TwoPoints | Method::OnePoint => vec![0.0; count],
    };
    let position = |(i, spread): (usize, &f64)| match method {
        Method::Swept | Method::Rails => on_rails(strip, flank, share(i), *spread),
        Method::ThreePoints => on_ruling(strip, flank, share(i)),
        Method::TwoPoints => Ok(offset(strip, flank, share(i), QUARTERS)),
        Method::OnePoint => Ok(beside_middle(strip, flank, share(i))),
    };
    spreads.iter().enumerate().map(position).collect()
}

/// The spreads that leave least: those of a smooth course, or those that touch the ruling all along where the largest height is
/// smaller so.
fn least_left(strip: &RuledStrip, flank: &Flank, count: usize) -> Result<Vec<f64>, FlankError> {
    let course = Course::fitted(strip, flank, count)?;
    let is_straight = count <= STRAIGHT_MOVES;
    let compared = if is_straight { count } else { COMPARED };
    let largest = |spreads: &[f64]| Course::largest_of(strip, flank, spreads, is_straight);
    let least = largest(&course.spreads(compared))?;
    let lefts = touched(strip, flank, compared).map(|spreads| {
        let steady = spreads.filter(|spreads| is_steady(spreads))?;
        largest(&steady).ok().filter(|left| *left < least)
    });
    let best = (0..lefts.len()).filter(|i| lefts[*i].is_some()).min_by(|a, b| {
        let left = |i: &usize| lefts[*i].unwrap_or(f64::INFINITY);
        left(a).total_cmp(&left(b))
    });
    let touching = best.and_then(|i| touched(strip, flank, count).into_iter().nth(i).flatten());
    Ok(touching.filter(|spreads| is_steady(spreads)).unwrap_or_else(|| course.spreads(count)))
}

/// The spreads at which the ruling is touched on either side, and the least of both, where it is all along.
fn touched(strip: &RuledStrip, flank: &Flank, count: usize) -> [Option<Vec<f64>>; 3] {
    let at = |i: usize| touching(strip, flank, i as f64 / (count - 1) as f64).unwrap_or_default();
    let found: Vec<_> = (0..count).into_par_iter().map(at).collect();
    let sides = [0, 1].map(|side| found.iter().map(|spreads| spreads[side]).collect());
    let least =
        |spreads: &[Option<f64>; 2]| spreads.iter().flatten().copied().min_by(|a, b| a.abs().total_cmp(&b.abs()));
    let [first, second] = sides;
    [first, second, found.iter().map(least).collect()]
}

/// Whether no spread differs from the one before it by far more than they do in the mean.
fn is_steady(spreads: &[f64]) -> bool {
    let changes = spreads.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let mean = changes.clone().sum::<f64>() / (spreads.len() - 1) as f64;
    changes.fold(0.0, f64::max) <= STEADY * mean.max(1.0 / (spreads.len() - 1) as f64)
}

/// Length of the ruling there, mm.
fn ruling(strip: &RuledStrip, u: f64) -> f64 {
    (strip.rail(1, u).point - strip.rail(0, u).point).norm()
}

/// Points of the axis beside both rails, where it lies beside two points of a ruling.
fn offset(strip: &RuledStrip, flank: &Flank, u: f64, shares: [f64; 2]) -> Stand {
    let growth = flank.growth_along_line() * ruling(strip, u);
    let radii = shares.map(|v| flank.radius() + growth * v);
    let [a, b] = [0, 1].map(|i| strip.point([u, shares[i]]) + strip.normal([u, shares[i]]) * radii[i]);
    let along = (b - a) / (shares[1] - shares[0]);
    // the tool is moved up or down until it has the first of the radii at the first of the points
    let back = if flank.growth() > 0.0 {
        along.normalize() * ((radii[0] - flank.radius()) / flank.growth())
    } else {
        along * shares[0]
    };
    Stand { axis: [a - back, b + along * (1.0 - shares[1])], contacts: shares.map(|v| strip.point([u, v])) }
}

fn beside_middle(strip: &RuledStrip, flank: &Flank, u: f64) -> Stand {
    let middle = [u, 0.5];
    let aside = strip.normal(middle);
    let radii = [flank.radius(), flank.radius() + flank.growth_along_line() * ruling(strip, u)];
    let axis = [0, 1].map(|rail| strip.rail(rail, u).point + aside * radii[rail]);
    Stand { axis, contacts: [strip.point(middle); 2] }
}

/// The position on both rails whose flank touches the ruling too: of those the one with the least spread.
fn on_ruling(strip: &RuledStrip, flank: &Flank, u: f64) -> Result<Stand, FlankError> {
    let spreads = touching(strip, flank, u)?;
    let least = spreads.into_iter().flatten().min_by(|a, b| a.abs().total_cmp(&b.abs()));
    on_rails(strip, flank, u, least.ok_or(FlankError::NoThreePoints { u })?)
}
