//! On which side of a level the nodes of a grid lie, and those of its parts that are known.

use std::collections::HashMap;

use super::grid::Grid;
use super::level_curve::{self, LevelCurve, PlanPosition};
use super::square::{is_coarse, Edge, Square, PARTS};
use crate::{lattice::Node, offset::Verdict};

/// A cell in which something may hide is looked into down to squares of this size.
pub const LOOKED_AT: usize = PARTS / 16;

/// An edge that the level crosses, in order along an outline.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    pub edge: Edge,
    /// Whether the outline leads to above the level there.
    pub rises: bool,
}

/// Which nodes are above a level.
pub struct Sides<'a> {
    grid: &'a Grid,
    z: f64,
    /// What is known of nodes between the grid's.
    fine: HashMap<Node, bool>,
}

impl<'a> Sides<'a> {
    pub fn new(grid: &'a Grid, z: f64) -> Self {
        Self { grid, z, fine: HashMap::new() }
    }

    /// Whether the tip must stay above the level at a node, if that is known.
    fn known(&self, node: Node) -> Option<bool> {
        if is_coarse(node) {
            let tip = self.grid.tip(node.map(|i| i / PARTS));
            Some(tip.is_some_and(|tip| level_curve::is_over(tip, self.z)))
        } else {
            self.fine.get(&node).copied()
        }
    }

    /// The same of a node that is known.
    fn is_above(&self, node: Node) -> bool {
        self.known(node).unwrap_or(false)
    }

    /// Finds out about a node; whether it was not known before.
    pub fn find(&mut self, node: Node, curve: &mut LevelCurve<'_>) -> bool {
        let is_new = self.known(node).is_none();
        if is_new {
            let is_above = curve.is_above(self.position(node));
            self.fine.insert(node, is_above);
        }
        is_new
    }

    /// How many corners of a square are above the level.
    pub fn corners_above(&self, square: &Square) -> usize {
        square.corners().into_iter().filter(|node| self.is_above(*node)).count()
    }

    /// Finds out about the nodes of a cell whose corners lie on one side, [`LOOKED_AT`] apart, as far as bounds do not decide at
    /// once; whether some lie on the other side. Only then they are kept.
    pub fn look_into(&mut self, cell: &Square, curve: &mut LevelCurve<'_>) -> bool {
        let side = self.is_above(cell.first);
        let (mut open, mut decided, mut asked) = (vec![*cell], Vec::new(), HashMap::new());
        while let Some(square) = open.pop() {
            let [low, _, high, _] = square.corners();
            match curve.verdict(&[self.position(low), self.position(high)]) {
                Verdict::Open if square.size > LOOKED_AT => open.extend(square.quarters()),
                Verdict::Open => {
                    for node in square.corners() {
                        let above = self.known(node).or_else(|| asked.get(&node).copied());
                        let above = above.unwrap_or_else(|| curve.is_above(self.position(node)));
                        asked.insert(node, above);
                    }
                }
                verdict => decided.push((square, verdict == Verdict::Above)),
            }
        }
        let differs = |above: &bool| *above != side;
        if !asked.values().any(differs) && !decided.iter().any(|(_, above)| differs(above)) {
            return false;
        }
        for (node, above) in asked.into_iter().filter(|(node, _)| !is_coarse(*node)) {
            self.fine.entry(node).or_insert(above);
        }
        for (square, above) in decided {
            for node in nodes_of(&square).filter(|node| !is_coarse(*node)) {
                self.fine.entry(node).or_insert(above);
            }
        }
        true
    }

    /// Whether nodes of a square that was looked into lie on different sides.
    pub fn differ(&self, square: &Square) -> bool {
        let first = self.is_above(square.first);
        nodes_of(square).any(|node| self.is_above(node) != first)
    }

    /// Where the level crosses the outline of a square, counterclockwise: between all nodes that are known on it.
    pub fn crossings(&self, square: &Square) -> Vec<Crossing> {
        let corners = square.corners();
        let mut outline = Vec::with_capacity(4);
        for i in 0..4 {
            self.walk(corners[i], corners[(i + 1) % 4], &mut outline);
        }
        outline.push(corners[0]);
        let pairs = outline.windows(2).map(|pair| (pair[0], pair[1]));
        let crossing = |(a, b): (Node, Node)| {
            let rises = self.is_above(b);
            (self.is_above(a) != rises).then(|| Crossing { edge: Edge::between(a, b), rises })
        };
        pairs.filter_map(crossing).collect()
    }

    /// The known nodes from one to another, without the last.
    fn walk(&self, from: Node, to: Node, found: &mut Vec<Node>) {
        let middle = [0, 1].map(|i| usize::midpoint(from[i], to[i]));
        let is_divisible = from[0].abs_diff(to[0]) + from[1].abs_diff(to[1]) > 1;
        if is_divisible && self.known(middle).is_some() {
            self.walk(from, middle, found);
            self.walk(middle, to, found);
        } else {
            found.push(from);
        }
    }

    /// The ends of an edge in plan, the one above the level first.
    pub fn ends(&self, edge: Edge) -> [PlanPosition; 2] {
        let (above, free) = if self.is_above(edge.from) { (edge.from, edge.to) } else { (edge.to, edge.from) };
        [self.position(above), self.position(free)]
    }

    /// Where the level most likely is on an edge, as a share of the distance down: on the straight line between the tips.
    pub fn guess(&self, edge: Edge) -> f64 {
        let tip = |node: Node| if is_coarse(node) { self.grid.tip(node.map(|i| i / PARTS)) } else { None };
        match (tip(edge.from), tip(edge.to)) {
            (Some(a), Some(b)) if (a - b).abs() > f64::MIN_POSITIVE => {
                ((a.max(b) - self.z) / (a - b).abs()).clamp(0.01, 0.99)
            }
            _ => 0.5,
        }
    }

    /// A node in plan.
    pub fn position(&self, node: Node) -> PlanPosition {
        self.grid.lattice().point(node.map(|i| i as f64 / PARTS as f64))
    }
}

/// The nodes of a square that was looked into.
fn nodes_of(square: &Square) -> impl Iterator<Item = Node> {
    let ([x, y], size) = (square.first, square.size);
    let along = move |first: usize| (first..=first + size).step_by(LOOKED_AT);
    along(y).flat_map(move |y| along(x).map(move |x| [x, y]))
}
