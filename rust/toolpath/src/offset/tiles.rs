//! Positions put together in tiles: neighbours share a search.

use rayon::prelude::*;

/// Positions in a tile, about.
const MEMBERS: f64 = 12.0;
/// Triangles under a tile, about, at most.
const TRIANGLES: f64 = 8.0;

/// Tiles in a row and in a column of a block.
const BLOCK: u64 = 4;

/// Positions in the order of their tiles.
pub struct Tiles {
    /// Numbers of positions, tile after tile.
    pub members: Vec<u32>,
    /// For each position, where among the members it stands.
    pub ranks: Vec<u32>,
    /// Where each tile's members begin, and the end.
    pub starts: Vec<u32>,
}

impl Tiles {
    /// Tiles of positions over a mesh with so much area for each triangle, mm^2: small enough for few triangles, large
    /// enough for some positions.
    pub fn of(positions: &[[f64; 2]], area_per_triangle: f64) -> Self {
        let size = Size::of(positions);
        let side =
            (size.per_place() * MEMBERS.sqrt()).min((area_per_triangle * TRIANGLES).sqrt()).max(1e-9 * size.extent());
        size.sorted(positions, side)
    }
}

/// The box around positions.
struct Size {
    low: [f64; 2],
    high: [f64; 2],
    count: usize,
}

impl Size {
    fn of(positions: &[[f64; 2]]) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for position in positions {
            for i in 0..2 {
                low[i] = low[i].min(position[i]);
                high[i] = high[i].max(position[i]);
            }
        }
        Self { low, high, count: positions.len() }
    }

    fn extent(&self) -> f64 {
        (self.high[0] - self.low[0]).max(self.high[1] - self.low[1]).max(f64::MIN_POSITIVE)
    }

    /// Side of a square that holds one position, mm.
    fn per_place(&self) -> f64 {
        let area = (self.high[0] - self.low[0]) * (self.high[1] - self.low[1]);
        let along = self.extent() / self.count as f64;
        (area / self.count as f64).sqrt().max(along)
    }

    /// By blocks of tiles in rows, every other one backwards: each tile begins near the last, and blocks are compact.
    fn sorted(&self, positions: &[[f64; 2]], side: f64) -> Tiles {
        let count = |i: usize| (((self.high[i] - self.low[i]) / side).floor() as u64 / BLOCK) + 1;
        let (columns, rows) = (count(0), count(1));
        let key = |position: &[f64; 2]| {
            let [column, row] = [0, 1].map(|i| ((position[i] - self.low[i]) / side) as u64);
            let (block_row, block) = (row / BLOCK, column / BLOCK);
            let block = if block_row % 2 == 0 { block } else { columns - 1 - block.min(columns - 1) };
            ((block_row * columns + block) * BLOCK + row % BLOCK) * BLOCK + column % BLOCK
        };
        let keys: Vec<u64> = positions.par_iter().map(key).collect();
        let tiles = columns * rows * BLOCK * BLOCK;
        if tiles <= 2 * positions.len() as u64 + 256 {
            counted(&keys, tiles as usize)
        } else {
            compared(&keys)
        }
    }
}

/// Counting sort: many positions, few tiles.
fn counted(keys: &[u64], tiles: usize) -> Tiles {
    let mut starts = vec![0_u32; tiles + 1];
    for key in keys {
        starts[*key as usize + 1] += 1;
    }
    for tile in 1..starts.len() {
        starts[tile] += starts[tile - 1];
    }
    let mut next = starts.clone();
    let mut members = vec![0; keys.len()];
    let mut ranks = Vec::with_capacity(keys.len());
    for (position, key) in keys.iter().enumerate() {
        let at = &mut next[*key as usize];
        members[*at as usize] = position as u32;
        ranks.push(*at);
        *at += 1;
    }
    starts.dedup();
    Tiles { members, ranks, starts }
}

/// By comparison: positions far from each other.
fn compared(keys: &[u64]) -> Tiles {
    let mut members: Vec<u32> = (0..keys.len() as u32).collect();
    members.par_sort_unstable_by_key(|m| (keys[*m as usize], *m));
    let mut starts: Vec<u32> = vec![0];
    for (at, pair) in members.windows(2).enumerate() {
        if keys[pair[0] as usize] != keys[pair[1] as usize] {
            starts.push(at as u32 + 1);
        }
    }
    starts.push(members.len() as u32);
    let mut ranks = vec![0; members.len()];
    for (rank, member) in members.iter().enumerate() {
        ranks[*member as usize] = rank as u32;
    }
    Tiles { members, ranks, starts }
}
