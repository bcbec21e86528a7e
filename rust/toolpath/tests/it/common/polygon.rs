//! The least value of a convex function over a convex polygon of the plane, by cuts through the centre of gravity.
//!
//! Each cut throws away what the tangent at the centre proves not to be lower than the best value found: at least a third
//! of the area (Levin 1965, Newman 1965). Kinks, flats and needle-shaped valleys change nothing of that.

/// Value and gradient of a convex function; at a kink any of its gradients.
pub type Tangent = (f64, [f64; 2]);

const CUTS: usize = 400;
/// A polygon this thin, as a share of its length squared, is as good as a line.
const THIN: f64 = 1e-13;

/// The least value found; it ends early with the first one that is at most `enough`.
pub fn least(corners: &[[f64; 2]], enough: f64, mut function: impl FnMut([f64; 2]) -> Tangent) -> f64 {
    let mut polygon = corners.to_vec();
    let mut best = f64::INFINITY;
    let mut looks = corners.to_vec();
    for _ in 0..CUTS {
        for at in std::mem::take(&mut looks) {
            let (value, gradient) = function(at);
            best = best.min(value);
            if best <= enough {
                return best;
            }
            polygon = cut(&polygon, at, gradient, best - value);
        }
        if polygon.is_empty() {
            return best;
        }
        looks.push(centre(&polygon));
    }
    best
}

/// What of a polygon lies where `gradient` (p - at) is at most `spare`.
fn cut(polygon: &[[f64; 2]], at: [f64; 2], gradient: [f64; 2], spare: f64) -> Vec<[f64; 2]> {
    let over = |p: [f64; 2]| gradient[0] * (p[0] - at[0]) + gradient[1] * (p[1] - at[1]) - spare;
    let mut left = Vec::with_capacity(polygon.len() + 1);
    for (i, p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        let (a, b) = (over(*p), over(q));
        if a <= 0.0 {
            left.push(*p);
        }
        if (a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0) {
            let share = a / (a - b);
            left.push([p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1])]);
        }
    }
    left
}

fn centre(polygon: &[[f64; 2]]) -> [f64; 2] {
    let from = polygon[0];
    let (mut area, mut sum, mut mean, mut length) = (0.0, [0.0; 2], [0.0; 2], 0.0_f64);
    for (p, q) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        let (a, b) = ([p[0] - from[0], p[1] - from[1]], [q[0] - from[0], q[1] - from[1]]);
        let piece = a[0] * b[1] - a[1] * b[0];
        area += piece;
        length = length.max(a[0].hypot(a[1]));
        for i in 0..2 {
            sum[i] += piece * (a[i] + b[i]) / 3.0;
            mean[i] += a[i] / polygon.len() as f64;
        }
    }
    let middle = if area.abs() > THIN * length * length { sum.map(|s| s / area) } else { mean };
    [from[0] + middle[0], from[1] + middle[1]]
}
