//! The course of a level through the cells of a grid.
//!
//! Marching squares, directed: every segment has the higher ground on its right; loops run counterclockwise inside a
//! cup and clockwise round a hill. A segment is accepted when exact points lie close along it, in its own square; else the
//! square is quartered, down to a thousandth of a cell, and its neighbours follow; what is smaller than that is passed
//! over. So narrow notches, two branches through a cell and what hides between the nodes are found without a finer grid.
//!
//! Marching squares (W. E. Lorensen, H. E. Cline, "Marching cubes", Computer Graphics 21, 1987, in the plane) with exact
//! crossings. See docs/concepts/waterlines.md.

use std::collections::{BTreeMap, HashMap, HashSet};

use styluscam_motion::{Cancelled, Watch};

use super::bounds::Bounds;
use super::grid::Grid;
use super::level_curve::LevelCurve;
use super::sides::{Crossing, Sides, LOOKED_AT};
use super::square::{Edge, Square, PARTS};
use crate::fitting::{self, Bending};
use crate::{lattice::Node, PathPoint};

/// How far outside its square a segment may go, as a share of the square.
const OUTSIDE: f64 = 0.1;

/// A piece of a level between two crossings.
pub struct Segment {
    pub from: Edge,
    pub to: Edge,
    /// Exact points, both ends among them.
    pub points: Vec<PathPoint>,
}

/// What is known of a level's course.
pub struct Trace<'a, 'c> {
    grid: &'a Grid,
    bounds: &'a Bounds,
    curve: &'c mut LevelCurve<'a>,
    sides: Sides<'a>,
    deviation: f64,
    divided: HashSet<Square>,
    /// Squares whose segments are to be found, or found again.
    open: Vec<Square>,
    segments: BTreeMap<Square, Vec<Segment>>,
    crossings: HashMap<Edge, Option<PathPoint>>,
}

impl<'a, 'c> Trace<'a, 'c> {
    /// Chords between the points of segments deviate by at most a share of `deviation` (mm), see [`fitting::densified`].
    pub fn new(grid: &'a Grid, bounds: &'a Bounds, curve: &'c mut LevelCurve<'a>, deviation: f64) -> Self {
        Self {
            grid,
            bounds,
            sides: Sides::new(grid, curve.z()),
            curve,
            deviation,
            divided: HashSet::new(),
            open: Vec::new(),
            segments: BTreeMap::new(),
            crossings: HashMap::new(),
        }
    }

    /// All segments, in the order of their squares.
    ///
    /// # Errors
    /// `Cancelled` when `watch` is cancelled.
    pub fn segments(mut self, watch: &Watch) -> Result<Vec<Segment>, Cancelled> {
        let (lattice, bounds, z) = (self.grid.lattice(), self.bounds, self.curve.z());
        for (number, cell) in lattice.cells().iter().enumerate() {
            let square = Square::cell(cell);
            match self.sides.corners_above(&square) {
                0 if !bounds.may_rise(number, z) => {}
                4 if !bounds.may_dip(number, z) => {}
                0 | 4 => {
                    watch.advance(0)?;
                    if self.sides.look_into(&square, self.curve) {
                        self.divide_where_nodes_differ(square);
                    }
                }
                _ => self.open.push(square),
            }
        }
        while let Some(square) = self.open.pop() {
            watch.advance(0)?;
            if !self.divided.contains(&square) {
                self.pass(square);
            }
        }
        Ok(self.segments.into_values().flatten().collect())
    }

    fn divide_where_nodes_differ(&mut self, square: Square) {
        if square.size > LOOKED_AT && self.sides.differ(&square) {
            self.divide(square);
            square.quarters().into_iter().for_each(|quarter| self.divide_where_nodes_differ(quarter));
        }
    }

    /// Finds the segments in a square, or divides it.
    fn pass(&mut self, square: Square) {
        let crossings = self.sides.crossings(&square);
        self.segments.remove(&square);
        if crossings.is_empty() {
            return;
        }
        let position = self.sides.position(square.middle());
        let is_middle_above = crossings.len() > 2 && square.size > 1 && self.curve.is_above(position);
        let segments: Option<Vec<Segment>> =
            pairs(&crossings, is_middle_above).map(|(from, to)| self.segment(&square, from, to)).collect();
        match segments {
            Some(segments) => {
                self.segments.insert(square, segments);
            }
            None => self.divide(square),
        }
    }

    /// The segment between two crossings of a square; none where it goes elsewhere and the square can be divided.
    fn segment(&mut self, square: &Square, from: Edge, to: Edge) -> Option<Segment> {
        let ends = [self.crossing(from), self.crossing(to)];
        let is_last = square.size == 1;
        let [Some(a), Some(b)] = ends else {
            return is_last.then(|| Segment { from, to, points: ends.into_iter().flatten().collect() });
        };
        let chord = [a, b];
        let points = if a.selected || b.selected {
            let [low, _, high, _] = square.corners().map(|node| self.sides.position(node));
            let slack = OUTSIDE * (high[0] - low[0]);
            let is_inside = |m: &PathPoint| (0..2).all(|i| m.tip[i] >= low[i] - slack && m.tip[i] <= high[i] + slack);
            let bend = self.curve.bend();
            let between = |a: &PathPoint, b: &PathPoint| self.curve.between(a, b).filter(is_inside);
            let runs = fitting::densified(&chord, self.deviation, f64::INFINITY, &mut Bending { between, bend });
            runs.into_iter().find(|run| run[0] == a && run[run.len() - 1] == b)
        } else {
            Some(chord.to_vec())
        };
        let points = points.or_else(|| is_last.then(|| chord.to_vec()))?;
        Some(Segment { from, to, points })
    }

    fn crossing(&mut self, edge: Edge) -> Option<PathPoint> {
        let Self { crossings, curve, sides, .. } = self;
        *crossings.entry(edge).or_insert_with(|| {
            let [above, free] = sides.ends(edge);
            curve.crossing(above, free, sides.guess(edge))
        })
    }

    /// Replaces a square by its quarters; what lies beside it is to be passed again where it learns of new nodes.
    fn divide(&mut self, square: Square) {
        self.divided.insert(square);
        self.sides.find(square.middle(), self.curve);
        for (node, beyond) in square.beyond() {
            if self.sides.find(node, self.curve) {
                self.open.extend(beyond.and_then(|beyond| self.leaf(beyond)));
            }
        }
        self.open.extend(square.quarters());
    }

    /// The square that is not divided and holds a smallest one; none outside the grid.
    fn leaf(&self, smallest: Node) -> Option<Square> {
        let (cell, lattice) = (smallest.map(|i| i / PARTS), self.grid.lattice());
        if cell[0] >= lattice.columns || cell[1] >= lattice.rows {
            return None;
        }
        let mut square = Square::cell(cell);
        while self.divided.contains(&square) {
            square = square.quarter_of(smallest);
        }
        Some(square)
    }
}

/// Segments through a square by the crossings of its outline: each begins where the outline rises above the level and
/// ends at the next fall, or at the last one before where the higher ground goes through the middle.
fn pairs(crossings: &[Crossing], is_middle_above: bool) -> impl Iterator<Item = (Edge, Edge)> + '_ {
    let count = crossings.len();
    let other = move |i: usize| crossings[(if is_middle_above { i + count - 1 } else { i + 1 }) % count].edge;
    (0..count).filter(|i| crossings[*i].rises).map(move |i| (crossings[i].edge, other(i)))
}
