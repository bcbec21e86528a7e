//! What a moving cylinder or cone leaves of a surface, measured: the swept surface against the one that was asked for, along its
//! normals; and how near the rest of a moving tool comes to points that it must not enter.
//!
//! Between two positions the axis moves straight: the points at its two ends go along lines, as a controller moves the tip, and
//! the direction with them. Nothing of how the positions were found is used.

use rayon::prelude::*;
use styluscam_geometry::{Cutter, Vector};

use crate::sections::least_between;

/// Places along the whole movement, at least, among which the nearest is looked for; every position is one of them.
const LOOKED_AT: usize = 512;
/// Parts of the golden section around it: to 1e-7 of the interval.
const STEPS: usize = 34;
/// Newton's steps to the flank; six are usual.
const NEWTON: usize = 60;
/// The same for the tool's clearance, whose distance takes longer to find.
const NEAR: usize = 128;

/// The side of a tool: its radius across the axis at the first point of each axis, mm, and how much that grows for each mm from
/// there to the second, 0 for a cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlankShape {
    /// Radius, mm.
    pub radius: f64,
    /// Growth, mm per mm.
    pub growth: f64,
}

/// What is left over each point (with its unit normal towards the tool), mm: above 0 what stands, below 0 what was cut too deep.
/// None where the first or the last position comes nearest, for what would come before or behind is not known.
///
/// `axes` are two points of the tool's axis in each position, in order.
#[must_use]
pub fn left_by_flank(axes: &[[Vector; 2]], flank: FlankShape, points: &[(Vector, Vector)]) -> Vec<Option<f64>> {
    points.par_iter().with_min_len(16).map(|(point, normal)| left(axes, flank, *point, *normal)).collect()
}

/// How near the whole tool, a body that goes on upwards without end, comes to each point on its way, mm: below 0 how deep it
/// enters. `positions` are its tip and a point up its axis, mm.
#[must_use]
pub fn clearance_of_tool(positions: &[[Vector; 2]], tool: &Cutter, points: &[Vector]) -> Vec<f64> {
    let distance = |ends: [Vector; 2], point: Vector| {
        let along = (ends[1] - ends[0]).normalize();
        let height = (point - ends[0]).dot(&along);
        tool.distance((point - ends[0] - along * height).norm(), height).0
    };
    let nearest = |point: &Vector| match positions {
        [] => f64::INFINITY,
        [only] => distance(*only, *point),
        _ => {
            // as many places as the moves need to be found apart, the rest by sections
            let each = NEAR.div_ceil(positions.len() - 1);
            least(positions, each, &|ends| distance(ends, *point)).map_or(f64::INFINITY, |(_, least)| least)
        }
    };
    points.par_iter().with_min_len(4).map(nearest).collect()
}

fn left(axes: &[[Vector; 2]], flank: FlankShape, point: Vector, normal: Vector) -> Option<f64> {
    if axes.len() < 2 {
        return None;
    }
    let each = LOOKED_AT.div_ceil(axes.len() - 1);
    let (place, least) = least(axes, each, &|ends| over(point, normal, ends, flank))?;
    let is_inside = place > 0 && place < each * (axes.len() - 1);
    (is_inside && least.is_finite()).then_some(least)
}

/// The least of a function of the axis along the whole movement, looked for at so many places of each move and by golden sections
/// around the least of them, whose number comes with it. Two positions at least.
fn least(axes: &[[Vector; 2]], each: usize, function: &dyn Fn([Vector; 2]) -> f64) -> Option<(usize, f64)> {
    let last = axes.len().checked_sub(1)?;
    let height = |at: f64| {
        let number = (at.floor() as usize).min(last - 1);
        let share = at - number as f64;
        function([0, 1].map(|end| axes[number][end] + (axes[number + 1][end] - axes[number][end]) * share))
    };
    let parts = each * last;
    let at = |part: usize| part as f64 / each as f64;
    let (nearest, least) = (0..=parts).map(|part| (part, height(at(part)))).min_by(|a, b| a.1.total_cmp(&b.1))?;
    let about = [at(nearest.saturating_sub(1)), at((nearest + 1).min(parts))];
    let (found, _) = least_between((least, at(nearest)), about, STEPS, height);
    Some((nearest, found))
}

