//! Ways to place the tool along a strip.

use styluscam_geometry::Vector;

use super::course::Course;
use super::stand::{stand, Stand};
use super::{FlankError, RuledStrip};

/// Shares of the ruling at which the two-point offset takes its points.
const QUARTERS: [f64; 2] = [0.25, 0.75];
/// Steps of the search for the spread that touches the ruling.
const STEPS: usize = 60;
/// An axis this near to the radius from the ruling touches it, as a share of the radius.
const TOUCHING: f64 = 1e-9;
/// The largest spread tried, as a share of the rails.
const WIDEST: f64 = 0.25;

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

/// `count` positions of a cylinder, evenly spread over the rails' parameters, the first and the last at their ends.
///
/// # Errors
/// The radius does not fit, or no position touches both rails.
pub fn positions(strip: &RuledStrip, radius: f64, count: usize, method: Method) -> Result<Vec<Stand>, FlankError> {
    strip.takes(radius)?;
    if count < 2 {
        return Err(FlankError::Count(count));
    }
    let course = match method {
        Method::Swept => Course::fitted(strip, radius)?,
        Method::Rails | Method::ThreePoints | Method::TwoPoints | Method::OnePoint => Course::straight(),
    };
    let position = |i: usize| {
        let u = i as f64 / (count - 1) as f64;
        match method {
            Method::Swept | Method::Rails => on_rails(strip, radius, u, course.spread(u)),
            Method::ThreePoints => on_ruling(strip, radius, u),
            Method::TwoPoints => Ok(offset(strip, radius, u, QUARTERS)),
            Method::OnePoint => Ok(beside_middle(strip, radius, u)),
        }
    };
    (0..count).map(position).collect()
}

fn on_rails(strip: &RuledStrip, radius: f64, u: f64, spread: f64) -> Result<Stand, FlankError> {
    stand(strip, radius, [u - spread, u + spread], [0.0; 2]).map(|(stand, _)| stand)
}

/// Points of the axis beside both rails, where it lies beside two points of a ruling.
fn offset(strip: &RuledStrip, radius: f64, u: f64, shares: [f64; 2]) -> Stand {
    let [a, b] = shares.map(|v| strip.point([u, v]) + strip.normal([u, v]) * radius);
    let along = (b - a) / (shares[1] - shares[0]);
    let axis = [a - along * shares[0], b + along * (1.0 - shares[1])];
    Stand { axis, contacts: shares.map(|v| strip.point([u, v])) }
}

fn beside_middle(strip: &RuledStrip, radius: f64, u: f64) -> Stand {
    let middle = [u, 0.5];
    let aside = strip.normal(middle) * radius;
    Stand { axis: [0, 1].map(|rail| strip.rail(rail, u).point + aside), contacts: [strip.point(middle); 2] }
}

/// The position on both rails whose axis is at the radius from the ruling too: of those the one with the least spread.
fn on_ruling(strip: &RuledStrip, radius: f64, u: f64) -> Result<Stand, FlankError> {
    let ends = [0, 1].map(|rail| strip.rail(rail, u).point);
    let beyond = |spread: f64| {
        let stand = on_rails(strip, radius, u, spread)?;
        Ok::<_, FlankError>((line_distance(stand.axis, ends) - radius, stand))
    };
    let (straight, stand) = beyond(0.0)?;
    if straight.abs() < TOUCHING * radius {
        return Ok(stand);
    }
    // the axis comes nearer to the ruling or goes away from it with the spread: towards where they touch
    let mut found: Option<(f64, Stand)> = None;
    for sign in [1.0, -1.0] {
        let mut low = (0.0, straight);
        let mut step = WIDEST / 64.0;
        while step <= WIDEST {
            let Ok((distance, _)) = beyond(sign * step) else { break };
            if distance * straight <= 0.0 {
                let mut high = (step, distance);
                for _ in 0..STEPS {
                    let middle = 0.5 * (low.0 + high.0);
                    let (distance, _) = beyond(sign * middle)?;
                    if distance * straight > 0.0 {
                        low = (middle, distance);
                    } else {
                        high = (middle, distance);
                    }
                }
                let (_, stand) = beyond(sign * high.0)?;
                if found.is_none_or(|(spread, _)| high.0 < spread) {
                    found = Some((high.0, stand));
                }
                break;
            }
            low = (step, distance);
            step *= 2.0;
        }
    }
    found.map(|(_, stand)| stand).ok_or(FlankError::NoThreePoints { u })
}

/// Distance between two lines through two points each, mm.
fn line_distance([a, b]: [Vector; 2], [c, d]: [Vector; 2]) -> f64 {
    let across = (b - a).cross(&(d - c));
    let length = across.norm();
    if length > 1e-12 * (b - a).norm() * (d - c).norm() {
        (c - a).dot(&across).abs() / length
    } else {
        (c - a).cross(&(b - a).normalize()).norm()
    }
}
