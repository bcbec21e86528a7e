//! Squares of the plan: cells of a grid and their quarters, down to a thousandth.

use crate::lattice::Node;

/// Parts into which a side of a cell is divided at most.
pub const PARTS: usize = 1024;

/// A cell of the grid or a part of one. Its nodes, and the smallest squares, are given in fine numbers: [`PARTS`] times
/// those of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Square {
    pub first: Node,
    pub size: usize,
}

/// Two nodes side by side; the first is the lower or left one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Edge {
    pub from: Node,
    pub to: Node,
}

impl Edge {
    pub fn between(a: Node, b: Node) -> Self {
        Self { from: a.min(b), to: a.max(b) }
    }
}

impl Square {
    /// A cell of the grid, by its numbers there.
    pub fn cell(cell: Node) -> Self {
        Self { first: cell.map(|i| i * PARTS), size: PARTS }
    }

    /// Counterclockwise.
    pub fn corners(&self) -> [Node; 4] {
        let ([x, y], size) = (self.first, self.size);
        [[x, y], [x + size, y], [x + size, y + size], [x, y + size]]
    }

    pub fn middle(&self) -> Node {
        self.first.map(|i| i + self.size / 2)
    }

    /// The middles of its sides, and the smallest square beyond each of them, if the plan goes on there.
    pub fn beyond(&self) -> [(Node, Option<Node>); 4] {
        let ([x, y], size, half) = (self.first, self.size, self.size / 2);
        [
            ([x + half, y], y.checked_sub(1).map(|below| [x + half, below])),
            ([x + size, y + half], Some([x + size, y + half])),
            ([x + half, y + size], Some([x + half, y + size])),
            ([x, y + half], x.checked_sub(1).map(|left| [left, y + half])),
        ]
    }

    pub fn quarters(&self) -> [Self; 4] {
        let ([x, y], size) = (self.first, self.size / 2);
        [[x, y], [x + size, y], [x, y + size], [x + size, y + size]].map(|first| Self { first, size })
    }

    /// The quarter that holds a smallest square.
    pub fn quarter_of(&self, smallest: Node) -> Self {
        let size = self.size / 2;
        let first = [0, 1].map(|i| self.first[i] + if smallest[i] >= self.first[i] + size { size } else { 0 });
        Self { first, size }
    }
}

/// Whether a node is one of the grid's.
pub fn is_coarse(node: Node) -> bool {
    node.iter().all(|i| i % PARTS == 0)
}
