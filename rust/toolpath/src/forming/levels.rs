//! The heights of Z-levels.

use super::Floors;
use crate::PlanError;

/// Levels at most.
const LIMIT: usize = 100_000;
/// Share of a step that is none of its own; the judge takes levels this near for one pass.
const SHORT: f64 = 0.25;

/// Where levels begin and end, mm: the first one is a step below the top.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelRange {
    /// Height from which the steps count.
    pub top: f64,
    /// Lowest height wanted.
    pub bottom: f64,
    /// Lowest height at which the tool still touches what was selected.
    pub reachable: f64,
    /// Distance between levels.
    pub step: f64,
    /// One unit of the machine's last place: levels are multiples of it, so that they are posted unrounded.
    pub resolution: f64,
}

/// Heights from the top down, each a step below the one before it, the last at the bottom.
///
/// The last level stands at `bottom`, or where the tool cannot go as low, just above the lowest place that it
/// reaches. A last step of less than a quarter of the others is joined to the one before it. Where a level meets one of
/// the `floors`, it stands just above that.
///
/// # Errors
/// More levels than a program can hold.
pub fn levels(range: &LevelRange, floors: &Floors) -> Result<Vec<f64>, PlanError> {
    let LevelRange { top, bottom, reachable, step, resolution } = *range;
    let rounded = |z: f64| (z / resolution).round() * resolution;
    // a quarter of a unit higher, so that a floor is clearly below its level and not beside it by chance
    let above = |tip: f64| (tip / resolution + 0.25).ceil() * resolution;
    let stood = |z: f64| Some(floors.raised(z)).filter(|raised| *raised > z).map_or(z, above);
    let floor = stood(above(reachable).max(rounded(bottom)));
    let count = ((top - floor) / step).ceil().max(0.0);
    if count > LIMIT as f64 {
        return Err(PlanError::TooMany { what: "step.height", value: step, count: count as usize, limit: LIMIT });
    }
    let mut out: Vec<f64> = (1..=count as usize)
        .map(|i| rounded(top - i as f64 * step))
        .filter(|z| *z > floor + SHORT * step)
        .map(stood)
        .collect();
    if floor < top {
        out.push(floor);
    }
    out.dedup();
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_end_at_the_bottom() {
        let range = LevelRange { top: 0.0, bottom: -2.1, reachable: -9.0, step: 0.5, resolution: 0.001 };
        assert_eq!(levels(&range, &Floors::default()).unwrap(), [-0.5, -1.0, -1.5, -2.1]);
        let range = LevelRange { bottom: -2.2, ..range };
        assert_eq!(levels(&range, &Floors::default()).unwrap(), [-0.5, -1.0, -1.5, -2.0, -2.2]);
    }

    #[test]
    fn a_floor_stops_the_levels_just_above_it() {
        let range = LevelRange { top: 0.0, bottom: -2.0, reachable: -0.998, step: 0.5, resolution: 0.001 };
        let found = levels(&range, &Floors::default()).unwrap();
        assert_eq!(found.len(), 2);
        assert!((found[1] + 0.997).abs() < 1e-12);
    }

    #[test]
    fn the_last_level_stands_on_the_floor_though_the_tool_dips_at_its_border() {
        let range = LevelRange { top: 0.0, bottom: -9.0, reachable: -0.998, step: 0.5, resolution: 0.001 };
        let found = levels(&range, &Floors::at(&[-1.0], 0.0034)).unwrap();
        assert!((found[1] + 0.996).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn a_level_at_a_floor_stands_just_above_it() {
        let range = LevelRange { top: 0.0, bottom: -2.0, reachable: -9.0, step: 0.5, resolution: 0.001 };
        let found = levels(&range, &Floors::at(&[-2.0, -1.0], 0.0024)).unwrap();
        let expected = [-0.5, -0.997, -1.5, -1.997];
        assert!(found.len() == 4 && found.iter().zip(expected).all(|(z, e)| (z - e).abs() < 1e-12), "{found:?}");
    }

    #[test]
    fn a_step_that_is_too_small_is_refused() {
        let range = LevelRange { top: 0.0, bottom: -2.0, reachable: -2.0, step: 1e-6, resolution: 0.001 };
        assert!(matches!(levels(&range, &Floors::default()), Err(PlanError::TooMany { .. })));
    }
}
