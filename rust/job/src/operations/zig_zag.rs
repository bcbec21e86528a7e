//! Zig-zag: parallel rows over the surface.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::ToolBody;
use styluscam_toolpath::{
    forming::{scallop_steps, zig_zag, Rows, ScallopRule, Spread, Turn},
    Pass, PlanError, Surface,
};
use styluscam_verify::{Across, Contact, OrderedPasses, Passes, Pitch};

use super::facts::counted;
use super::surface::{self, FollowsSurface, Task, Traced};
use super::{About, Areas, Context, Effort, Fact, OperationKind, PassContext, PassSpacing, Planned, Serves};
use crate::{JobError, OperationKeys};

/// Parallel rows over the surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ZigZag {
    /// Distance between rows in plan, mm.
    #[schemars(extend("x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 100.0, "x-example" = "0.5"))]
    pub stepover: f64,
    /// No more than this scallop between rows, mm: they lie closer than the stepover where that takes it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 10.0))]
    pub scallop: Option<f64>,
    /// Smallest distance between rows by scallop, mm: steeper walls keep it and a larger scallop; a tenth of the stepover when
    /// left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-advanced" = true, "x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 100.0))]
    pub stepover_min: Option<f64>,
    /// Direction of rows from +X, degrees.
    #[serde(default)]
    #[schemars(extend("x-unit" = "deg", "minimum" = -360.0, "maximum" = 360.0))]
    pub angle_deg: f64,
    /// A second set of rows over the same faces, across the first.
    #[serde(default)]
    pub cross: bool,
    /// Angle from the first set of rows to the second, degrees; 90 when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-advanced" = true, "x-unit" = "deg", "minimum" = 10.0, "maximum" = 170.0))]
    pub cross_angle_deg: Option<f64>,
    /// How the tool turns from a row to the next.
    #[serde(default)]
    pub turns: Turns,
    /// Radius of looped turns, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 100.0))]
    pub turn_radius: Option<f64>,
}

/// The shape of the path from a row to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Turns {
    /// A line along the surface.
    #[default]
    Straight,
    /// Without a corner, along arcs of half the distance between the rows; where none fits, straight.
    Rounded,
    /// Without a corner, along a loop of `turn_radius` beyond the ends of the rows; where none fits, straight.
    Looped,
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

impl ZigZag {
    /// Share of the stepover that is the smallest distance between rows where none is stated.
    const CLOSEST: f64 = 0.1;

    /// Angle between both sets of rows where none is stated, degrees.
    const ACROSS_DEG: f64 = 90.0;

    /// Directions of the sets of rows from +X, rad: the first, and where there is one the second.
    fn angles(&self) -> (f64, Option<f64>) {
        let across = self.angle_deg + self.cross_angle_deg.unwrap_or(Self::ACROSS_DEG);
        (self.angle_deg.to_radians(), self.cross.then(|| across.to_radians()))
    }

    /// The passes of one set of rows.
    fn rows(&self, angle: f64, task: &Task<'_>, surface: &Surface<'_>) -> Result<Vec<Pass>, PlanError> {
        let closer = match self.pitch_of_rows() {
            Pitch::Even(_) | Pitch::Listed { .. } => None,
            Pitch::Scallop { height, steps: limits } => {
                let rule = ScallopRule { height, limits };
                Some(scallop_steps(surface, task.body, Spread::Rows(angle), &rule, task.context.watch)?)
            }
        };
        let rows = Rows {
            angle,
            stepover: self.stepover,
            closer,
            spacing: task.context.node_spacing(),
            narrow: task.narrow(),
        };
        zig_zag(surface, &rows, task.budget.deviation, task.context.watch)
    }

    /// How far apart rows lie.
    fn pitch_of_rows(&self) -> Pitch {
        let least = self.stepover_min.unwrap_or(Self::CLOSEST * self.stepover);
        match self.scallop {
            None => Pitch::Even(self.stepover),
            Some(height) => Pitch::Scallop { height, steps: [least, self.stepover] },
        }
    }
}

