//! Z-levels: the level sets of the envelope, exact at their points and fitted between them.

use rayon::prelude::*;
use styluscam_motion::Watch;

use super::{
    bounds::Bounds,
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
    let bounds = Bounds::of(grid, surface, heights, watch)?;
    watch.begin("levels", heights.len());
    let levels: Result<Vec<Vec<Pass>>, PlanError> = heights
        .par_iter()
        .enumerate()
        .map(|(group, z)| {
            let level = Level { surface, grid, bounds: &bounds, z: *z, group };
            let passes = level.passes(deviation, watch)?;
            watch.advance(1)?;
            Ok(passes)
        })
        .collect();
    Ok(levels?.into_iter().flatten().collect())
}

struct Level<'a> {
    surface: &'a Surface<'a>,
    grid: &'a Grid,
    bounds: &'a Bounds,
    z: f64,
    group: usize,
}

impl Level<'_> {
    fn passes(&self, deviation: f64, watch: &Watch) -> Result<Vec<Pass>, PlanError> {
        let mut curve = LevelCurve::new(self.surface, self.z);
        let mut passes = Vec::new();
        let sides = Sides::of(self.grid, self.bounds, &mut curve, self.z, watch)?;
        for chain in contour::chains(&sides, |place| curve.is_above(place)) {
            watch.advance(0)?;
            let exact = crossings(&mut curve, &sides, &chain);
            let whole = chain.closed && exact.iter().all(|p| p.selected);
            for run in fitting::selected_runs(&exact, chain.closed, |a, b| curve.between(a, b)) {
                let runs = fitting::densified(&run, deviation, |a, b| curve.between(a, b));
                let closed = whole && runs.len() == 1;
                let pass =
                    |run: &Vec<PathPoint>| Pass { points: fitting::thinned(run, deviation), closed, group: self.group };
                passes.extend(runs.iter().map(pass));
            }
        }
        Ok(passes)
    }
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
