//! Zig-zag: parallel rows over the surface.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::ToolBody;
use styluscam_toolpath::{
    forming::{layers, scallop_steps, zig_zag, Rows, ScallopRule, Spread, Turn},
    Freedom, Pass, PlanError, Planes, Surface,
};
use styluscam_verify::{Across, Contact, Layers, OrderedPasses, Passes, Pitch};

use super::facts::counted;
use super::surface::{self, FollowsSurface, Task, Traced};
use super::{About, Areas, Context, Effort, Fact, OperationKind, PassContext, PassSpacing, Planned, Serves};
use crate::numbers::shown;
use crate::{Direction, JobError, OperationKeys};

/// Rows that are no farther apart than so many stepovers are neighbours.
const NEIGHBOURS: f64 = 1.5;

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
    /// How deep a row presses the sheet at most below where it stands, mm: flat sheet is formed by rows in layers so far apart.
    /// When left out, rows finish what operations before them have formed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.05, "maximum" = 100.0))]
    pub max_increment: Option<f64>,
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

/// Keys that contradict each other.
struct Conflict {
    code: &'static str,
    /// The key to mend.
    key: &'static str,
    message: &'static str,
    hint: &'static str,
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

    /// Layers are so many tolerances apart at least.
    const TOLERANCES: f64 = 10.0;

    /// Angle between both sets of rows where none is stated, degrees.
    const ACROSS_DEG: f64 = 90.0;

    /// Directions of the sets of rows from +X, rad: the first, and where there is one the second.
    fn angles(&self) -> (f64, Option<f64>) {
        let across = self.angle_deg + self.cross_angle_deg.unwrap_or(Self::ACROSS_DEG);
        (self.angle_deg.to_radians(), self.cross.then(|| across.to_radians()))
    }

    /// Keys of turns.
    fn turns_without_radius(&self) -> Option<Conflict> {
        let key = "turn_radius";
        match (self.turns, self.turn_radius) {
            (Turns::Looped, None) => Some(Conflict {
                code: "missing",
                key,
                message: "looped turns have a radius",
                hint: "state turn_radius, mm",
            }),
            (Turns::Straight | Turns::Rounded, Some(_)) => Some(Conflict {
                code: "conflict",
                key,
                message: "turn_radius is the radius of looped turns",
                hint: "remove it, or set turns = \"looped\"",
            }),
            (Turns::Looped, Some(_)) | (Turns::Straight | Turns::Rounded, None) => None,
        }
    }

    /// Keys of a second set of rows.
    fn crossing(&self) -> Option<Conflict> {
        (self.cross_angle_deg.is_some() && !self.cross).then_some(Conflict {
            code: "conflict",
            key: "cross_angle_deg",
            message: "cross_angle_deg is the angle of a second set of rows",
            hint: "remove it, or set cross = true",
        })
    }

    /// Keys of rows by scallop.
    fn closeness(&self) -> Option<Conflict> {
        let (message, hint) = match (self.stepover_min?, self.scallop) {
            (_, None) => ("stepover_min limits rows by scallop, and no scallop is stated", "remove it, or set scallop"),
            (least, Some(_)) if least > self.stepover => {
                ("stepover_min is above stepover, which is the largest distance", "swap them")
            }
            (_, Some(_)) => return None,
        };
        Some(Conflict { code: "conflict", key: "stepover_min", message, hint })
    }

    /// Planes of layers must be distinguished within the tolerance.
    fn increment(&self, common: &OperationKeys) -> Option<Conflict> {
        let is_fine = self.max_increment? < Self::TOLERANCES * common.tolerance;
        is_fine.then_some(Conflict {
            code: "conflict",
            key: "max_increment",
            message: "max_increment is less than ten times the tolerance: layers could not be distinguished",
            hint: "raise max_increment, or lower tolerance",
        })
    }