impl OperationKind for ZigZag {
    fn check(&self, _common: &OperationKeys, path: &str) -> Result<(), JobError> {
        match (self.turns, self.turn_radius) {
            (Turns::Looped, None) => {
                let (message, hint) = ("looped turns have a radius", "state turn_radius, mm");
                return Err(JobError::document("missing", format!("{path}.turn_radius"), message, hint));
            }
            (Turns::Straight | Turns::Rounded, Some(_)) => {
                let (message, hint) =
                    ("turn_radius is the radius of looped turns", "remove it, or set turns = \"looped\"");
                return Err(JobError::document("conflict", format!("{path}.turn_radius"), message, hint));
            }
            (Turns::Looped, Some(_)) | (Turns::Straight | Turns::Rounded, None) => {}
        }
        if self.cross_angle_deg.is_some() && !self.cross {
            let (message, hint) =
                ("cross_angle_deg is the angle of a second set of rows", "remove it, or set cross = true");
            return Err(JobError::document("conflict", format!("{path}.cross_angle_deg"), message, hint));
        }
        let Some(least) = self.stepover_min else { return Ok(()) };
        let (message, hint) = if self.scallop.is_none() {
            ("stepover_min limits rows by scallop, and no scallop is stated", "remove it, or set scallop")
        } else if least > self.stepover {
            ("stepover_min is above stepover, which is the largest distance", "swap them")
        } else {
            return Ok(());
        };
        Err(JobError::document("conflict", format!("{path}.stepover_min"), message, hint))
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

    fn passes(&self, given: &PassContext<'_>) -> Passes {
        let set = |direction_rad| OrderedPasses {
            scalar: Arc::new(Across { direction_rad }),
            pitch: self.pitch_of_rows(),
            continuous: false,
            smallest_feature: given.smallest_feature,
        };
        match self.angles() {
            (angle, None) => Passes::Ordered(set(angle)),
            (angle, Some(across)) => Passes::Crossed([set(angle), set(across)]),
        }
    }

    fn spacing(&self) -> Option<PassSpacing> {
        let across = PassSpacing::Across { pitch: self.stepover, direction_deg: self.angle_deg };
        Some(across).filter(|_| self.scallop.is_none())
    }

    fn effort(&self, areas: &Areas) -> Option<Effort> {
        // of rows by scallop the distances are not known before
        let key = if self.scallop.is_none() { "stepover" } else { return None };
        Some(Effort {
            key,
            pitch: self.stepover,
            length: if self.cross { 2.0 } else { 1.0 } * areas.plan / self.stepover,
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

    fn turn(&self) -> Option<Turn> {
        match self.turns {
            Turns::Straight => None,
            Turns::Rounded => Some(Turn::Rounded),
            Turns::Looped => self.turn_radius.map(Turn::Looped),
        }
    }

    fn pitch(&self, _body: &ToolBody) -> f64 {
        self.stepover
    }

    fn lowest_rest(&self, _body: &ToolBody) -> f64 {
        0.0
    }

    fn trace(&self, task: &Task<'_>, surface: &Surface<'_>) -> Result<Traced, PlanError> {
        let (angle, across) = self.angles();
        let mut passes = self.rows(angle, task, surface)?;
        if let Some(across) = across {
            let count = passes.last().map_or(0, |last| last.group + 1);
            let crossing = self.rows(across, task, surface)?;
            passes.extend(crossing.into_iter().map(|pass| Pass { group: count + pass.group, ..pass }));
        }
        if passes.is_empty() {
            return Err(PlanError::NothingReached(task.why_nothing()));
        }
        Ok(Traced { passes, smallest_feature: task.context.common.smallest_feature })
    }

    fn words(&self, groups: usize, passes: usize) -> String {
        let directions = if self.cross { " in two directions" } else { "" };
        format!("{} on {}{directions}", counted(passes, "pass", "passes"), counted(groups, "row", "rows"))
    }

    fn facts(&self, groups: usize, traced: &Traced) -> Vec<Fact> {
        vec![Fact::count(groups, "row", "rows"), Fact::count(traced.passes.len(), "pass", "passes")]
    }

    fn note(&self, groups: usize, passes: usize) -> String {
        format!("{groups} rows, {passes} passes")
    }
}
