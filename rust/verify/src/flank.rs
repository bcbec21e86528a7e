//! What a moving cylinder leaves of a surface, measured: the swept surface against the one that was asked for, along its normals.
//!
//! Between two positions the axis moves straight: the points at its two ends go along lines, as a controller moves the tip, and
//! the direction with them. Nothing of how the positions were found is used.

use rayon::prelude::*;
use styluscam_geometry::Vector;

/// Places along the whole movement, at least, among which the nearest is looked for; every position is one of them.
const LOOKED_AT: usize = 512;
/// Parts of the golden section around it: to 1e-7 of the interval.
const STEPS: usize = 34;
const RATIO: f64 = 0.618_033_988_749_894_9;

/// What is left over each point (with its unit normal towards the tool), mm: above 0 what stands, below 0 what was cut too deep.
/// None where the first or the last position comes nearest, for what would come before or behind is not known.
///
/// `axes` are two points of the tool's axis in each position, in order; `radius` is the tool's, mm.
#[must_use]
pub fn left_by_flank(axes: &[[Vector; 2]], radius: f64, points: &[(Vector, Vector)]) -> Vec<Option<f64>> {
    points.par_iter().with_min_len(16).map(|(point, normal)| left(axes, radius, *point, *normal)).collect()
}

fn left(axes: &[[Vector; 2]], radius: f64, point: Vector, normal: Vector) -> Option<f64> {
    let last = axes.len().checked_sub(1)? as f64;
    let height = |at: f64| {
        let number = (at.floor() as usize).min(axes.len() - 2);
        let share = at - number as f64;
        let ends = [0, 1].map(|end| axes[number][end] + (axes[number + 1][end] - axes[number][end]) * share);
        over(point, normal, ends, radius)
    };
    if axes.len() < 2 {
        return None;
    }
    let each = LOOKED_AT.div_ceil(axes.len() - 1);
    let parts = each * (axes.len() - 1);
    let at = |part: usize| part as f64 / each as f64;
    let (nearest, least) = (0..=parts).map(|part| (part, height(at(part)))).min_by(|a, b| a.1.total_cmp(&b.1))?;
    if nearest == 0 || nearest == parts || !least.is_finite() {
        return None;
    }
    let (mut low, mut high) = (at(nearest - 1), at(nearest + 1).min(last));
    let mut found = least;
    for _ in 0..STEPS {
        let [p, q] = [high - RATIO * (high - low), low + RATIO * (high - low)];
        let [at_p, at_q] = [height(p), height(q)];
        found = found.min(at_p).min(at_q);
        if at_p < at_q {
            high = q;
        } else {
            low = p;
        }
    }
    Some(found)
}

/// How far over a point, along its normal, a cylinder begins; infinite where the normal passes beside it. The cylinder is as long
/// as its axis between the two points, and by its radius longer at both ends.
fn over(point: Vector, normal: Vector, [a, b]: [Vector; 2], radius: f64) -> f64 {
    // a plane across the axis: the cylinder is a circle there, the normal a line
    let along = (b - a).normalize();
    let flat = |v: Vector| v - along * v.dot(&along);
    let (start, way) = (flat(point - a), flat(normal));
    let length = way.norm();
    let way = way / length;
    let towards = -start.dot(&way);
    let aside = (start + way * towards).norm();
    if aside >= radius {
        return f64::INFINITY;
    }
    let found = (towards - ((radius - aside) * (radius + aside)).sqrt()) / length;
    let height = (point + normal * found - a).dot(&along);
    if (-radius..=(b - a).norm() + radius).contains(&height) {
        found
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn upright(x: f64, y: f64) -> [Vector; 2] {
        [Vector::new(x, y, 0.0), Vector::new(x, y, 10.0)]
    }

    #[test]
    fn a_straight_wall_is_left_as_far_off_as_the_axis_passes() {
        let axes = [upright(0.0, 5.01), upright(20.0, 5.01), upright(40.0, 5.01)];
        let points = [(Vector::new(13.0, 0.0, 4.0), Vector::y()), (Vector::new(-3.0, 0.0, 4.0), Vector::y())];
        let found = left_by_flank(&axes, 5.0, &points);
        assert!((found[0].unwrap() - 0.01).abs() < 1e-12);
        assert_eq!(found[1], None, "beyond the first position");
    }

    #[test]
    fn chords_of_a_circle_cut_into_it_by_their_sagitta() {
        // the tool outside a cylinder of radius 30, positions 10 degrees apart on radius 35
        let at = |i: usize| (10.0 * i as f64).to_radians();
        let axes: Vec<[Vector; 2]> = (0..5).map(|i| upright(35.0 * at(i).cos(), 35.0 * at(i).sin())).collect();
        let middle = 15.0_f64.to_radians();
        let normal = Vector::new(middle.cos(), middle.sin(), 0.0);
        let found = left_by_flank(&axes, 5.0, &[(normal * 30.0, normal)]);
        let sagitta = 35.0 * (1.0 - 5.0_f64.to_radians().cos());
        assert!((found[0].unwrap() + sagitta).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn no_movement_leaves_nothing_to_measure() {
        assert_eq!(left_by_flank(&[upright(0.0, 5.0)], 5.0, &[(Vector::zeros(), Vector::y())]), [None]);
        assert_eq!(left_by_flank(&[], 5.0, &[(Vector::zeros(), Vector::y())]), [None]);
    }
}
