//! Triangles to be tried at the positions of a tile.

use super::super::contact::Best;
use super::super::index::WIDTH;
use super::ground::Ground;
use super::tangents::Eight;

/// Triangles of a position that are picked one by one, the highest bound first; if that is not the end of them, the rest
/// are sorted: where thousands meet, as in the tip of a cone, to look through all of them for each is too long.
const PICKED: usize = 16;

/// Triangles to be tried at the positions of a tile, position by position.
#[derive(Default)]
pub struct Trials {
    queries: Vec<Query>,
    triangles: Vec<u32>,
    /// What they do not exceed over their positions.
    values: Vec<f32>,
    eight: Eight,
}

struct Query {
    at: [f64; 2],
    /// The highest contact found before.
    found: Best,
    /// The first of its triangles.
    first: usize,
}

impl Trials {
    pub fn clear(&mut self) {
        self.queries.clear();
        self.triangles.clear();
    }

    /// The next position, and what was found over it before.
    #[inline]
    pub fn begin(&mut self, found: Best, at: [f64; 2]) {
        self.queries.push(Query { at, found, first: self.triangles.len() });
    }

    /// A triangle for the last position.
    #[inline]
    pub fn add(&mut self, triangle: u32) {
        self.triangles.push(triangle);
    }

    /// Finds out what the triangles do not exceed, over `zero`: eight at a time, whatever positions they are for.
    pub fn bound(&mut self, ground: &Ground<'_>, zero: f64) {
        self.values.clear();
        let mut lane = 0;
        for (i, query) in self.queries.iter().enumerate() {
            let end = self.queries.get(i + 1).map_or(self.triangles.len(), |next| next.first);
            for triangle in &self.triangles[query.first..end] {
                self.eight.put(lane, &ground.contacts.seen(*triangle, query.at, zero));
                lane += 1;
                if lane == WIDTH {
                    lane = 0;
                    self.values.extend_from_slice(&self.eight.most(ground.lines).to_array());
                }
            }
        }
        if lane > 0 {
            self.values.extend_from_slice(&self.eight.most(ground.lines).to_array());
        }
    }

    /// The highest contact over a position: the triangles are tried from the highest bound on.
    #[inline]
    pub fn highest(&mut self, number: usize, ground: &Ground<'_>, zero: f64) -> Best {
        let end = self.queries.get(number + 1).map_or(self.triangles.len(), |next| next.first);
        let Query { at, mut found, first } = self.queries[number];
        let (values, triangles) = (&mut self.values[first..end], &self.triangles[first..end]);
        for _ in 0..PICKED {
            let mut enough = ground.enough(found.tip, zero);
            let mut next = None;
            for (i, value) in values.iter().enumerate() {
                if *value >= enough {
                    (enough, next) = (*value, Some(i));
                }
            }
            let Some(i) = next else { return found };
            values[i] = f32::NAN; // reaches nothing any more
            ground.contacts.touch(triangles[i], at, &mut found);
        }
        let enough = ground.enough(found.tip, zero);
        let mut rest: Vec<usize> = (0..values.len()).filter(|i| values[*i] >= enough).collect();
        rest.sort_unstable_by(|a, b| values[*b].total_cmp(&values[*a]).then(a.cmp(b)));
        for i in rest {
            if values[i] < ground.enough(found.tip, zero) {
                break;
            }
            ground.contacts.touch(triangles[i], at, &mut found);
        }
        found
    }
}
