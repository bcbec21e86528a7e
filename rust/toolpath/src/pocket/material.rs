//! Material that is still there: how far a point is from it, and whether it lies in it.

use super::boxes::Boxes;
use super::polygons::{sides, Point, Polygons};
use super::window::Window;
use crate::plan::foot;

/// An area with its sides in boxes.
#[derive(Debug)]
pub struct Material {
    pub area: Polygons,
    sides: Vec<(Point, Point)>,
    boxes: Boxes,
}

impl Material {
    pub fn new(area: Polygons) -> Self {
        let sides: Vec<(Point, Point)> = area.contours.iter().flat_map(|contour| sides(contour)).collect();
        let boxes = Boxes::new(&sides);
        Self { area, sides, boxes }
    }

    pub fn is_empty(&self) -> bool {
        self.area.is_empty()
    }

    /// A box around what is taken of it by an area; None where that is nothing.
    pub fn taken_by(&self, swept: &Polygons) -> Option<Window> {
        self.area.clipped(swept.bounds()?).bounds()
    }

    /// Whether a point lies in it.
    pub fn holds(&self, point: Point) -> bool {
        self.boxes.is_inside(&self.sides, point)
    }

    /// Distance from a point to the nearest side, mm: to the material, for points outside of it. Infinite where there is none.
    pub fn distance(&self, point: Point) -> f64 {
        self.distance_up_to(f64::INFINITY, point)
    }

    /// The same, up to a distance: that, where none is nearer, mm.
    pub fn distance_up_to(&self, most: f64, point: Point) -> f64 {
        self.boxes.nearest(&self.sides, point, (most * most, usize::MAX)).0.sqrt()
    }

    /// The point of its sides that is nearest to a point; None where there is none.
    pub fn nearest(&self, point: Point) -> Option<Point> {
        let (_, number) = self.boxes.nearest(&self.sides, point, (f64::INFINITY, usize::MAX));
        self.sides.get(number).map(|(a, b)| foot(point, [*a, *b]))
    }

    /// Calls with the sides that may come through a circle.
    pub fn crossed(&self, centre: Point, radius: f64, found: &mut impl FnMut(Point, Point)) {
        self.boxes.crossed(&self.sides, centre, radius, found);
    }

    /// Distance to the material, 0 within it, mm.
    pub fn away(&self, point: Point) -> f64 {
        if self.holds(point) {
            0.0
        } else {
            self.distance(point)
        }
    }
}
