//! The slope at a radius, for curves without a closed form of it.

use super::Meridian;

/// Steps at most: bisection alone would need sixty.
const STEPS: usize = 80;

/// The slope of `within` at which `curve` has `radius`, by Newton's method kept between two sides.
///
/// It works in the root of the slope: in it, a radius that begins flat (clothoid) or straight is smooth.
pub fn slope_at_radius(curve: &(impl Meridian + ?Sized), radius: f64, within: [f64; 2]) -> f64 {
    let (mut low, mut high) = (within[0].sqrt(), within[1].sqrt());
    let mut x = 0.5 * (low + high);
    for _ in 0..STEPS {
        let slope = x * x;
        let excess = curve.point_at(slope).0 - radius;
        if excess > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let rate = 2.0 * x * libm::cos(slope) * curve.curvature_radius_at(slope);
        let next = x - excess / rate;
        let next = if next > low && next < high { next } else { 0.5 * (low + high) };
        let step = (next - x).abs();
        x = next;
        if step <= 1e-15 * x || high - low <= 1e-15 * high {
            break;
        }
    }
    (x * x).clamp(within[0], within[1])
}
