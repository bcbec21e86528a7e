//! What the tool's centre may reach next without exceeding the bound: the union of discs on whose circles it engages
//! less, by the material as it is.
//!
//! Large discs go first, a few radii at a time: as long as they gain ground smaller ones are not asked, and those that the material is nowhere near
//! to any more, never again. What discs cover stays permitted as material goes, so that new ones are looked for only around what has been cleared
//! since.

use std::sync::Arc;

use rayon::prelude::*;

use super::bound::{ladder, Bound};
use super::material::Material;
use super::pieces::{pieces, Piece, SHALLOWEST};
use super::polygons::{Kernel, Polygons};
use super::window::{area, common, joined, wider, Window};

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
/// Windows that are more than this share of all are not worth their clipping.
const WIDEST: f64 = 0.25;

/// Discs of one radius.
#[derive(Debug)]
struct Rung {
    radius: f64,
    /// Distance that material keeps from their centres, mm.
    keep: f64,
    tolerance: f64,
    /// How far a pass beside an equal one may be from it, mm.
    gain: f64,
    /// Where their centres may be, by the walls; and the box around it.
    centres: Arc<Polygons>,
    all: Window,
    /// Steps for which they are left out: now, and the last time.
    waits: [u32; 2],
    /// How many boxes of what has been cleared were looked around; None before the first time.
    seen: Option<usize>,
    /// Whether no material is near to any of them.
    is_done: bool,
}

/// The discs that fit between the walls.
#[derive(Debug)]
pub struct Growth {
    rungs: Vec<Rung>,
    /// Where the tool's centre may be.
    free: Polygons,
    /// What of that permissible discs cover, as far as they were looked for.
    covered: Polygons,
    /// The tool's radius, mm.
    radius: f64,
    /// How much larger the material may be taken than it is, mm.
    sag: f64,
}

/// The material at a step.
#[derive(Clone, Copy, Debug)]
struct Step<'a> {
    kernel: &'a Kernel,
    /// More of it than there is: the safe side.
    material: &'a Polygons,
    /// Boxes around all that has been taken of it.
    cleared: &'a [Window],
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
                all: centres.bounds().unwrap_or_default(),
                waits: [0, 0],
                seen: None,
                is_done: false,
            };
            let rungs: Vec<Rung> = discs.iter().map(rung).collect();
            let sag = SAG * rungs.first().map_or(0.0, |rung| rung.gain);
            Self { rungs, free: free.clone(), covered: Polygons::default(), radius: bound.radius, sag }
        })
    }

    /// The pieces that are next: deep ones of the largest discs that have any; else the deepest of all. `cleared` has boxes around all that was
    /// taken of the material so far, in the order in which it was.
    pub fn next(&mut self, kernel: &Kernel, material: &Material, cleared: &[Window]) -> Vec<Piece> {
        let filled = material.area.filled(self.sag);
        let step = Step { kernel, material: &filled, cleared };
        let mut found: Vec<Piece> = Vec::new();
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
                let reaches: Vec<Polygons> = group.par_iter_mut().map(|rung| rung.reach(&step)).collect();
                // one after the other: their edges nearly coincide, and all at once that is slow
                let reach = reaches.iter().fold(Polygons::default(), |sum, reach| kernel.union(&sum, reach));
                if let Some(window) = reach.bounds() {
                    // beside a fold of the walls' offset discs may come nearer to them than they should, by some hundredths of their radius
                    let reach = kernel.intersection(&reach, &self.free.clipped(window));
                    self.covered = kernel.union(&self.covered, &reach).thinned(kernel.noise());
                }
                if !reach.is_empty() || found.is_empty() {
                    found = pieces(&self.covered.clone().thinned(0.3 * WALL), material, self.radius);
                }
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
            }
        }
        let deepest = found.iter().fold(0.0, |deepest: f64, piece| deepest.max(piece.depth));
        found.retain(|piece| piece.depth >= 0.5 * deepest && piece.depth > SHALLOWEST);
        found
    }
}

impl Rung {
    /// What permissible discs of the radius cover: at least those that were none the last time.
    fn reach(&mut self, step: &Step<'_>) -> Polygons {
        let windows = self.windows(step);
        self.seen = Some(step.cleared.len());
        windows
            .into_iter()
            .fold(Polygons::default(), |covered, window| step.kernel.union(&covered, &self.reach_in(step, window)))
    }

    /// Where the centres of new ones are.
    fn windows(&self, step: &Step<'_>) -> Vec<Option<Window>> {
        let Some(seen) = self.seen else { return vec![None] };
        let news = step.cleared.get(seen..).unwrap_or(&[]);
        let windows = joined(news.iter().filter_map(|news| common(wider(*news, self.keep), self.all)));
        match windows.iter().map(area).sum::<f64>() < WIDEST * area(&self.all) {
            true => windows.into_iter().map(Some).collect(),
            false => vec![None],
        }
    }

    /// What those cover whose centres lie in a window, or anywhere.
    fn reach_in(&mut self, step: &Step<'_>, window: Option<Window>) -> Polygons {
        let kernel = step.kernel;
        let clipped = window.map(|window| {
            let material = kernel.clipped(step.material, wider(window, self.keep));
            (kernel.clipped(&self.centres, window), material)
        });
        let (all, material) = match &clipped {
            Some((all, material)) => (all, material),
            None => (&*self.centres, step.material),
        };
        let kept = kernel.offset(material, self.keep, self.tolerance);
        let centres = kernel.difference(all, &kept).without_specks(SPECK);
        self.is_done = window.is_none() && all.area() - centres.area() <= 0.0;
        kernel.offset(&centres, self.radius, self.tolerance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rectangle([x, y]: [f64; 2]) -> Polygons {
        Polygons { contours: vec![vec![[-x, -y], [x, -y], [x, y], [-x, y]]] }
    }

    #[test]
    fn in_windows_all_is_found_that_is_permitted_anywhere() {
        let kernel = Kernel::new(200.0);
        let (r, free) = (2.5, rectangle([77.5, 8.0]));
        let bound = Bound::new(r, 1.0);
        let [mut growth] = Growth::all(&kernel, [&free, &free], [bound], [8.0, 0.2]);
        let entry = Polygons::disc([-20.0, 0.0], 5.0, WALL);
        let mut material = Material::new(kernel.difference(&rectangle([80.0, 10.5]), &entry));
        let mut cleared: Vec<Window> = entry.bounds().into_iter().collect();
        let mut windows = 0;
        for _ in 0..20 {
            let pieces = growth.next(&kernel, &material, &cleared);
            let filled = material.area.filled(growth.sag);
            let step = Step { kernel: &kernel, material: &filled, cleared: &cleared };
            for rung in growth.rungs.iter_mut().filter(|rung| rung.seen == Some(cleared.len())) {
                let missed = kernel.difference(&rung.reach_in(&step, None), &growth.covered);
                // by the chords of circles that were found in another step
                assert!(missed.area() < 0.02, "{} mm: {} mm^2", rung.radius, missed.area());
                rung.seen = Some(cleared.len() - 1);
                windows += usize::from(rung.windows(&step).iter().any(Option::is_some));
                rung.seen = Some(cleared.len());
            }
            let swept = pieces.iter().map(|piece| kernel.sweep(&piece.points, r, WALL));
            for swept in swept.collect::<Vec<_>>() {
                cleared.extend(material.taken_by(&swept));
                material = Material::new(kernel.difference(&material.area, &swept));
            }
        }
        assert!(cleared.len() > 8 && windows > 8, "{} pieces, {windows} windows", cleared.len());
    }
}
