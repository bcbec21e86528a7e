//! Points and straight sides in plan, mm.

/// A point in plan, mm.
pub type PlanPoint = [f64; 2];

/// The distance of two points, mm.
#[must_use]
pub fn apart(a: PlanPoint, b: PlanPoint) -> f64 {
    libm::hypot(b[0] - a[0], b[1] - a[1])
}

/// The point of a side that is nearest to a point.
#[must_use]
pub fn foot(point: PlanPoint, [a, b]: [PlanPoint; 2]) -> PlanPoint {
    let (along, arm) = ([b[0] - a[0], b[1] - a[1]], [point[0] - a[0], point[1] - a[1]]);
    let square = along[0] * along[0] + along[1] * along[1];
    let dot = along[0] * arm[0] + along[1] * arm[1];
    let share = if square > 0.0 { (dot / square).clamp(0.0, 1.0) } else { 0.0 };
    [a[0] + share * along[0], a[1] + share * along[1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_point_of_a_side_lies_on_it_or_is_its_end() {
        let side = [[0.0, 0.0], [4.0, 0.0]];
        for (point, nearest) in [([1.0, 3.0], [1.0, 0.0]), ([-3.0, 4.0], [0.0, 0.0]), ([7.0, 4.0], [4.0, 0.0])] {
            assert!(apart(foot(point, side), nearest) < 1e-15);
        }
        assert!(apart(foot([1.0, 1.0], [[2.0, 3.0]; 2]), [2.0, 3.0]) < 1e-15);
        assert!((apart([-3.0, 4.0], [0.0, 0.0]) - 5.0).abs() < 1e-15);
    }
}
