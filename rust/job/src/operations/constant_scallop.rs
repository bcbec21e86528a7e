//! Constant scallop: contours over the surface between which the same scallop stands everywhere.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::ToolBody;
use styluscam_toolpath::{
    forming::{constant_scallop, Contours},
    Freedom, PlanError, Surface,
};
use styluscam_verify::{Contact, Passes};

use super::facts::counted;
use super::surface::{self, FollowsSurface, Task, Traced};
use super::{About, Areas, Context, Effort, Fact, OperationKind, PassContext, PassSpacing, Planned, Serves};
use crate::{JobError, OperationKeys};

/// Contours that are no farther apart than so many of their distances on a floor are neighbours.
const NEIGHBOURS: f64 = 1.5;

/// Contours over the surface, from its border inwards, between which the same scallop stands everywhere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ConstantScallop {
    /// The scallop between passes, mm: their distances follow from slope and curvature of the surface and from the tool.
    #[schemars(extend("x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 10.0, "x-example" = "0.02"))]
    pub scallop: f64,
}

impl ConstantScallop {
    pub(super) const ABOUT: About = About {
        purpose: "for freeform surfaces",
        serves: Serves::OnRequest,
        starter: |_| "scallop = 0.02             # height of the ridges between passes\n".to_owned(),
    };
}

impl OperationKind for ConstantScallop {
    fn check(&self, _common: &OperationKeys, _path: &str) -> Result<(), JobError> {
        Ok(()) // its only key stands alone
    }

    /// In plan upright walls have no extent.
    fn cuts_upright_walls(&self) -> bool {
        false
    }

    fn plan(&self, context: &Context<'_>) -> Result<Planned, JobError> {
        surface::plan(self, context)
    }

    fn contact(&self) -> Contact {
        Contact::Touch
    }

    fn passes(&self, _given: &PassContext<'_>) -> Passes {
        Passes::Covering { scallop: self.scallop }
    }

    fn spacing(&self) -> Option<PassSpacing> {
        None // neither in height nor across straight rows
    }

    /// The distances are not known before.
    fn effort(&self, _areas: &Areas) -> Option<Effort> {
        None
    }
}

impl FollowsSurface for ConstantScallop {
    /// What lies farther from the border.
    fn has_material_on_right(&self) -> bool {
        true
    }

    fn freedom<'a>(&self, task: &Task<'_>, _traced: &'a Traced) -> Freedom<'a> {
        Freedom::OfAreas { reach: NEIGHBOURS * self.pitch(task.body), inside_first: false }
    }

    fn links_across(&self) -> bool {
        true
    }

    fn pitch(&self, body: &ToolBody) -> f64 {
        body.chord(0.0, self.scallop).min(body.max_radius())
    }

    fn trace(&self, task: &Task<'_>, surface: &Surface<'_>) -> Result<Traced, PlanError> {
        let contours = Contours { scallop: self.scallop, spacing: task.context.node_spacing(), narrow: task.narrow() };
        let passes = constant_scallop(surface, task.body, &contours, task.budget.deviation, task.context.watch)?;
        if passes.is_empty() {
            return Err(PlanError::NothingReached(task.why_nothing()));
        }
        Ok(Traced::new(passes, task.context.common.smallest_feature))
    }

    fn words(&self, groups: usize, passes: usize) -> String {
        format!("{} on {}", counted(passes, "pass", "passes"), counted(groups, "contour", "contours"))
    }

    fn facts(&self, groups: usize, traced: &Traced) -> Vec<Fact> {
        vec![Fact::count(groups, "contour", "contours"), Fact::count(traced.passes.len(), "pass", "passes")]
    }

    fn note(&self, groups: usize, passes: usize) -> String {
        format!("{groups} contours, {passes} passes")
    }
}
