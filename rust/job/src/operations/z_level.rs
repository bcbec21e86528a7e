//! Z-level: loops at constant heights, from the top down.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_toolpath::{
    forming::{
        left_out, levels, raise_last, selected_range, with_levels_at, z_levels, z_levels_beside, Floors, Grid,
        LevelRange,
    },
    PlanError, Surface,
};
use styluscam_verify::{Contact, Height, OrderedPasses, Passes};

use super::facts::counted;
use super::surface::{self, FollowsSurface, Task, Traced};
use super::{About, Areas, Context, Effort, Fact, OperationKind, PassSpacing, Planned, Serves};
use crate::{JobError, OperationKeys};

/// Loops at constant heights, from the top down.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ZLevel {
    /// Distance between levels.
    #[schemars(extend("x-example" = "{ height = 0.5 }"))]
    pub step: Step,
}

/// What sets the distance between levels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Step {
    /// This distance, mm.
    Height(#[schemars(extend("x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 100.0))] f64),
}

impl ZLevel {
    pub(super) const ABOUT: About = About {
        purpose: "for walls",
        serves: Serves::Walls,
        starter: |passes| format!("step = {{ height = {:?} }}    # distance between levels\n", passes.pitch),
    };

    fn height(&self) -> f64 {
        let Step::Height(height) = self.step;
        height
    }
}

impl OperationKind for ZLevel {
    fn check(&self, _common: &OperationKeys, _path: &str) -> Result<(), JobError> {
        Ok(()) // its only key stands alone
    }

    fn cuts_upright_walls(&self) -> bool {
        true
    }

    fn plan(&self, context: &Context<'_>) -> Result<Planned, JobError> {
        surface::plan(self, context)
    }

    fn contact(&self) -> Contact {
        Contact::Touch
    }

    fn passes(&self, smallest_feature: f64) -> Passes {
        let scalar = Arc::new(Height);
        Passes::Ordered(OrderedPasses { scalar, step: self.height(), continuous: false, smallest_feature })
    }

    fn spacing(&self) -> Option<PassSpacing> {
        Some(PassSpacing::Height { pitch: self.height() })
    }

    fn effort(&self, areas: &Areas) -> Option<Effort> {
        Some(Effort {
            key: "step",
            pitch: self.height(),
            length: areas.elevation / self.height(),
            samples_grid: true,
            seconds_per_point: 80e-6, // the boundary of the envelope is searched at each point
        })
    }
}

impl FollowsSurface for ZLevel {
    /// Levels choose their own heights.
    fn tip_range(&self, _task: &Task<'_>) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }

    fn pitch(&self) -> f64 {
        self.height()
    }

    fn lowest_rest(&self) -> f64 {
        self.height()
    }

    fn trace(&self, task: &Task<'_>, surface: &Surface<'_>) -> Result<Traced, PlanError> {
        let (watch, deviation) = (task.context.watch, task.budget.deviation);
        let nothing = || PlanError::NothingReached(task.why_nothing());
        let grid = Grid::sample(surface, task.context.node_spacing(), watch)?.ok_or_else(nothing)?;
        let resolution = task.context.machine.resolution_mm();
        let (lowest, highest) = selected_range(surface, &grid, resolution, watch)?.ok_or_else(nothing)?;
        // the flat top lies margin below what the envelope shows
        let top = task.context.heights.top.unwrap_or_else(|| rounded(highest - task.budget.margin, resolution));
        let bottom = task.context.heights.bottom;
        let range = LevelRange { top, bottom, reachable: lowest, step: self.height(), resolution };
        let floors = Floors::of(surface.envelope());
        let heights = levels(&range, &floors)?;
        let mut passes = z_levels(surface, &grid, &heights, deviation, watch)?;
        let bands = left_out(surface, (&heights, &passes), grid.spacing(), watch)?;
        let mut more = with_levels_at(&heights, &bands, &range, &floors).unwrap_or_else(|| heights.clone());
        let is_at =
            |z: f64| passes.iter().flat_map(|pass| pass.points.first()).any(|p| (p.tip.z - z).abs() < resolution);
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
        Ok(Traced { passes, smallest_feature: grid.smallest_feature() })
    }

    fn words(&self, groups: usize, passes: usize) -> String {
        format!("{} on {}", counted(passes, "loop", "loops"), counted(groups, "level", "levels"))
    }

    fn facts(&self, groups: usize, traced: &Traced) -> Vec<Fact> {
        vec![
            Fact::count(groups, "level", "levels"),
            Fact::count(traced.passes.len(), "loop", "loops"),
            Fact::length("smallest_feature", traced.smallest_feature, "no loop is missed that holds a disc of"),
        ]
    }

    fn note(&self, groups: usize, passes: usize) -> String {
        format!("{groups} levels, {passes} passes")
    }
}

fn rounded(z: f64, unit: f64) -> f64 {
    (z / unit).round() * unit
}
