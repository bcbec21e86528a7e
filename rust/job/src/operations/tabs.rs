//! Tabs: what holds the part until it is cut out.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_motion::{Arc, Move};
use styluscam_toolpath::{lifted, tabs, Pass, Tab, TabError, TabNumber, TabRule};
use styluscam_verify::TabShape;

use super::{Context, Fact};
use crate::numbers::shown;
use crate::JobError;

/// A tool is as wide as it gets where its radius is less by no more, mm.
const SAME_RADIUS: f64 = 1e-6;

/// Tabs that hold the part: the tool is lifted over them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tabs {
    /// How many each loop has, evenly along it; instead of `spacing`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("minimum" = 1, "maximum" = 100))]
    pub count: Option<u32>,
    /// How far apart they are at most, mm along the path; instead of `count`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm", "minimum" = 1.0, "maximum" = 10000.0))]
    pub spacing: Option<f64>,
    /// How wide each is at least, mm along the wall.
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.1, "maximum" = 1000.0))]
    pub width: f64,
    /// How high each is above the lowest loop of its wall, mm.
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.01, "maximum" = 1000.0))]
    pub height: f64,
    /// Angle at which the tool goes up and down beside each, degrees.
    #[serde(default = "slope")]
    #[schemars(extend("x-unit" = "deg", "minimum" = 1.0, "maximum" = 60.0))]
    pub slope_deg: f64,
}

fn slope() -> f64 {
    30.0
}

impl Tabs {
    /// Checks that their number is stated once; `path` is the operation's.
    pub(super) fn check(&self, path: &str) -> Result<(), JobError> {
        let message = match (self.count, self.spacing) {
            (Some(_), None) | (None, Some(_)) => return Ok(()),
            (Some(_), Some(_)) => "count and spacing both state how many tabs there are",
            (None, None) => "neither count nor spacing states how many tabs there are",
        };
        Err(JobError::document("conflict", format!("{path}.tabs"), message, "state one of them"))
    }

    fn number(&self) -> TabNumber {
        match (self.count, self.spacing) {
            (None, Some(most)) => TabNumber::Spacing(most),
            (count, _) => TabNumber::Count(count.unwrap_or_default() as usize),
        }
    }

    fn tan(&self) -> f64 {
        libm::tan(self.slope_deg.to_radians())
    }

    /// What the verifier is to expect.
    pub(crate) fn expected(&self) -> TabShape {
        let (count, spacing) = (self.count.map(|count| count as usize), self.spacing);
        TabShape { count, spacing, width: self.width, height: self.height, slope: self.tan() }
    }

    /// Those of an operation's passes.
    pub(super) fn planned(&self, context: &Context<'_>, passes: &[Pass]) -> Result<Planned, JobError> {
        let at = format!("{}.tabs", context.path);
        if context.scene.sheet.is_some() {
            let message = "tabs hold what is cut out, and this job forms a sheet";
            return Err(JobError::document("conflict", at, message, "remove tabs"));
        }
        let radius = 0.5 * context.tool.diameter();
        let rule = TabRule { number: self.number(), width: self.width, height: self.height, slope: self.tan(), radius };
        let found = tabs(passes, &rule).map_err(|error| {
            let hint = match error {
                TabError::NoLoop => "remove tabs",
                TabError::TooShort { .. } => "state fewer, narrower or lower tabs, or select the faces of other loops",
                TabError::Leaning { .. } => "select upright faces, or remove tabs",
            };
            JobError::document("tabs", at, error.to_string(), hint)
        })?;
        let highest = found.iter().map(|tab| tab.top).fold(f64::NEG_INFINITY, f64::max);
        let wall = context.scene.top - highest;
        if wall <= 0.0 || context.tool.cutter().at_height(wall).0 < radius - SAME_RADIUS {
            let message = format!("the tool, lifted over tabs to Z{}, is above the wall", shown(highest));
            return Err(JobError::document(
                "tabs",
                format!("{}.tabs.height", context.path),
                message,
                "lower tabs.height",
            ));
        }
        Ok(Planned { tabs: found, rule })
    }
}

/// Tabs with their places.
pub struct Planned {
    tabs: Vec<Tab>,
    rule: TabRule,
}

impl Planned {
    /// The moves, lifted over them.
    pub fn lifted(&self, context: &Context<'_>, moves: &[Move]) -> Vec<Move> {
        let machine = context.machine;
        let planes = machine.arc.as_ref().map_or(&[][..], |rules| &rules.planes);
        let takes = |ends: [[f64; 3]; 2], arc: &Arc| {
            planes.contains(&arc.plane) && machine.posts_arc(ends, arc, context.reference_height)
        };
        lifted(moves, (&self.tabs, &self.rule), &takes)
    }

    pub fn fact(&self) -> Fact {
        Fact::count(self.tabs.len(), "tab", "tabs")
    }
}
