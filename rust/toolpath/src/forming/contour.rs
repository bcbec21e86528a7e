//! Which crossings of the grid follow each other along a level: marching squares, directed.
//!
//! Every segment has the higher ground on its right: loops run counterclockwise inside a cup and clockwise round
//! a hill. A cell with two opposite corners above is decided by its middle.

use std::collections::BTreeMap;

use super::grid::Grid;

/// An edge of the grid: between a node and the next one in its row or column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct GridEdge {
    row: usize,
    column: usize,
    upward: bool,
}

impl GridEdge {
    /// The nodes that it joins, (column, row).
    pub fn nodes(self) -> [(usize, usize); 2] {
        let Self { row, column, upward } = self;
        [(column, row), if upward { (column, row + 1) } else { (column + 1, row) }]
    }
}

/// Edges of the grid in the order in which a level crosses them; closed chains do not repeat the first.
pub struct Chain {
    pub edges: Vec<GridEdge>,
    pub closed: bool,
}

/// The sides of a cell.
#[derive(Clone, Copy)]
enum Side {
    Bottom,
    Right,
    Top,
    Left,
}

/// All chains of the level `z`; `is_above` decides the middle of an undecided cell, given its lower left node.
pub fn chains(grid: &Grid, z: f64, mut is_above: impl FnMut([f64; 2]) -> bool) -> Vec<Chain> {
    let mut next = BTreeMap::new();
    for row in 0..grid.rows() - 1 {
        for column in 0..grid.columns() - 1 {
            let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(c, r)| grid.is_above(column + c, row + r, z));
            let case = corners.iter().rev().fold(0, |bits, above| bits * 2 + u8::from(*above));
            let middle = (case == 5 || case == 10) && is_above(middle_of(grid, column, row));
            for (from, to) in segments(case, middle) {
                next.insert(edge(column, row, *from), edge(column, row, *to));
            }
        }
    }
    follow(next)
}

fn middle_of(grid: &Grid, column: usize, row: usize) -> [f64; 2] {
    let (a, b) = (grid.place(column, row), grid.place(column + 1, row + 1));
    [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
}

/// Segments of a cell by its corners above the level: bits from the lower left, counterclockwise.
fn segments(case: u8, middle_above: bool) -> &'static [(Side, Side)] {
    use Side::{Bottom, Left, Right, Top};
    match (case, middle_above) {
        (1, _) => &[(Left, Bottom)],
        (2, _) => &[(Bottom, Right)],
        (3, _) => &[(Left, Right)],
        (4, _) => &[(Right, Top)],
        (5, false) => &[(Left, Bottom), (Right, Top)],
        (5, true) => &[(Right, Bottom), (Left, Top)],
        (6, _) => &[(Bottom, Top)],
        (7, _) => &[(Left, Top)],
        (8, _) => &[(Top, Left)],
        (9, _) => &[(Top, Bottom)],
        (10, false) => &[(Bottom, Right), (Top, Left)],
        (10, true) => &[(Bottom, Left), (Top, Right)],
        (11, _) => &[(Top, Right)],
        (12, _) => &[(Right, Left)],
        (13, _) => &[(Right, Bottom)],
        (14, _) => &[(Bottom, Left)],
        _ => &[],
    }
}

fn edge(column: usize, row: usize, side: Side) -> GridEdge {
    match side {
        Side::Bottom => GridEdge { row, column, upward: false },
        Side::Right => GridEdge { row, column: column + 1, upward: true },
        Side::Top => GridEdge { row: row + 1, column, upward: false },
        Side::Left => GridEdge { row, column, upward: true },
    }
}

/// Joins segments to chains: open ones from their beginnings, then closed ones.
fn follow(mut next: BTreeMap<GridEdge, GridEdge>) -> Vec<Chain> {
    let reached: std::collections::BTreeSet<GridEdge> = next.values().copied().collect();
    let begins: Vec<GridEdge> = next.keys().filter(|e| !reached.contains(e)).copied().collect();
    let mut chains: Vec<Chain> = begins.into_iter().map(|begin| walk(&mut next, begin, false)).collect();
    while let Some((begin, _)) = next.first_key_value().map(|(a, b)| (*a, *b)) {
        chains.push(walk(&mut next, begin, true));
    }
    chains
}

fn walk(next: &mut BTreeMap<GridEdge, GridEdge>, begin: GridEdge, closed: bool) -> Chain {
    let mut edges = vec![begin];
    let mut at = begin;
    while let Some(to) = next.remove(&at) {
        if to == begin {
            break;
        }
        edges.push(to);
        at = to;
    }
    Chain { edges, closed }
}
