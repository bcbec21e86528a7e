//! Material that is still there: how far a point is from it.

use rstar::primitives::{GeomWithData, Line};
use rstar::{PointDistance, RTree};

use super::polygons::{sides, Point, Polygons};

/// An area with an index of its sides.
#[derive(Debug)]
pub struct Material {
    pub area: Polygons,
    sides: RTree<GeomWithData<Line<Point>, u32>>,
    rows: Rows,
}

impl Material {
    pub fn new(area: Polygons) -> Self {
        let lines: Vec<(Point, Point)> = area.contours.iter().flat_map(|contour| sides(contour)).collect();
        let rows = Rows::new(&lines);
        let numbered = (0u32..).zip(lines).map(|(number, (a, b))| GeomWithData::new(Line::new(a, b), number));
        let sides = RTree::bulk_load(numbered.collect());
        Self { area, sides, rows }
    }

    pub fn is_empty(&self) -> bool {
        self.area.is_empty()
    }

    /// Whether a point lies in it.
    pub fn holds(&self, point: Point) -> bool {
        self.rows.hold(point)
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
        if self.holds(point) {
            0.0
        } else {
            self.distance(point)
        }
    }
}

/// Sides by rows of equal height, for the ray from a point to +X.
#[derive(Debug)]
struct Rows {
    low: f64,
    height: f64,
    rows: Vec<Vec<(Point, Point)>>,
}

/// Rows, at most.
const MOST_ROWS: usize = 512;

impl Rows {
    fn new(lines: &[(Point, Point)]) -> Self {
        let ends = |pick: fn(f64, f64) -> f64, start| lines.iter().fold(start, |y, (a, b)| pick(y, pick(a[1], b[1])));
        let (low, high) = (ends(f64::min, f64::INFINITY), ends(f64::max, f64::NEG_INFINITY));
        let count = lines.len().clamp(1, MOST_ROWS);
        let height = ((high - low) / count as f64).max(f64::MIN_POSITIVE);
        let mut rows = Self { low, height, rows: vec![Vec::new(); count] };
        for (a, b) in lines {
            let (from, to) = (rows.row(a[1].min(b[1])), rows.row(a[1].max(b[1])));
            for row in rows.rows.iter_mut().take(to + 1).skip(from) {
                row.push((*a, *b));
            }
        }
        rows
    }

    /// Number of the row of a height; above and below there are the last and the first.
    fn row(&self, y: f64) -> usize {
        (((y - self.low) / self.height).max(0.0) as usize).min(self.rows.len() - 1)
    }

    fn hold(&self, [x, y]: Point) -> bool {
        let sides = self.rows.get(self.row(y)).map_or(&[] as &[_], Vec::as_slice);
        sides.iter().fold(false, |inside, (a, b)| {
            inside ^ ((a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
        })
    }
}
