//! Heights as triangles: large where the surface is flat, small where it is not, without a gap.
//!
//! Squares of nodes are halved into right triangles, and those across their longest sides, as long as that is needed. A
//! node is needed where the middle of a side is off it, or anything finer is off that: both together bound what the
//! triangles are off any node. Source: W. Evans, D. Kirkpatrick, G. Townsend, "Right-Triangulated Irregular Networks",
//! Algorithmica 30, 2001.

use styluscam_geometry::Vector;

use super::grid::Grid;
use super::stock::Simulation;

/// No vertex yet.
const NONE: u32 = u32::MAX;

/// A surface or a closed body as triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skin {
    /// Work coordinates, mm.
    pub vertices: Vec<Vector>,
    /// Seen from outside counterclockwise.
    pub triangles: Vec<[u32; 3]>,
}

impl Simulation {
    /// The surface as triangles that are off no node by more than `tolerance` mm; with a `floor` (mm) the body between
    /// both, no node lower than that.
    #[must_use]
    pub fn skin(&self, tolerance: f64, floor: Option<f64>) -> Skin {
        let lowest = floor.unwrap_or(f64::NEG_INFINITY);
        let heights: Vec<f64> = self.heights.iter().map(|height| height.max(lowest)).collect();
        let errors = errors(&self.grid, &heights);
        let mut drawing = Drawing {
            grid: &self.grid,
            heights: &heights,
            errors: &errors,
            tolerance,
            numbers: vec![NONE; heights.len()],
            skin: Skin::default(),
        };
        drawing.surface();
        if let Some(floor) = floor {
            drawing.close(floor);
        }
        drawing.skin
    }
}

/// What triangles that leave a node out may be off it and off all finer ones, mm.
fn errors(grid: &Grid, heights: &[f64]) -> Vec<f32> {
    let [width, depth] = grid.nodes;
    let mut errors = vec![0.0_f32; heights.len()];
    let mut half = 1;
    while half < grid.square() {
        // middles of the squares' sides, then of their diagonals: each with the finer nodes that hang on it
        for diagonal in [false, true] {
            for y in (0..depth).step_by(half) {
                for x in (0..width).step_by(half) {
                    let odd = [x, y].map(|at| at / half % 2 == 1);
                    if odd[0] != odd[1] && !diagonal {
                        let (a, b) =
                            if odd[0] { ([x - half, y], [x + half, y]) } else { ([x, y - half], [x, y + half]) };
                        let finer = half / 2;
                        let around = [(true, true), (true, false), (false, true), (false, false)];
                        let around = around.map(|(right, up)| [moved(x, right, finer), moved(y, up, finer)]);
                        let finer = if finer > 0 { worst(&errors, grid.nodes, around) } else { 0.0 };
                        errors[y * width + x] = off(heights, width, [x, y], a, b) + finer;
                    } else if odd[0] && odd[1] && diagonal {
                        let [a, b] = ends_of_diagonal([x, y], half);
                        let sides = [(true, half), (false, half)];
                        let across = sides.map(|(right, by)| [moved(x, right, by), Some(y)]);
                        let along = sides.map(|(up, by)| [Some(x), moved(y, up, by)]);
                        let finer = worst(&errors, grid.nodes, [across[0], across[1], along[0], along[1]]);
                        errors[y * width + x] = off(heights, width, [x, y], a, b) + finer;
                    }
                }
            }
        }
        half *= 2;
    }
    errors
}

fn moved(at: usize, forward: bool, by: usize) -> Option<usize> {
    if forward {
        at.checked_add(by)
    } else {
        at.checked_sub(by)
    }
}

/// The largest error of some nodes, those beside the grid left out.
fn worst(errors: &[f32], [width, depth]: [usize; 2], nodes: [[Option<usize>; 2]; 4]) -> f32 {
    let on_grid = |[x, y]: [Option<usize>; 2]| Some((x.filter(|x| *x < width)?, y.filter(|y| *y < depth)?));
    nodes.into_iter().filter_map(on_grid).map(|(x, y)| errors[y * width + x]).fold(0.0, f32::max)
}

