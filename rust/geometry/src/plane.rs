//! Pieces of plane paths and outlines: straight or circular, given by two points and a bulge.
//!
//! The bulge is the tangent of a quarter of the arc's angle, positive where it turns left, 0 on a straight piece, as in DXF's
//! LWPOLYLINE (Autodesk, "DXF Reference", group code 42).

use std::f64::consts::TAU;

/// A position in the plane, mm.
pub type PlanePoint = [f64; 2];

/// An arc with less height over its chord than this is straight, mm: the arithmetic of its centre would be off by as much.
const STRAIGHT: f64 = 1e-9;

/// The closed outline of a circle, counterclockwise: two points (x, y, bulge), mm.
#[must_use]
pub fn circle_outline([x, y]: PlanePoint, radius: f64) -> Vec<[f64; 3]> {
    vec![[x + radius, y, 1.0], [x - radius, y, 1.0]]
}

/// The closed outline of a rectangle along the axes, counterclockwise from its lower corner: points (x, y, bulge), mm.
#[must_use]
pub fn rectangle_outline([x0, y0]: PlanePoint, [x1, y1]: PlanePoint) -> Vec<[f64; 3]> {
    vec![[x0, y0, 0.0], [x1, y0, 0.0], [x1, y1, 0.0], [x0, y1, 0.0]]
}

/// A straight or circular piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanePiece {
    /// Where it begins, mm.
    pub start: PlanePoint,
    /// Where it ends, mm.
    pub end: PlanePoint,
    /// The circle that it runs on; None of a straight piece.
    pub circle: Option<PlaneCircle>,
}

/// Part of a circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneCircle {
    /// Centre, mm.
    pub centre: PlanePoint,
    /// Radius, mm.
    pub radius: f64,
    /// Direction of the start as seen from the centre, rad.
    pub from: f64,
    /// Angle turned through, rad; positive to the left.
    pub turn: f64,
}

impl PlanePiece {
    /// The piece from `start` to `end` with a `bulge`.
    #[must_use]
    pub fn new(start: PlanePoint, end: PlanePoint, bulge: f64) -> Self {
        let chord = [end[0] - start[0], end[1] - start[1]];
        let length = libm::hypot(chord[0], chord[1]);
        if (bulge * length).abs() < 2.0 * STRAIGHT {
            return Self { start, end, circle: None };
        }
        // the centre lies left of the chord's middle by this share of the chord
        let aside = (1.0 - bulge * bulge) / (4.0 * bulge);
        let centre = [0.5 * (start[0] + end[0]) - aside * chord[1], 0.5 * (start[1] + end[1]) + aside * chord[0]];
        let radius = length * (1.0 + bulge * bulge) / (4.0 * bulge.abs());
        let from = libm::atan2(start[1] - centre[1], start[0] - centre[0]);
        Self { start, end, circle: Some(PlaneCircle { centre, radius, from, turn: 4.0 * libm::atan(bulge) }) }
    }

    /// The piece of a circle about `centre`, from the direction `from` through `turn`, rad.
    #[must_use]
    pub fn of_circle(centre: PlanePoint, radius: f64, from: f64, turn: f64) -> Self {
        let circle = PlaneCircle { centre, radius, from, turn };
        Self { start: circle.at(from), end: circle.at(from + turn), circle: Some(circle) }
    }

    /// The pieces between consecutive points (x, y, bulge): the bulge is that of the piece which begins at the point.
    #[must_use]
    pub fn path(points: &[[f64; 3]]) -> Vec<Self> {
        let piece = |pair: &[[f64; 3]]| match pair {
            [[x, y, bulge], [u, v, _]] => Some(Self::new([*x, *y], [*u, *v], *bulge)),
            _ => None,
        };
        points.windows(2).filter_map(piece).collect()
    }

    /// The pieces of a closed outline: as [`Self::path`], and back from the last point to the first.
    #[must_use]
    pub fn outline(points: &[[f64; 3]]) -> Vec<Self> {
        let (Some(first), Some(last)) = (points.first(), points.last()) else { return Vec::new() };
        let mut pieces = Self::path(points);
        pieces.push(Self::new([last[0], last[1]], [first[0], first[1]], last[2]));
        pieces.retain(|piece| piece.length() > 0.0);
        pieces
    }

    /// Length, mm.
    #[must_use]
    pub fn length(&self) -> f64 {
        match &self.circle {
            Some(circle) => circle.radius * circle.turn.abs(),
            None => libm::hypot(self.end[0] - self.start[0], self.end[1] - self.start[1]),
        }
    }

    /// The bulge.
    #[must_use]
    pub fn bulge(&self) -> f64 {
        self.circle.map_or(0.0, |circle| libm::tan(0.25 * circle.turn))
    }

