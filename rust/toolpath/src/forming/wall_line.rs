//! The line down the walls: where the tool's tip goes in the upright section across the levels, and so how high the ridge between
//! two levels is, whatever the wall does between them.
//!
//! Where the tool stands on the two levels, its sections cross over the middle of the chord between both positions, and
//! between them the tool would stand lower than that chord by what the line sags. So the ridge is as high as the section is at
//! half its chord, and higher by the sag. Nothing is assumed of the part's curvatures: derived in docs/concepts/scallops.md.

use super::spread::Ridge;

/// Going down, walls that become steeper at once by more, rad, are not one wall: a tool rolls over convex edges.
const BREAK: f64 = 0.005;
/// Cotangent of the flattest wall that counts: flatter ones are floors.
const FLATTEST: f64 = 1e4;
/// A step is halved so often.
const HALVINGS: usize = 24;
/// Positions between two levels at which it is looked how far the line sags.
const SAMPLES: u32 = 48;

/// Slopes by height, summed up.
#[derive(Clone, Debug, PartialEq)]
pub struct WallLine {
    low: f64,
    /// Size of a cell, mm.
    cell: f64,
    /// By border of cells from `low` up: how far in plan the tip goes from the lowest to there, mm.
    travel: Vec<f64>,
    /// By border of cells from `low` up: how many breaks are below.
    breaks: Vec<u32>,
    ridge: Ridge,
}

impl WallLine {
    /// Of the slopes in cells of a size from `low` up, as the cosine of each; NaN where the tool meets no wall. `ridge` is the one
    /// between two levels.
    pub fn new(low: f64, cell: f64, cosines: &[f64], ridge: Ridge) -> Self {
        let (mut travel, mut breaks) = (vec![0.0], vec![0]);
        let (mut sum, mut count, mut before) = (0.0, 0, None);
        let known = |from: usize| cosines.get(from).is_some_and(|cosine| !cosine.is_nan());
        let (first, last) = ((0..cosines.len()).find(|i| known(*i)), (0..cosines.len()).rfind(|i| known(*i)));
        let (first, last) = (first.unwrap_or(0), last.unwrap_or(0));
        for cosine in (0..cosines.len()).map(|i| cosines[i.clamp(first, last)]) {
            // beyond both ends the walls go on; where nothing is known between, the tool goes straight down
            let slope = libm::acos(if cosine.is_nan() { 0.0 } else { cosine.clamp(0.0, 1.0) });
            sum += cell * libm::tan(slope).recip().min(FLATTEST);
            // from the lower cell to this one: steeper below than here
            count += u32::from(before.is_some_and(|below: f64| below - slope > BREAK));
            before = Some(slope);
            travel.push(sum);
            breaks.push(count);
        }
        Self { low, cell, travel, breaks, ridge }
    }

    /// The step down from a height after which the ridge is as high as asked for, mm, up to `most`; none where the walls break
    /// before, or nothing is known of them.
    pub fn step(&self, from: f64, first: f64, most: f64) -> Option<f64> {
        let top = self.low + self.cell * (self.travel.len() - 1) as f64;
        if self.travel.len() < 2 || from > top || from <= self.low {
            return None;
        }
        let is_over = |step: f64| self.is_over([from - step, from]);
        let (mut low, mut high) = (0.0, first.min(most).min(from - self.low));
        while !is_over(high) && high < most && from - high > self.low {
            (low, high) = (high, (1.25 * high).min(most));
        }
        if self.breaks_at(from) != self.breaks_at(from - high) {
            return None;
        }
        if is_over(high) {
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if is_over(middle) {
                    high = middle;
                } else {
                    low = middle;
                }
            }
        }
        Some(high)
    }

    /// Whether the ridge between levels at two heights, the lower first, is higher than asked for.
    fn is_over(&self, [bottom, top]: [f64; 2]) -> bool {
        let (x0, x1) = (self.travel_at(bottom), self.travel_at(top));
        let (along, up) = (x1 - x0, top - bottom);
        let length = libm::hypot(along, up);
        if length <= 0.0 {
            return false;
        }
        let chord = libm::atan2(up, along);
        let Ridge { body, height, .. } = &self.ridge;
        let section = body.chord(chord, *height);
        let radius = section * section / (8.0 * height);
        // below the ridge the tool would stand where it gets nearest to it: mostly, but not where the line bends at once, in the
        // middle
        let rise = |sample: u32| {
            let z = bottom + up * f64::from(sample) / f64::from(SAMPLES);
            let (x, z) = (self.travel_at(z) - x0, z - bottom);
            // to the right of the chord, upwards, is below it
            let (sag, aside) = ((x * up - z * along) / length, (x * along + z * up) / length - 0.5 * length);
            sag - 0.5 * aside * aside / radius
        };
        let sag = (0..=SAMPLES).map(rise).fold(f64::NEG_INFINITY, f64::max);
        let left = height - sag;
        left <= 0.0 || length + self.ridge.apart(along / up) >= body.chord(chord, left)
    }

    /// How far in plan from the lowest position the tip is at a height, mm.
    fn travel_at(&self, z: f64) -> f64 {
        let at = self.border(z);
        let cell = (at as usize).min(self.travel.len() - 2);
        self.travel[cell] + (at - cell as f64) * (self.travel[cell + 1] - self.travel[cell])
    }

    fn breaks_at(&self, z: f64) -> u32 {
        self.breaks[self.border(z) as usize]
    }

    /// A height by the numbers of the cells' borders, within them.
    fn border(&self, z: f64) -> f64 {
        ((z - self.low) / self.cell).clamp(0.0, (self.travel.len() - 1) as f64)
    }
}

