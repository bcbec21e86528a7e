//! Helix bore: round upright holes by a tool narrower than they are, along helices.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::ToolBody;
use styluscam_motion::{Move, Role, SpindleDirection};
use styluscam_toolpath::boring::{ramp, Bore, Turn};
use styluscam_verify::{Boring, Contact, DrilledHole, Passes};

use super::at_holes::{begins, breakthrough, check_solid, check_walls, no_hole, retract_height};
use super::budget;
use super::facts::counted;
use super::in_order::in_order;
use super::keys;
use super::{
    About, Areas, Context, Direction, Effort, Fact, Fit, LeadForm, LinkHeight, Machining, OperationKind, PassContext,
    PassSpacing, Planned, Serves,
};
use crate::cutting::{CuttingWork, Engagement};
use crate::holes::{holes_among, Hole};
use crate::numbers::shown;
use crate::{JobError, OperationKeys};

/// A path's radius at least, mm: what is narrower is drilled.
const LEAST: f64 = 0.05;
/// Diameters that differ by less are the same, mm, as holes of one diameter do.
const SAME: f64 = 0.02;
/// A floor that rises by no more is flat, mm.
const FLAT: f64 = 0.01;

/// Bores the round upright holes among the selected faces with a tool narrower than they are: down along a helix with a level turn at its
/// end, back to the axis and up; in several, from the inside out, where one would leave a core. Turns are full circles, or short lines on
/// machines without these arcs. Of faces = "all" wider holes are taken; named faces must all be walls of such holes. All directions but
/// conventional are climb.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HelixBore {
    /// Fall of a turn, mm at most: turns share the depth evenly.
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.01, "maximum" = 100.0, "x-example" = "1.0"))]
    pub pitch: f64,
    /// Diameter of the holes that are bored, mm; when left out, all that are wider than the tool.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 10000.0))]
    pub diameter: Option<f64>,
    /// Of what feeds.cut is the feed.
    #[serde(default)]
    pub feed_at: FeedAt,
    /// Distance between helices, mm at most, where the tool is too narrow to clear the hole in one; its radius when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.01, "maximum" = 100.0))]
    pub helix_distance: Option<f64>,
    /// The steepest helix that the tool withstands, degrees; steeper ones are refused.
    #[serde(default = "max_ramp")]
    #[schemars(extend("x-unit" = "deg", "minimum" = 0.1, "maximum" = 60.0))]
    pub max_ramp_deg: f64,
    /// How far the tool's full diameter goes on below through holes, mm.
    #[serde(default = "breakthrough")]
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.0, "maximum" = 100.0))]
    pub breakthrough: f64,
    /// How far above a hole's top the tool comes down at rapid, mm.
    #[serde(default = "retract_height")]
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.1, "maximum" = 1000.0))]
    pub retract_height: f64,
}

/// Of what a feed is that differs across the tool on a circle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FeedAt {
    /// Of the tool's rim on the wall, as tables of cutting data state it: the axis is slower by (D - d) / D.
    #[default]
    Rim,
    /// Of the tool's axis, as it is posted: the rim is faster.
    Axis,
}

/// A tool as holes see it, mm.
#[derive(Clone, Copy)]
struct BoringTool {
    radius: f64,
    /// From its tip to its full diameter.
    point: f64,
}

impl BoringTool {
    fn of(body: &ToolBody) -> Self {
        Self { radius: body.max_radius(), point: body.max_height() }
    }
}

impl HelixBore {
    pub(super) const ABOUT: About = About {
        purpose: "for round upright holes wider than the tool",
        serves: Serves::OnRequest,
        starter: |_| "pitch = 1.0               # fall of the helix in a turn\n".to_owned(),
    };

    /// Whether a hole is of the diameter that is bored.
    fn is_asked(&self, hole: &Hole) -> bool {
        self.diameter.is_none_or(|diameter| (hole.diameter() - diameter).abs() <= SAME)
    }

    /// Whether a tool has room to turn in a hole on whose wall `left` mm stay.
    fn has_room(hole: &Hole, tool: BoringTool, left: f64) -> bool {
        hole.radius - tool.radius - left >= LEAST
    }

