//! Positions on both rails whose flank touches the ruling too.

use styluscam_geometry::Vector;

use super::cutter::Flank;
use super::stand::{stand, Stand};
use super::{FlankError, RuledStrip};

/// Steps of the search for the spread that touches the ruling.
const STEPS: usize = 40;
/// A flank this near to the ruling touches it, as a share of its radius.
const TOUCHING: f64 = 1e-9;
/// The largest spread tried, as a share of the rails, and the first.
const WIDEST: f64 = 0.25;
const NARROWEST: f64 = WIDEST / 64.0;

/// The position whose contacts are spread so far.
///
/// # Errors
/// [`FlankError::NoPosition`].
pub fn on_rails(strip: &RuledStrip, flank: &Flank, u: f64, spread: f64) -> Result<Stand, FlankError> {
    stand(strip, flank, [u - spread, u + spread], [0.0; 2]).map(|(stand, _)| stand)
}

/// The least spread above and that below 0 at which the flank touches both rails and the ruling.
pub fn touching(strip: &RuledStrip, flank: &Flank, u: f64) -> [Option<f64>; 2] {
    let ends = [0, 1].map(|rail| strip.rail(rail, u).point);
    let gap = |spread: f64| on_rails(strip, flank, u, spread).map(|stand| gap(&stand, flank, ends));
    let straight = gap(0.0).ok();
    if straight.is_some_and(|gap| gap.abs() < TOUCHING * flank.radius()) {
        return [Some(0.0); 2];
    }
    // the flank comes nearer to the ruling or goes away from it with the spread: towards where they touch
    [1.0, -1.0].map(|sign| {
        let mut low = straight.map(|gap| (0.0, gap));
        let mut spread = NARROWEST;
        while spread <= WIDEST {
            let high = gap(sign * spread).ok().map(|gap| (sign * spread, gap));
            match (low, high) {
                (Some(low), Some(high)) if high.1 * low.1 <= 0.0 => {
                    return root(low, high, &gap, TOUCHING * flank.radius());
                }
                // positions end there
                (Some(_), None) => return None,
                _ => {}
            }
            low = high;
            spread *= 2.0;
        }
        None
    })
}

/// Where a function is 0 between two places of opposite sign: false position, whose end that stays counts half each time
/// (Illinois; M. Dowell, P. Jarratt: A modified regula falsi method for computing the root of an equation. BIT 11, 1971).
fn root(
    mut low: (f64, f64),
    mut high: (f64, f64),
    function: &dyn Fn(f64) -> Result<f64, FlankError>,
    tolerance: f64,
) -> Option<f64> {
    for _ in 0..STEPS {
        let at = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
        let value = function(at).ok()?;
        if value.abs() < tolerance {
            return Some(at);
        }
        if value * high.1 < 0.0 {
            (low, high) = (high, (at, value));
        } else {
            (low.1, high) = (0.5 * low.1, (at, value));
        }
    }
    None
}

/// How far the flank is from a ruling at the nearest, mm; below 0 where it enters.
fn gap(stand: &Stand, flank: &Flank, [first, second]: [Vector; 2]) -> f64 {
    let direction = stand.direction();
    let (from, ruling) = (first - stand.axis[0], second - first);
    let (start, way) = (from.dot(&direction), ruling.dot(&direction));
    let (beside, across) = (from - direction * start, ruling - direction * way);
    // the distance from the flank is convex along the ruling: the root of a square less a multiple of the share
    let (a, b) = (across.norm_squared(), beside.dot(&across));
    let slope = way * flank.growth_along_line();
    let left = (a * beside.norm_squared() - b * b).max(0.0);
    let bend = a - slope * slope;
    // where the ruling is steeper in the cone than its lines, it only comes nearer upwards
    let nearest = if bend > 0.0 { (slope * (left / bend).sqrt() - b) / a } else { 1.0 };
    let nearest = if nearest.is_finite() { nearest.clamp(0.0, 1.0) } else { 0.5 };
    flank.distance(start + way * nearest, (beside + across * nearest).norm())
}
