//! Meridian: one path from the axis outwards, on a part that the spindle turns.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::ToolBody;
use styluscam_motion::{Move, MoveKind};
use styluscam_post::machine::FeedMode;
use styluscam_toolpath::{
    forming::{over_line, roundness, Roundness},
    Pass, PlanError, Sense, Surface,
};
use styluscam_verify::{Contact, OrderedPasses, Outwards, Passes, Pitch};

use super::facts::counted;
use super::surface::{self, FollowsSurface, Task, Traced};
use super::{About, Areas, Context, Direction, Effort, Fact, LeadForm, LinkHeight, OperationKind, PassContext};
use super::{PassSpacing, Planned, Serves, Spindle};
use crate::numbers::shown;
use crate::{JobError, OperationKeys};

/// How much of the tolerance a part may be out of round by: on one side of it the tool is that much nearer to the part than on the
/// other, and the rest of the tolerance is the path's.
const ROUND: f64 = 0.5;
/// Turns for which the tool waits: one, and what a spindle may be slower than it is set.
const TURN: f64 = 1.1;
/// So near to the axis a turn is none, mm.
const ON_AXIS: f64 = 1e-6;
/// Steps in which scallops are looked at, degrees.
const PITCH_DEG: f64 = 1.0;
/// Halvings of a scallop's height: more than a double distinguishes.
const HALVINGS: usize = 60;

/// The path along the part's meridian, from the axis outwards, in X and Z, while the spindle turns the part: for parts that are
/// surfaces of revolution about X = Y = 0, which is measured, with a tool that stands parallel to that axis. `feeds.cut` follows from
/// the feed per revolution and the spindle's speed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Meridian {
    /// Feed per revolution along the path, mm: the distance between its turns on the part.
    #[schemars(extend("x-unit" = "mm/rev", "minimum" = 0.001, "maximum" = 20.0, "x-example" = "0.5"))]
    pub feed_per_rev: f64,
}

impl Meridian {
    pub(super) const ABOUT: About = About {
        purpose: "for spinning",
        serves: Serves::OnRequest,
        starter: |passes| format!("feed_per_rev = {:?}        # distance between turns\n", passes.pitch),
    };

    /// The height of the scallops between turns on the face of the slope, up to the steepest one, rad, that has the highest, mm.
    fn scallop(&self, body: &ToolBody, steepest: f64) -> f64 {
        let of_slope = |slope: f64| {
            let [mut low, mut high] = [0.0, self.feed_per_rev];
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if body.scallop_travel(slope, middle, [1.0, 0.0], 0.0) < self.feed_per_rev {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            0.5 * (low + high)
        };
        let count = (steepest.to_degrees() / PITCH_DEG).ceil().max(1.0) as u32;
        (0..=count).map(|i| of_slope(steepest * f64::from(i) / f64::from(count))).fold(0.0, f64::max)
    }
}

impl OperationKind for Meridian {
    fn check(&self, common: &OperationKeys, path: &str) -> Result<(), JobError> {
        let Spindle::Fixed { .. } = common.spindle else {
            let message = "the spindle turns the part, and its speed is not stated";
            let hint = "write spindle = { mode = \"fixed\", rpm = 300 }";
            return Err(JobError::document("conflict", format!("{path}.spindle.mode"), message, hint));
        };
        match common.direction {
            Direction::Alternate | Direction::Same => between(common, path),
            Direction::Climb | Direction::Conventional => {
                let message = "a meridian is run from the axis outwards, whichever way the spindle turns";
                Err(JobError::document("conflict", format!("{path}.direction"), message, "remove direction"))
            }
        }
    }

    fn cuts_upright_walls(&self) -> bool {
        false
    }

    fn plan(&self, context: &Context<'_>) -> Result<Planned, JobError> {
        self.per_revolution(context)?;
        surface::plan(self, context)
    }

    fn cut_feed(&self, common: &OperationKeys) -> f64 {
        // spindles that are not driven are refused by `check`
        common.spindle.rpm().map_or(common.feeds.cut, |rpm| self.feed_per_rev * rpm)
    }

