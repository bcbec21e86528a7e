//! Stock: the material that a part is cut from.

use crate::{circle_outline, rectangle_outline, PlanePiece, Vector};

/// Upright stock: the same outlines from its bottom to its top. Work coordinates, mm.
#[derive(Clone, Debug, PartialEq)]
pub struct Stock {
    /// Closed outlines in plan, points (x, y, bulge); holes are outlines within outlines.
    pub outlines: Vec<Vec<[f64; 3]>>,
    /// Height of its underside.
    pub bottom: f64,
    /// Height of its top.
    pub top: f64,
}

impl Stock {
    /// A box between two corners.
    #[must_use]
    pub fn of_box(low: Vector, high: Vector) -> Self {
        Self { outlines: vec![rectangle_outline([low.x, low.y], [high.x, high.y])], bottom: low.z, top: high.z }
    }

    /// An upright cylinder between two heights.
    #[must_use]
    pub fn cylinder(axis: [f64; 2], radius: f64, [bottom, top]: [f64; 2]) -> Self {
        Self { outlines: vec![circle_outline(axis, radius)], bottom, top }
    }

    /// The outlines of what lies between two heights, from the upper one: none above its top and below its underside.
    #[must_use]
    pub fn outlines_between(&self, [top, floor]: [f64; 2]) -> &[Vec<[f64; 3]>] {
        if floor < self.top && top > self.bottom {
            &self.outlines
        } else {
            &[]
        }
    }

    /// Corners of its box.
    #[must_use]
    pub fn bounds(&self) -> (Vector, Vector) {
        let boxes = self.outlines.iter().flat_map(|outline| PlanePiece::outline(outline)).map(|piece| piece.bounds());
        let empty = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        let [low, high] = boxes
            .fold(empty, |[low, high], [l, h]| [[0, 1].map(|i| low[i].min(l[i])), [0, 1].map(|i| high[i].max(h[i]))]);
        (Vector::new(low[0], low[1], self.bottom), Vector::new(high[0], high[1], self.top))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cylinder_reaches_its_radius_to_all_sides() {
        let stock = Stock::cylinder([3.0, -1.0], 5.0, [-2.0, 4.0]);
        let (low, high) = stock.bounds();
        assert!(
            (low - Vector::new(-2.0, -6.0, -2.0)).norm() < 1e-12 && (high - Vector::new(8.0, 4.0, 4.0)).norm() < 1e-12
        );
    }

    #[test]
    fn a_box_is_bounded_by_its_corners() {
        let corners = (Vector::new(-1.0, 2.0, 0.0), Vector::new(4.0, 6.0, 3.0));
        assert_eq!(Stock::of_box(corners.0, corners.1).bounds(), corners);
    }

    #[test]
    fn there_is_none_above_its_top_and_below_its_underside() {
        let stock = Stock::cylinder([0.0; 2], 5.0, [-2.0, 4.0]);
        assert!(stock.outlines_between([6.0, 4.0]).is_empty() && stock.outlines_between([-2.0, -3.0]).is_empty());
        assert_eq!(stock.outlines_between([6.0, 3.0]).len(), 1);
    }
}
