//! Stock: the material that a part is cut from; how: docs/concepts/stock.md.

mod slab;
mod solid;

use std::borrow::Cow;

pub use solid::Solid;

use crate::{circle_outline, rectangle_outline, PlanePiece, Vector};

/// What a part is cut from. Work coordinates, mm.
#[derive(Clone, Debug)]
pub struct Stock {
    /// Height of its underside.
    pub bottom: f64,
    /// Height of its top.
    pub top: f64,
    shape: Shape,
}

#[derive(Clone, Debug)]
enum Shape {
    /// The same closed outlines in plan from its bottom to its top, points (x, y, bulge); holes are outlines within outlines.
    Upright(Vec<Vec<[f64; 3]>>),
    /// A closed mesh.
    Solid(Box<Solid>),
}

impl Stock {
    /// A box between two corners.
    #[must_use]
    pub fn of_box(low: Vector, high: Vector) -> Self {
        Self::upright(rectangle_outline([low.x, low.y], [high.x, high.y]), [low.z, high.z])
    }

    /// An upright cylinder between two heights.
    #[must_use]
    pub fn cylinder(axis: [f64; 2], radius: f64, heights: [f64; 2]) -> Self {
        Self::upright(circle_outline(axis, radius), heights)
    }

    fn upright(outline: Vec<[f64; 3]>, [bottom, top]: [f64; 2]) -> Self {
        Self { bottom, top, shape: Shape::Upright(vec![outline]) }
    }

    /// A closed body.
    #[must_use]
    pub fn of_solid(solid: Solid) -> Self {
        let (low, high) = solid.mesh().bounds();
        Self { bottom: low.z, top: high.z, shape: Shape::Solid(Box::new(solid)) }
    }

    /// The outlines of all that lies between two heights, from the upper one, as seen from above; points (x, y, bulge), holes are outlines within
    /// outlines. None above its top and below its underside. Those of a body are good to 0.00001 mm.
    #[must_use]
    pub fn outlines_between(&self, [top, floor]: [f64; 2]) -> Cow<'_, [Vec<[f64; 3]>]> {
        match &self.shape {
            _ if floor >= self.top || top <= self.bottom => Cow::Borrowed(&[]),
            Shape::Upright(outlines) => Cow::Borrowed(outlines),
            Shape::Solid(solid) => Cow::Owned(solid.outlines_between([top, floor])),
        }
    }

    /// The body that it is, where it is not upright.
    #[must_use]
    pub fn solid(&self) -> Option<&Solid> {
        match &self.shape {
            Shape::Upright(_) => None,
            Shape::Solid(solid) => Some(solid),
        }
    }

    /// Corners of its box.
    #[must_use]
    pub fn bounds(&self) -> (Vector, Vector) {
        let outlines = match &self.shape {
            Shape::Upright(outlines) => outlines,
            Shape::Solid(solid) => return solid.mesh().bounds(),
        };
        let boxes = outlines.iter().flat_map(|outline| PlanePiece::outline(outline)).map(|piece| piece.bounds());
        let empty = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        let [low, high] = boxes
            .fold(empty, |[low, high], [l, h]| [[0, 1].map(|i| low[i].min(l[i])), [0, 1].map(|i| high[i].max(h[i]))]);
        (Vector::new(low[0], low[1], self.bottom), Vector::new(high[0], high[1], self.top))
    }
}

#[cfg(test)]
mod tests;
