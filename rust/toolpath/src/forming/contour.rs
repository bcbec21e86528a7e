//! Which crossings of the grid follow each other along a level: marching squares, directed.
//!
//! Every segment has the higher ground on its right: loops run counterclockwise inside a cup and clockwise round
//! a hill. A cell that the level passes twice is decided by its middle.

use std::collections::{BTreeMap, BTreeSet};

use super::sides::{Crossing, Edge, Sides};

/// Edges of the grid in the order in which a level crosses them; closed chains do not repeat the first.
pub struct Chain {
    pub edges: Vec<Edge>,
    pub closed: bool,
}

/// All chains of a level; `is_above` decides the middle of an undecided cell.
pub fn chains(sides: &Sides<'_>, mut is_above: impl FnMut([f64; 2]) -> bool) -> Vec<Chain> {
    let mut next = BTreeMap::new();
    sides.visit_cells(|crossings, middle| {
        let is_middle_above = crossings.len() > 2 && is_above(middle);
        next.extend(segments(&crossings, is_middle_above));
    });
    follow(next)
}

/// Segments through a cell by the crossings of its outline, counterclockwise: each begins where the outline rises above
/// the level and ends at the next fall, or at the last one before where the higher ground goes through the middle.
fn segments(crossings: &[Crossing], is_middle_above: bool) -> Vec<(Edge, Edge)> {
    let count = crossings.len();
    let other = |i: usize| crossings[(if is_middle_above { i + count - 1 } else { i + 1 }) % count].edge;
    (0..count).filter(|i| crossings[*i].rises).map(|i| (crossings[i].edge, other(i))).collect()
}

/// Joins segments to chains: open ones from their beginnings, then closed ones.
fn follow(mut next: BTreeMap<Edge, Edge>) -> Vec<Chain> {
    let reached: BTreeSet<Edge> = next.values().copied().collect();
    let begins: Vec<Edge> = next.keys().filter(|e| !reached.contains(e)).copied().collect();
    let mut chains: Vec<Chain> = begins.into_iter().map(|begin| walk(&mut next, begin, false)).collect();
    while let Some((begin, _)) = next.first_key_value().map(|(a, b)| (*a, *b)) {
        chains.push(walk(&mut next, begin, true));
    }
    chains
}

fn walk(next: &mut BTreeMap<Edge, Edge>, begin: Edge, closed: bool) -> Chain {
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
