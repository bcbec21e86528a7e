//! Lines below a cutter's profile, in single precision, looked up by distance from the axis.

use styluscam_geometry::Cutter;
use wide::f32x8;

use super::width::WIDTH;

/// Cells up to the cutter's radius; one more serves beyond.
const CELLS: usize = 512;
/// Entries for them, a power of two: a number cut to it needs no check.
const ENTRIES: usize = 1024;
/// Steepest line, dz/dr: steeper ones would only magnify rounding.
pub const STEEPEST: f64 = 16.0;

/// For each cell of distances a line `height + rise * distance` that the profile never falls below.
#[derive(Clone, Debug)]
pub struct Lines {
    cells_per_mm: f64,
    lines: Box<[[f32; 2]; ENTRIES]>,
    /// Heights of the profile at the cells' borders, mm.
    heights: Vec<f64>,
}

impl Lines {
    pub fn of(cutter: &Cutter) -> Self {
        let cells_per_mm = CELLS as f64 / cutter.max_radius();
        let mut lines = Box::new([[0.0; 2]; ENTRIES]);
        for (cell, slot) in lines.iter_mut().enumerate().take(CELLS + 1) {
            *slot = line(cutter, (cell as f64 + 0.5) / cells_per_mm);
        }
        let heights =
            (0..=CELLS).map(|cell| cutter.height_at_radius(cell as f64 / cells_per_mm).min(cutter.max_height()));
        Self { cells_per_mm, heights: heights.collect(), lines }
    }

    /// Height on the axis's side of the lines, at the distance, and their rise.
    #[inline]
    pub fn at(&self, distance: f32x8) -> (f32x8, f32x8) {
        let cells = distance * f32x8::splat(self.cells_per_mm as f32);
        let cells = cells.fast_min(f32x8::splat(CELLS as f32)).fast_trunc_int().to_array();
        let (mut heights, mut rises) = ([0.0; WIDTH], [0.0; WIDTH]);
        for lane in 0..WIDTH {
            [heights[lane], rises[lane]] = self.lines[cells[lane] as usize % ENTRIES];
        }
        let (heights, rises) = (f32x8::new(heights), f32x8::new(rises));
        (heights + rises * distance, rises)
    }

    /// The rise of the line at one distance, mm.
    pub fn rise_at(&self, distance: f64) -> f64 {
        f64::from(self.line_at(distance)[1])
    }

    /// A height that the profile does not fall below at a distance, mm.
    pub fn below(&self, distance: f64) -> f64 {
        let [height, rise] = self.line_at(distance).map(f64::from);
        height + rise * distance
    }

    /// A height that the profile does not exceed at a distance, mm: the chord over it. Infinite beyond the cutter.
    pub fn above(&self, distance: f64) -> f64 {
        let scaled = distance * self.cells_per_mm;
        let cell = scaled as usize;
        match self.heights.get(cell..cell + 2) {
            Some(ends) => ends[0] + (scaled - cell as f64) * (ends[1] - ends[0]),
            None => f64::INFINITY,
        }
    }

    fn line_at(&self, distance: f64) -> [f32; 2] {
        let cell = (distance * self.cells_per_mm) as usize;
        self.lines[cell.min(CELLS)]
    }
}

/// The tangent at a radius, or the steepest line; lowered by what rounding can raise it.
fn line(cutter: &Cutter, radius: f64) -> [f32; 2] {
    let slope = if radius < cutter.max_radius() { cutter.slope_at_radius(radius) } else { std::f64::consts::FRAC_PI_2 };
    let slope = slope.min(libm::atan(STEEPEST));
    let (r, z) = cutter.point_at(slope);
    let rise = libm::tan(slope);
    let rounding = 2e-7 * (z + rise * (r + 2.0 * cutter.max_radius()));
    [(z - rise * r - rounding) as f32, rise as f32]
}
