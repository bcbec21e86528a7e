//! Material that is still there: how far a point is from it, and whether it lies in it.

use super::boxes::{foot, square_distance, Boxes};
use super::polygons::{sides, Point, Polygons};

/// An area with its sides by the square cells that they pass.
#[derive(Debug)]
pub struct Material {
    pub area: Polygons,
    sides: Vec<(Point, Point)>,
    boxes: Boxes,
    low: Point,
    size: f64,
    count: [usize; 2],
    /// Of each cell, row by row, where its list begins; and all lists.
    begins: Vec<u32>,
    listed: Vec<u32>,
}

/// Cells along an axis, at most.
const MOST: f64 = 256.0;

impl Material {
    pub fn new(area: Polygons) -> Self {
        let sides: Vec<(Point, Point)> = area.contours.iter().flat_map(|contour| sides(contour)).collect();
        let [low, high] = area.bounds().unwrap_or_default();
        let span = (high[0] - low[0]).max(high[1] - low[1]);
        let size = (span / (sides.len() as f64).sqrt().clamp(1.0, MOST)).max(1e-9);
        let count = [0, 1].map(|i| libm::floor((high[i] - low[i]) / size) as usize + 1);
        let boxes = Boxes::new(&sides);
        let mut material = Self { area, sides, boxes, low, size, count, begins: Vec::new(), listed: Vec::new() };
        let mut entries: Vec<(u32, u32)> = Vec::new();
        for (number, (a, b)) in (0u32..).zip(&material.sides) {
            material.passed(*a, *b, |cell| entries.push((cell as u32, number)));
        }
        entries.sort_unstable();
        let mut begins = vec![0u32; count[0] * count[1] + 1];
        for (cell, _) in &entries {
            if let Some(begin) = begins.get_mut(*cell as usize + 1) {
                *begin += 1;
            }
        }
        let mut sum = 0;
        for begin in &mut begins {
            sum += *begin;
            *begin = sum;
        }
        material.begins = begins;
        material.listed = entries.into_iter().map(|(_, number)| number).collect();
        material
    }

    pub fn is_empty(&self) -> bool {
        self.area.is_empty()
    }

    /// Whether a point lies in it: the parity of the sides that the ray to +X crosses.
    pub fn holds(&self, [x, y]: Point) -> bool {
        let [column, row] = self.cell([x, y]);
        let high = self.low[1] + self.count[1] as f64 * self.size;
        if self.sides.is_empty() || y < self.low[1] || y > high {
            return false;
        }
        // a side is counted in the cell in which it crosses the ray's height
        (column..self.count[0]).fold(false, |inside, column| {
            self.list([column, row]).fold(inside, |inside, (a, b)| {
                if (a[1] > y) == (b[1] > y) {
                    return inside;
                }
                let at = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
                inside ^ (x < at && self.cell([at, y])[0] == column)
            })
        })
    }

    /// Distance from a point to the nearest side, mm: to the material, for points outside of it. Infinite where there is none.
    pub fn distance(&self, point: Point) -> f64 {
        self.nearest_side(point).0.sqrt()
    }

    /// The same, up to a distance: that, where none is nearer, mm.
    pub fn distance_up_to(&self, most: f64, point: Point) -> f64 {
        self.boxes.nearest(&self.sides, point, (most * most, usize::MAX)).0.sqrt()
    }

    /// The point of its sides that is nearest to a point; None where there is none.
    pub fn nearest(&self, point: Point) -> Option<Point> {
        let (_, number) = self.nearest_side(point);
        self.sides.get(number).map(|(a, b)| foot(point, *a, *b))
    }

    fn nearest_side(&self, point: Point) -> (f64, usize) {
        let near = self.numbers(self.cell(point)).iter().map(|number| *number as usize);
        let near =
            near.filter_map(|number| self.sides.get(number).map(|(a, b)| (square_distance(point, *a, *b), number)));
        let best = near.fold((f64::INFINITY, usize::MAX), |best, found| if found.0 < best.0 { found } else { best });
        self.boxes.nearest(&self.sides, point, best)
    }

    /// The sides of it nearer than `distance` to a point, mm.
    pub fn sides_within(&self, point: Point, distance: f64) -> Vec<(Point, Point)> {
        let low = self.cell(point.map(|x| x - distance));
        let high = self.cell(point.map(|x| x + distance));
        let cells = (low[1]..=high[1]).flat_map(|y| (low[0]..=high[0]).map(move |x| [x, y]));
        let mut numbers: Vec<u32> = cells.flat_map(|cell| self.numbers(cell)).copied().collect();
        numbers.sort_unstable();
        numbers.dedup();
        let near = numbers.into_iter().filter_map(|number| self.sides.get(number as usize)).copied();
        near.filter(|(a, b)| square_distance(point, *a, *b) < distance * distance).collect()
    }

    /// Distance to the material, 0 within it, mm.
    pub fn away(&self, point: Point) -> f64 {
        if self.holds(point) {
            0.0
        } else {
            self.distance(point)
        }
    }

    /// Column and row of the cell of a point, or of the nearest one.
    fn cell(&self, point: Point) -> [usize; 2] {
        let cell = |i: usize| (((point[i] - self.low[i]) / self.size).max(0.0) as usize).min(self.count[i] - 1);
        [cell(0), cell(1)]
    }

    fn numbers(&self, [x, y]: [usize; 2]) -> &[u32] {
        let cell = y * self.count[0] + x;
        match (self.begins.get(cell), self.begins.get(cell + 1)) {
            (Some(from), Some(to)) => self.listed.get(*from as usize..*to as usize).unwrap_or(&[]),
            _ => &[],
        }
    }

    fn list(&self, cell: [usize; 2]) -> impl Iterator<Item = (Point, Point)> + '_ {
        self.numbers(cell).iter().filter_map(|number| self.sides.get(*number as usize)).copied()
    }

    /// The numbers of the cells that a side passes: row by row those between its crossings with the row's edges, and one more at
    /// either end, for rounding.
    fn passed(&self, a: Point, b: Point, mut found: impl FnMut(usize)) {
        let [from, to] = if a[1] <= b[1] { [a, b] } else { [b, a] };
        let (first, last) = (self.cell(from)[1], self.cell(to)[1]);
        for row in first..=last {
            let edges = [row, row + 1].map(|row| self.low[1] + row as f64 * self.size);
            let at = edges.map(|y| {
                let share = if to[1] > from[1] { ((y - from[1]) / (to[1] - from[1])).clamp(0.0, 1.0) } else { 0.0 };
                from[0] + share * (to[0] - from[0])
            });
            let [low, high] = if to[1] > from[1] { at } else { [from[0], to[0]] };
            let (low, high) = (low.min(high), low.max(high));
            let columns = [low, high].map(|x| self.cell([x, edges[0]])[0]);
            for column in columns[0].saturating_sub(1)..=(columns[1] + 1).min(self.count[0] - 1) {
                found(row * self.count[0] + column);
            }
        }
    }
}
