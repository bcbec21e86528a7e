//! Triangles that a file has more than once.

use std::collections::HashMap;

use super::mending::Mending;
use super::triangles::{area_vector, retain};
use super::union_find::Union;
use crate::Vector;

/// A triangle's corners in ascending order, and whether they are wound in that order.
fn key(triangle: [u32; 3]) -> ([u32; 3], bool) {
    let [a, b, c] = triangle;
    let mut sorted = triangle;
    sorted.sort_unstable();
    (sorted, [(a, b, c), (b, c, a), (c, a, b)].contains(&(sorted[0], sorted[1], sorted[2])))
}

/// Keeps the first of triangles that have the same corners and are wound alike.
pub fn drop_alike(triangles: &mut Vec<[u32; 3]>, mending: &mut Mending) {
    let copies = copies(triangles, |a, b| a == b);
    mending.duplicate += retain(triangles, |t| !copies[t]);
}

/// Marks each triangle whose key is that of one before it.
fn copies(triangles: &[[u32; 3]], same: impl Fn(&([u32; 3], bool), &([u32; 3], bool)) -> bool) -> Vec<bool> {
    let mut keys: Vec<(([u32; 3], bool), usize)> = triangles.iter().enumerate().map(|(t, c)| (key(*c), t)).collect();
    keys.sort_unstable();
    let mut is_copy = vec![false; triangles.len()];
    for pair in keys.windows(2) {
        is_copy[pair[1].1] = same(&pair[0].0, &pair[1].0);
    }
    is_copy
}

/// What an edge of a set of pairs belongs to.
#[derive(Default)]
struct Use {
    pairs: Vec<u32>,
    /// Triangles that are not of pairs,
    others: usize,
    /// and how many more of them run it upwards than downwards.
    excess: i64,
}

/// Looks at triangles that lie back to back. A wall between two bodies that touch goes; of a surface that has two sides
/// in the file, one stays; a fin without thickness stays as it is.
pub fn drop_opposite(vertices: &[Vector], triangles: &mut Vec<[u32; 3]>, mending: &mut Mending) {
    let second = copies(triangles, |a, b| a.0 == b.0);
    if !second.contains(&true) {
        return;
    }
    let mut by_key: HashMap<[u32; 3], Vec<usize>> = HashMap::new();
    for t in (0..triangles.len()).filter(|t| second[*t]) {
        by_key.entry(key(triangles[t]).0).or_default().push(t);
    }
    for t in (0..triangles.len()).filter(|t| !second[*t]) {
        if let Some(pair) = by_key.get_mut(&key(triangles[t]).0) {
            pair.push(t);
        }
    }
    let mut pairs: Vec<([u32; 3], Vec<usize>)> = by_key.into_iter().collect();
    pairs.sort_unstable();
    let mut stays = vec![true; triangles.len()];
    for (sides, fate) in pairs.iter().zip(fates(&pairs, triangles)) {
        let (first, last) = (sides.1[0], sides.1[1]);
        match fate {
            Fate::Wall => {
                (stays[first], stays[last]) = (false, false);
                mending.back_to_back += 2;
            }
            Fate::Sheet => {
                let up = |t: usize| area_vector(vertices, triangles[t]).z;
                stays[if up(first) >= up(last) { last } else { first }] = false;
                mending.double_sided += 1;
            }
            Fate::Fin => {}
        }
    }
    retain(triangles, |t| stays[t]);
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Fate {
    /// Between bodies: all around, other triangles meet it that close without it.
    Wall,
    /// No other triangle meets it, or those that do close with one side of it.
    Sheet,
    /// It stands on other triangles and ends somewhere.
    Fin,
}

fn fates(pairs: &[([u32; 3], Vec<usize>)], triangles: &[[u32; 3]]) -> Vec<Fate> {
    let mut uses: HashMap<(u32, u32), Use> = HashMap::new();
    for (i, ([a, b, c], _)) in pairs.iter().enumerate() {
        for edge in [(*a, *b), (*b, *c), (*a, *c)] {
            uses.entry(edge).or_default().pairs.push(i as u32);
        }
    }
    let mut is_paired = vec![false; triangles.len()];
    pairs.iter().flat_map(|(_, sides)| sides).for_each(|t| is_paired[*t] = true);
    for t in (0..triangles.len()).filter(|t| !is_paired[*t]) {
        let [a, b, c] = triangles[t];
        for (from, to) in [(a, b), (b, c), (c, a)] {
            if let Some(found) = uses.get_mut(&(from.min(to), from.max(to))) {
                found.others += 1;
                found.excess += if from < to { 1 } else { -1 };
            }
        }
    }
    let mut sets = Union::new(pairs.len());
    for found in uses.values() {
        found.pairs.iter().for_each(|pair| sets.join(found.pairs[0], *pair));
    }
    let (mut touches, mut ends) = (vec![false; pairs.len()], vec![false; pairs.len()]);
    let mut is_needed = vec![false; pairs.len()];
    for found in uses.values() {
        let set = sets.root(found.pairs[0]) as usize;
        touches[set] |= found.others > 0;
        ends[set] |= found.others == 0 && found.pairs.len() == 1;
        is_needed[set] |= found.excess != 0;
    }
    let fate = |set: usize| match (touches[set], ends[set], is_needed[set]) {
        (true, true, _) => Fate::Fin,
        (true, false, false) => Fate::Wall,
        (true, false, true) | (false, _, _) => Fate::Sheet,
    };
    (0..pairs.len() as u32).map(|i| fate(sets.root(i) as usize)).collect()
}
