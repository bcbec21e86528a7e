//! Spiral: one descent along the walls, without the marks that steps between levels leave.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::ToolBody;
use styluscam_toolpath::{forming::spirals, PlanError, Sense, Surface};
use styluscam_verify::{Contact, Height, OrderedPasses, Passes};

use super::facts::counted;
use super::levels::{self, LevelKeys};
use super::step::{Step, StepLimits};
use super::surface::{self, FollowsSurface, Task, Traced};
use super::{About, Areas, Context, Effort, Fact, OperationKind, PassContext, PassSpacing, Planned, Serves};
use crate::{JobError, OperationKeys};

/// One descent along the walls: a loop at the top, turns that fall evenly along their length, a loop at the bottom. Where a
/// wall's loops part (two pockets in one cup) each part has a spiral of its own. It runs one way: the higher ground on its right.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spiral {
    /// How far a turn goes down.
    #[schemars(extend("x-example" = "{ height = 0.5 }"))]
    pub step: Step,
    /// Smallest step by scallop, mm: gentler slopes keep it and a larger scallop; what the scallop allows at 10 degrees when left
    /// out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-advanced" = true, "x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 100.0))]
    pub step_min: Option<f64>,
    /// Largest step by scallop, mm; the tool's radius when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-advanced" = true, "x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 100.0))]
    pub step_max: Option<f64>,
}

impl Spiral {
    pub(super) const ABOUT: About = About {
        purpose: "for walls without step marks",
        serves: Serves::OnRequest,
        starter: |passes| format!("step = {{ height = {:?} }}    # how far a turn goes down\n", passes.pitch),
    };
}

impl Spiral {
    fn limits(&self) -> StepLimits {
        StepLimits { least: self.step_min, most: self.step_max }
    }
}

impl OperationKind for Spiral {
    fn check(&self, common: &OperationKeys, path: &str) -> Result<(), JobError> {
        self.limits().check(&self.step, path)?;
        if surface::sense(common, self.has_material_on_right()) != Sense::Reversed {
            return Ok(()); // levels may alternate: a spiral has none
        }
        let message =
            "a spiral runs with the higher ground on its right, which is the other direction with this spindle";
        Err(JobError::document("conflict", format!("{path}.direction"), message, "set direction = \"same\""))
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

    fn passes(&self, given: &PassContext<'_>) -> Passes {
        Passes::Ordered(OrderedPasses {
            scalar: Arc::new(Height),
            pitch: self.step.pitch(self.limits(), given.top, given.body),
            continuous: true,
            smallest_feature: given.smallest_feature,
        })
    }

    fn spacing(&self) -> Option<PassSpacing> {
        self.step.even().map(|pitch| PassSpacing::Height { pitch })
    }

    fn effort(&self, areas: &Areas) -> Option<Effort> {
        let pitch = self.step.even()?;
        Some(Effort {
            key: "step",
            pitch,
            length: areas.elevation / pitch,
            samples_grid: true,
            seconds_per_point: 160e-6, // the loops of levels first, then the descents between them
        })
    }
}

impl FollowsSurface for Spiral {
    /// Levels choose their own heights.
    fn tip_range(&self, _task: &Task<'_>) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }

    fn pitch(&self, body: &ToolBody) -> f64 {
        self.step.typical(self.limits(), body)
    }

    fn lowest_rest(&self, body: &ToolBody) -> f64 {
        self.step.typical(self.limits(), body)
    }

    /// The higher ground.
    fn has_material_on_right(&self) -> bool {
        true
    }

    /// A spiral that is turned round would go up: `check` refuses what asks for that.
    fn sense(&self, _common: &OperationKeys) -> Sense {
        Sense::Forward
    }

    fn trace(&self, task: &Task<'_>, surface: &Surface<'_>) -> Result<Traced, PlanError> {
        let asked = LevelKeys { step: &self.step, limits: self.limits(), at_flats: false, of_turns: true };
        let levels = levels::trace(&asked, task, surface)?;
        let (deviation, longest) = (task.budget.deviation, task.context.node_spacing());
        let passes = spirals(surface, &levels.passes, deviation, longest, task.context.watch)?;
        Ok(Traced { passes, ..levels })
    }

    fn words(&self, _groups: usize, passes: usize) -> String {
        counted(passes, "descent", "descents")
    }

    fn facts(&self, _groups: usize, traced: &Traced) -> Vec<Fact> {
        let turning = traced.passes.iter().filter(|pass| pass.descends()).count();
        let level = traced.passes.len() - turning;
        let spirals = (turning > 0).then(|| Fact::count(turning, "spiral", "spirals"));
        let levels = (level > 0).then(|| Fact::count(level, "level pass", "level passes"));
        let feature =
            Fact::length("smallest_feature", traced.smallest_feature, "no loop is missed that holds a disc of");
        spirals.into_iter().chain(levels).chain([feature]).collect()
    }

    fn note(&self, _groups: usize, passes: usize) -> String {
        counted(passes, "descent", "descents")
    }
}