    /// The position at a share of the length, 0 to 1.
    #[must_use]
    pub fn at(&self, share: f64) -> PlanePoint {
        match &self.circle {
            Some(circle) => circle.at(circle.from + share * circle.turn),
            None => [0, 1].map(|i| self.start[i] + share * (self.end[i] - self.start[i])),
        }
    }

    /// The part from the start up to a share of the length, 0 to 1.
    #[must_use]
    pub fn up_to(&self, share: f64) -> Self {
        let circle = self.circle.map(|circle| PlaneCircle { turn: share * circle.turn, ..circle });
        Self { start: self.start, end: self.at(share), circle }
    }

    /// Distance from a point to the nearest of the piece, mm.
    #[must_use]
    pub fn distance(&self, point: PlanePoint) -> f64 {
        if let Some(circle) = &self.circle {
            if circle.faces(point) {
                return (between(circle.centre, point) - circle.radius).abs();
            }
            return between(self.start, point).min(between(self.end, point));
        }
        let along = [self.end[0] - self.start[0], self.end[1] - self.start[1]];
        let square = along[0] * along[0] + along[1] * along[1];
        let arm = [point[0] - self.start[0], point[1] - self.start[1]];
        let share = if square > 0.0 { ((arm[0] * along[0] + arm[1] * along[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
        libm::hypot(arm[0] - share * along[0], arm[1] - share * along[1])
    }

    /// Corners of the smallest upright box around it, mm.
    #[must_use]
    pub fn bounds(&self) -> [PlanePoint; 2] {
        let mut low = [0, 1].map(|i| self.start[i].min(self.end[i]));
        let mut high = [0, 1].map(|i| self.start[i].max(self.end[i]));
        if let Some(circle) = &self.circle {
            for (axis, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
                let mut extreme = circle.centre;
                extreme[axis] += sign * circle.radius;
                if circle.faces(extreme) {
                    low[axis] = low[axis].min(extreme[axis]);
                    high[axis] = high[axis].max(extreme[axis]);
                }
            }
        }
        [low, high]
    }
}

impl PlaneCircle {
    /// The position in a direction from the centre, rad.
    #[must_use]
    pub fn at(&self, direction: f64) -> PlanePoint {
        let (sin, cos) = libm::sincos(direction);
        [self.centre[0] + self.radius * cos, self.centre[1] + self.radius * sin]
    }

    /// Whether the ray from the centre to a point meets the arc.
    #[must_use]
    pub fn faces(&self, point: PlanePoint) -> bool {
        let direction = libm::atan2(point[1] - self.centre[1], point[0] - self.centre[0]);
        let turned = (direction - self.from) * self.turn.signum();
        turned.rem_euclid(TAU) <= self.turn.abs()
    }
}

fn between(a: PlanePoint, b: PlanePoint) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bulge_of_one_is_half_a_circle_to_the_left() {
        let piece = PlanePiece::new([1.0, 0.0], [-1.0, 0.0], 1.0);
        let circle = piece.circle.unwrap();
        assert!(between(circle.centre, [0.0, 0.0]) < 1e-15 && (circle.radius - 1.0).abs() < 1e-15);
        assert!(between(piece.at(0.5), [0.0, 1.0]) < 1e-15);
        assert!((piece.length() - std::f64::consts::PI).abs() < 1e-15);
        let [low, high] = piece.bounds();
        assert!(between(low, [-1.0, 0.0]) < 1e-15 && between(high, [1.0, 1.0]) < 1e-15);
    }

    #[test]
    fn distances_are_to_the_arc_or_to_its_ends() {
        // a quarter to the right, about the origin, from (0, 2) to (2, 0)
        let piece = PlanePiece::new([0.0, 2.0], [2.0, 0.0], -libm::tan(std::f64::consts::PI / 8.0));
        assert!((piece.distance([3.0, 4.0]) - 3.0).abs() < 1e-14);
        assert!((piece.distance([0.3, 0.4]) - 1.5).abs() < 1e-14);
        assert!((piece.distance([-1.0, 2.0]) - 1.0).abs() < 1e-14);
        assert!((piece.distance([2.0, -1.5]) - 1.5).abs() < 1e-14);
        assert!((piece.up_to(0.5).length() - 0.5 * piece.length()).abs() < 1e-14);
        let line = PlanePiece::new([0.0, 0.0], [4.0, 0.0], 1e-12);
        assert!(line.circle.is_none() && (line.distance([7.0, 4.0]) - 5.0).abs() < 1e-15);
    }

    #[test]
    fn an_outline_closes_with_the_last_points_bulge() {
        let half = PlanePiece::outline(&[[1.0, 0.0, 1.0], [-1.0, 0.0, 0.0]]);
        assert_eq!(half.len(), 2);
        assert!(half[0].circle.is_some() && half[1].circle.is_none());
        assert!(between(half[1].end, [1.0, 0.0]) < 1e-15);
        assert!((half[0].bulge() - 1.0).abs() < 1e-15);
    }
}
