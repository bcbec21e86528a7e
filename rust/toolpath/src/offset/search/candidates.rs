//! Triangles that may be touched somewhere in a tile.

use wide::f32x8;

use super::super::index::WIDTH;
use super::ground::Floor;

/// Triangles that may be touched somewhere in a tile, with their bounds.
#[derive(Default)]
pub struct Candidates {
    /// Height from which the values count, mm.
    pub zero: f64,
    pub triangles: Vec<u32>,
    values: Vec<f32>,
    along: [Vec<f32>; 2],
}

impl Candidates {
    pub fn clear(&mut self, zero: f64) {
        self.zero = zero;
        self.triangles.clear();
        self.values.clear();
        self.along.iter_mut().for_each(Vec::clear);
    }

    #[inline]
    pub fn push(&mut self, triangle: u32, value: f32, along: [f32; 2]) {
        self.triangles.push(triangle);
        self.values.push(value);
        self.along[0].push(along[0]);
        self.along[1].push(along[1]);
    }

    /// Leaves out what the last floor rules out: most were collected under lower ones.
    pub fn keep_above(&mut self, floor: &Floor, half: [f32; 2], margin: f32) {
        let mut kept = 0;
        for i in 0..self.triangles.len() {
            let along = [self.along[0][i], self.along[1][i]];
            if floor.rules_out(self.values[i], along, half, margin) {
                continue;
            }
            self.triangles[kept] = self.triangles[i];
            self.values[kept] = self.values[i];
            (self.along[0][kept], self.along[1][kept]) = (along[0], along[1]);
            kept += 1;
        }
        self.triangles.truncate(kept);
        self.values.truncate(kept);
        self.along.iter_mut().for_each(|row| row.truncate(kept));
        // whole groups of eight
        let padded = kept.next_multiple_of(WIDTH);
        self.values.resize(padded, 0.0);
        self.along.iter_mut().for_each(|row| row.resize(padded, 0.0));
    }

    /// A candidate, and where its bound rises to.
    pub fn direction(&self, i: usize) -> (u32, [f32; 2]) {
        (self.triangles[i], [self.along[0][i], self.along[1][i]])
    }

    /// What a candidate does not exceed in a tile, over zero.
    pub fn most(&self, i: usize, half: [f32; 2]) -> f32 {
        self.values[i] + self.along[0][i].abs() * half[0] + self.along[1][i].abs() * half[1]
    }

    /// Groups of eight.
    pub fn eights(&self) -> usize {
        self.triangles.len().div_ceil(WIDTH)
    }

    /// Those of eight candidates that reach a tip height at a place `away` from the tile's middle, as bits.
    #[inline]
    pub fn reaching(&self, eight: usize, tip: f64, away: [f32; 2], margin: f32) -> u32 {
        let first = eight * WIDTH;
        let lanes = |row: &[f32]| {
            let mut lanes = [0.0; WIDTH];
            lanes.copy_from_slice(&row[first..first + WIDTH]);
            f32x8::new(lanes)
        };
        let heights = lanes(&self.values)
            + lanes(&self.along[0]) * f32x8::splat(away[0])
            + lanes(&self.along[1]) * f32x8::splat(away[1])
            + f32x8::splat(margin);
        let low = heights.simd_lt(f32x8::splat((tip - self.zero) as f32)).to_bitmask();
        let count = WIDTH.min(self.triangles.len() - first);
        !low & ((1 << count) - 1)
    }
}
