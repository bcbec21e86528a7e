//! Triangles of an offset surface split where flags change.
//!
//! Sides are halved by Rivara's longest-side propagation (1984): with any side of a triangle its longest side is halved
//! too, and the triangle is cut through that one first.
//!
//! Why rounds of it come to an end, whatever the flags say. A round takes sides away, all longer than `fine`: with a side that is
//! to be halved go the longest sides of the triangles beside it, which are no shorter. Instead of them it puts halves;
//! in each triangle beside them the median to its longest side c, at most sqrt(3)/2 c long (its square is
//! (2 a^2 + 2 b^2 - c^2) / 4 with a, b <= c); and cuts from the middle of c to the middles of other sides, which are half as
//! long as the third. So each new side can be written to the account of one that goes and is longer by 2 / sqrt(3) at
//! least; a side has as many entries as its halves and the triangles beside it give, a finite number that halving does not
//! raise; and what is no longer than `fine` never goes. Accounts opened from the first sides are trees of finite width and
//! of a depth of log(longest / fine) / log(2 / sqrt(3)) at most: finite. Each round closes one account or more.
//!
//! Without the propagation a neighbour is cut through a short side while its longest stays whole, and flattens for ever.

use std::collections::{HashMap, HashSet};

use rayon::prelude::*;

use super::{corners::Corner, OffsetSurface};

/// How much longer the sides of a triangle may stay that is stopped at all its corners: a
/// reached region in it that is narrower than the tool's radius may be missed.
const ALL_STOPPED: f64 = 4.0;

/// A side by its ends, the lower first.
type Side = (u32, u32);

/// Sides to be halved in one round.
pub struct Splits {
    /// Their middles: points that the surface does not have yet.
    pub middles: Vec<Corner>,
    /// The number that each side's middle will have among the surface's points.
    numbers: HashMap<Side, u32>,
}

/// A triangle with a side that may be halved.
struct Large {
    /// Among the surface's.
    triangle: usize,
    sides: [Side; 3],
    lengths: [f64; 3],
}

impl Large {
    fn of(surface: &OffsetSurface, triangle: usize, fine: f64) -> Option<Self> {
        let sides = sides(surface.triangles[triangle]);
        let lengths = sides.map(|side| length(surface, side));
        lengths.iter().any(|length| *length > fine).then_some(Self { triangle, sides, lengths })
    }

    /// The sides longer than `fine`.
    fn long(&self, fine: f64) -> impl Iterator<Item = Side> + '_ {
        self.sides.iter().zip(&self.lengths).filter(move |(_, length)| **length > fine).map(|(side, _)| *side)
    }

    fn longest(&self) -> Side {
        let [a, b, c] = self.lengths;
        self.sides[if a >= b && a >= c { 0 } else { 1 + usize::from(c > b) }]
    }
}

impl Splits {
    /// The sides longer than `fine` (mm) of triangles whose corners differ in flag, and those [`ALL_STOPPED`] times as long
    /// where all corners are stopped; with each the longest side of every triangle that has it.
    pub fn of(surface: &OffsetSurface, fine: f64) -> Self {
        let large: Vec<Large> =
            (0..surface.triangles.len()).into_par_iter().filter_map(|t| Large::of(surface, t, fine)).collect();
        let halved = propagated(surface, &large, fine);
        let mut splits = Self { middles: Vec::with_capacity(halved.len()), numbers: HashMap::new() };
        for large in large.iter().filter(|_| !halved.is_empty()) {
            let triangle = surface.numbers[large.triangle];
            for side in large.sides.into_iter().filter(|side| halved.contains(side)) {
                let next = (surface.points.len() + splits.middles.len()) as u32;
                splits.numbers.entry(side).or_insert_with(|| {
                    splits.middles.push(middle(surface, side, triangle));
                    next
                });
            }
        }
        splits
    }

    /// Puts the parts instead of all triangles that have such a side; the middles are among the points by now.
    pub fn apply(&self, surface: &mut OffsetSurface) {
        let (mut triangles, mut numbers) = (Vec::new(), Vec::new());
        for (corners, number) in surface.triangles.iter().zip(&surface.numbers) {
            self.part(surface, *corners, &mut triangles);
            numbers.resize(triangles.len(), *number);
        }
        (surface.triangles, surface.numbers) = (triangles, numbers);
    }

    /// Cuts a triangle from the middle of the longest side to be halved to the corner beyond it, and the two parts again.
    fn part(&self, surface: &OffsetSurface, corners: [u32; 3], parts: &mut Vec<[u32; 3]>) {
        let sides = sides(corners);
        let halved = (0..3).filter_map(|k| Some((k, *self.numbers.get(&sides[k])?)));
        let longest = halved.max_by(|a, b| length(surface, sides[a.0]).total_cmp(&length(surface, sides[b.0])));
        let Some((k, middle)) = longest else {
            parts.push(corners);
            return;
        };
        let [a, b, c] = [0, 1, 2].map(|i| corners[(k + i) % 3]);
        self.part(surface, [a, middle, c], parts);
        self.part(surface, [middle, b, c], parts);
    }
}

/// The sides to be halved: those that flags ask for, and the longest sides of all triangles beside them, and so on.
fn propagated(surface: &OffsetSurface, large: &[Large], fine: f64) -> HashSet<Side> {
    let flag = |corner: u32| surface.points[corner as usize].flag;
    let asked = |large: &Large| {
        let [a, b, c] = surface.triangles[large.triangle].map(flag);
        let least = if a != b || a != c {
            fine
        } else if a.is_stopped() {
            ALL_STOPPED * fine
        } else {
            f64::INFINITY
        };
        large.long(least).collect::<Vec<Side>>()
    };
    let mut halved: HashSet<Side> = large.iter().flat_map(asked).collect();
    if halved.is_empty() {
        return halved;
    }
    let mut beside: Vec<(Side, u32)> = large
        .par_iter()
        .enumerate()
        .flat_map_iter(|(number, large)| large.long(fine).map(move |side| (side, number as u32)))
        .collect();
    beside.par_sort_unstable();
    let mut open: Vec<Side> = halved.iter().copied().collect();
    while let Some(side) = open.pop() {
        let first = beside.partition_point(|(other, _)| *other < side);
        for (_, number) in beside[first..].iter().take_while(|(other, _)| *other == side) {
            let longest = large[*number as usize].longest();
            if halved.insert(longest) {
                open.push(longest);
            }
        }
    }
    halved
}

fn middle(surface: &OffsetSurface, side: Side, triangle: u32) -> Corner {
    let [a, b] = [side.0, side.1].map(|i| &surface.points[i as usize]);
    Corner {
        point: (a.contact + b.contact) * 0.5,
        normal: (a.normal + b.normal).try_normalize(0.0).unwrap_or(a.normal),
        triangle,
    }
}

/// Side k runs from corner k to the next.
fn sides([a, b, c]: [u32; 3]) -> [Side; 3] {
    [(a, b), (b, c), (c, a)].map(|(p, q)| (p.min(q), p.max(q)))
}

fn length(surface: &OffsetSurface, side: Side) -> f64 {
    (surface.points[side.0 as usize].contact - surface.points[side.1 as usize].contact).norm()
}
