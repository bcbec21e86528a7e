//! The heights of Z-levels.

use super::{Floors, Steps};
use crate::PlanError;

/// Levels at most.
const LIMIT: usize = 100_000;
/// Share of a step that is none of its own; the verifier takes levels this near for one pass.
const SHORT: f64 = 0.25;
/// Where the last level has no pass, how far over it the next attempt is, in steps.
const OVER_LAST: f64 = 0.2;
const _: () = assert!(OVER_LAST < SHORT);
/// Most that the lowest level over a tip lies above it, in units of the machine's last decimal.
const MOST_ABOVE: f64 = 1.26;

/// Where levels begin and end, mm: the first one is a step below the top.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelRange {
    /// Height from which the steps count.
    pub top: f64,
    /// Lowest height asked for.
    pub bottom: f64,
    /// Lowest height at which the tool still touches what was selected.
    pub reachable: f64,
    /// Distances between levels.
    pub steps: Steps,
    /// One unit of the machine's last decimal: levels are multiples of it, so that they are posted unrounded.
    pub resolution: f64,
}

impl LevelRange {
    /// The lowest multiple of the resolution over a tip, a quarter of a unit higher: a floor is clearly below its level then,
    /// and not beside it by chance.
    fn above(&self, tip: f64) -> f64 {
        (tip / self.resolution + 0.25).ceil() * self.resolution
    }

    /// A level's height, just above a floor where it meets one.
    fn stood(&self, z: f64, floors: &Floors) -> f64 {
        Some(floors.raised(z)).filter(|raised| *raised > z).map_or(z, |raised| self.above(raised))
    }
}

/// Heights from the top down, each a step below the one before it, the last at the bottom.
///
/// The last level stands at `bottom`, or where the tool cannot go as low, just above the lowest position that it
/// reaches. A last step of less than a quarter of the others is joined to the one before it, unless a bound would be
/// exceeded. Where a level meets one of the `floors`, it stands just above that.
///
/// # Errors
/// More levels than a program can hold.
pub fn levels(range: &LevelRange, floors: &Floors) -> Result<Vec<f64>, PlanError> {
    let LevelRange { top, bottom, reachable, ref steps, resolution } = *range;
    let rounded = |z: f64| (z / resolution).round() * resolution;
    let stood = |z: f64| range.stood(z, floors);
    let floor = stood(range.above(reachable).max(rounded(bottom)));
    let heights: Vec<f64> = steps.heights(top).take(LIMIT + 1).take_while(|z| *z > floor).collect();
    if heights.len() > LIMIT {
        let value = steps.smallest();
        let count = ((top - floor) / value).ceil() as usize;
        return Err(PlanError::TooMany { what: steps.key(), value, count, limit: LIMIT });
    }
    let is_bounded = matches!(steps, Steps::Bounded(_));
    // what is rounded up never lies beyond its bound
    let settled = |z: f64| if is_bounded { (z / resolution).ceil() * resolution } else { rounded(z) };
    let shortest = |z: f64| if is_bounded { resolution } else { SHORT * steps.at(z) };
    let mut out: Vec<f64> = heights.into_iter().map(settled).filter(|z| *z > floor + shortest(*z)).map(stood).collect();
    if floor < top {
        out.push(floor);
    }
    out.dedup();
    Ok(out)
}

/// The same heights with one more in each of some bands (lowest and highest tip, mm) that holds none: at its lower end, or a
/// quarter of a step over the next level below it, but no higher than the band's middle. None where nothing is to be added.
#[must_use]
pub fn with_levels_at(heights: &[f64], bands: &[(f64, f64)], range: &LevelRange, floors: &Floors) -> Option<Vec<f64>> {
    let mut bands = bands.to_vec();
    // of bands that end alike the narrowest first: its level serves the others
    let end = |z: f64| (z / range.resolution).round();
    bands.sort_by(|a, b| end(a.1).total_cmp(&end(b.1)).then(b.0.total_cmp(&a.0)));
    let mut all = heights.to_vec();
    for (low, high) in bands {
        let (low, high) = (low.max(range.bottom), high.min(range.top));
        let is_outside = low > high;
        // no level lies finer than the machine's unit
        let high = high.max(low + MOST_ABOVE * range.resolution);
        if is_outside || all.iter().any(|z| (low..=high).contains(z)) {
            continue;
        }
        let below = all.iter().copied().filter(|z| *z < low).fold(f64::NEG_INFINITY, f64::max);
        let aside = range.above(below + SHORT * range.steps.at(below));
        let level = range.stood(aside.min(range.above(0.5 * (low + high))).max(range.above(low)), floors);
        let lowest = || range.stood(range.above(low), floors);
        all.extend([level].into_iter().chain(std::iter::once_with(lowest)).find(|level| *level <= high));
    }
    all.sort_by(|a, b| b.total_cmp(a));
    all.dedup();
    (all.len() > heights.len()).then_some(all)
}