/// How far a node is off the middle of two others, mm.
fn off(heights: &[f64], width: usize, [x, y]: [usize; 2], a: [usize; 2], b: [usize; 2]) -> f32 {
    let height = |[x, y]: [usize; 2]| heights[y * width + x];
    (height([x, y]) - 0.5 * (height(a) + height(b))).abs() as f32
}

/// The ends of the diagonal through the middle of a square: they take turns, so that those of four squares meet.
fn ends_of_diagonal([x, y]: [usize; 2], half: usize) -> [[usize; 2]; 2] {
    let (low, high) = ([x - half, y - half], [x + half, y + half]);
    if ((low[0] + low[1]) / (2 * half)).is_multiple_of(2) {
        [low, high]
    } else {
        [[high[0], low[1]], [low[0], high[1]]]
    }
}

/// A skin in the making.
struct Drawing<'a> {
    grid: &'a Grid,
    heights: &'a [f64],
    errors: &'a [f32],
    tolerance: f64,
    /// Number of the vertex at every node.
    numbers: Vec<u32>,
    skin: Skin,
}

impl Drawing<'_> {
    fn surface(&mut self) {
        let size = self.grid.square();
        let [columns, rows] = self.grid.nodes.map(|nodes| (nodes - 1) / size);
        for row in 0..rows {
            for column in 0..columns {
                let ([left, front], [right, back]) =
                    ([column * size, row * size], [(column + 1) * size, (row + 1) * size]);
                let corners = [[left, front], [right, front], [right, back], [left, back]];
                let first = (column + row) % 2;
                let [a, b, c, d] = [0, 1, 2, 3].map(|k| corners[(k + first) % 4]);
                self.triangle([c, a, b]);
                self.triangle([a, c, d]);
            }
        }
    }

    /// A triangle, its longest side first, or its halves.
    fn triangle(&mut self, corners: [[usize; 2]; 3]) {
        let mut left = vec![corners];
        while let Some([a, b, c]) = left.pop() {
            let sum = [a[0] + b[0], a[1] + b[1]];
            let middle = sum.map(|sum| sum / 2);
            let is_node = sum.iter().all(|sum| sum % 2 == 0);
            if is_node && f64::from(self.errors[middle[1] * self.grid.nodes[0] + middle[0]]) > self.tolerance {
                left.extend([[b, c, middle], [c, a, middle]]);
            } else {
                let triangle = [a, b, c].map(|node| self.vertex(node));
                self.skin.triangles.push(triangle);
            }
        }
    }

    fn vertex(&mut self, [x, y]: [usize; 2]) -> u32 {
        let node = y * self.grid.nodes[0] + x;
        if self.numbers[node] == NONE {
            let [along, across] = self.grid.at(x, y);
            self.numbers[node] = self.add(Vector::new(along, across, self.heights[node]));
        }
        self.numbers[node]
    }

    fn add(&mut self, vertex: Vector) -> u32 {
        self.skin.vertices.push(vertex);
        self.skin.vertices.len() as u32 - 1
    }

    /// Walls from the surface's border down to a floor, and that.
    fn close(&mut self, floor: f64) {
        let [width, depth] = self.grid.nodes;
        let (right, back) = (width - 1, depth - 1);
        let front = (0..right).map(|x| [x, 0]);
        let border = front.chain((0..back).map(|y| [right, y]));
        let border = border.chain((1..=right).rev().map(|x| [x, back])).chain((1..=back).rev().map(|y| [0, y]));
        let upper: Vec<u32> = border.map(|[x, y]| self.numbers[y * width + x]).filter(|n| *n != NONE).collect();
        let down = |drawing: &mut Self, number: &u32| {
            let over = drawing.skin.vertices[*number as usize];
            drawing.add(Vector::new(over.x, over.y, floor))
        };
        let lower: Vec<u32> = upper.iter().map(|number| down(self, number)).collect();
        let (low, high) = (self.grid.at(0, 0), self.grid.at(right, back));
        let middle = self.add(Vector::new(0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), floor));
        for i in 0..upper.len() {
            let next = (i + 1) % upper.len();
            let walls = [[lower[i], lower[next], upper[next]], [lower[i], upper[next], upper[i]]];
            self.skin.triangles.extend(walls);
            self.skin.triangles.push([lower[next], lower[i], middle]);
        }
    }
}
