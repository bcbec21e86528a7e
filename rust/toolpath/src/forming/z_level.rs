//! Z-levels: the level sets of the envelope, exact at their points and fitted between them.

use rayon::prelude::*;
use styluscam_motion::Watch;

use super::{bounds::Bounds, contour, gaps, grid::Grid, level_curve::LevelCurve, trace::Trace};
use crate::fitting::{self, Bending};
use crate::{Pass, PathPoint, PlanError, Surface};

/// All passes at the given heights, in their order; chords deviate by at most `deviation` mm along the normal.
///
/// Within a level the loops stand in the grid's order. The higher ground is on the right of each. The tool stays down over
/// what is not selected where that is no wider than the grid's smallest feature.
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
            let level = Level { surface, grid, bounds: &bounds, group, deviation };
            let passes = level.passes(*z, watch)?;
            watch.advance(1)?;
            Ok(passes)
        })
        .collect();
    Ok(levels?.into_iter().flatten().collect())
}

/// Passes at all `asked` heights, of which those at some heights are `known`: only the others are looked for.
///
/// # Errors
/// As [`z_levels`].
pub fn z_levels_beside(
    known: (&[f64], Vec<Pass>),
    surface: &Surface<'_>,
    grid: &Grid,
    asked: &[f64],
    deviation: f64,
    watch: &Watch,
) -> Result<Vec<Pass>, PlanError> {
    let (heights, passes) = known;
    let others: Vec<f64> = asked.iter().copied().filter(|z| !heights.contains(z)).collect();
    let found = z_levels(surface, grid, &others, deviation, watch)?;
    let at = |z: f64| asked.iter().position(|height| height.to_bits() == z.to_bits());
    let known = passes.into_iter().map(|pass| (at(heights[pass.group]), pass));
    let found = found.into_iter().map(|pass| (at(others[pass.group]), pass));
    let mut all: Vec<Pass> =
        known.chain(found).filter_map(|(group, pass)| Some(Pass { group: group?, ..pass })).collect();
    all.sort_by_key(|pass| pass.group);
    Ok(all)
}

struct Level<'a> {
    surface: &'a Surface<'a>,
    grid: &'a Grid,
    bounds: &'a Bounds,
    group: usize,
    deviation: f64,
}

impl<'a> Level<'a> {
    fn passes(&self, z: f64, watch: &Watch) -> Result<Vec<Pass>, PlanError> {
        let Self { surface, grid, bounds, group, deviation } = *self;
        let mut curve = LevelCurve::new(surface, z);
        let segments = Trace::new(grid, bounds, &mut curve, deviation).segments(watch)?;
        let mut passes = Vec::new();
        let chains = contour::chains(segments).into_iter();
        let chains: Vec<_> = chains
            .flat_map(|chain| surface.stretches(chain.points, chain.closed, |a, b| curve.between(a, b)))
            .collect();
        for (points, closed) in chains {
            let chain = contour::Chain { points, closed };
            let bend = surface.bend();
            let mut course = Bending { between: |a: &_, b: &_| curve.between(a, b), bend };
            let chain = gaps::bridged(chain, grid.smallest_feature(), deviation, &mut course);
            let closed = chain.closed && chain.points.iter().all(|p| p.selected);
            let runs = fitting::selected_runs(&chain.points, chain.closed, |a, b| curve.between(a, b));
            let pass = |run: &Vec<PathPoint>| Pass { points: surface.thinned(run, deviation), closed, group };
            passes.extend(runs.iter().map(pass));
        }
        Ok(passes)
    }
}
