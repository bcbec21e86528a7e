//! The part as a map of heights, and the height of its border: where a sheet of this shape would be clamped.

use styluscam_geometry::Vector;

use super::Body;

/// Cells along the longer side of the map.
const CELLS: f64 = 80.0;
/// Where in its cell a ray falls: not in the middle, where edges of symmetric parts lie.
const WITHIN: [f64; 2] = [0.513, 0.487];

/// What rays from above meet.
#[derive(Clone, Debug)]
pub struct Heights {
    /// The highest point, mm.
    pub top: f64,
    /// The lowest one that is seen from above, mm.
    pub bottom: f64,
    /// The border; none where nothing is seen from above.
    pub border: Option<Border>,
}

/// The outer border, as it is seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Border {
    /// Half of the border is higher than this, mm.
    pub middle: f64,
    /// The lowest tenth ends here, mm.
    pub low: f64,
    /// The highest tenth begins here, mm.
    pub high: f64,
    /// Share of the plan's area that is more than a hundredth of the depth above the border's middle.
    pub above: f64,
}

struct Map {
    columns: usize,
    rows: usize,
    /// Row by row, in a frame of cells without any.
    heights: Vec<Option<f64>>,
}

impl Map {
    /// Cells around one, itself among them.
    fn around(&self, cell: usize) -> impl Iterator<Item = usize> + '_ {
        let (column, row) = (cell % self.columns, cell / self.columns);
        let rows = row.saturating_sub(1)..(row + 2).min(self.rows);
        rows.flat_map(move |r| {
            let columns = column.saturating_sub(1)..(column + 2).min(self.columns);
            columns.map(move |c| r * self.columns + c)
        })
    }

    /// Cells without a height that can be reached from the frame: holes within the part are not among them.
    fn outside(&self) -> Vec<bool> {
        let mut outside = vec![false; self.heights.len()];
        let mut stack = vec![0_usize];
        while let Some(cell) = stack.pop() {
            let is_new = outside.get(cell) == Some(&false) && self.heights.get(cell) == Some(&None);
            if is_new {
                outside[cell] = true;
                let (column, row) = (cell % self.columns, cell / self.columns);
                stack.extend((column > 0).then(|| cell - 1));
                stack.extend((column + 1 < self.columns).then_some(cell + 1));
                stack.extend((row > 0).then(|| cell - self.columns));
                stack.extend((row + 1 < self.rows).then_some(cell + self.columns));
            }
        }
        outside
    }
}

impl Body<'_> {
    /// Heights as seen from above.
    #[must_use]
    pub fn heights(&self) -> Heights {
        let (low, high) = self.bounds();
        let map = map(self, low, high);
        let seen: Vec<f64> = map.heights.iter().flatten().copied().collect();
        let bottom = seen.iter().copied().fold(high.z, f64::min);
        Heights { top: high.z, bottom, border: border(&map, &seen, high.z - bottom) }
    }

    /// The highest point over (x, y), mm; none beside the part.
    #[must_use]
    pub fn height_at(&self, x: f64, y: f64) -> Option<f64> {
        let (low, high) = self.bounds();
        let above = high.z + (high.z - low.z) + 1.0;
        let hit = self.rays.first(Vector::new(x, y, above), -Vector::z(), 0.0, |_| true)?;
        Some(above - hit.distance)
    }
}

fn map(body: &Body<'_>, low: Vector, high: Vector) -> Map {
    let size = high - low;
    let cell = (size.x.max(size.y) / CELLS).max(f64::MIN_POSITIVE);
    let count = |length: f64| (length / cell).ceil().max(1.0) as usize;
    let (columns, rows) = (count(size.x) + 2, count(size.y) + 2);
    let height = |index: usize| {
        let (column, row) = (index % columns, index / columns);
        let is_frame = column == 0 || row == 0 || column + 1 == columns || row + 1 == rows;
        let x = low.x + (column as f64 - 1.0 + WITHIN[0]) * cell;
        let y = low.y + (row as f64 - 1.0 + WITHIN[1]) * cell;
        if is_frame {
            None
        } else {
            body.height_at(x, y)
        }
    };
    Map { columns, rows, heights: (0..columns * rows).map(height).collect() }
}

fn border(map: &Map, seen: &[f64], depth: f64) -> Option<Border> {
    let outside = map.outside();
    let is_border = |cell: &usize| map.heights[*cell].is_some() && map.around(*cell).any(|near| outside[near]);
    // beside the very edge: of a cell and those around it the highest, or a wall's slope would count
    let level = |cell: usize| map.around(cell).filter_map(|near| map.heights[near]).fold(f64::NEG_INFINITY, f64::max);
    let mut levels: Vec<f64> = (0..map.heights.len()).filter(is_border).map(level).collect();
    levels.sort_by(f64::total_cmp);
    let at = |share: f64| levels.get((share * (levels.len() as f64 - 1.0)).round() as usize).copied();
    let middle = at(0.5)?;
    let above = seen.iter().filter(|z| **z > middle + 0.01 * depth).count() as f64 / seen.len() as f64;
    Some(Border { middle, low: at(0.1)?, high: at(0.9)?, above })
}
