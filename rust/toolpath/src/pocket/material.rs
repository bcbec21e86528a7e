//! Material that is still there: how far a point is from it.

use rstar::primitives::{GeomWithData, Line};
use rstar::{PointDistance, RTree};

use super::polygons::{sides, Point, Polygons};

/// An area with an index of its sides.
#[derive(Debug)]
pub struct Material {
    pub area: Polygons,
    sides: RTree<GeomWithData<Line<Point>, u32>>,
}

impl Material {
    pub fn new(area: Polygons) -> Self {
        let lines = area.contours.iter().flat_map(|contour| sides(contour));
        let lines = (0u32..).zip(lines).map(|(number, (a, b))| GeomWithData::new(Line::new(a, b), number));
        let sides = RTree::bulk_load(lines.collect());
        Self { area, sides }
    }

    pub fn is_empty(&self) -> bool {
        self.area.is_empty()
    }

    /// Distance from a point to the nearest side, mm: to the material, for points outside of it. Infinite where there is none.
    pub fn distance(&self, point: Point) -> f64 {
        self.sides.nearest_neighbor(point).map_or(f64::INFINITY, |side| side.distance_2(&point).sqrt())
    }

    /// The sides of it nearer than `distance` to a point, mm.
    pub fn sides_within(&self, point: Point, distance: f64) -> impl Iterator<Item = (Point, Point)> + '_ {
        let sides = self.sides.locate_within_distance(point, distance * distance);
        sides.map(|side| (side.geom().from, side.geom().to))
    }

    /// Distance to the material, 0 within it, mm.
    pub fn away(&self, point: Point) -> f64 {
        if self.area.holds(point) {
            0.0
        } else {
            self.distance(point)
        }
    }
}
