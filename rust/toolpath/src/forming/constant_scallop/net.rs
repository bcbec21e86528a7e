//! The tool's positions over the nodes of a lattice, the triangles between them, and how many passes lie along their sides.

use rayon::prelude::*;
use styluscam_motion::{Cancelled, Watch};

use super::crossing::{crossing, Crossing};
use super::stations::{Spacing, Station};
use crate::lattice::Node;
use crate::{Lattice, Surface};

/// Three nodes, counterclockwise.
pub type Triangle = [usize; 3];

/// Stations at the nodes of a lattice, and triangles between them.
pub struct Net {
    pub lattice: Lattice,
    /// By node; none where nothing selected is touched.
    pub stations: Vec<Option<Station>>,
    pub spacing: Spacing,
    /// By cell: whether it is divided from its lower right to its upper left.
    falling: Vec<bool>,
    /// By node: passes along the sides to its right, upwards, and along the diagonal of the cell between these; infinite where there is
    /// no such side.
    lengths: Vec<[f64; 3]>,
    /// Where sides cross creases, in the order of their nodes.
    pub crossings: Vec<Crossing>,
}

impl Net {
    /// Cells are divided along the shorter of their diagonals.
    ///
    /// # Errors
    /// `Cancelled` when `watch` is cancelled.
    pub fn new(
        surface: &Surface<'_>,
        lattice: Lattice,
        stations: Vec<Option<Station>>,
        spacing: Spacing,
        watch: &Watch,
    ) -> Result<Self, Cancelled> {
        let falls = |cell: Node| {
            let corners = lattice.corner_numbers(cell).map(|number| stations[number]);
            match corners {
                [Some(a), Some(b), Some(c), Some(d)] => spacing.between(&b, &d) < spacing.between(&a, &c),
                [_, Some(_), _, Some(_)] => true,
                _ => false,
            }
        };
        let cells: Vec<Node> = lattice.cells().iter().collect();
        let falling = cells.par_iter().map(|cell| falls(*cell)).collect();
        let mut net = Self { lattice, stations, spacing, falling, lengths: Vec::new(), crossings: Vec::new() };
        let of_node = |node: usize| {
            watch.advance(1)?;
            Ok(net.sides(node).map(|side| side.map_or((f64::INFINITY, None), |side| net.side(surface, side))))
        };
        let found = (0..net.stations.len()).into_par_iter().with_min_len(1024).map(of_node);
        let found: Vec<[(f64, Option<Crossing>); 3]> = found.collect::<Result<_, Cancelled>>()?;
        net.lengths = found.iter().map(|sides| [0, 1, 2].map(|i| sides[i].0)).collect();
        net.crossings = found.into_iter().flatten().filter_map(|(_, crossing)| crossing).collect();
        Ok(net)
    }

    /// The sides of triangles that are stored with a node: to its right, upwards, and the diagonal between.
    fn sides(&self, node: usize) -> [Option<[usize; 2]>; 3] {
        let width = self.lattice.columns + 1;
        let [column, row] = self.place(node);
        let (is_last_column, is_last_row) = (column == self.lattice.columns, row == self.lattice.rows);
        let diagonal = (!is_last_column && !is_last_row).then(|| {
            if self.is_falling([column, row]) {
                [node + 1, node + width]
            } else {
                [node, node + width + 1]
            }
        });
        [(!is_last_column).then_some([node, node + 1]), (!is_last_row).then_some([node, node + width]), diagonal]
    }

    /// Whether a cell is divided from its lower right to its upper left.
    pub fn is_falling(&self, cell: Node) -> bool {
        self.falling[self.lattice.number(cell)]
    }

    /// The length of a side, and where it crosses a crease.
    fn side(&self, surface: &Surface<'_>, side: [usize; 2]) -> (f64, Option<Crossing>) {
        let [Some(a), Some(b)] = side.map(|node| self.stations[node]) else { return (f64::INFINITY, None) };
        match crossing(surface, side, [&a, &b]) {
            Some(crossing) if crossing.is_jump() => (f64::INFINITY, Some(crossing)),
            Some(crossing) => (self.spacing.over_crease(&a, &b), Some(crossing)),
            None => (self.spacing.between(&a, &b), None),
        }
    }

    /// Makes the sides around each node longer by a factor.
    pub fn scale(&mut self, factors: &[f64]) {
        for node in 0..self.lengths.len() {
            for (number, side) in self.sides(node).into_iter().enumerate() {
                let Some([a, b]) = side else { continue };
                self.lengths[node][number] *= 0.5 * (factors[a] + factors[b]);
            }
        }
    }

    /// Column and row of a node.
    pub fn place(&self, node: usize) -> Node {
        let width = self.lattice.columns + 1;
        [node % width, node / width]
    }

    /// The position of a node in plan, mm.
    pub fn position(&self, node: usize) -> [f64; 2] {
        self.lattice.point(self.place(node).map(|i| i as f64))
    }

    /// Passes along a side of a triangle.
    pub fn length(&self, a: usize, b: usize) -> f64 {
        let (first, last) = (a.min(b), a.max(b));
        let width = self.lattice.columns + 1;
        match last - first {
            1 => self.lengths[first][0],
            step if step == width => self.lengths[first][1],
            step if step == width + 1 => self.lengths[first][2],
            _ => self.lengths[first - 1][2],
        }
    }

    /// The lengths of all sides along the lattice's lines, passes.
    pub fn lengths(&self) -> impl Iterator<Item = f64> + '_ {
        self.lengths.iter().flat_map(|sides| [sides[0], sides[1]]).filter(|length| length.is_finite())
    }

    /// The triangles of a cell whose corners all have a station, and that no wall crosses.
    pub fn triangles(&self, cell: Node) -> impl Iterator<Item = Triangle> + '_ {
        let is_whole = |[a, b, c]: &Triangle| {
            self.length(*a, *b).is_finite() && self.length(*b, *c).is_finite() && self.length(*c, *a).is_finite()
        };
        self.halves(cell).filter(is_whole)
    }

    /// The triangles of a cell whose corners all have a station.
    pub fn halves(&self, cell: Node) -> impl Iterator<Item = Triangle> + '_ {
        let [a, b, c, d] = self.lattice.corner_numbers(cell);
        let halves = if self.is_falling(cell) { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] };
        halves.into_iter().filter(|half| half.iter().all(|node| self.stations[*node].is_some()))
    }

    /// The cells around a node.
    pub fn around(&self, node: usize) -> impl Iterator<Item = Node> + '_ {
        let [column, row] = self.place(node);
        let columns = column.saturating_sub(1)..(column + 1).min(self.lattice.columns);
        let rows = row.saturating_sub(1)..(row + 1).min(self.lattice.rows);
        rows.flat_map(move |row| columns.clone().map(move |column| [column, row]))
    }
}
