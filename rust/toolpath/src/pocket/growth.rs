//! What the tool's centre may reach next without exceeding the bound: the union of all discs on whose circles it engages
//! less, by the material as it is.

use super::bound::{ladder, Bound};
use super::polygons::{Kernel, Polygons};

/// Chords of walls are at most this far off their arcs, mm: what the offsets take off the part, they leave.
pub const WALL: f64 = 4e-4;

/// How much larger than it is the material may be taken, in tool radii: half a percent of a pass, for a third of the corners.
const SAG: f64 = 0.002;

/// Discs of one radius.
#[derive(Debug)]
struct Rung {
    radius: f64,
    /// Distance that material keeps from their centres, mm.
    keep: f64,
    tolerance: f64,
    /// Where their centres may be, by the walls.
    centres: Polygons,
}

/// The discs that fit between the walls.
#[derive(Debug)]
pub struct Growth {
    rungs: Vec<Rung>,
    /// How much larger the material may be taken than it is, mm.
    sag: f64,
}

impl Growth {
    /// For the positions that the walls leave to the tool's centre; discs from `largest` to `smallest`, mm.
    pub fn new(kernel: &Kernel, free: &Polygons, bound: &Bound, [largest, smallest]: [f64; 2]) -> Self {
        let rung = |radius: f64| Rung {
            radius,
            keep: bound.keep(radius),
            tolerance: bound.tolerance(radius),
            centres: kernel.offset(free, -radius, WALL),
        };
        Self { rungs: ladder(largest, smallest).into_iter().map(rung).collect(), sag: SAG * bound.radius }
    }

    /// All positions on permissible discs.
    pub fn reach(&self, kernel: &Kernel, material: &Polygons) -> Polygons {
        // more material than there is: the safe side
        let material = material.filled(self.sag);
        let mut reach = Polygons::default();
        for rung in self.rungs.iter().filter(|rung| !rung.centres.is_empty()) {
            let kept = kernel.offset(&material, rung.keep, rung.tolerance);
            let centres = kernel.difference(&rung.centres, &kept);
            if !centres.is_empty() {
                // one after the other: their edges nearly coincide, and all at once that is slow
                reach = kernel.union(&reach, &kernel.offset(&centres, rung.radius, rung.tolerance));
            }
        }
        reach.thinned(0.3 * WALL)
    }
}
