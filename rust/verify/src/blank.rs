//! The sheet while it is formed: how low it stands, cell by cell.
//!
//! Where the tool was, the sheet stands no higher than the tool's profile. Where it was not, the sheet hangs between what is
//! formed and what is flat: inside a loop it hangs as low as the loop, since no path leads from there to flat sheet that does
//! not cross it. So the height of a position is that of the best path to it from sheet that stays flat, and the height of a path
//! is that of its lowest position: the flooding of terrain, upside down (R. Barnes, C. Lehman, D. Mulla, "Priority-Flood",
//! Computers & Geosciences 62, 2014).

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use styluscam_geometry::{Cutter, Mesh, Vector};

use crate::subject::Support;
use crate::tolerances::ROUGH;

/// Side of a cell, as a share of the tool's radius.
const CELL: f64 = 0.5;
/// Cells along a side at most: those of a large part are larger, and forgive more.
const CELLS: f64 = 128.0;
/// The same where increments of layers are measured.
const FINE_CELLS: f64 = 256.0;
/// What a cell of these may be too low, as a share of the increment: the tool's profile rises by so much within its diagonal.
const TOO_LOW: f64 = 0.05;

/// How large the cells are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cells {
    /// Side, mm.
    side: f64,
    /// Along a side of the part, at most.
    most: f64,
}

impl Cells {
    /// For tools that are no narrower than `radius`, mm.
    pub fn of(radius: f64) -> Self {
        Self { side: CELL * radius, most: CELLS }
    }

    /// As fine as it takes to measure an increment of a tool, mm.
    pub fn fine(self, tool: &Cutter, increment: f64) -> Self {
        let (radius, _) = tool.at_height(TOO_LOW * increment);
        Self { side: self.side.min(radius * std::f64::consts::SQRT_2), most: FINE_CELLS }
    }
}

/// The sheet over the part, in square cells.
pub(crate) struct Blank {
    low: [f64; 2],
    cell: f64,
    counts: [usize; 2],
    top: f64,
    /// Heights of the upper side that tools have pressed it down to, mm.
    pressed: Vec<f64>,
    /// Heights at which it hangs: minus infinity off the part.
    hanging: Vec<f64>,
    /// Cells in which the part lies.
    part: Vec<bool>,
    /// Heights below which it cannot stand, of cells in which it is held up: where it stays flat, where a die is under it.
    held: Vec<(usize, f64)>,
    /// Where it is clamped, when the clamp goes down: the outermost cells of the part, and how high it stands there now.
    frame: Option<(Vec<usize>, f64)>,
    /// Whether something was pressed since the heights at which it hangs were found.
    is_stale: bool,
    /// The lowest position of all, mm.
    lowest: f64,
}

impl Blank {
    /// A flat sheet over `part`, its upper side at `top`, mm.
    pub fn new(part: &Mesh, top: f64, cells: Cells, support: Support) -> Self {
        let (low, high) = part.bounds();
        let [long, wide] = [high.x - low.x, high.y - low.y];
        let cell = cells.side.max(long.max(wide) / cells.most).max(f64::MIN_POSITIVE);
        let counts = [long, wide].map(|length| (length / cell).ceil().max(1.0) as usize);
        let mut blank = Self {
            low: [low.x, low.y],
            cell,
            counts,
            top,
            pressed: vec![top; counts[0] * counts[1]],
            hanging: Vec::new(),
            part: Vec::new(),
            held: Vec::new(),
            frame: None,
            is_stale: true,
            lowest: top,
        };
        let heights = blank.heights_of(part);
        let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        blank.part = heights.iter().map(|height| height.is_finite()).collect();
        let of_part = heights.iter().copied().enumerate().filter(|(_, height)| height.is_finite());
        match support {
            Support::Rim => {
                blank.held =
                    of_part.filter(|(_, height)| *height >= highest - ROUGH).map(|(at, _)| (at, top)).collect();
            }
            Support::DieAndFrame | Support::Mandrel => {
                // the sheet's upper side is as far above the model everywhere as where both are highest
                blank.held = of_part.map(|(at, height)| (at, height + top - highest)).collect();
                blank.frame = Some((blank.outermost(), top));
            }
        }
        blank
    }