    /// The height that the tip reaches in a hole, mm.
    fn bottom(&self, hole: &Hole, tool: BoringTool) -> f64 {
        match hole.floor_top {
            None => hole.bottom - tool.point - self.breakthrough,
            Some(floor) => hole.bottom.max(floor),
        }
    }

    /// The holes that are bored, and the others.
    fn holes(&self, given: &PassContext<'_>) -> (Vec<Hole>, Vec<Hole>) {
        let tool = BoringTool::of(given.body);
        let is_bored = |hole: &Hole| self.is_asked(hole) && Self::has_room(hole, tool, given.to_leave[0]);
        holes_among(given.scene.solid(), given.faces).into_iter().partition(is_bored)
    }

    /// That a hole is not of the diameter asked for, or too narrow for the tool.
    fn misfit(&self, hole: &Hole, given: &PassContext<'_>, path: &str) -> JobError {
        let (name, wide) = (hole.name(), hole.diameter());
        if let Some(diameter) = self.diameter.filter(|_| !self.is_asked(hole)) {
            let code = if wide < diameter { "narrow-hole" } else { "wide-hole" };
            let message = format!("the hole {name} is {wide:.3} mm wide, and diameter = {}", shown(diameter));
            let hint = format!("set diameter = {wide:.3}, or remove it");
            return JobError::document(code, format!("{path}.diameter"), message, hint);
        }
        let least = 2.0 * (BoringTool::of(given.body).radius + given.to_leave[0] + LEAST);
        let message =
            format!("the hole {name} is {wide:.3} mm wide, and a helix of this tool takes at least {least:.3} mm");
        let hint = "take a narrower tool, or one of the hole's diameter and kind = \"drill\"";
        JobError::document("narrow-hole", format!("{path}.tool"), message, hint)
    }

    /// A hole as it is bored, from `start` mm on, its path `margin` mm inside of the exact one.
    fn bore(&self, hole: &Hole, given: &PassContext<'_>, (start, margin): (f64, f64), clockwise: bool) -> Bore {
        let tool = BoringTool::of(given.body);
        Bore {
            at: hole.at,
            tool_radius: tool.radius,
            radius: hole.radius - tool.radius - given.to_leave[0] - margin,
            start,
            bottom: self.bottom(hole, tool),
            pitch: self.pitch,
            stepover: self.helix_distance.unwrap_or(tool.radius),
            clockwise,
        }
    }

    /// Holes that cannot be bored as the keys ask for it.
    fn check_hole(&self, hole: &Hole, given: &PassContext<'_>, path: &str) -> Result<(), JobError> {
        let name = hole.name();
        if let Some(rise) = hole.floor_top.map(|top| top - hole.bottom).filter(|rise| *rise > FLAT) {
            let message = format!(
                "the floor of the hole {name} rises {rise:.3} mm above the lower end of its wall: it is not flat"
            );
            let hint = "leave this hole out of faces, and mill its floor with another operation";
            return Err(JobError::document("sloped-floor", format!("{path}.faces"), message, hint));
        }
        let bore = self.bore(hole, given, (begins(hole, given) + self.retract_height, 0.0), false);
        let refused = |error| JobError::planning(path.to_owned())(error);
        let least = bore.radii().map_err(refused)?.first().copied().unwrap_or(bore.radius);
        let steepest = ramp(least, bore.fall().map_err(refused)?).to_degrees();
        if steepest > self.max_ramp_deg {
            let message = format!(
                "the helix in the hole {name} goes down at {steepest:.2} degrees: max_ramp_deg = {}",
                shown(self.max_ramp_deg)
            );
            let pitch = std::f64::consts::TAU * least * libm::tan(self.max_ramp_deg.to_radians());
            let hint = format!("set pitch = {:.3}, take a narrower tool, or raise max_ramp_deg", floored(pitch));
            return Err(JobError::document("steep-helix", format!("{path}.pitch"), message, hint));
        }
        Ok(())
    }
}

/// Less by what rounding to three decimals may add, mm.
fn floored(length: f64) -> f64 {
    (length * 1e3).floor() / 1e3
}

