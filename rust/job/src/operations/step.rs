//! How far one level lies below the other.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::ToolBody;
use styluscam_verify::Pitch;

use crate::numbers::shown;
use crate::JobError;

/// Walls that are less steep, degrees, are floors to a step by scallop: rows suit them better, and levels would lie ever closer.
const FLOOR_DEG: f64 = 10.0;

/// Steps of a list at most: more than anybody writes, and few enough to be searched at every position.
const MOST_STEPS: usize = 1000;

/// What sets the distance between levels, or between turns that go down.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Step {
    /// This distance, mm.
    Height(#[schemars(extend("x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 100.0))] f64),
    /// No more than this scallop between them, mm: steps follow from the wall's slope and curvature and from the tool.
    #[schemars(extend("x-not-of" = ["pocket"]))]
    Scallop(#[schemars(extend("x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 10.0))] f64),
    /// These distances one after the other, mm, from `z_top` or the sheet's (the part's) highest point down; the last one again
    /// and again.
    List(#[schemars(length(min = 1), extend("x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 100.0))] Vec<f64>),
}

/// The limits of a step by scallop, as the job states them, mm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepLimits {
    /// The smallest.
    pub least: Option<f64>,
    /// The largest.
    pub most: Option<f64>,
}

impl StepLimits {
    /// Checks that a list has steps, and that limits are stated with a scallop only, and in their order; `path` is the
    /// operation's.
    ///
    /// # Errors
    /// An empty list, limits of another step, or the smallest above the largest.
    pub fn check(self, step: &Step, path: &str) -> Result<(), JobError> {
        if let Step::List(steps) = step {
            let hint = "list the distances between levels: [0.2, 0.5]; the last one goes on";
            if steps.is_empty() {
                return Err(JobError::document("empty", format!("{path}.step.list"), "the list has no step", hint));
            }
            if steps.len() > MOST_STEPS {
                let message = format!("the list has {} steps: at most {MOST_STEPS}", steps.len());
                return Err(JobError::document("out-of-range", format!("{path}.step.list"), message, hint));
            }
        }
        let stated = [("step_min", self.least), ("step_max", self.most)].into_iter().find(|(_, limit)| limit.is_some());
        let Some((key, _)) = stated else { return Ok(()) };
        if !matches!(step, Step::Scallop(_)) {
            let message = format!("{key} limits steps by scallop, and the step is none");
            let hint = format!("remove {key}, or set step = {{ scallop = 0.01 }}");
            return Err(JobError::document("conflict", format!("{path}.{key}"), message, hint));
        }
        match (self.least, self.most) {
            (Some(least), Some(most)) if least > most => {
                let message = format!("step_min = {} is above step_max = {}", shown(least), shown(most));
                Err(JobError::document("conflict", format!("{path}.step_min"), message, "swap them"))
            }
            (Some(_) | None, Some(_) | None) => Ok(()),
        }
    }

    /// The smallest and the largest step for a scallop of `height`, mm, of a tool with its sheet: what is not stated is what the
    /// scallop allows on a wall of [`FLOOR_DEG`], and the tool's radius.
    fn of(self, height: f64, body: &ToolBody) -> [f64; 2] {
        let slope = FLOOR_DEG.to_radians();
        let most = self.most.unwrap_or_else(|| body.max_radius());
        let gentle = body.scallop_travel(slope, height, [1.0, 0.0], 0.0) * libm::sin(slope);
        [self.least.unwrap_or(gentle).min(most), most]
    }
}

impl Step {
    /// The one distance of steps that are all alike, mm.
    #[must_use]
    pub fn even(&self) -> Option<f64> {
        match self {
            Self::Height(height) => Some(*height),
            Self::Scallop(_) | Self::List(_) => None,
        }
    }

    /// A step that stands for all of them, mm: of a scallop, that on a wall of 45 degrees.
    #[must_use]
    pub fn typical(&self, limits: StepLimits, body: &ToolBody) -> f64 {
        match self {
            Self::Height(height) => *height,
            Self::List(steps) => steps.last().copied().unwrap_or_default(),
            Self::Scallop(height) => {
                let slope = std::f64::consts::FRAC_PI_4;
                let [least, most] = limits.of(*height, body);
                (body.scallop_travel(slope, *height, [1.0, 0.0], 0.0) * libm::sin(slope)).clamp(least, most)
            }
        }
    }

    /// What the verifier is to expect, where lists count from `top`.
    #[must_use]
    pub fn pitch(&self, limits: StepLimits, top: f64, body: &ToolBody) -> Pitch {
        match self {
            Self::Height(height) => Pitch::Even(*height),
            Self::List(steps) => Pitch::Listed { from: top, steps: steps.clone() },
            Self::Scallop(height) => Pitch::Scallop { height: *height, steps: limits.of(*height, body) },
        }
    }
}
