//! On which side of a level the nodes of a grid lie, and those of a finer grid where something may hide in a cell.
//!
//! A cell whose corners agree, but whose bounds do not, is looked into: it is divided until bounds decide, or down to
//! a sixteenth. What is then found there is part of the grid; a cell beside it follows, where both must meet.

use std::collections::{BTreeMap, BTreeSet};

use styluscam_motion::{Cancelled, Watch};

use super::bounds::Bounds;
use super::grid::Grid;
use super::level_curve::{self, LevelCurve};
use crate::{lattice::Node, offset::Verdict};

/// Parts into which a side of a cell is divided at most.
pub const PARTS: usize = 16;

/// Two neighbouring nodes of the fine grid, or of the coarse one; the first is the lower or left one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Edge {
    pub from: Node,
    pub to: Node,
}

/// An edge that the level crosses, on the way along an outline.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    pub edge: Edge,
    /// Whether the way leads to above the level.
    pub rises: bool,
}

/// Which nodes are above a level. Nodes and cells are told in fine numbers, [`PARTS`] times the coarse ones, unless they
/// are said to be coarse.
pub struct Sides<'a> {
    grid: &'a Grid,
    bounds: &'a Bounds,
    z: f64,
    /// What is known of nodes of the fine grid.
    fine: BTreeMap<Node, bool>,
    /// Cells that the fine grid divides, in coarse numbers.
    divided: BTreeSet<Node>,
}

impl<'a> Sides<'a> {
    /// Finds out where the level `z` may hide.
    ///
    /// # Errors
    /// `Cancelled` when `watch` says so.
    pub fn of(
        grid: &'a Grid,
        bounds: &'a Bounds,
        curve: &mut LevelCurve<'_>,
        z: f64,
        watch: &Watch,
    ) -> Result<Self, Cancelled> {
        let mut sides = Self { grid, bounds, z, fine: BTreeMap::new(), divided: BTreeSet::new() };
        let mut found = Vec::new();
        for cell in grid.lattice().cells().iter() {
            if sides.may_hide(cell) {
                watch.advance(0)?;
                if sides.look_into(cell, curve) {
                    found.push(cell);
                }
            }
        }
        while let Some(cell) = found.pop() {
            watch.advance(0)?;
            sides.divided.insert(cell);
            for beside in sides.beside(cell) {
                if !sides.divided.contains(&beside) && sides.follows(beside) {
                    sides.look_into(beside, curve);
                    found.push(beside);
                }
            }
        }
        Ok(sides)
    }

    /// Whether the tip must stay above the level at a node of the coarse grid, in coarse numbers.
    fn is_node_above(&self, node: Node) -> bool {
        self.grid.tip(node).is_some_and(|tip| level_curve::is_over(tip, self.z))
    }

    /// Whether the tip must stay above the level at a node that is known, in fine numbers.
    fn is_above(&self, node: Node) -> bool {
        if is_coarse(node) {
            self.is_node_above(node.map(|i| i / PARTS))
        } else {
            self.fine.get(&node).copied().unwrap_or(false)
        }
    }

    /// Whether the corners of a cell agree, but the level may still pass it.
    fn may_hide(&self, cell: Node) -> bool {
        let number = self.grid.lattice().number(cell);
        match self.corners_above(cell) {
            0 => self.bounds.may_rise(number, self.z),
            4 => self.bounds.may_dip(number, self.z),
            _ => false,
        }
    }

    /// Finds out about the fine nodes of a cell; whether some are on the other side than its first corner.
    fn look_into(&mut self, cell: Node, curve: &mut LevelCurve<'_>) -> bool {
        let first = cell.map(|i| i * PARTS);
        let mut open = vec![(first, PARTS)];
        while let Some((from, size)) = open.pop() {
            let to = from.map(|i| i + size);
            match curve.verdict(&[self.place(from), self.place(to)]) {
                Verdict::Open if size > 1 => {
                    let half = size / 2;
                    let [x, y] = from;
                    open.extend([[x, y], [x + half, y], [x, y + half], [x + half, y + half]].map(|at| (at, half)));
                }
                Verdict::Open => {
                    for node in corners(from, size) {
                        let place = self.place(node);
                        self.fine.entry(node).or_insert_with(|| curve.is_above(place));
                    }
                }
                decided => {
                    for y in from[1]..=to[1] {
                        for x in from[0]..=to[0] {
                            self.fine.entry([x, y]).or_insert(decided == Verdict::Above);
                        }
                    }
                }
            }
        }
        let side = self.is_above(first);
        let nodes = |at: usize| at..=at + PARTS;
        nodes(first[1]).any(|y| nodes(first[0]).any(|x| self.is_above([x, y]) != side))
    }

    /// The cells that share a side with one.
    fn beside(&self, [column, row]: Node) -> Vec<Node> {
        let mut cells = Vec::with_capacity(4);
        if column > 0 {
            cells.push([column - 1, row]);
        }
        if row > 0 {
            cells.push([column, row - 1]);
        }
        if column + 1 < self.grid.lattice().columns {
            cells.push([column + 1, row]);
        }
        if row + 1 < self.grid.lattice().rows {
            cells.push([column, row + 1]);
        }
        cells
    }

