//! Z-level: loops at constant heights, from the top down.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::ToolBody;
use styluscam_toolpath::{Freedom, PlanError, Seam, Surface};
use styluscam_verify::{Contact, Height, OrderedPasses, Passes};

use super::facts::counted;
use super::levels::{self, LevelKeys};
use super::step::{Step, StepLimits};
use super::surface::{self, FollowsSurface, Task, Traced};
use super::{About, Areas, Context, Effort, Fact, OperationKind, PassContext, PassSpacing, Planned, Serves, Tabs};
use crate::{JobError, OperationKeys};

/// Loops at constant heights, from the top down.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ZLevel {
    /// Distance between levels.
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
    /// One more level at every level floor that no other level stands on: shoulders and pockets' floors at their exact height.
    #[serde(default)]
    pub levels_at_flats: bool,
    /// Direction from a loop's middle in which it begins, degrees from +X; where it is nearest when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "deg", "minimum" = -360.0, "maximum" = 360.0))]
    pub seam_direction_deg: Option<f64>,
    /// By how much that direction turns from level to level, degrees: 137.5 spreads the beginnings evenly.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "deg", "minimum" = -360.0, "maximum" = 360.0))]
    pub seam_spread_deg: Option<f64>,
    /// In which order loops of several areas are run: areas are apart by more than the tool's diameter. When left out by level
    /// in forming, else by area.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub order: Option<LevelOrder>,
    /// Angle of ramps along the wall from level to level, degrees: they leave no line of steps; straight down when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "deg", "minimum" = 0.1, "maximum" = 45.0))]
    pub ramp_angle_deg: Option<f64>,
    /// Tabs that hold the part while loops cut it out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-example" = "{ count = 4, width = 5.0, height = 1.5 }"))]
    pub tabs: Option<Tabs>,
}

/// Which loops come first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LevelOrder {
    /// All of a level before the next one: a sheet is formed evenly.
    ByLevel,
    /// Each area from the top down before the next one, where that is less air.
    ByArea,
}

impl ZLevel {
    pub(super) const ABOUT: About = About {
        purpose: "for walls",
        serves: Serves::Walls,
        starter: |passes| format!("step = {{ height = {:?} }}    # distance between levels\n", passes.pitch),
    };
}

impl ZLevel {
    fn limits(&self) -> StepLimits {
        StepLimits { least: self.step_min, most: self.step_max }
    }
}

impl OperationKind for ZLevel {
    fn check(&self, _common: &OperationKeys, path: &str) -> Result<(), JobError> {
        self.limits().check(&self.step, path)?; // ramps lead from any seam
        self.tabs.map_or(Ok(()), |tabs| tabs.check(path))
    }

    fn cuts_upright_walls(&self) -> bool {
        true
    }

    fn comes_back_up(&self) -> bool {
        self.order == Some(LevelOrder::ByArea)
    }

    fn plan(&self, context: &Context<'_>) -> Result<Planned, JobError> {
        surface::plan(self, context)
    }

    fn tabs(&self) -> Option<Tabs> {
        self.tabs
    }

    fn contact(&self) -> Contact {
        Contact::Touch
    }

    fn passes(&self, given: &PassContext<'_>) -> Passes {
        Passes::Ordered(OrderedPasses {
            scalar: Arc::new(Height),
            pitch: self.step.pitch(self.limits(), given.top, given.body),
            continuous: false,
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
            seconds_per_point: 80e-6, // the boundary of the envelope is searched at each point
        })
    }
}

impl FollowsSurface for ZLevel {
    /// Levels choose their own heights.
    fn tip_range(&self, _task: &Task<'_>) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }

    /// The higher ground.
    fn has_material_on_right(&self) -> bool {
        true
    }

    fn seam(&self) -> Seam {
        match (self.seam_direction_deg, self.seam_spread_deg) {
            (None, None) => Seam::Nearest,
            (first, spread) => {
                Seam::Bearing { first: first.unwrap_or(0.0).to_radians(), spread: spread.unwrap_or(0.0).to_radians() }
            }
        }
    }

    fn freedom<'a>(&self, task: &Task<'_>, _traced: &'a Traced) -> Freedom<'a> {
        let Context { scene, tool, .. } = *task.context;
        let default = if scene.sheet.is_some() { LevelOrder::ByLevel } else { LevelOrder::ByArea };
        match self.order.unwrap_or(default) {
            LevelOrder::ByLevel => Freedom::WithinGroups,
            LevelOrder::ByArea => {
                let thickness = scene.sheet.map_or(0.0, |sheet| sheet.thickness);
                Freedom::OfAreas { reach: tool.diameter() + 2.0 * thickness, inside_first: scene.sheet.is_some() }
            }
        }
    }

    fn ramp_slope(&self) -> Option<f64> {
        self.ramp_angle_deg.map(|angle| libm::tan(angle.to_radians()))
    }

    fn pitch(&self, body: &ToolBody) -> f64 {
        self.step.typical(self.limits(), body)
    }

    fn lowest_rest(&self, body: &ToolBody) -> f64 {
        self.step.typical(self.limits(), body)
    }

    fn trace(&self, task: &Task<'_>, surface: &Surface<'_>) -> Result<Traced, PlanError> {
        let (step, limits) = (&self.step, self.limits());
        let levels = LevelKeys { step, limits, at_flats: self.levels_at_flats, of_turns: false };
        levels::trace(&levels, task, surface)
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
