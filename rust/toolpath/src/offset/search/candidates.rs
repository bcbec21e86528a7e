//! Triangles that may be touched somewhere in a tile.

use wide::f32x8;

use super::super::index::WIDTH;

/// Triangles that may be touched somewhere in a tile, with their bounds.
#[derive(Default)]
pub struct Candidates {
    /// Height from which the bounds count, mm.
    pub zero: f64,
    count: usize,
    groups: Vec<Group>,
}

/// Up to eight candidates.
#[derive(Clone, Copy, Default)]
struct Group {
    triangles: [u32; WIDTH],
    /// What the tips do not exceed over the middle of the tile,
    values: [f32; WIDTH],
    /// and how that changes beside it.
    along: [[f32; WIDTH]; 2],
}

impl Candidates {
    pub fn clear(&mut self, zero: f64) {
        self.zero = zero;
        self.count = 0;
        self.groups.clear();
    }

    pub fn count(&self) -> usize {
        self.count
    }

    #[inline]
    pub fn push(&mut self, triangle: u32, value: f32, along: [f32; 2]) {
        let lane = self.count % WIDTH;
        if lane == 0 {
            self.groups.push(Group::default());
        }
        self.count += 1;
        if let Some(group) = self.groups.last_mut() {
            group.triangles[lane] = triangle;
            group.values[lane] = value;
            group.along[0][lane] = along[0];
            group.along[1][lane] = along[1];
        }
    }

    /// Calls `keep` with the triangles that may reach a height, over zero, at a position `away` from the tile's middle.
    #[inline]
    pub fn reaching(&self, height: f32, away: [f32; 2], mut keep: impl FnMut(u32)) {
        let [dx, dy] = away.map(f32x8::splat);
        for (number, group) in self.groups.iter().enumerate() {
            let filled = (self.count - number * WIDTH).min(WIDTH);
            let [ax, ay] = group.along.map(f32x8::new);
            let heights = f32x8::new(group.values) + ax * dx + ay * dy;
            let mut open = !heights.simd_lt(f32x8::splat(height)).to_bitmask() & ((1 << filled) - 1);
            while open != 0 {
                keep(group.triangles[open.trailing_zeros() as usize]);
                open &= open - 1;
            }
        }
    }

    fn bound(&self, i: usize) -> (f32, [f32; 2]) {
        let (group, lane) = (&self.groups[i / WIDTH], i % WIDTH);
        (group.values[lane], group.along.map(|row| row[lane]))
    }

    /// A candidate, and where its bound rises to.
    pub fn direction(&self, i: usize) -> (u32, [f32; 2]) {
        (self.groups[i / WIDTH].triangles[i % WIDTH], self.bound(i).1)
    }

    /// What a candidate does not exceed in a tile, over zero.
    pub fn most(&self, i: usize, half: [f32; 2]) -> f32 {
        let (value, along) = self.bound(i);
        value + along[0].abs() * half[0] + along[1].abs() * half[1]
    }
}