impl OperationKind for HelixBore {
    fn check(&self, common: &OperationKeys, path: &str) -> Result<(), JobError> {
        let refused = [
            ("boundary", common.boundary.is_some()),
            ("check_faces", common.check_faces.is_some()),
            ("max_corner_deg", common.max_corner_deg.is_some()),
            ("edges", common.edges.is_some()),
            ("lead", common.lead != LeadForm::None),
            ("links", common.links != LinkHeight::Clearance),
            ("z_bottom", common.z_bottom.is_some()),
            ("fit", common.fit != Fit::Lines),
            ("slow_corners", common.slow_corners),
            ("axial_stock_to_leave", common.axial_stock_to_leave > 0.0),
        ];
        keys::refuse(&refused, path, |key| {
            let message = format!("boring does not follow {key}: it turns about the axes of holes, to their depth");
            (message, format!("remove {key}"))
        })
    }

    fn cutting(&self) -> Machining {
        let engagement = Engagement { depth: Some(self.pitch), ..Engagement::default() };
        Machining { work: CuttingWork::RoughMilling, engagement, pitch: None }
    }

    fn cuts_upright_walls(&self) -> bool {
        true
    }

    fn owes_faces(&self) -> bool {
        false
    }

    /// On each hole's helices it is lower: the verifier looks at it hole by hole.
    fn highest_feed(&self, common: &OperationKeys) -> Option<f64> {
        Some(common.feeds.cut)
    }

    fn plan(&self, context: &Context<'_>) -> Result<Planned, JobError> {
        check_solid(context)?;
        let body = context.tool.body(None);
        let given = PassContext::of(context, &body);
        let (holes, others) = self.holes(&given);
        let (holes, across) = in_order(context, &holes, |hole| hole.at)?;
        let holes = from_above(holes);
        let mut bored = self.bored(context, &given, &holes)?;
        let through = holes.iter().filter(|hole| hole.floor.is_none()).count();
        bored.facts.push(Fact::length("across", across, "across from hole to hole"));
        let skipped = (!others.is_empty()).then(|| {
            let words = format!("{} of another diameter left out", counted(others.len(), "hole", "holes"));
            Fact { fact: "other_holes", value: others.len() as f64, unit: "", words }
        });
        bored.facts.extend(skipped);
        Ok(Planned {
            words: format!("{}, {through} of them through", counted(holes.len(), "hole", "holes")),
            note: counted(holes.len(), "hole", "holes"),
            ..bored
        })
    }

    fn contact(&self) -> Contact {
        Contact::Clear
    }

    fn check_part(&self, given: &PassContext<'_>, are_named: bool, path: &str) -> Result<(), JobError> {
        let wide = 2.0 * BoringTool::of(given.body).radius;
        if let Some(apart) = self.helix_distance.filter(|apart| *apart > wide) {
            let message =
                format!("helices {} mm apart leave rings between them: the tool is {wide:.3} mm wide", shown(apart));
            let hint = "lower helix_distance, or take a wider tool";
            return Err(JobError::document("conflict", format!("{path}.helix_distance"), message, hint));
        }
        let found = holes_among(given.scene.solid(), given.faces);
        let (bored, others) = self.holes(given);
        if are_named {
            check_walls(given, &found, path)?;
            if let Some(hole) = others.first() {
                return Err(self.misfit(hole, given, path));
            }
        }
        if bored.is_empty() {
            let widest = found
                .iter()
                .max_by(|a, b| self.is_asked(a).cmp(&self.is_asked(b)).then_with(|| a.radius.total_cmp(&b.radius)));
            return Err(widest.map_or_else(|| no_hole(path), |hole| self.misfit(hole, given, path)));
        }
        bored.iter().try_for_each(|hole| self.check_hole(hole, given, path))
    }

    fn passes(&self, given: &PassContext<'_>) -> Passes {
        let tool = BoringTool::of(given.body);
        let bored = |hole: &Hole| DrilledHole {
            name: hole.name(),
            at: hole.at,
            radius: hole.radius,
            chord: hole.chord,
            top: begins(hole, given),
            bottom: self.bottom(hole, tool),
        };
        Passes::Boring(Boring {
            holes: self.holes(given).0.iter().map(bored).collect(),
            pitch: self.pitch,
            left: given.to_leave[0],
            is_climb: given.direction != Direction::Conventional,
            feed_at_rim: self.feed_at == FeedAt::Rim,
        })
    }

    fn spacing(&self) -> Option<PassSpacing> {
        None // holes lie where the part has them
    }