    /// The passes of one set of rows.
    fn rows(&self, angle: f64, task: &Task<'_>, surface: &Surface<'_>) -> Result<Vec<Pass>, PlanError> {
        let closer = match self.pitch_of_rows() {
            Pitch::Even(_) | Pitch::Listed { .. } => None,
            Pitch::Scallop { height, steps: limits } => {
                let rule = ScallopRule { height, limits, deviation: task.budget.deviation };
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
    fn check(&self, common: &OperationKeys, path: &str) -> Result<(), JobError> {
        let conflicts = [self.turns_without_radius(), self.closeness(), self.increment(common), self.crossing()];
        conflicts.into_iter().flatten().next().map_or(Ok(()), |Conflict { code, key, message, hint }| {
            Err(JobError::document(code, format!("{path}.{key}"), message, hint))
        })
    }

    /// Rows pass walls at one height only.
    fn cuts_upright_walls(&self) -> bool {
        false
    }

    fn plan(&self, context: &Context<'_>) -> Result<Planned, JobError> {
        let body = context.tool.body(context.scene.sheet.as_ref());
        match self.max_increment.map(|increment| (increment, body.chord(0.0, increment))) {
            Some((increment, most)) if self.stepover > most => Err(ridges(context, self.stepover, increment, most)),
            Some(_) | None => surface::plan(self, context),
        }
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

    fn forms_in_layers(&self) -> bool {
        self.max_increment.is_some()
    }

    fn layers(&self, given: &PassContext<'_>) -> Option<Layers> {
        self.max_increment.map(|increment| Layers { top: given.top, increment })
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

/// Between rows so far apart the sheet would stand higher than a row may press it down.
fn ridges(context: &Context<'_>, stepover: f64, increment: f64, most: f64) -> JobError {
    let [stepover, increment, most] = [stepover, increment, (1e3 * most).floor() / 1e3].map(shown);
    let message = format!(
        "stepover = {stepover}: this tool leaves the sheet more than max_increment = {increment} mm higher between such rows, and \
         turns and the next layer would press it farther"
    );
    let hint = format!("lower stepover to {most} or less, or raise max_increment");
    JobError::document("conflict", format!("{}.max_increment", context.path), message, hint)
}

impl FollowsSurface for ZigZag {
    /// What lies at the top is formed within the tolerance above it.
    /// Rows go on to the left of their direction.
    fn has_material_on_right(&self) -> bool {
        false
    }

    fn planes(&self, context: &Context<'_>) -> Option<Planes> {
        let top = context.heights.top.unwrap_or(context.scene.top);
        self.max_increment.map(|increment| Planes { top, increment })
    }

    /// Rows leave the material on the side that they are asked to leave it on as long as neighbours follow each other.
    fn freedom<'a>(&self, task: &Task<'_>, traced: &'a Traced) -> Freedom<'a> {
        // each row presses the sheet beside the one before; turns lead from each to the one beside it
        if self.max_increment.is_some() || self.turn().is_some() {
            return Freedom::WithinGroups;
        }
        let reach = NEIGHBOURS * self.stepover;
        let of_rows = |is_reversible| Freedom::OfRows { sets: &traced.sets, is_reversible, reach };
        match task.context.common.direction {
            Direction::Alternate => of_rows(true),
            Direction::Same => of_rows(false),
            Direction::Climb | Direction::Conventional => Freedom::OfAreas { reach, inside_first: false },
        }
    }

    fn links_across(&self) -> bool {
        true
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

    fn trace(&self, task: &Task<'_>, surface: &Surface<'_>) -> Result<Traced, PlanError> {
        let (angle, across) = self.angles();
        let mut passes = self.rows(angle, task, surface)?;
        let first_set = passes.last().map_or(0, |last| last.group + 1);
        let mut sets = vec![0];
        if let Some(across) = across {
            sets.push(first_set);
            let crossing = self.rows(across, task, surface)?;
            passes.extend(crossing.into_iter().map(|pass| Pass { group: first_set + pass.group, ..pass }));
        }
        if passes.is_empty() {
            return Err(PlanError::NothingReached(task.why_nothing()));
        }
        let smallest_feature = task.context.common.smallest_feature;
        let Some(planes) = self.planes(task.context) else {
            return Ok(Traced { sets, ..Traced::new(passes, smallest_feature) });
        };
        // the second set finishes what the first has formed
        let (rows, crossing): (Vec<Pass>, Vec<Pass>) = passes.into_iter().partition(|pass| pass.group < first_set);
        Ok(Traced::in_layers(layers(&rows, &planes, task.budget.deviation)?, crossing, smallest_feature))
    }

    fn words(&self, groups: usize, passes: usize) -> String {
        let directions = if self.cross { " in two directions" } else { "" };
        let layers = self.max_increment.map_or_else(String::new, |mm| format!(", in layers of {} mm", shown(mm)));
        format!("{} on {}{directions}{layers}", counted(passes, "pass", "passes"), counted(groups, "row", "rows"))
    }

    fn facts(&self, groups: usize, traced: &Traced) -> Vec<Fact> {
        let figures = [Fact::count(groups, "row", "rows"), Fact::count(traced.passes.len(), "pass", "passes")];
        let layers = self.max_increment.map(|_| Fact::count(traced.layers.len(), "layer", "layers"));
        figures.into_iter().chain(layers).collect()
    }

    fn note(&self, groups: usize, passes: usize) -> String {
        let layers = self.max_increment.map_or_else(String::new, |mm| format!(", layers of {} mm", shown(mm)));
        format!("{groups} rows, {passes} passes{layers}")
    }
}