#[cfg(test)]
mod tests {
    use styluscam_geometry::{kinds, Tool, ToolBody, ToolDocument};

    use super::*;

    const CELL: f64 = 1e-3;

    fn ball(diameter: f64) -> ToolBody {
        Tool::new(ToolDocument::of(kinds::Ball { diameter, radius: None, tip_flat: 0.0 }.into())).unwrap().body(None)
    }

    /// The tip's height over the lowest of a circle of a radius about the part's, and the cosines of its slopes.
    fn line(cosine: impl Fn(f64) -> f64, height: f64) -> WallLine {
        let cosines: Vec<f64> = (0..5000).map(|i| cosine((f64::from(i) + 0.5) * CELL)).collect();
        WallLine::new(0.0, CELL, &cosines, Ridge { body: ball(6.0), height, deviation: 0.0 })
    }

    #[test]
    fn on_a_plane_it_is_the_chord() {
        let slope = 0.7_f64;
        let line = line(|_| slope.cos(), 0.05);
        let step = line.step(4.0, 0.3, 3.0).unwrap();
        assert!((step - ball(6.0).chord(slope, 0.05) * slope.sin()).abs() < 1e-6, "{step}");
    }

    #[test]
    fn levels_lie_nearer_by_what_their_passes_slide_along_the_wall() {
        let (slope, deviation) = (0.3_f64, 0.005);
        let of = |deviation| {
            let cosines = vec![slope.cos(); 5000];
            let ridge = Ridge { body: ball(6.0), height: 0.05, deviation };
            WallLine::new(0.0, CELL, &cosines, ridge).step(4.0, 0.3, 3.0).unwrap()
        };
        let nearer = (of(0.0) - of(deviation)) / slope.sin();
        assert!((nearer - 2.0 * deviation / slope.tan()).abs() < 1e-6, "{nearer}");
    }

    #[test]
    fn in_and_around_a_circle_it_is_that_of_two_circles() {
        // the tool's centre goes on a circle of 7 mm in a hollow of 10 mm, or of 13 mm around 10 mm; the ridge lies where both
        // positions' circles cross
        for (centre, hollow) in [(7.0_f64, true), (13.0, false)] {
            let height = 0.05;
            // the tip's height counts from where the circle is lowest, or from 5 mm below its top
            let cosine = |z: f64| if hollow { 1.0 - z / centre } else { 1.0 - (5.0 - z) / centre };
            let line = line(cosine, height);
            let from = 4.0;
            let step = line.step(from, 0.3, 3.0).unwrap();
            let [a, b] = [from, from - step].map(|z| cosine(z).acos());
            let half = 0.5 * (a - b).abs();
            let (along, aside) = (centre * half.cos(), (9.0 - (centre * half.sin()).powi(2)).sqrt());
            let ridge = if hollow { 10.0 - (along + aside) } else { along - aside - 10.0 };
            assert!((ridge.abs() - height).abs() < 1e-4, "{centre}: {ridge} after {step}");
        }
    }

    #[test]
    fn walls_that_break_are_not_one() {
        let broken = line(|z| if z > 2.0 { 0.9 } else { 0.5 }, 0.05);
        assert!(broken.step(4.0, 0.3, 1.0).is_some() && broken.step(2.2, 0.3, 1.0).is_none());
        let hollow = line(|z| if z > 2.0 { 0.5 } else { 0.9 }, 0.05);
        let (across, on_the_wall) = (hollow.step(2.2, 0.3, 1.0).unwrap(), hollow.step(4.0, 0.3, 1.0).unwrap());
        assert!(across < 0.8 * on_the_wall, "{across} {on_the_wall}");
        assert!(line(|_| 0.5, 0.05).step(6.0, 0.3, 1.0).is_none());
    }
}
