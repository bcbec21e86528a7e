//! Zig-zag (lace): slices of the envelope by parallel vertical planes.

use rayon::prelude::*;
use styluscam_motion::Watch;

use crate::{fitting, Pass, PathPoint, PlanError, Surface};

/// Rows at most.
const LIMIT: usize = 100_000;

/// How the rows lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rows {
    /// Direction of the rows from +X, counterclockwise, rad.
    pub angle: f64,
    /// Distance between rows in plan, mm.
    pub stepover: f64,
    /// First spacing of samples along a row, mm; refined where the tolerance asks for it.
    pub spacing: f64,
}

/// All rows over the selected faces, side by side, each in the direction of `angle`.
///
/// Chords stray by at most `deviation` mm along the normal. Rows are interrupted where the contact leaves the
/// selected faces.
///
/// # Errors
/// Nothing to touch, more rows than a program can hold, `Cancelled`.
pub fn zig_zag(surface: &Surface<'_>, rows: &Rows, deviation: f64, watch: &Watch) -> Result<Vec<Pass>, PlanError> {
    let Some(lines) = Lines::over(surface, rows) else {
        return Err(PlanError::NothingReached(String::new()));
    };
    if lines.count > LIMIT {
        return Err(PlanError::TooMany { what: "stepover", value: rows.stepover, count: lines.count, limit: LIMIT });
    }
    watch.begin("rows", lines.count);
    let passes: Result<Vec<Vec<Pass>>, PlanError> = (0..lines.count)
        .into_par_iter()
        .map(|row| {
            let passes = lines.slice(surface, row, deviation);
            watch.advance(1)?;
            Ok(passes)
        })
        .collect();
    Ok(passes?.into_iter().flatten().collect())
}

/// Parallel lines in plan: along + across = place.
struct Lines {
    along: [f64; 2],
    across: [f64; 2],
    /// From and to along the rows.
    range: [f64; 2],
    /// Place of row 0 across them.
    first: f64,
    count: usize,
    stepover: f64,
    spacing: f64,
}

impl Lines {
    /// Rows over the surface's domain, the pattern centred on it.
    fn over(surface: &Surface<'_>, rows: &Rows) -> Option<Self> {
        let (low, high) = surface.domain()?;
        let (sin, cos) = libm::sincos(rows.angle);
        let (along, across) = ([cos, sin], [-sin, cos]);
        let corners = [low, [high[0], low[1]], high, [low[0], high[1]]];
        let range = |axis: [f64; 2]| {
            let places = corners.map(|c| c[0] * axis[0] + c[1] * axis[1]);
            [
                places.iter().copied().fold(f64::INFINITY, f64::min),
                places.iter().copied().fold(-f64::INFINITY, f64::max),
            ]
        };
        let [left, right] = range(across);
        let count = ((right - left) / rows.stepover).floor() as usize + 1;
        let first = 0.5 * (left + right - (count - 1) as f64 * rows.stepover);
        let (stepover, spacing) = (rows.stepover, rows.spacing);
        Some(Self { along, across, range: range(along), first, count, stepover, spacing })
    }

    fn slice(&self, surface: &Surface<'_>, row: usize, deviation: f64) -> Vec<Pass> {
        let mut hint = None;
        let met = self.met(surface, row, &mut hint);
        let mut between = |a: &PathPoint, b: &PathPoint| surface.between(a, b, &mut hint);
        let mut passes = Vec::new();
        for exact in met {
            for run in fitting::selected_runs(&exact, false, &mut between) {
                let runs = fitting::densified(&run, deviation, &mut between);
                let pass = |run| Pass { points: fitting::thinned(run, deviation), closed: false, group: row };
                passes.extend(runs.iter().map(|run| pass(run)));
            }
        }
        passes
    }

    /// Exact points of a row, as far apart as the spacing says: in runs, as the tool meets something or nothing, from the
    /// first place at which it does to the last.
    fn met(&self, surface: &Surface<'_>, row: usize, hint: &mut Option<u32>) -> Vec<Vec<PathPoint>> {
        let offset = self.first + row as f64 * self.stepover;
        let [first, last] = self.range;
        let samples = ((last - first) / self.spacing).ceil().max(1.0) as usize;
        let mut at = |s: f64| {
            let [x, y] = [0, 1].map(|axis| s * self.along[axis] + offset * self.across[axis]);
            surface.at(x, y, hint)
        };
        let mut runs = Vec::new();
        let mut run = Vec::new();
        let mut before = first;
        for i in 0..=samples {
            let s = first + (last - first) * i as f64 / samples as f64;
            match at(s) {
                Some(point) => {
                    if run.is_empty() && i > 0 {
                        run.extend(outermost(s, before, &mut at));
                    }
                    run.push(point);
                }
                None if !run.is_empty() => {
                    run.extend(outermost(before, s, &mut at));
                    runs.push(std::mem::take(&mut run));
                }
                None => {}
            }
            before = s;
        }
        runs.push(run);
        runs
    }
}

/// The last place at which the tool meets something, on the way from one where it does to one where it does not.
fn outermost(touching: f64, free: f64, at: &mut impl FnMut(f64) -> Option<PathPoint>) -> Option<PathPoint> {
    let (mut touching, mut free) = (touching, free);
    let mut found = None;
    while (free - touching).abs() > fitting::BORDER {
        let middle = 0.5 * (touching + free);
        match at(middle) {
            Some(point) => (touching, found) = (middle, Some(point)),
            None => free = middle,
        }
    }
    found
}
