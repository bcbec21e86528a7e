//! Cones that stand on a line: the lowest of them over a position.

use crate::Vector;

/// Over a position in plan: the lowest of all upright cones, opening upwards with `slope` (rise per length in plan, above 0), whose
/// tips lie on the segment from `a` to `b`; with where that tip lies. The second is a share of the segment, 0 to 1.
///
/// The tip at length s along the segment, which rises by m per length in plan, gives the height h + m s + slope sqrt((x - s)^2 + y^2)
/// over a position x along it and y across it. It is convex in s, and least where x - s = y m / sqrt(slope^2 - m^2); where the segment is
/// steeper than the cones, at its lower end.
pub fn lowest(a: Vector, b: Vector, [px, py]: [f64; 2], slope: f64) -> (f64, f64) {
    let (dx, dy, rise) = (b.x - a.x, b.y - a.y, b.z - a.z);
    let length = libm::hypot(dx, dy);
    let at = |share: f64| {
        let away = libm::hypot(px - (a.x + share * dx), py - (a.y + share * dy));
        (a.z + share * rise + slope * away, share)
    };
    if rise.abs() >= slope * length {
        return at(if rise > 0.0 { 0.0 } else { 1.0 });
    }
    let (rx, ry) = (px - a.x, py - a.y);
    let along = (rx * dx + ry * dy) / length;
    let across = (rx * dy - ry * dx).abs() / length;
    let m = rise / length;
    let s = along - across * m / (slope * slope - m * m).sqrt();
    at((s / length).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn no_tip_of_the_segment_gives_less(
            ends in prop::collection::vec(-9.0..9.0_f64, 6),
            (px, py) in (-20.0..20.0_f64, -20.0..20.0_f64),
            slope in 0.1..5.0_f64,
        ) {
            let [a, b] = [0, 3].map(|i| Vector::new(ends[i], ends[i + 1], ends[i + 2]));
            let (height, share) = lowest(a, b, [px, py], slope);
            let over = |share: f64| {
                let tip = a + (b - a) * share;
                tip.z + slope * libm::hypot(px - tip.x, py - tip.y)
            };
            prop_assert!((over(share) - height).abs() < 1e-9);
            for i in 0..=1000 {
                prop_assert!(over(f64::from(i) / 1000.0) >= height - 1e-9);
            }
        }
    }
}
