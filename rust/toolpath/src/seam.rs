//! Where closed passes begin.

use styluscam_geometry::Vector;

use crate::PathPoint;

/// Where loops begin and end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Seam {
    /// At the point nearest to where the tool comes from.
    #[default]
    Nearest,
    /// In one direction from the loop's middle, turned by the same angle from level to level.
    Bearing {
        /// Of the first level, rad from +X.
        first: f64,
        /// From level to level, rad.
        spread: f64,
    },
}

impl Seam {
    /// The direction in plan in which the loops of a level begin, by its number in their order; none where the nearest point
    /// decides.
    pub(crate) fn bearing(self, level: usize) -> Option<f64> {
        match self {
            Self::Nearest => None,
            Self::Bearing { first, spread } => Some(first + spread * level as f64),
        }
    }
}

/// A position on a side of a polyline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Start {
    /// Number of the side.
    pub side: usize,
    /// Of the side, from its start.
    pub share: f64,
}

impl Start {
    /// The point there, and the side's direction. A side is a chord within the path's deviation, and so is the point.
    pub fn on(self, points: &[PathPoint]) -> Option<(PathPoint, Vector)> {
        let [a, b] = points.get(self.side..)?.first_chunk()?;
        let normal = (a.normal + (b.normal - a.normal) * self.share).try_normalize(0.0).unwrap_or(a.normal);
        let along = b.tip - a.tip;
        Some((PathPoint { tip: a.tip + along * self.share, normal, ..*a }, along))
    }

    /// The direction in which a closed polyline that begins there leaves.
    pub fn leaving(self, points: &[PathPoint]) -> Option<Vector> {
        let next = if self.side + 2 < points.len() { self.side + 1 } else { 0 };
        let side = if self.share < 1.0 { self.side } else { next };
        Some(Self { side, share: 0.0 }.on(points)?.1)
    }

    /// The direction in which a closed polyline that ends there arrives.
    pub fn arriving(self, points: &[PathPoint]) -> Option<Vector> {
        let before = self.side.checked_sub(1).unwrap_or(points.len().saturating_sub(2));
        let side = if self.share > 0.0 { self.side } else { before };
        Some(Self { side, share: 0.0 }.on(points)?.1)
    }
}

/// Has a closed polyline begin where a ray from the middle of its box leaves it: on a chord, if need be. Where the ray misses it,
/// at its point farthest in that direction.
pub(crate) fn begin_at(points: &mut Vec<PathPoint>, bearing: f64) {
    let (sin, cos) = libm::sincos(bearing);
    let tips = || points.iter().map(|point| point.tip);
    let low = tips().fold(Vector::repeat(f64::INFINITY), |low, tip| low.inf(&tip));
    let high = tips().fold(Vector::repeat(f64::NEG_INFINITY), |high, tip| high.sup(&tip));
    let middle = 0.5 * (low + high);
    // along the ray and to its left
    let turned = |point: &PathPoint| {
        let away = point.tip - middle;
        [cos * away.x + sin * away.y, cos * away.y - sin * away.x]
    };
    let crossing = |(side, pair): (usize, &[PathPoint])| {
        let ([along, left], [next_along, next_left]) = (turned(&pair[0]), turned(&pair[1]));
        let share = left / (left - next_left);
        let crosses = (left < 0.0) != (next_left < 0.0);
        let along = along + share * (next_along - along);
        (crosses && along > 0.0).then_some((side, share, along))
    };
    let outermost = points.windows(2).enumerate().filter_map(crossing).max_by(|a, b| a.2.total_cmp(&b.2));
    if let Some((side, share, _)) = outermost {
        begin_on(points, Start { side, share });
    } else {
        let along = points.iter().map(|point| turned(point)[0]).enumerate();
        let farthest = along.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(number, _)| number);
        begin_on(points, Start { side: farthest, share: 0.0 });
    }
}

/// Has a closed polyline begin at its position nearest to a point in plan: on a chord, if need be.
pub(crate) fn begin_beside(points: &mut Vec<PathPoint>, from: Vector) {
    if let Some(start) = beside(points, from) {
        begin_on(points, start);
    }
}

