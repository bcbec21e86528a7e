//! What the tool's centre may reach next without exceeding the bound: the union of discs on whose circles it engages
//! less, by the material as it is.
//!
//! Large discs go first, a few radii at a time: as long as they gain ground smaller ones are not asked, and those that the material is nowhere near
//! to any more, never again.

use std::sync::Arc;

use rayon::prelude::*;

use super::bound::{ladder, Bound};
use super::material::Material;
use super::pieces::{pieces, Piece, SHALLOWEST};
use super::polygons::{Kernel, Polygons};

/// Chords of walls are at most this far off their arcs, mm: what the offsets take off the part, they leave.
pub const WALL: f64 = 4e-4;

/// How much larger than it is the material may be taken, as a share of what the largest discs gain: for a third of the corners.
const SAG: f64 = 0.005;

/// Areas of centres smaller than this are left out, mm: no disc moves in them farther than chords are off.
const SPECK: f64 = 1e-4;
/// Radii that are asked together.
const TOGETHER: usize = 3;
/// Pieces shallower than this share of what the discs can gain wait until nothing else is left.
const SHALLOW: f64 = 0.35;
/// Radii that gain nothing are left out for so many steps, at most.
const LONGEST_WAIT: u32 = 4;

/// Discs of one radius.
#[derive(Debug)]
struct Rung {
    radius: f64,
    /// Distance that material keeps from their centres, mm.
    keep: f64,
    tolerance: f64,
    /// How far a pass beside an equal one may be from it, mm.
    gain: f64,
    /// Where their centres may be, by the walls.
    centres: Arc<Polygons>,
    /// Steps for which they are left out: now, and the last time.
    waits: [u32; 2],
    /// Whether no material is near to any of them.
    is_done: bool,
}

/// The discs that fit between the walls.
#[derive(Debug)]
pub struct Growth {
    rungs: Vec<Rung>,
    /// Where the tool's centre may be.
    free: Polygons,
    /// The tool's radius, mm.
    radius: f64,
    /// How much larger the material may be taken than it is, mm.
    sag: f64,
}

impl Growth {
    /// Discs from `largest` to `smallest` in an area, mm, for positions of the tool's centre in `free`; one growth for each bound.
    pub fn all<const N: usize>(
        kernel: &Kernel,
        [free, area]: [&Polygons; 2],
        bounds: [Bound; N],
        [largest, smallest]: [f64; 2],
    ) -> [Self; N] {
        let centres = |radius: f64| (radius, Arc::new(kernel.offset(area, -radius, WALL).without_specks(SPECK)));
        let mut discs: Vec<(f64, Arc<Polygons>)> = ladder(largest, smallest).into_par_iter().map(centres).collect();
        discs.retain(|(_, centres)| !centres.is_empty());
        bounds.map(|bound| {
            let rung = |(radius, centres): &(f64, Arc<Polygons>)| Rung {
                radius: *radius,
                keep: bound.keep(*radius),
                tolerance: bound.tolerance(*radius),
                gain: radius + bound.radius - bound.keep(*radius),
                centres: Arc::clone(centres),
                waits: [0, 0],
                is_done: false,
            };
            let rungs: Vec<Rung> = discs.iter().map(rung).collect();
            let sag = SAG * rungs.first().map_or(0.0, |rung| rung.gain);
            Self { rungs, free: free.clone(), radius: bound.radius, sag }
        })
    }

    /// The pieces that are next: deep ones of the largest discs that have any; else the deepest of all.
    pub fn next(&mut self, kernel: &Kernel, material: &Material) -> Vec<Piece> {
        // more material than there is: the safe side
        let filled = material.area.filled(self.sag);
        let mut shallow: Vec<Piece> = Vec::new();
        // those that wait are asked where the others have nothing
        for is_last in [false, true] {
            let mut asked: Vec<&mut Rung> = Vec::new();
            for rung in self.rungs.iter_mut().filter(|rung| !rung.is_done) {
                match (is_last, rung.waits[0]) {
                    (false, 0) => asked.push(rung),
                    (false, _) => rung.waits[0] -= 1,
                    (true, now) if now < rung.waits[1] => asked.push(rung),
                    (true, _) => {}
                }
            }
            for group in asked.chunks_mut(TOGETHER) {
                let reaches: Vec<Polygons> = group.par_iter_mut().map(|rung| rung.reach(kernel, &filled)).collect();
                // one after the other: their edges nearly coincide, and all at once that is slow
                let reach = reaches.iter().fold(Polygons::default(), |sum, reach| kernel.union(&sum, reach));
                // beside a fold of the walls' offset discs may come nearer to them than they should, by some hundredths of their radius
                let reach = kernel.intersection(&reach, &self.free);
                let mut found = pieces(&reach.thinned(0.3 * WALL), material, self.radius);
                let deep = SHALLOW * group.first().map_or(0.0, |rung| rung.gain);
                if found.iter().any(|piece| piece.depth >= deep) {
                    group.iter_mut().for_each(|rung| rung.waits = [0, 0]);
                    found.retain(|piece| piece.depth >= deep);
                    return found;
                }
                for rung in group {
                    let wait = (2 * rung.waits[1]).clamp(1, LONGEST_WAIT);
                    rung.waits = [wait, wait];
                }
                shallow.append(&mut found);
            }
        }
        let deepest = shallow.iter().fold(0.0, |deepest: f64, piece| deepest.max(piece.depth));
        shallow.retain(|piece| piece.depth >= 0.5 * deepest && piece.depth > SHALLOWEST);
        shallow
    }
}

impl Rung {
    /// All positions on permissible discs of the radius.
    fn reach(&mut self, kernel: &Kernel, material: &Polygons) -> Polygons {
        let kept = kernel.offset(material, self.keep, self.tolerance);
        let centres = kernel.difference(&self.centres, &kept).without_specks(SPECK);
        self.is_done = self.centres.area() - centres.area() <= 0.0;
        kernel.offset(&centres, self.radius, self.tolerance)
    }
}