    fn effort(&self, _areas: &Areas) -> Option<Effort> {
        None // a few moves for each hole
    }
}

impl HelixBore {
    /// The moves of holes in their order.
    fn bored(&self, context: &Context<'_>, given: &PassContext<'_>, holes: &[Hole]) -> Result<Planned, JobError> {
        let budget = budget::of_circles(given.tolerance, context.machine).map_err(|error| context.error(error))?;
        let is_climb = given.direction != Direction::Conventional;
        // in a hole the wall is outside: climb milling goes round it as the tool turns the other way
        let clockwise = is_climb == (context.common.spindle.direction() == Some(SpindleDirection::Counterclockwise));
        let clearance = context.scene.clearance;
        let (mut moves, mut depth, mut steepest, mut helices) = (Vec::new(), 0.0, 0.0_f64, 0);
        for hole in holes {
            let begins = begins(hole, given).max(context.heights.top.unwrap_or(hole.top));
            let start = (begins + self.retract_height).min(clearance);
            let bore = self.bore(hole, given, (start, budget.margin), clockwise);
            let radii = bore.radii().map_err(|error| context.error(error))?;
            for radius in &radii {
                let [x, y, z] = bore.begin(*radius);
                let rim = if self.feed_at == FeedAt::Rim { radius + bore.tool_radius } else { *radius };
                let feed = context.common.feeds.cut * radius / rim;
                moves.extend([[x, y, clearance], [x, y, z]].map(Move::rapid));
                let mut from = [x, y, z];
                for turn in bore.turns(*radius).map_err(|error| context.error(error))? {
                    moves.extend(turned(context, (from, turn), feed, budget.deviation));
                    from = turn.0;
                }
                let [x, y] = hole.at;
                moves.push(Move::feed([x, y, bore.bottom], feed).role(Role::Cut));
                moves.push(Move::rapid([x, y, clearance]));
            }
            let fall = bore.fall().map_err(|error| context.error(error))?;
            steepest = radii.first().map_or(steepest, |least| steepest.max(ramp(*least, fall)));
            depth += begins - bore.bottom;
            helices += radii.len();
        }
        let steepest = steepest.to_degrees();
        let words = format!("the steepest at {steepest:.2} degrees");
        let facts = vec![
            Fact::count(holes.len(), "hole", "holes"),
            Fact::count(helices, "helix", "helices"),
            Fact { fact: "ramp", value: steepest, unit: "deg", words },
            Fact::length("bored", depth, "bored, all holes together"),
        ];
        let moves = moves.into_iter().map(|step| step.of_operation(context.operation)).collect();
        let (events, cycles) = (Vec::new(), Vec::new());
        Ok(Planned { moves, events, cycles, words: String::new(), note: String::new(), facts, surface: None })
    }
}

/// The same holes, those within another's circle behind those that begin higher: a counterbore comes before what is below it.
fn from_above(holes: Vec<Hole>) -> Vec<Hole> {
    let mut left = holes;
    let mut sorted = Vec::with_capacity(left.len());
    while let Some(first) = left.first().cloned() {
        let is_within = |hole: &Hole| {
            libm::hypot(hole.at[0] - first.at[0], hole.at[1] - first.at[1]) < hole.radius.max(first.radius)
        };
        let (mut stack, others): (Vec<Hole>, Vec<Hole>) = left.into_iter().partition(is_within);
        stack.sort_by(|a, b| b.top.total_cmp(&a.top));
        sorted.extend(stack);
        left = others;
    }
    sorted
}

/// A turn from a position of the tip, mm: an arc where the machine has it, else chords no farther than `deviation` mm from it.
fn turned(context: &Context<'_>, (from, (end, arc)): ([f64; 3], Turn), feed: f64, deviation: f64) -> Vec<Move> {
    let step = |tip| Move::feed(tip, feed).role(Role::Cut);
    let machine = context.machine;
    if machine.rotary.is_none() && machine.posts_arc([from, end], &arc, context.reference_height) {
        return vec![step(end).arc(arc)];
    }
    let path = arc.path(from, end);
    let count = path.chords(deviation);
    let corner = |number: usize| if number == count { end } else { path.at(number as f64 / count as f64) };
    (1..=count).map(|number| step(corner(number))).collect()
}

fn max_ramp() -> f64 {
    10.0
}