    fn turns_part(&self) -> bool {
        true
    }

    fn contact(&self) -> Contact {
        Contact::Touch
    }

    fn passes(&self, given: &PassContext<'_>) -> Passes {
        Passes::Ordered(OrderedPasses {
            scalar: Arc::new(Outwards),
            pitch: Pitch::Even(self.feed_per_rev),
            continuous: true,
            smallest_feature: given.smallest_feature,
        })
    }

    fn spacing(&self) -> Option<PassSpacing> {
        None // turns lie in step along the meridian, neither in height nor in plan
    }

    fn effort(&self, areas: &Areas) -> Option<Effort> {
        // one line across a round part
        let length = 0.5 * libm::sqrt(areas.plan_box) + areas.elevation / libm::sqrt(areas.plan_box).max(1.0);
        let pitch = self.feed_per_rev;
        Some(Effort { key: "feed_per_rev", pitch, length, samples_grid: false, seconds_per_point: 15e-6 })
    }
}

impl Meridian {
    /// Refuses machines whose texts do not state feeds per revolution.
    fn per_revolution(&self, context: &Context<'_>) -> Result<(), JobError> {
        let machine = context.machine;
        if machine.feed.mode == FeedMode::PerRevolution {
            return Ok(());
        }
        let (message, hint) = if machine.feed.per_revolution.is_some() {
            (
                format!(
                    "the path has a feed per revolution, and {} is set to state feeds in another way",
                    machine.name
                ),
                "write options = { feed_mode = \"per-revolution\" } in [machine]",
            )
        } else {
            (
                format!("the path has a feed per revolution, and {} knows none (G95)", machine.name),
                "choose a machine that does: linuxcnc, fanuc, haas, siemens or mach4, with feed_mode = \"per-revolution\"",
            )
        };
        Err(JobError::document("conflict", "machine.options.feed_mode", message, hint))
    }

    /// How far the part is out of round.
    fn measured(context: &Context<'_>) -> Result<Option<Roundness>, JobError> {
        let scene = context.scene;
        let selected = scene.facing_up(&context.faces);
        Ok(roundness(&scene.mesh, &scene.bvh, &selected, context.watch)?)
    }
}

/// Low rapids and leads are laid beside what stands still: the disc turns through them.
fn between(common: &OperationKeys, path: &str) -> Result<(), JobError> {
    let (key, message, hint) = match (common.links, common.lead) {
        (LinkHeight::Clearance, LeadForm::None) => return Ok(()),
        (LinkHeight::Low, _) => (
            "links",
            "links = \"low\" is for a sheet that stands still, and this one turns: the tool crosses it at clearance",
            "write links = \"clearance\"",
        ),
        (LinkHeight::Clearance, LeadForm::Tangent | LeadForm::Vertical) => (
            "lead",
            "leads are for a sheet that stands still, and this one turns: the tool comes straight down onto it",
            "write lead = \"none\"",
        ),
    };
    Err(JobError::document("conflict", format!("{path}.{key}"), message, hint))
}

/// The error of a part that is no surface of revolution.
fn not_round(found: &Roundness, allowed: f64, context: &Context<'_>) -> JobError {
    let [x, y, z] = found.at.into();
    let (low, high) = context.scene.mesh.bounds();
    let middle = 0.5 * (low + high);
    let message = format!(
        "the faces are no surface of revolution about X0 Y0: turned about Z, X{x:.3} Y{y:.3} Z{z:.3} comes to lie {:.4} mm off the \
         part, and {} mm are allowed, half of the tolerance ({} were turned)",
        found.deviation,
        shown(allowed),
        counted(found.samples, "point", "points")
    );
    let hint = format!(
        "select the round faces, set setup.zero to a point of the axis (the middle of the part's box is at X{:.3} Y{:.3}), or \
         raise the tolerance if the part is as round as it is meant to be",
        middle.x, middle.y
    );
    JobError::document("not-round", format!("{}.faces", context.path), message, hint)
}

impl FollowsSurface for Meridian {
    fn tip_range(&self, task: &Task<'_>) -> [f64; 2] {
        [task.context.heights.bottom, task.context.heights.top.unwrap_or(f64::INFINITY)]
    }

