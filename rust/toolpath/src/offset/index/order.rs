//! Pieces in an order that makes every aligned group of 8, 64, 512 and so on a compact heap of neighbours.

use rayon::prelude::*;
use styluscam_geometry::Vector;
use styluscam_motion::Watch;

use super::pieces::Piece;
use super::width::WIDTH;

/// Ranges larger than this are split in parallel.
const PARALLEL: usize = 8192;

/// What the order is made by.
#[derive(Clone, Copy)]
struct Key {
    /// Middle of the piece's box, relative to the index's centre.
    middle: [f32; 3],
    piece: u32,
}

/// The pieces, halved again and again along their longest extent; the same whatever the number of threads. In some order
/// when `watch` is cancelled meanwhile.
pub fn of(pieces: &[Piece], centre: Vector, watch: &Watch) -> Vec<u32> {
    let key = |(number, piece): (usize, &Piece)| Key { middle: piece.middle(centre), piece: number as u32 };
    let mut keys: Vec<Key> = pieces.par_iter().enumerate().map(key).collect();
    let mut group = WIDTH;
    while group * WIDTH < keys.len() {
        group *= WIDTH;
    }
    split(&mut keys, group, watch);
    keys.iter().map(|key| key.piece).collect()
}

/// Splits until no range is larger than a group, then with the next smaller groups.
fn split(keys: &mut [Key], mut group: usize, watch: &Watch) {
    while keys.len() <= group {
        group /= WIDTH;
        if group < WIDTH {
            return;
        }
    }
    // whole groups to the left: the boundaries of groups are boundaries of halves
    let half = keys.len().div_ceil(group).div_ceil(2) * group;
    let axis = longest(keys);
    keys.select_nth_unstable_by(half, |a, b| a.middle[axis].total_cmp(&b.middle[axis]).then(a.piece.cmp(&b.piece)));
    let (left, right) = keys.split_at_mut(half);
    if left.len() <= PARALLEL {
        split(left, group, watch);
        split(right, group, watch);
    } else if !watch.is_cancelled() {
        rayon::join(|| split(left, group, watch), || split(right, group, watch));
    }
}

/// The axis along which the middles spread most.
fn longest(keys: &[Key]) -> usize {
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for key in keys {
        for i in 0..3 {
            low[i] = low[i].min(key.middle[i]);
            high[i] = high[i].max(key.middle[i]);
        }
    }
    // tools look from above: height separates best only where plan does not
    let spread = [high[0] - low[0], high[1] - low[1], 0.5 * (high[2] - low[2])];
    (0..3).max_by(|a, b| spread[*a].total_cmp(&spread[*b])).unwrap_or(0)
}