    /// Cells of the part beside which there is none.
    fn outermost(&self) -> Vec<usize> {
        let is_part = |cell: [i64; 2]| self.index(cell).is_some_and(|at| self.part[at]);
        let is_outermost = |at: &usize| self.part[*at] && !self.beside(*at).into_iter().all(is_part);
        (0..self.part.len()).filter(is_outermost).collect()
    }

    /// The clamp goes to a height, mm; without effect where it stays.
    pub fn hold_at(&mut self, height: f64) {
        if let Some((_, stands)) = &mut self.frame {
            self.is_stale |= stands.total_cmp(&height) != Ordering::Equal;
            *stands = height;
        }
    }

    /// Side of a cell, mm.
    pub fn cell(&self) -> f64 {
        self.cell
    }

    /// Height of the flat sheet's upper side, mm.
    pub fn top(&self) -> f64 {
        self.top
    }

    /// Presses the sheet down to a tool's profile, its tip at `tip`.
    pub fn press(&mut self, [x, y, z]: [f64; 3], tool: &Cutter) {
        self.is_stale = true;
        self.lowest = self.lowest.min(z);
        let reach = (tool.max_radius() / self.cell).ceil() as i64;
        let [i, j] = self.cell_at([x, y]);
        for (other_i, other_j) in (-reach..=reach).flat_map(|di| (-reach..=reach).map(move |dj| (i + di, j + dj))) {
            let Some(at) = self.index([other_i, other_j]) else { continue };
            let height = if (other_i, other_j) == (i, j) {
                0.0
            } else {
                let [from_x, from_y] = self.middle([other_i, other_j]);
                tool.quick_height_at_radius(libm::hypot(from_x - x, from_y - y))
            };
            self.pressed[at] = self.pressed[at].min(z + height);
        }
    }

    /// Height at which the sheet stands at a position, as far as the tools around have pressed it, mm.
    pub fn pressed_at(&self, position: [f64; 2]) -> f64 {
        let [i, j] = self.cell_at(position);
        let around = (-1..=1).flat_map(|di| (-1..=1).map(move |dj| [i + di, j + dj]));
        around.filter_map(|at| self.index(at)).map(|at| self.pressed[at]).fold(self.top, f64::min)
    }

    /// Height at which it stands there, also where it only hangs, mm. Off the part it is taken to hang as low as anything
    /// is: what lies there the job does not state.
    pub fn hangs_at(&mut self, position: [f64; 2]) -> f64 {
        let Some(at) = self.index(self.cell_at(position)).filter(|at| self.part[*at]) else { return self.lowest };
        if self.is_stale {
            self.hang();
        }
        self.hanging[at].min(self.pressed_at(position))
    }

    /// How high it stands where it is most in the way of a tool, its tip at `tip`, and by how much it is, mm; none where it is
    /// nowhere.
    pub fn in_the_way(&mut self, [x, y, z]: [f64; 3], tool: &Cutter) -> Option<(f64, f64)> {
        let reach = (tool.max_radius() / self.cell).ceil() as i64;
        let own = self.cell_at([x, y]);
        let around = (-reach..=reach).flat_map(|di| (-reach..=reach).map(move |dj| [own[0] + di, own[1] + dj]));
        let mut worst: Option<(f64, f64)> = None;
        for cell in around {
            let middle = self.middle(cell);
            let radius = if cell == own { 0.0 } else { libm::hypot(middle[0] - x, middle[1] - y) };
            if radius > tool.max_radius() {
                continue;
            }
            let stands = self.hangs_at(middle);
            let by = stands - (z + tool.quick_height_at_radius(radius));
            if by > 0.0 && worst.is_none_or(|(_, most)| by > most) {
                worst = Some((stands, by));
            }
        }
        worst
    }

