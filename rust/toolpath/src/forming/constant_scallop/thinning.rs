//! The middle lines of strips of cells.
//!
//! Z. Guo, R. W. Hall, "Parallel thinning with two-subiteration algorithms", Communications of the ACM 32, 1989: strips that are
//! two cells wide stay, in any direction.

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
        for first in [0, 4] {
            let gone: Vec<Node> = cells.iter().copied().filter(|cell| may_go(around(&cells, *cell), first)).collect();
            for cell in gone {
                cells.remove(&cell);
            }
        }
        if cells.len() == before {
            return cells;
        }
    }
}

/// Whether a cell lies on the edge of a strip, towards one of two sides by the number of the first around it that counts, and
/// neither at the strip's end nor where it is one cell wide.
fn may_go(around: [bool; 8], first: usize) -> bool {
    let set = |i: usize| around[i % 8];
    let parts = (0..4).filter(|i| !set(2 * i) && (set(2 * i + 1) || set(2 * i + 2))).count();
    let pairs = |from: usize| (0..4).filter(|i| set(2 * i + from) || set(2 * i + from + 1)).count();
    let is_towards = !((set(first) || set(first + 1) || !set(first + 3)) && set(first + 2));
    parts == 1 && (2..=3).contains(&pairs(0).min(pairs(7))) && is_towards
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
    fn strips_two_cells_wide_stay_in_any_direction() {
        for [right, up] in [[1, 0], [0, 1], [1, 1]] {
            let wide = (0..30).flat_map(|i| [[i * right, i * up], [i * right + 1 - right * up, i * up + 1]]);
            let lines = middle_lines(wide.collect());
            assert!(lines.len() == 1 && lines[0].len() > 25, "{right} {up}: {lines:?}");
        }
        let falling = (0..30).flat_map(|i| [[i, 40 - i], [i + 1, 40 - i]]);
        let lines = middle_lines(falling.collect());
        assert!(lines.len() == 1 && lines[0].len() > 25, "{lines:?}");
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