    /// The path lies on one side of the part, and on any other the part may be as much nearer or farther as it is out of round.
    fn allowance(&self, context: &Context<'_>) -> Result<f64, JobError> {
        let Some(found) = Self::measured(context)? else { return Ok(0.0) };
        let allowed = ROUND * context.common.tolerance;
        if found.deviation > allowed {
            return Err(not_round(&found, allowed, context));
        }
        Ok(found.deviation)
    }

    fn pitch(&self, _body: &ToolBody) -> f64 {
        self.feed_per_rev
    }

    fn has_material_on_right(&self) -> bool {
        true
    }

    /// Outwards: the sheet is pushed on to where the mandrel is wider.
    fn sense(&self, _common: &OperationKeys) -> Sense {
        Sense::Forward
    }

    fn trace(&self, task: &Task<'_>, surface: &Surface<'_>) -> Result<Traced, PlanError> {
        let context = task.context;
        let mesh = &context.scene.mesh;
        let far = mesh.vertices().iter().map(|vertex| vertex.xy().norm()).fold(0.0, f64::max);
        let pitch = context.node_spacing();
        let count = ((far + context.tool.diameter()) / pitch).ceil() as u32;
        let line = (0..=count).map(|corner| [f64::from(corner) * pitch, 0.0]);
        let runs = over_line(surface, line, task.narrow(), task.budget.deviation, context.watch)?;
        let pass = |points| Pass { points, closed: false, group: 0 };
        let passes: Vec<Pass> = runs.into_iter().filter(|run| run.len() > 1).map(pass).collect();
        if passes.is_empty() {
            return Err(PlanError::NothingReached(task.why_nothing()));
        }
        Ok(Traced::new(passes, context.common.smallest_feature))
    }

    /// A turn where a path begins beside the axis, and where it ends: else the spiral's first and last turn are formed on one side.
    fn waits(&self, moves: &[Move], common: &OperationKeys) -> Vec<(usize, f64)> {
        let Spindle::Fixed { rpm, .. } = common.spindle else { return Vec::new() };
        let is_feed = |index: usize| moves.get(index).is_some_and(|made| made.kind == MoveKind::Feed);
        let is_rapid = |index: usize| moves.get(index).is_none_or(|made| made.kind == MoveKind::Rapid);
        let begins = |index: usize| index > 0 && is_rapid(index - 1) && moves[index].end.tip[0] > ON_AXIS;
        let ends = |index: usize| is_rapid(index + 1);
        let stands = (0..moves.len()).filter(|index| is_feed(*index) && (begins(*index) || ends(*index)));
        stands.map(|index| (index, TURN * 60.0 / rpm)).collect()
    }

    fn words(&self, _groups: usize, passes: usize) -> String {
        format!("{} along the meridian", counted(passes, "path", "paths"))
    }

    fn facts(&self, _groups: usize, traced: &Traced) -> Vec<Fact> {
        let points = traced.passes.iter().map(|pass| &pass.points);
        let length: f64 = points.flat_map(|run| run.windows(2)).map(|pair| (pair[1].tip - pair[0].tip).norm()).sum();
        vec![
            Fact::count(traced.passes.len(), "path", "paths"),
            Fact::count((length / self.feed_per_rev).ceil() as usize, "turn", "turns"),
        ]
    }

    fn task_facts(&self, task: &Task<'_>) -> Vec<Fact> {
        let scene = task.context.scene;
        let steepest = scene.steepest(&scene.facing_up(&task.context.faces));
        vec![
            Fact::length("scallop", self.scallop(task.body, steepest), "turns leave scallops up to"),
            Fact::length("out_of_round", task.allowance, "measured, with its triangles, the part is out of round by"),
        ]
    }

    fn note(&self, _groups: usize, _passes: usize) -> String {
        format!("meridian in X and Z, X is a radius, {} mm/rev", shown(self.feed_per_rev))
    }
}
