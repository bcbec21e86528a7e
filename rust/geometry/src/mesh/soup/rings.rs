//! Open sides of a mesh, and the shortest rings of them.

use std::collections::{BTreeMap, HashSet};

use super::edges::{ends, sides_of, Edges};

/// Sides at which one triangle is. On the hole's side each runs against its triangle: from the half-edge's end to its beginning.
pub struct Open<'a> {
    triangles: &'a [[u32; 3]],
    /// By the corner from which they run on the hole's side.
    from: BTreeMap<u32, Vec<u32>>,
}

impl<'a> Open<'a> {
    pub fn of(triangles: &'a [[u32; 3]], edges: &Edges) -> Self {
        let mut from: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for half in edges.open() {
            from.entry(ends(triangles, half).1).or_default().push(half);
        }
        from.values_mut().for_each(|sides| sides.sort_by_key(|half| ends(triangles, *half).0));
        Self { triangles, from }
    }

    fn ends(&self, half: u32) -> (u32, u32) {
        ends(self.triangles, half)
    }

    /// All that are left, in the order of their corners.
    pub fn sides(&self) -> Vec<u32> {
        self.from.values().flatten().copied().collect()
    }

    /// The ring of so many sides that begins with one, if there is one, with each corner in it once.
    pub fn ring(&self, half: u32, count: usize) -> Option<Vec<u32>> {
        let (last, first) = self.ends(half);
        if !self.from.get(&first)?.contains(&half) {
            return None;
        }
        let mut ring = vec![half];
        self.goes_back(&mut ring, last, first, count).then_some(ring)
    }

    /// Whether a path that has come to a corner can go back to its first one, with so many sides in all; then it has them.
    fn goes_back(&self, path: &mut Vec<u32>, at: u32, first: u32, count: usize) -> bool {
        if at == first {
            return path.len() == count;
        }
        let passed = |corner: u32| path.iter().any(|half| self.ends(*half).1 == corner);
        if path.len() == count || passed(at) {
            return false;
        }
        for half in self.from.get(&at).into_iter().flatten() {
            path.push(*half);
            if self.goes_back(path, self.ends(*half).0, first, count) {
                return true;
            }
            path.pop();
        }
        false
    }

    pub fn remove(&mut self, ring: &[u32]) {
        for half in ring {
            let begin = self.ends(*half).1;
            if let Some(sides) = self.from.get_mut(&begin) {
                sides.retain(|side| side != half);
                if sides.is_empty() {
                    self.from.remove(&begin);
                }
            }
        }
    }

    /// All sides of triangles between corners at open sides, lower corner first.
    pub fn sides_between_corners(&self) -> HashSet<(u32, u32)> {
        let highest = self.triangles.iter().flatten().max().map_or(0, |last| *last as usize + 1);
        let mut is_corner = vec![false; highest];
        for half in self.from.values().flatten() {
            let (begin, end) = self.ends(*half);
            (is_corner[begin as usize], is_corner[end as usize]) = (true, true);
        }
        let sides = self.triangles.iter().flat_map(|corners| sides_of(*corners));
        sides.filter(|(a, b)| is_corner[*a as usize] && is_corner[*b as usize]).collect()
    }
}