/// The position of a polyline nearest to a point in plan.
pub(crate) fn beside(points: &[PathPoint], from: Vector) -> Option<Start> {
    let nearest = |(side, pair): (usize, &[PathPoint])| {
        let (start, along) = (pair[0].tip.xy(), (pair[1].tip - pair[0].tip).xy());
        let share = ((from.xy() - start).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (Start { side, share }, (start + along * share - from.xy()).norm_squared())
    };
    let nearest = points.windows(2).enumerate().map(nearest).min_by(|a, b| a.1.total_cmp(&b.1));
    nearest.map(|(start, _)| start)
}

/// Has a closed polyline begin on one of its sides.
pub(crate) fn begin_on(points: &mut Vec<PathPoint>, start: Start) {
    let Some((begin, _)) = start.on(points) else { return };
    let Start { side, .. } = start;
    let first = side + 1;
    points.insert(first, begin);
    points.pop();
    let last = points.len().saturating_sub(1);
    points.rotate_left(first.min(last));
    points.extend(points.first().copied());
    points.dedup_by(|next, point| next.tip == point.tip);
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

    fn square() -> Vec<PathPoint> {
        let corners = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0], [0.0, 0.0]];
        let at = |[x, y]: [f64; 2]| PathPoint {
            tip: Vector::new(x, y, -1.0),
            normal: Vector::z(),
            selected: true,
            triangle: 0,
        };
        corners.map(at).to_vec()
    }

    fn begun(bearing: f64) -> (Vector, usize) {
        let mut points = square();
        begin_at(&mut points, bearing);
        assert_eq!(points.first(), points.last());
        let length: f64 = points.windows(2).map(|side| (side[1].tip - side[0].tip).norm()).sum();
        assert!((length - 40.0).abs() < 1e-12);
        (points[0].tip, points.len())
    }

    #[test]
    fn a_loop_begins_on_the_chord_in_the_direction() {
        for (bearing, expected) in [(0.0, [10.0, 5.0]), (FRAC_PI_2, [5.0, 10.0]), (PI, [0.0, 5.0])] {
            let (tip, count) = begun(bearing);
            assert!((tip - Vector::new(expected[0], expected[1], -1.0)).norm() < 1e-12, "{tip}");
            assert_eq!(count, 6);
        }
        let (tip, _) = begun(FRAC_PI_4);
        assert!((tip - Vector::new(10.0, 10.0, -1.0)).norm() < 1e-9, "{tip}");
    }

    #[test]
    fn a_loop_begins_beside_a_point() {
        let mut points = square();
        begin_beside(&mut points, Vector::new(4.0, 12.0, 7.0));
        assert_eq!((points[0].tip, points.len()), (Vector::new(4.0, 10.0, -1.0), 6));
        begin_beside(&mut points, Vector::new(-3.0, -3.0, 0.0));
        assert_eq!((points[0].tip, points.first() == points.last()), (Vector::new(0.0, 0.0, -1.0), true));
    }

    #[test]
    fn at_a_corner_a_loop_leaves_along_the_next_side() {
        let points = square();
        let directions = |side, share| {
            let start = Start { side, share };
            [start.arriving(&points), start.leaving(&points)].map(|along| along.unwrap().normalize())
        };
        let (x, y) = (Vector::x(), Vector::y());
        assert_eq!(directions(0, 0.5), [x, x]);
        assert_eq!([directions(1, 0.0), directions(0, 1.0)], [[x, y]; 2]);
        assert_eq!([directions(0, 0.0), directions(3, 1.0)], [[-y, x]; 2]);
    }

    #[test]
    fn levels_begin_a_spread_apart() {
        let seam = Seam::Bearing { first: 0.5, spread: 0.25 };
        assert_eq!([seam.bearing(0), seam.bearing(2)], [Some(0.5), Some(1.0)]);
        assert_eq!(Seam::Nearest.bearing(3), None);
    }
}
