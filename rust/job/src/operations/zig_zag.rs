//! Zig-zag: parallel rows over the surface.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_toolpath::{
    forming::{zig_zag, Rows},
    PlanError, Surface,
};
use styluscam_verify::{Across, Contact, OrderedPasses, Passes};

use super::facts::counted;
use super::surface::{self, FollowsSurface, Task, Traced};
use super::{About, Areas, Context, Effort, Fact, OperationKind, PassSpacing, Planned, Serves};
use crate::{JobError, OperationKeys};

/// Parallel rows over the surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ZigZag {
    /// Distance between rows in plan, mm.
    #[schemars(extend("x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 100.0, "x-example" = "0.5"))]
    pub stepover: f64,
    /// Direction of rows from +X, degrees.
    #[serde(default)]
    #[schemars(extend("x-unit" = "deg", "minimum" = -360.0, "maximum" = 360.0))]
    pub angle_deg: f64,
}

impl ZigZag {
    pub(super) const ABOUT: About = About {
        purpose: "for floors",
        serves: Serves::Floors,
        starter: |passes| {
            format!(
                "stepover = {:?}              # distance between rows\nangle_deg = {:?}             # their direction\n",
                passes.pitch, passes.angle_deg
            )
        },
    };
}

impl OperationKind for ZigZag {
    fn check(&self, _common: &OperationKeys, _path: &str) -> Result<(), JobError> {
        Ok(()) // any direction goes with any distance
    }

    /// Rows pass walls at one height only.
    fn cuts_upright_walls(&self) -> bool {
        false
    }

    fn plan(&self, context: &Context<'_>) -> Result<Planned, JobError> {
        surface::plan(self, context)
    }

    fn contact(&self) -> Contact {
        Contact::Touch
    }

    fn passes(&self, smallest_feature: f64) -> Passes {
        let scalar = Arc::new(Across { direction_rad: self.angle_deg.to_radians() });
        Passes::Ordered(OrderedPasses { scalar, step: self.stepover, continuous: false, smallest_feature })
    }

    fn spacing(&self) -> Option<PassSpacing> {
        Some(PassSpacing::Across { pitch: self.stepover, direction_deg: self.angle_deg })
    }

    fn effort(&self, areas: &Areas) -> Option<Effort> {
        Some(Effort {
            key: "stepover",
            pitch: self.stepover,
            length: areas.plan / self.stepover,
            samples_grid: false,
            seconds_per_point: 15e-6, // the envelope is asked for its height at a known position
        })
    }
}

impl FollowsSurface for ZigZag {
    /// What lies at the top is formed within the tolerance above it.
    fn tip_range(&self, task: &Task<'_>) -> [f64; 2] {
        let tolerance = task.context.common.tolerance;
        [task.context.heights.bottom, task.context.heights.top.map_or(f64::INFINITY, |z| z + tolerance)]
    }

    /// Rows go on to the left of their direction.
    fn has_material_on_right(&self) -> bool {
        false
    }

    fn pitch(&self) -> f64 {
        self.stepover
    }

    fn lowest_rest(&self) -> f64 {
        0.0
    }

    fn trace(&self, task: &Task<'_>, surface: &Surface<'_>) -> Result<Traced, PlanError> {
        let rows = Rows {
            angle: self.angle_deg.to_radians(),
            stepover: self.stepover,
            spacing: task.context.node_spacing(),
            narrow: task.narrow(),
        };
        let passes = zig_zag(surface, &rows, task.budget.deviation, task.context.watch)?;
        if passes.is_empty() {
            return Err(PlanError::NothingReached(task.why_nothing()));
        }
        Ok(Traced { passes, smallest_feature: task.context.common.smallest_feature })
    }

    fn words(&self, groups: usize, passes: usize) -> String {
        format!("{} on {}", counted(passes, "pass", "passes"), counted(groups, "row", "rows"))
    }

    fn facts(&self, groups: usize, traced: &Traced) -> Vec<Fact> {
        vec![Fact::count(groups, "row", "rows"), Fact::count(traced.passes.len(), "pass", "passes")]
    }

    fn note(&self, groups: usize, passes: usize) -> String {
        format!("{groups} rows, {passes} passes")
    }
}
