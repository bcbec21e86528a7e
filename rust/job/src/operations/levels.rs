//! The loops of levels, which several kinds begin with.

use styluscam_geometry::ToolBody;
use styluscam_motion::Watch;
use styluscam_toolpath::{
    forming::{
        left_out, levels, raise_last, scallop_steps, selected_range, with_levels_at, z_levels, z_levels_beside, Floors,
        Grid, LevelRange, ScallopRule, Spread, Steps,
    },
    PlanError, Surface,
};

use styluscam_verify::Pitch;

use super::step::{Step, StepLimits};
use super::surface::{Task, Traced};

/// What a job states of an operation's levels.
#[derive(Clone, Copy, Debug)]
pub struct LevelKeys<'a> {
    /// Their distances.
    pub step: &'a Step,
    /// The limits of these.
    pub limits: StepLimits,
    /// Whether there is one on every level floor.
    pub at_flats: bool,
    /// Whether turns lead evenly from one to the next.
    pub of_turns: bool,
}

/// The loops of levels a step apart, with more where these leave out a wall, and, if asked for, on every level floor.
///
/// # Errors
/// Nothing is reached, no level meets the faces, too many levels, `Cancelled`.
pub fn trace(keys: &LevelKeys<'_>, task: &Task<'_>, surface: &Surface<'_>) -> Result<Traced, PlanError> {
    let (watch, deviation) = (task.context.watch, task.budget.deviation);
    let nothing = || PlanError::NothingReached(task.why_nothing());
    let grid = Grid::sample(surface, task.context.node_spacing(), watch)?.ok_or_else(nothing)?;
    let resolution = task.context.machine.resolution_mm();
    let (lowest, highest) = selected_range(surface, &grid, resolution, watch)?.ok_or_else(nothing)?;
    // the flat top lies margin below what the envelope shows
    let top = task.context.heights.top.unwrap_or_else(|| rounded(highest - task.budget.margin, resolution));
    let bottom = task.context.heights.bottom;
    let steps = steps(keys, task, surface)?;
    let range = LevelRange { top, bottom, reachable: lowest, steps, resolution };
    let floors = Floors::of(surface.envelope());
    let heights = levels(&range, &floors)?;
    let mut passes = z_levels(surface, &grid, &heights, deviation, watch)?;
    let mut bands = left_out(surface, (&heights, &passes), grid.spacing(), watch)?;
    if keys.at_flats {
        bands.extend(floors.bands());
    }
    let mut more = with_levels_at(&heights, &bands, &range, &floors).unwrap_or_else(|| heights.clone());
    let is_at = |z: f64| passes.iter().flat_map(|pass| pass.points.first()).any(|p| (p.tip.z - z).abs() < resolution);
    // rims that rise and fall leave stretches of it that are too short
    if heights.last().is_some_and(|z| more.last() == Some(z) && !is_at(*z)) {
        raise_last(&mut more, &range, &floors);
    }
    if more != heights {
        let known = (&*heights, passes);
        passes = z_levels_beside(known, surface, &grid, &more, deviation, watch)?;
    }
    if passes.is_empty() {
        return Err(PlanError::Empty { top, bottom: bottom.max(lowest) });
    }
    Ok(Traced::new(passes, grid.smallest_feature()))
}

/// The distances between levels.
fn steps(keys: &LevelKeys<'_>, task: &Task<'_>, surface: &Surface<'_>) -> Result<Steps, PlanError> {
    let context = task.context;
    let top = context.heights.top.unwrap_or(context.scene.top);
    steps_of(keys, (top, task.body), task.budget.deviation, surface, context.watch)
}

/// The distances between levels from a height, mm, down, of a tool with its sheet. Passes are off the faces by up to `deviation`, mm,
/// to either side.
///
/// # Errors
/// `Cancelled`.
pub fn steps_of(
    keys: &LevelKeys<'_>,
    (top, body): (f64, &ToolBody),
    deviation: f64,
    surface: &Surface<'_>,
    watch: &Watch,
) -> Result<Steps, PlanError> {
    Ok(match keys.step.pitch(keys.limits, top, body) {
        Pitch::Even(step) => Steps::Even(step),
        Pitch::Listed { from, steps } => Steps::Listed { from, steps },
        Pitch::Scallop { height, steps: limits } => {
            let rule = ScallopRule { height, limits, deviation };
            let bounds = scallop_steps(surface, body, Spread::Levels, &rule, watch)?;
            Steps::Bounded(if keys.of_turns { bounds.for_turns() } else { bounds })
        }
    })
}

fn rounded(z: f64, unit: f64) -> f64 {
    (z / unit).round() * unit
}
