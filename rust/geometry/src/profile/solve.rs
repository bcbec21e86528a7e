//! The slope at a radius, at a height and nearest to a point, for curves without a closed form of it.
//!
//! A curve is given by slope (rad), as its point (r, z) and its radius of curvature, mm.

/// Steps at most: bisection alone would need sixty.
const STEPS: usize = 80;

/// The slope of `within` at which `curve` has `radius`, by Newton's method kept between two sides.
///
/// It works in the root of the slope: in it, a radius that begins flat (clothoid) or straight is smooth.
pub fn slope_at_radius(curve: impl Fn(f64) -> ((f64, f64), f64), radius: f64, within: [f64; 2]) -> f64 {
    let (mut low, mut high) = (within[0].sqrt(), within[1].sqrt());
    let mut x = 0.5 * (low + high);
    for _ in 0..STEPS {
        let slope = x * x;
        let ((r, _), curvature_radius) = curve(slope);
        let excess = r - radius;
        if excess > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let rate = 2.0 * x * libm::cos(slope) * curvature_radius;
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

/// The slope of `within` at which `curve` has `height`, by Newton's method kept between two sides.
pub fn slope_at_height(curve: impl Fn(f64) -> ((f64, f64), f64), height: f64, within: [f64; 2]) -> f64 {
    let [mut low, mut high] = within;
    let mut slope = 0.5 * (low + high);
    for _ in 0..STEPS {
        let ((_, z), curvature_radius) = curve(slope);
        let excess = z - height;
        if excess > 0.0 {
            high = slope;
        } else {
            low = slope;
        }
        let rate = libm::sin(slope) * curvature_radius;
        let next = slope - excess / rate;
        let next = if next > low && next < high { next } else { 0.5 * (low + high) };
        let step = (next - slope).abs();
        slope = next;
        if step <= 1e-15 * slope || high - low <= 1e-15 * high {
            break;
        }
    }
    slope
}

/// The last step to the slope of the nearest point is at most this share of the interval: its error is of the square.
pub const NEAREST: f64 = 1e-5;

/// The slope of `within` at which `curve` is nearest to a point, by Newton's method kept between two sides.
///
/// For a point no farther inside than the radius of curvature the distance has one minimum. Farther inside the slope
/// is that of one of the minima: a point on the curve, if not the nearest.
pub fn slope_nearest(
    curve: impl Fn(f64) -> ((f64, f64), f64),
    (r, z): (f64, f64),
    within: [f64; 2],
    guess: f64,
) -> f64 {
    let [mut low, mut high] = within;
    let width = high - low;
    let mut slope = guess.clamp(low, high);
    for _ in 0..STEPS {
        let (sin, cos) = libm::sincos(slope);
        let (on, curvature_radius) = curve(slope);
        let along = (r - on.0) * cos + (z - on.1) * sin;
        if along > 0.0 {
            low = slope;
        } else {
            high = slope;
        }
        let rate = curvature_radius + (r - on.0) * sin - (z - on.1) * cos;
        let next = slope + along / rate;
        let next = if next > low && next < high { next } else { 0.5 * (low + high) };
        let step = (next - slope).abs();
        slope = next;
        // the distance is stationary in the slope
        if step <= NEAREST * width || high - low <= f64::EPSILON * high {
            break;
        }
    }
    slope
}