    /// By how much a tool, its tip at `tip`, would press it down where it does so most, mm, if that is more than `most`.
    pub fn pressed_by(&mut self, [x, y, z]: [f64; 3], tool: &Cutter, most: f64) -> Option<f64> {
        let reach = (tool.max_radius() / self.cell).ceil() as i64;
        let [i, j] = self.cell_at([x, y]);
        let mut worst = most;
        for cell in (-reach..=reach).flat_map(|di| (-reach..=reach).map(move |dj| [i + di, j + dj])) {
            let Some(at) = self.index(cell).filter(|at| self.part[*at] && self.pressed[*at] - z > worst) else {
                continue;
            };
            let [from_x, from_y] = self.middle(cell);
            let below = z + tool.quick_height_at_radius(libm::hypot(from_x - x, from_y - y));
            if self.pressed[at] - below > worst {
                if self.is_stale {
                    self.hang();
                }
                worst = worst.max(self.hanging[at].min(self.pressed[at]) - below);
            }
        }
        (worst > most).then_some(worst)
    }

    /// Lets it hang: from where it is held, each cell as high as the best path to it.
    fn hang(&mut self) {
        self.is_stale = false;
        self.hanging = vec![f64::NEG_INFINITY; self.pressed.len()];
        let clamped = self.frame.iter().flat_map(|(cells, height)| cells.iter().map(|at| (*at, *height)));
        let held = self.held.iter().copied().chain(clamped);
        let mut next: BinaryHeap<Cell> =
            held.map(|(at, height)| Cell { height: height.min(self.pressed[at]), at }).collect();
        while let Some(Cell { height, at }) = next.pop() {
            if self.hanging[at] >= height {
                continue; // a better path has led there
            }
            self.hanging[at] = height;
            for beside in self.beside(at) {
                let Some(other) = self.index(beside).filter(|other| self.part[*other]) else { continue };
                let height = height.min(self.pressed[other]);
                if self.hanging[other] < height {
                    next.push(Cell { height, at: other });
                }
            }
        }
    }

    /// The four cells beside one.
    fn beside(&self, at: usize) -> [[i64; 2]; 4] {
        let (i, j) = ((at % self.counts[0]) as i64, (at / self.counts[0]) as i64);
        [[i - 1, j], [i + 1, j], [i, j - 1], [i, j + 1]]
    }

    /// The part's height in the middle of each cell, mm; minus infinity beside it.
    fn heights_of(&self, part: &Mesh) -> Vec<f64> {
        let mut heights = vec![f64::NEG_INFINITY; self.pressed.len()];
        for corners in (0..part.triangles().len()).map(|triangle| part.corners(triangle)) {
            let [low, high] = [Vector::inf, Vector::sup].map(|end| end(&end(&corners[0], &corners[1]), &corners[2]));
            let ([i, j], [last_i, last_j]) = (self.cell_at([low.x, low.y]), self.cell_at([high.x, high.y]));
            for at in (i..=last_i).flat_map(|i| (j..=last_j).map(move |j| [i, j])) {
                let Some(index) = self.index(at) else { continue };
                heights[index] = heights[index].max(height_over(&corners, self.middle(at)));
            }
        }
        heights
    }

    fn cell_at(&self, [x, y]: [f64; 2]) -> [i64; 2] {
        [(x - self.low[0]) / self.cell, (y - self.low[1]) / self.cell].map(|at| at.floor() as i64)
    }

    fn middle(&self, [i, j]: [i64; 2]) -> [f64; 2] {
        [self.low[0] + (i as f64 + 0.5) * self.cell, self.low[1] + (j as f64 + 0.5) * self.cell]
    }

    fn index(&self, [i, j]: [i64; 2]) -> Option<usize> {
        let [i, j] = [usize::try_from(i).ok()?, usize::try_from(j).ok()?];
        (i < self.counts[0] && j < self.counts[1]).then(|| j * self.counts[0] + i)
    }
}

/// Height of a triangle over a position in plan, mm; minus infinity where it does not lie there.
fn height_over([a, b, c]: &[Vector; 3], [x, y]: [f64; 2]) -> f64 {
    let across = |p: &Vector, q: &Vector| (p.x - x) * (q.y - y) - (p.y - y) * (q.x - x);
    let shares = [across(b, c), across(c, a), across(a, b)];
    let whole: f64 = shares.iter().sum();
    if whole == 0.0 || shares.iter().any(|share| share * whole < 0.0) {
        return f64::NEG_INFINITY;
    }
    (shares[0] * a.z + shares[1] * b.z + shares[2] * c.z) / whole
}

