//! Square cells over the plan.

/// Column and row of a cell, or of the node at its lower left.
pub type Node = [usize; 2];

/// Square cells side by side.
#[derive(Clone, Debug)]
pub struct Lattice {
    /// Lower left corner, mm.
    pub origin: [f64; 2],
    /// Length of a cell's side, mm.
    pub cell: f64,
    /// Cells along X.
    pub columns: usize,
    /// Cells along Y.
    pub rows: usize,
}

impl Lattice {
    /// A point in plan, mm, from its coordinates in cells: column and row of a node where they are whole.
    #[must_use]
    pub fn point(&self, [column, row]: [f64; 2]) -> [f64; 2] {
        [self.origin[0] + column * self.cell, self.origin[1] + row * self.cell]
    }

    /// All cells.
    #[must_use]
    pub fn cells(&self) -> Cells {
        Cells { from: [0, 0], to: [self.columns, self.rows] }
    }

    /// Lower and upper corner of some cells.
    #[must_use]
    pub fn corners(&self, cells: &Cells) -> [[f64; 2]; 2] {
        [cells.from, cells.to].map(|node| self.point(node.map(|i| i as f64)))
    }

    /// All nodes, row by row.
    pub fn nodes(&self) -> impl Iterator<Item = Node> {
        Cells { from: [0, 0], to: [self.columns + 1, self.rows + 1] }.iter()
    }

    /// The number of a node among [`nodes`](Self::nodes).
    #[must_use]
    pub fn node_number(&self, [column, row]: Node) -> usize {
        row * (self.columns + 1) + column
    }

    /// The numbers of a cell's corners.
    #[must_use]
    pub fn corner_numbers(&self, cell: Node) -> [usize; 4] {
        let first = self.node_number(cell);
        let above = first + self.columns + 1;
        [first, first + 1, above + 1, above]
    }

    /// The number of a cell, row by row.
    #[must_use]
    pub fn number(&self, [column, row]: Node) -> usize {
        row * self.columns + column
    }

    /// The cell of a number.
    #[must_use]
    pub fn cell_of(&self, number: usize) -> Node {
        [number % self.columns, number / self.columns]
    }
}

/// A rectangle of cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cells {
    /// The first column and row.
    pub from: Node,
    /// The column and row after the last.
    pub to: Node,
}

impl Cells {
    /// One cell.
    #[must_use]
    pub fn single([column, row]: Node) -> Self {
        Self { from: [column, row], to: [column + 1, row + 1] }
    }

    /// Whether it is one cell.
    #[must_use]
    pub fn is_single(&self) -> bool {
        (0..2).all(|i| self.from[i] + 1 == self.to[i])
    }

    /// Its cells.
    pub fn iter(&self) -> impl Iterator<Item = Node> {
        let Self { from, to } = *self;
        (from[1]..to[1]).flat_map(move |row| (from[0]..to[0]).map(move |column| [column, row]))
    }

    /// Pieces of at most `size` cells in each direction.
    pub fn pieces(&self, size: usize) -> impl Iterator<Item = Self> {
        let Self { from, to } = *self;
        let firsts = move |i: usize| (from[i]..to[i]).step_by(size);
        firsts(1).flat_map(move |row| {
            firsts(0).map(move |column| Self {
                from: [column, row],
                to: [(column + size).min(to[0]), (row + size).min(to[1])],
            })
        })
    }

    /// Its quarters, fewer where it is one cell wide.
    pub fn quarters(&self) -> impl Iterator<Item = Self> {
        let width = (self.to[0] - self.from[0]).max(self.to[1] - self.from[1]);
        self.pieces(width.div_ceil(2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LATTICE: Lattice = Lattice { origin: [-3.0, 1.0], cell: 0.5, columns: 3, rows: 2 };

    #[test]
    fn nodes_are_numbered_row_by_row() {
        let numbers: Vec<usize> = LATTICE.nodes().map(|node| LATTICE.node_number(node)).collect();
        assert_eq!(numbers, (0..12).collect::<Vec<_>>());
        assert_eq!(LATTICE.nodes().last(), Some([3, 2]));
    }

    #[test]
    fn cells_have_numbers_and_corners() {
        let cells: Vec<Node> = LATTICE.cells().iter().collect();
        assert_eq!(cells.len(), 6);
        for (number, cell) in cells.into_iter().enumerate() {
            assert_eq!((LATTICE.number(cell), LATTICE.cell_of(number)), (number, cell));
        }
        // counterclockwise from the lower left; four nodes in a row
        assert_eq!(LATTICE.corner_numbers([1, 1]), [5, 6, 10, 9]);
    }

    #[test]
    #[allow(clippy::float_cmp)] // halves
    fn corners_are_in_mm() {
        assert_eq!(LATTICE.corners(&LATTICE.cells()), [[-3.0, 1.0], [-1.5, 2.0]]);
        assert_eq!(LATTICE.corners(&Cells::single([2, 0])), [[-2.0, 1.0], [-1.5, 1.5]]);
    }

    #[test]
    fn pieces_and_quarters_cover_every_cell_once() {
        let cells = Cells { from: [2, 3], to: [9, 5] };
        for pieces in [cells.pieces(3).collect::<Vec<_>>(), cells.quarters().collect()] {
            let mut found: Vec<Node> = pieces.iter().flat_map(Cells::iter).collect();
            found.sort_unstable();
            let mut expected: Vec<Node> = cells.iter().collect();
            expected.sort_unstable();
            assert_eq!(found, expected);
        }
        // seven columns by two rows: halves of four, and both rows in each
        assert_eq!(cells.quarters().count(), 2);
        assert!(Cells::single([4, 4]).is_single() && !cells.is_single());
    }
}