/// Puts the last level, where it had no pass, so little higher that the verifier expects none below.
pub fn raise_last(heights: &mut [f64], range: &LevelRange, floors: &Floors) {
    let Some((last, others)) = heights.split_last_mut() else { return };
    let raised = range.stood(range.above(*last + OVER_LAST * range.steps.at(*last)), floors);
    if others.last().is_none_or(|next| raised < *next) {
        *last = raised;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_end_at_the_bottom() {
        let range = LevelRange { top: 0.0, bottom: -2.1, reachable: -9.0, steps: Steps::Even(0.5), resolution: 0.001 };
        assert_eq!(levels(&range, &Floors::default()).unwrap(), [-0.5, -1.0, -1.5, -2.1]);
        let range = LevelRange { bottom: -2.2, ..range };
        assert_eq!(levels(&range, &Floors::default()).unwrap(), [-0.5, -1.0, -1.5, -2.0, -2.2]);
    }

    #[test]
    fn a_floor_stops_the_levels_just_above_it() {
        let range =
            LevelRange { top: 0.0, bottom: -2.0, reachable: -0.998, steps: Steps::Even(0.5), resolution: 0.001 };
        let found = levels(&range, &Floors::default()).unwrap();
        assert_eq!(found.len(), 2);
        assert!((found[1] + 0.997).abs() < 1e-12);
    }

    #[test]
    fn the_last_level_stands_on_the_floor_though_the_tool_dips_at_its_border() {
        let range =
            LevelRange { top: 0.0, bottom: -9.0, reachable: -0.998, steps: Steps::Even(0.5), resolution: 0.001 };
        let found = levels(&range, &Floors::at(&[-1.0], 0.0034)).unwrap();
        assert!((found[1] + 0.996).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn a_level_at_a_floor_stands_just_above_it() {
        let range = LevelRange { top: 0.0, bottom: -2.0, reachable: -9.0, steps: Steps::Even(0.5), resolution: 0.001 };
        let found = levels(&range, &Floors::at(&[-2.0, -1.0], 0.0024)).unwrap();
        let expected = [-0.5, -0.997, -1.5, -1.997];
        assert!(found.len() == 4 && found.iter().zip(expected).all(|(z, e)| (z - e).abs() < 1e-12), "{found:?}");
    }

    #[test]
    fn bands_between_levels_get_one_of_their_own() {
        let range = LevelRange { top: 0.0, bottom: -2.0, reachable: -9.0, steps: Steps::Even(0.5), resolution: 0.001 };
        let heights = [-0.5, -1.0, -1.5, -2.0];
        let with = |bands: &[(f64, f64)]| with_levels_at(&heights, bands, &range, &Floors::default());
        assert_eq!(with(&[(-1.2, -0.9), (-3.0, -2.2), (0.1, 0.4)]), None);
        // one level for two bands that overlap; clear of the level below where the band allows
        // a band that begins just over a level: its middle
        let found = with(&[(-0.999, -0.9)]).unwrap();
        assert!(found.len() == 5 && (found[1] + 0.949).abs() < 1e-9, "{found:?}");
        let expected = [-0.5, -0.874, -1.0, -1.299, -1.5, -2.0];
        let found = with(&[(-0.95, -0.6), (-0.9, -0.7), (-1.3, -1.2)]).unwrap();
        assert!(found.len() == 6 && found.iter().zip(expected).all(|(z, e)| (z - e).abs() < 1e-9), "{found:?}");
    }

    #[test]
    fn a_band_thinner_than_the_machines_unit_gets_the_level_over_it() {
        for (resolution, low) in [(0.01, -1.997), (0.0254, -1.99), (0.0254, -1.98), (0.1, -1.97)] {
            let range = LevelRange { top: 0.0, bottom: -9.0, reachable: -9.0, steps: Steps::Even(2.0), resolution };
            let found = with_levels_at(&[-1.0, -3.0], &[(low, low + 0.02)], &range, &Floors::default()).unwrap();
            assert!(found.len() == 3 && (low..low + 1.26 * resolution).contains(&found[1]), "{found:?}");
        }
    }

    #[test]
    fn the_last_level_is_raised_by_a_fifth_of_a_step_if_there_is_room() {
        let range = LevelRange { top: 0.0, bottom: -2.0, reachable: -9.0, steps: Steps::Even(0.5), resolution: 0.001 };
        let raised = |mut heights: Vec<f64>| {
            raise_last(&mut heights, &range, &Floors::default());
            heights
        };
        assert!((raised(vec![-1.5, -2.0])[1] + 1.899).abs() < 1e-9);
        assert_eq!(raised(vec![-1.95, -2.0]), [-1.95, -2.0]);
        assert!(raised(Vec::new()).is_empty());
    }

    #[test]
    fn a_step_that_is_too_small_is_refused() {
        let range = LevelRange { top: 0.0, bottom: -2.0, reachable: -2.0, steps: Steps::Even(1e-6), resolution: 0.001 };
        assert!(matches!(levels(&range, &Floors::default()), Err(PlanError::TooMany { .. })));
    }
}