/// How far over a point, along its normal, the flank begins; infinite where the normal passes beside it. The flank is as long
/// as its axis between the two points, and by its radius longer at both ends.
///
/// Along a line the distance from a cone is convex: Newton's steps from outside never pass the first place where it is 0.
fn over(point: Vector, normal: Vector, [a, b]: [Vector; 2], flank: FlankShape) -> f64 {
    let along = (b - a).normalize();
    let cosine = 1.0 / (1.0 + flank.growth * flank.growth).sqrt();
    let (start, rise) = ((point - a).dot(&along), normal.dot(&along));
    let (beside, way) = (point - a - along * start, normal - along * rise);
    // distance from the flank and its slope
    let at = |found: f64| {
        let across = beside + way * found;
        let radius = across.norm();
        let gap = radius - flank.radius - flank.growth * (start + rise * found);
        (gap * cosine, (across.dot(&way) / radius - flank.growth * rise) * cosine)
    };
    let mut found = 0.0;
    let mut back = flank.radius * 1e-6;
    // from inside out again, towards the part
    while at(found).0 < 0.0 {
        if back > 4.0 * flank.radius {
            return f64::INFINITY;
        }
        found -= back;
        back *= 4.0;
    }
    for _ in 0..NEWTON {
        let (gap, slope) = at(found);
        if gap <= flank.radius * 1e-14 {
            break;
        }
        if slope >= 0.0 {
            return f64::INFINITY;
        }
        found -= gap / slope;
    }
    let height = start + rise * found;
    if (-flank.radius..=(b - a).norm() + flank.radius).contains(&height) {
        found
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CYLINDER: FlankShape = FlankShape { radius: 5.0, growth: 0.0 };

    fn upright(x: f64, y: f64) -> [Vector; 2] {
        [Vector::new(x, y, 0.0), Vector::new(x, y, 10.0)]
    }

    #[test]
    fn a_straight_wall_is_left_as_far_off_as_the_axis_passes() {
        let axes = [upright(0.0, 5.01), upright(20.0, 5.01), upright(40.0, 5.01)];
        let points = [(Vector::new(13.0, 0.0, 4.0), Vector::y()), (Vector::new(-3.0, 0.0, 4.0), Vector::y())];
        let found = left_by_flank(&axes, CYLINDER, &points);
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
        let found = left_by_flank(&axes, CYLINDER, &[(normal * 30.0, normal)]);
        let sagitta = 35.0 * (1.0 - 5.0_f64.to_radians().cos());
        assert!((found[0].unwrap() + sagitta).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn no_movement_leaves_nothing_to_measure() {
        assert_eq!(left_by_flank(&[upright(0.0, 5.0)], CYLINDER, &[(Vector::zeros(), Vector::y())]), [None]);
        assert_eq!(left_by_flank(&[], CYLINDER, &[(Vector::zeros(), Vector::y())]), [None]);
    }

    #[test]
    fn a_cone_leaves_a_wedge_of_an_upright_wall() {
        // upright beside a wall, 0.1 wider for each mm of height: it enters by that where it is wider
        let axes = [upright(0.0, 5.0), upright(20.0, 5.0)];
        let flank = FlankShape { radius: 5.0, growth: 0.1 };
        for height in [2.0, 9.0] {
            let found = left_by_flank(&axes, flank, &[(Vector::new(9.0, 0.0, height), Vector::y())]);
            assert!((found[0].unwrap() + 0.1 * height).abs() < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn the_end_of_the_tool_is_found_in_a_floor() {
        let ball = styluscam_geometry::Tool::new(styluscam_geometry::ToolDocument::of(
            serde_json::from_str(r#"{"kind": "ball", "diameter": 6.0}"#).unwrap(),
        ))
        .unwrap()
        .cutter();
        // lying along X, the tip over a floor: beside the end the ball's middle is 3 above it
        let positions = [0.0, 20.0].map(|y| [Vector::new(0.0, y, 2.9), Vector::new(1.0, y, 2.9)]);
        let points = [Vector::new(3.0, 11.0, 0.0), Vector::new(40.0, 11.0, 0.0), Vector::new(-5.0, 11.0, 2.9)];
        let found = clearance_of_tool(&positions, &ball, &points);
        for (found, expected) in found.iter().zip([-0.1, -0.1, 5.0]) {
            assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        }
    }
}
