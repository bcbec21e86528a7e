//! Waterlines of the whole part, asked for by height.

use styluscam_motion::Watch;

use super::{z_levels, Floors, Grid};
use crate::{budget::LoopBudget, offset::Envelope, Pass, PlanError, Surface};

/// The loops at each of the `heights` (mm), by [`Pass::group`]; none where the tool meets nothing.
///
/// # Errors
/// Cancelled by `watch`.
pub fn waterlines(
    envelope: &Envelope<'_>,
    heights: &[f64],
    budget: &LoopBudget,
    watch: &Watch,
) -> Result<Vec<Pass>, PlanError> {
    let floors = Floors::of(envelope);
    let heights: Vec<f64> = heights.iter().map(|z| floors.raised(*z)).collect();
    let surface = Surface::whole(envelope);
    let Some(grid) = Grid::sample(&surface, budget.spacing, watch)? else { return Ok(Vec::new()) };
    z_levels(&surface, &grid, &heights, budget.shares.deviation, watch)
}
