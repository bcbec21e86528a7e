//! Z-levels: the level sets of the envelope, exact at their points and fitted between them.

use rayon::prelude::*;
use styluscam_motion::Watch;

use super::{
    contour,
    grid::Grid,
    level_curve::LevelCurve,
    sides::{Edge, Sides},
};
use crate::{fitting, Pass, PathPoint, PlanError, Surface};

/// All passes at the given heights, in their order; chords stray by at most `deviation` mm along the normal.
///
/// Within a level the loops stand in the grid's order. The higher ground is on the right of each.
///
/// # Errors
/// `Cancelled`.
pub fn z_levels(
    surface: &Surface<'_>,
    grid: &Grid,
    heights: &[f64],
    deviation: f64,
    watch: &Watch,
) -> Result<Vec<Pass>, PlanError> {
    watch.begin("levels", heights.len());
    let levels: Result<Vec<Vec<Pass>>, PlanError> = heights
        .par_iter()
        .enumerate()
        .map(|(group, z)| {
            let passes = level(surface, grid, *z, deviation, group, watch)?;
            watch.advance(1)?;
            Ok(passes)
        })
        .collect();
    Ok(levels?.into_iter().flatten().collect())
}

/// The loops of one height, whatever they touch; see [`z_levels`].
///
/// # Errors
/// `Cancelled`.
pub fn waterline(
    surface: &Surface<'_>,
    grid: &Grid,
    z: f64,
    deviation: f64,
    watch: &Watch,
) -> Result<Vec<Pass>, PlanError> {
    watch.begin("waterline", 1);
    level(surface, grid, z, deviation, 0, watch)
}

fn level(
    surface: &Surface<'_>,
    grid: &Grid,
    z: f64,
    deviation: f64,
    group: usize,
    watch: &Watch,
) -> Result<Vec<Pass>, PlanError> {
    let mut curve = LevelCurve::new(surface, z);
    let mut passes = Vec::new();
    let sides = Sides::of(grid, &mut curve, z, watch)?;
    for chain in contour::chains(&sides, |place| curve.is_above(place)) {
        watch.advance(0)?;
        let exact = crossings(&mut curve, &sides, &chain);
        let whole = chain.closed && exact.iter().all(|p| p.selected);
        for run in fitting::selected_runs(&exact, chain.closed, |a, b| curve.between(a, b)) {
            let runs = fitting::densified(&run, deviation, |a, b| curve.between(a, b));
            let closed = whole && runs.len() == 1;
            passes.extend(runs.iter().map(|run| Pass { points: fitting::thinned(run, deviation), closed, group }));
        }
    }
    Ok(passes)
}

/// The exact points at which a chain crosses the grid; the first repeated when closed.
fn crossings(curve: &mut LevelCurve<'_>, sides: &Sides<'_>, chain: &contour::Chain) -> Vec<PathPoint> {
    let crossing = |edge: &Edge| {
        let [above, free] = sides.ends(*edge);
        curve.crossing(above, free, sides.guess(*edge))
    };
    let mut points: Vec<PathPoint> = chain.edges.iter().filter_map(crossing).collect();
    if chain.closed {
        points.extend(points.first().copied());
    }
    points
}