/// A cell and the height at which it hangs: the highest comes first, of equal ones the first.
#[derive(Clone, Copy)]
struct Cell {
    height: f64,
    at: usize,
}

impl Ord for Cell {
    fn cmp(&self, other: &Self) -> Ordering {
        self.height.total_cmp(&other.height).then(other.at.cmp(&self.at))
    }
}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Cell {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Cell {}

#[cfg(test)]
#[allow(clippy::float_cmp)] // sums and halves of whole numbers are exact
mod tests {
    use super::*;
    use crate::body::tests::tool;
    use styluscam_geometry::{kinds, ProfileDocument};

    /// A plate of 40 mm with a flat flange and a square pit in the middle, 20 mm wide.
    fn plate() -> Mesh {
        let ring = |half: f64, z: f64| {
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vector::new(x * half, y * half, z))
        };
        let vertices: Vec<Vector> = [ring(20.0, 0.0), ring(10.0, 0.0), ring(5.0, -5.0)].concat();
        let sides = |outer: i64| {
            (0..4).flat_map(move |i| {
                let (a, b) = (outer + i, outer + (i + 1) % 4);
                [[a, b, b + 4], [a, b + 4, a + 4]]
            })
        };
        let triangles: Vec<[i64; 3]> = sides(0).chain(sides(4)).chain([[8, 9, 10], [8, 10, 11]]).collect();
        Mesh::new(vertices, &triangles, &[]).unwrap()
    }

    fn ball(diameter: f64) -> Cutter {
        tool(ProfileDocument::from(kinds::Ball { diameter, radius: None, tip_flat: 0.0 })).cutter()
    }

    #[test]
    fn inside_a_loop_the_sheet_hangs_as_low_as_the_loop() {
        let (mut blank, ball) = (Blank::new(&plate(), 0.0, Cells::of(2.0), Support::Rim), ball(4.0));
        for i in 0..400 {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(i) / 400.0);
            blank.press([8.0 * cos, 8.0 * sin, -1.0], &ball);
        }
        assert_eq!(blank.hangs_at([0.0, 0.0]), -1.0);
        assert_eq!(blank.pressed_at([0.0, 0.0]), 0.0);
        assert_eq!(blank.hangs_at([15.0, 15.0]), 0.0);
    }

    #[test]
    fn over_a_die_it_stands_on_that_and_in_the_frame() {
        let hill = plate().placed(&styluscam_geometry::Frame::turning_up(-Vector::z(), 0.0));
        let (mut blank, ball) = (Blank::new(&hill, 5.0, Cells::of(2.0), Support::DieAndFrame), ball(4.0));
        assert_eq!(blank.hangs_at([0.0, 0.0]), 5.0);
        assert_eq!(blank.hangs_at([18.0, 18.0]), 5.0);
        for i in 0..400 {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(i) / 400.0);
            blank.press([8.0 * cos, 8.0 * sin, 4.0], &ball);
        }
        // the frame still holds it up outside; once it goes down, the sheet does, as far as the loop
        assert_eq!(blank.hangs_at([18.0, 18.0]), 5.0);
        blank.hold_at(1.0);
        assert_eq!(blank.hangs_at([18.0, 18.0]), 4.0);
        assert_eq!(blank.hangs_at([0.0, 0.0]), 5.0);
    }

    #[test]
    fn beside_half_a_loop_it_stands() {
        let (mut blank, ball) = (Blank::new(&plate(), 0.0, Cells::of(2.0), Support::Rim), ball(4.0));
        for i in 0..200 {
            let (sin, cos) = libm::sincos(std::f64::consts::PI * f64::from(i) / 200.0);
            blank.press([8.0 * cos, 8.0 * sin, -1.0], &ball);
        }
        assert_eq!(blank.hangs_at([0.0, 0.0]), 0.0);
        assert_eq!(blank.hangs_at([0.0, 8.0]), -1.0);
    }
}