    /// Whether a cell must be divided as well: the level crosses one of its sides more than once, or it has more than one
    /// way through it and one of them is finely known.
    fn follows(&self, cell: Node) -> bool {
        let corners = corners(cell.map(|i| i * PARTS), PARTS);
        let crossed = [0, 1, 2, 3].map(|i| self.crossings(&self.side(corners[i], corners[(i + 1) % 4])).len());
        crossed.iter().any(|count| *count > 1) || crossed.iter().sum::<usize>() > 2
    }

    /// The nodes from one corner of a cell to the next: fine ones where the fine grid divides a cell on either side.
    fn side(&self, from: Node, to: Node) -> Vec<Node> {
        let first = [from[0].min(to[0]) / PARTS, from[1].min(to[1]) / PARTS];
        let across = usize::from(from[0] != to[0]);
        let beside = first[across].checked_sub(1).map(|before| {
            let mut cell = first;
            cell[across] = before;
            cell
        });
        if !self.divided.contains(&first) && !beside.is_some_and(|cell| self.divided.contains(&cell)) {
            return vec![from, to];
        }
        let part = |i: usize| [0, 1].map(|k| (from[k] * (PARTS - i) + to[k] * i) / PARTS);
        (0..=PARTS).map(part).collect()
    }

    /// The pairs of neighbours on different sides of the level, in the order of the nodes.
    fn crossings(&self, nodes: &[Node]) -> Vec<Crossing> {
        let pairs = nodes.windows(2).map(|pair| (pair[0], pair[1]));
        let crossing = |(a, b): (Node, Node)| {
            let rises = self.is_above(b);
            (self.is_above(a) != rises).then(|| Crossing { edge: Edge { from: a.min(b), to: a.max(b) }, rises })
        };
        pairs.filter_map(crossing).collect()
    }

    /// The crossings of the level with the outline of each cell that it passes, counterclockwise, and the cell's middle.
    pub fn visit_cells(&self, mut visit: impl FnMut(Vec<Crossing>, [f64; 2])) {
        for cell in self.grid.lattice().cells().iter() {
            let first = cell.map(|i| i * PARTS);
            if self.divided.contains(&cell) {
                for part in 0..PARTS * PARTS {
                    self.visit([first[0] + part % PARTS, first[1] + part / PARTS], 1, &mut visit);
                }
            } else if self.differ(cell) || self.is_beside_divided(cell) {
                self.visit(first, PARTS, &mut visit);
            }
        }
    }

    fn visit(&self, first: Node, size: usize, visit: &mut impl FnMut(Vec<Crossing>, [f64; 2])) {
        let corners = corners(first, size);
        let sides = [0, 1, 2, 3].map(|i| {
            let (from, to) = (corners[i], corners[(i + 1) % 4]);
            if size == 1 {
                vec![from, to]
            } else {
                self.side(from, to)
            }
        });
        let crossings: Vec<Crossing> = sides.iter().flat_map(|side| self.crossings(side)).collect();
        if !crossings.is_empty() {
            let half = 0.5 * size as f64;
            let middle = first.map(|i| (i as f64 + half) / PARTS as f64);
            visit(crossings, self.grid.lattice().place(middle));
        }
    }

    fn differ(&self, cell: Node) -> bool {
        let above = self.corners_above(cell);
        above != 0 && above != 4
    }

    fn corners_above(&self, cell: Node) -> usize {
        corners(cell, 1).into_iter().filter(|node| self.is_node_above(*node)).count()
    }

    fn is_beside_divided(&self, cell: Node) -> bool {
        !self.divided.is_empty() && self.beside(cell).iter().any(|beside| self.divided.contains(beside))
    }

    /// The ends of an edge in plan, the one above the level first.
    pub fn ends(&self, edge: Edge) -> [[f64; 2]; 2] {
        let (above, free) = if self.is_above(edge.from) { (edge.from, edge.to) } else { (edge.to, edge.from) };
        [self.place(above), self.place(free)]
    }

    /// Where the level most likely is on an edge, as a share of the way down: on the straight line between the tips.
    pub fn guess(&self, edge: Edge) -> f64 {
        let tip = |node: Node| if is_coarse(node) { self.grid.tip(node.map(|i| i / PARTS)) } else { None };
        let (a, b) = (tip(edge.from), tip(edge.to));
        match (a, b) {
            (Some(a), Some(b)) if (a - b).abs() > f64::MIN_POSITIVE => {
                ((a.max(b) - self.z) / (a - b).abs()).clamp(0.01, 0.99)
            }
            _ => 0.5,
        }
    }

    fn place(&self, node: Node) -> [f64; 2] {
        self.grid.lattice().place(node.map(|i| i as f64 / PARTS as f64))
    }
}

/// The corners of a cell, counterclockwise.
fn corners([x, y]: Node, size: usize) -> [Node; 4] {
    [[x, y], [x + size, y], [x + size, y + size], [x, y + size]]
}

fn is_coarse(node: Node) -> bool {
    node.iter().all(|i| i % PARTS == 0)
}
