//! Short stretches of a level over faces that are not selected, between selected ones: the tool stays down there.
//!
//! A level that runs along the border of what is selected crosses it again and again; lifted each time, the tool would
//! leave a mark at every millimetre and spend its time in the air.

use super::contour::Chain;
use crate::pass::plan_length;
use crate::{
    fitting::{self, Course},
    PathPoint,
};

/// The chain with such stretches taken for selected, which in plan are no longer than `longest` mm from the selected point
/// before them to the one behind; their points are made as dense as the others, see [`fitting::densified`].
///
/// A stretch where the course has a hole stays what it is.
pub fn bridged(chain: Chain, longest: f64, deviation: f64, course: &mut impl Course) -> Chain {
    let Chain { points, closed } = chain;
    let points = if closed { from_a_selected(points) } else { points };
    let mut bridged: Vec<PathPoint> = Vec::with_capacity(points.len());
    let mut rest = points.as_slice();
    while let Some((first, behind)) = rest.split_first() {
        bridged.push(*first);
        rest = behind;
        if !first.selected {
            continue;
        }
        let gap = behind.iter().take_while(|point| !point.selected).count();
        if gap == 0 || gap == behind.len() {
            continue;
        }
        let stretch: Vec<PathPoint> = std::iter::once(first).chain(&behind[..=gap]).copied().collect();
        if plan_length(&stretch) > longest {
            continue;
        }
        if let [dense] = fitting::densified(&stretch, deviation, f64::INFINITY, course).as_slice() {
            bridged.extend(dense[1..dense.len() - 1].iter().map(|point| PathPoint { selected: true, ..*point }));
            rest = &behind[gap..];
        }
    }
    Chain { points: bridged, closed }
}

/// A loop, its first point repeated at its end, begun at a selected point if it has one: no stretch lies across its seam.
fn from_a_selected(mut points: Vec<PathPoint>) -> Vec<PathPoint> {
    let Some(first) = points.iter().position(|point| point.selected).filter(|first| *first > 0) else { return points };
    points.pop();
    points.rotate_left(first);
    points.extend(points.first().copied());
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use styluscam_geometry::Vector;

    fn point(x: f64, selected: bool) -> PathPoint {
        PathPoint { tip: Vector::new(x, 0.01 * x * x, 0.0), normal: Vector::y(), selected, triangle: 0 }
    }

    /// The parabola y = x²/100, of which nothing but the points given is selected.
    fn parabola(a: &PathPoint, b: &PathPoint) -> Option<PathPoint> {
        Some(point(0.5 * (a.tip.x + b.tip.x), false))
    }

    fn chain(positions: &[(f64, bool)], closed: bool) -> Chain {
        Chain { points: positions.iter().map(|(x, selected)| point(*x, *selected)).collect(), closed }
    }

    #[test]
    fn a_short_stretch_is_selected_and_dense_and_a_long_one_stays() {
        let open = chain(&[(-1.0, false), (0.0, true), (0.4, false), (0.9, true), (1.5, false), (2.0, true)], false);
        let whole = bridged(open, 0.95, 1e-4, &mut { parabola });
        let selected: Vec<bool> = whole.points.iter().map(|p| p.selected).collect();
        let bridge = &selected[1..selected.len() - 2];
        assert!(!selected[0] && bridge.len() > 6 && bridge.iter().all(|s| *s), "{selected:?}");
        assert_eq!(selected[selected.len() - 2..], [false, true], "1.1 mm");
        assert!(whole.points.windows(2).all(|pair| pair[0].tip.x < pair[1].tip.x));
    }

    #[test]
    fn a_stretch_across_the_seam_of_a_loop_is_bridged() {
        let ring = chain(&[(0.1, false), (0.2, true), (3.0, true), (0.0, false), (0.1, false)], true);
        let whole = bridged(ring, 4.0, 1.0, &mut { parabola });
        assert!(whole.closed && whole.points.iter().all(|p| p.selected));
        assert_eq!(whole.points.first(), whole.points.last());
    }

    #[test]
    fn where_the_course_has_a_hole_nothing_is_bridged() {
        let open = chain(&[(0.0, true), (0.4, false), (0.9, true)], false);
        let same = bridged(open, 2.0, 1e-4, &mut |_: &PathPoint, _: &PathPoint| None);
        assert_eq!(same.points.iter().map(|p| p.selected).collect::<Vec<_>>(), [true, false, true]);
    }
}
