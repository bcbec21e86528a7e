//! Pencil: passes along concave edges that the tool bridges.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::ToolBody;
use styluscam_toolpath::{
    forming::{pencil, PencilRule},
    Freedom, PlanError, Surface,
};
use styluscam_verify::{Contact, Passes};

use super::facts::counted;
use super::surface::{self, FollowsSurface, Task, Traced};
use super::{About, Areas, Context, Effort, Fact, OperationKind, PassContext, PassSpacing, Planned, Serves};
use crate::{JobError, OperationKeys};

/// Passes along concave edges and narrow fillets, where the tool touches two faces at once: they take what wider steps and a larger
/// tool leave in the corners.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pencil {
    /// The least angle by which the two faces turn away from each other where the tool touches them, degrees.
    #[serde(default = "least_turn_deg")]
    #[schemars(extend("x-unit" = "deg", "minimum" = 6.0, "maximum" = 175.0))]
    pub least_turn_deg: f64,
}

impl Pencil {
    pub(super) const ABOUT: About = About {
        purpose: "for concave edges",
        serves: Serves::OnRequest,
        starter: |_| "least_turn_deg = 15.0      # between the faces that the tool touches\n".to_owned(),
    };
}

impl OperationKind for Pencil {
    fn check(&self, _common: &OperationKeys, _path: &str) -> Result<(), JobError> {
        Ok(()) // its only key stands alone
    }

    /// At the foot of upright walls the tool touches the floor too.
    fn cuts_upright_walls(&self) -> bool {
        true
    }

    fn owes_faces(&self) -> bool {
        false
    }

    fn plan(&self, context: &Context<'_>) -> Result<Planned, JobError> {
        surface::plan(self, context)
    }

    fn contact(&self) -> Contact {
        Contact::Touch
    }

    fn passes(&self, _given: &PassContext<'_>) -> Passes {
        Passes::Unordered { reason: "they run where the tool touches two faces, and not over all of them" }
    }

    fn spacing(&self) -> Option<PassSpacing> {
        None // a pass lies where the part has an edge
    }

    fn effort(&self, _areas: &Areas) -> Option<Effort> {
        None
    }
}

impl FollowsSurface for Pencil {
    fn has_material_on_right(&self) -> bool {
        true
    }

    fn freedom<'a>(&self, _task: &Task<'_>, _traced: &'a Traced) -> Freedom<'a> {
        Freedom::OfRows { sets: &[], is_reversible: true, reach: 0.0 }
    }

    fn pitch(&self, body: &ToolBody) -> f64 {
        body.max_radius()
    }

    fn trace(&self, task: &Task<'_>, surface: &Surface<'_>) -> Result<Traced, PlanError> {
        let least_turn = self.least_turn_deg.to_radians();
        let rule = PencilRule { least_turn, spacing: task.context.node_spacing(), narrow: task.narrow() };
        let passes = pencil(surface, task.body, &rule, task.budget.deviation, task.context.watch)?;
        if passes.is_empty() {
            return Err(PlanError::NothingReached(
                " where it touches two at once: there is no concave edge".to_owned(),
            ));
        }
        Ok(Traced::new(passes, task.context.common.smallest_feature))
    }

    fn words(&self, groups: usize, passes: usize) -> String {
        format!("{} along {}", counted(passes, "pass", "passes"), counted(groups, "concave edge", "concave edges"))
    }

    fn facts(&self, groups: usize, traced: &Traced) -> Vec<Fact> {
        vec![Fact::count(groups, "concave edge", "concave edges"), Fact::count(traced.passes.len(), "pass", "passes")]
    }

    fn note(&self, _groups: usize, passes: usize) -> String {
        counted(passes, "pass", "passes")
    }
}

fn least_turn_deg() -> f64 {
    15.0
}
