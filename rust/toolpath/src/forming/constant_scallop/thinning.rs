//! The middle lines of strips of cells.
//!
//! T. Y. Zhang, C. Y. Suen, "A fast parallel algorithm for thinning digital patterns", Communications of the ACM 27, 1984.

use std::collections::BTreeSet;

use super::chains::Beside;
use crate::lattice::Node;

/// The cells around one, from the one above on, clockwise.
const AROUND: [[isize; 2]; 8] = [[0, 1], [1, 1], [1, 0], [1, -1], [0, -1], [-1, -1], [-1, 0], [-1, 1]];

/// The lines of cells in the middle of strips of them; a single cell is one.
pub fn middle_lines(cells: BTreeSet<Node>) -> Vec<Vec<Node>> {
    let thin = thinned(cells);
    let beside = |cell: Node| {
        let around = around(&thin, cell);
        let neighbours = (0..8).filter(move |i| around[*i]);
        // across a corner only where no cell beside both leads there
        let neighbours = neighbours.filter(move |i| i % 2 == 0 || !around[(i + 7) % 8] && !around[(i + 1) % 8]);
        neighbours.filter_map(move |i| shifted(cell, AROUND[i]))
    };
    let pairs = thin.iter().flat_map(|cell| beside(*cell).map(move |other| [*cell, other]));
    let mut lines = Beside::of(pairs.filter(|[a, b]| a < b)).chains();
    lines.extend(thin.iter().filter(|cell| beside(**cell).next().is_none()).map(|cell| vec![*cell]));
    lines
}

fn thinned(mut cells: BTreeSet<Node>) -> BTreeSet<Node> {
    loop {
        let before = cells.len();
        for [first, second] in [[[0, 2, 4], [2, 4, 6]], [[0, 2, 6], [0, 4, 6]]] {
            let may_go = |cell: &Node| {
                let around = around(&cells, *cell);
                let count = around.iter().filter(|is_set| **is_set).count();
                let begins = (0..8).filter(|i| !around[*i] && around[(i + 1) % 8]).count();
                let is_open = |sides: [usize; 3]| sides.iter().any(|i| !around[*i]);
                (2..=6).contains(&count) && begins == 1 && is_open(first) && is_open(second)
            };
            let gone: Vec<Node> = cells.iter().copied().filter(may_go).collect();
            for cell in gone {
                cells.remove(&cell);
            }
        }
        if cells.len() == before {
            return cells;
        }
    }
}

fn around(cells: &BTreeSet<Node>, cell: Node) -> [bool; 8] {
    AROUND.map(|shift| shifted(cell, shift).is_some_and(|other| cells.contains(&other)))
}

fn shifted([column, row]: Node, [right, up]: [isize; 2]) -> Option<Node> {
    Some([column.checked_add_signed(right)?, row.checked_add_signed(up)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_strip_has_its_middle_line() {
        let strip = (0..20).flat_map(|column| (4..9).map(move |row| [column, row])).collect();
        let lines = middle_lines(strip);
        assert_eq!(lines.len(), 1);
        assert!(lines[0].len() > 12 && lines[0].iter().all(|cell| (5..=7).contains(&cell[1])), "{lines:?}");
    }

    #[test]
    fn a_ring_is_closed_and_a_single_cell_stays() {
        let away = |cell: &Node| (cell[0] as f64 - 10.0).hypot(cell[1] as f64 - 10.0);
        let all = (0..21).flat_map(|column| (0..21).map(move |row| [column, row]));
        let ring: BTreeSet<Node> = all.filter(|cell| (6.0..9.0).contains(&away(cell))).chain([[30, 3]]).collect();
        let lines = middle_lines(ring);
        assert_eq!(lines.len(), 2);
        assert_eq!(lines[0].first(), lines[0].last());
        assert_eq!(lines[1], [[30, 3]]);
    }
}
