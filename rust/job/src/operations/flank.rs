//! Flank: mills ruled surfaces with the side of a leaning tool.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::{ToolFlank, Vector};
use styluscam_motion::Move;
use styluscam_toolpath::flank::{
    flank_pass, positions_within, FlankError, FlankPose, FlankWays, Method, RuledStrip, Side, Stand,
};
use styluscam_verify::{Contact, FlankFace, FlankPasses, Passes};

use super::facts::counted;
use super::keys;
use super::rails::{FlankSide, Rails, RuledSurface};
use super::{
    About, Areas, Context, Direction, Effort, Fact, Fit, LeadForm, LinkHeight, OperationKind, PassContext, PassSpacing,
    Planned, Serves,
};
use crate::numbers::shown;
use crate::{JobError, OperationKeys};

/// Mills ruled surfaces, such as blades and twisted walls, with the side of a tool that leans: on machines with two rotary axes. The tool
/// is a cylinder or a cone, with a flat end or a round one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Flank {
    /// The curves between which the surface is ruled; when left out, the selected faces are milled, each of which must be ruled.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-example" = "{ edges = [\"Edge3\", \"Edge7\"] }"))]
    pub rails: Option<Rails>,
    /// The side of stated rails on which the tool moves, seen along them with the upper one above the lower one; of faces, it is outside.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub side: Option<FlankSide>,
    /// How the tool is placed along the surface.
    #[serde(default)]
    #[schemars(extend("x-advanced" = true))]
    pub method: FlankMethod,
    /// Most that the tool may enter the surface or leave on it when it moves, mm: twisted surfaces cannot be milled exactly.
    #[serde(default = "max_error")]
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.0001, "maximum" = 10.0))]
    pub max_error: f64,
    /// Stock that stays on the surface, mm along its normals.
    #[serde(default)]
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.0, "maximum" = 100.0))]
    pub stock_to_leave: f64,
    /// How far the side of the tool goes on below the lower rail, mm; a round end lies below that. Below 0 the side ends above the rail, where a
    /// floor is in the way, and what is lower stays.
    #[serde(default)]
    #[schemars(extend("x-unit" = "mm", "minimum" = -100.0, "maximum" = 100.0))]
    pub overreach: f64,
    /// Most that a pass cuts along the tool, mm; all at once, as far as the tool's length allows it, when left out. Cylinders only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.1, "maximum" = 1000.0))]
    pub pass_depth: Option<f64>,
    /// How far the tool goes on beyond both ends of the surface, mm: the curves go on as they end.
    #[serde(default = "extension")]
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.0, "maximum" = 1000.0))]
    pub extension: f64,
    /// Length of the way in from the free side and out to it, mm.
    #[serde(default = "lead_length")]
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.0, "maximum" = 1000.0))]
    pub lead_length: f64,
}

/// How a tool is placed along a ruled surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FlankMethod {
    /// It touches both rails, and what its movement leaves of the surface between them is least.
    #[default]
    Swept,
    /// It touches both rails at equal parameters.
    Rails,
    /// It touches both rails and the line between them.
    ThreePoints,
    /// Two points of its axis lie beside two points of the line.
    TwoPoints,
    /// Its axis is parallel to the line.
    OnePoint,
}

impl FlankMethod {
    fn method(self) -> Method {
        match self {
            Self::Swept => Method::Swept,
            Self::Rails => Method::Rails,
            Self::ThreePoints => Method::ThreePoints,
            Self::TwoPoints => Method::TwoPoints,
            Self::OnePoint => Method::OnePoint,
        }
    }
}

impl Flank {
    pub(super) const ABOUT: About = About {
        purpose: "for ruled surfaces, with the side of a leaning tool",
        serves: Serves::OnRequest,
        starter: |_| "extension = 2.0           # beyond both ends of the surface\n".to_owned(),
    };

    /// The surface and the tool's side as planning takes them.
    fn strip(&self, surface: &RuledSurface) -> Result<RuledStrip, FlankError> {
        let side = if surface.is_left { Side::Left } else { Side::Right };
        RuledStrip::new(surface.rails.clone(), side)
    }

    /// The tool's side, thicker by the stock to leave, with which it touches the lower rail.
    fn side_of(&self, tool: &ToolFlank) -> Result<styluscam_toolpath::flank::Flank, FlankError> {
        let radius = tool.radius + self.overreach * tool.growth() + self.stock_to_leave * libm::cos(tool.half_angle);
        styluscam_toolpath::flank::Flank::new(radius, tool.half_angle)
    }

    /// How far up along its axis the tool stands in each pass, mm, from the first pass to the last.
    fn lifts(&self, tool: &ToolFlank, stands: &[Stand], path: &str) -> Result<Vec<f64>, JobError> {
        let axis = |stand: &Stand| (stand.axis[1] - stand.axis[0]).norm();
        let longest = stands.iter().map(axis).fold(0.0, f64::max);
        let needed = self.overreach + tool.needed(longest) - tool.height;
        let available = tool.top - tool.height;
        if available < LEAST_FLANK {
            let message = format!(
                "the side of the tool is {:.3} mm long: its length, or the shank above its profile, ends it",
                available.max(0.0)
            );
            let hint = "give the tool its true length, and a base of the height at which its shank begins";
            return Err(JobError::document("short-flank", path, message, hint));
        }
        let most = self.pass_depth.unwrap_or(f64::INFINITY).min(available);
        let count = (needed / most - 1e-9).ceil().max(1.0);
        if count > MOST_PASSES {
            let message =
                format!("{needed:.2} mm along the tool take {count} passes of {most:.3} mm: at most {MOST_PASSES}");
            return Err(JobError::document("out-of-range", format!("{path}.pass_depth"), message, "raise pass_depth"));
        }
        if count > 1.0 && tool.half_angle > 0.0 {
            let message = format!(
                "the side of the tool is {available:.2} mm long, {needed:.2} mm are needed, and a cone cannot mill in several depths"
            );
            return Err(JobError::document("short-flank", path, message, "take a longer tool, or a cylinder"));
        }
        Ok((0..count as usize).map(|pass| needed * (1.0 - (pass as f64 + 1.0) / count)).collect())
    }

    /// The passes over one surface.
    fn passes_over(&self, context: &Context<'_>, surface: &RuledSurface) -> Result<Milled, JobError> {
        let path = &context.path;
        let refused = |error: FlankError| {
            JobError::document(error.code(), path.clone(), format!("{}: {error}", surface.name), "")
        };
        let tool = context.tool.flank().map_err(JobError::geometry(format!("tools.{}", context.common.tool)))?;
        let strip = self.strip(surface).map_err(refused)?;
        let strip = strip.extended(self.extension).map_err(|error| {
            let message = format!("{}: it cannot be continued by {} mm: {error}", surface.name, shown(self.extension));
            JobError::document(error.code(), format!("{path}.extension"), message, "lower extension")
        })?;
        let side = self.side_of(&tool).map_err(refused)?;
        let stands = positions_within(&strip, &side, CHORDS * context.common.tolerance, self.method.method())
            .map_err(refused)?;
        check_lean(&stands, &surface.name, path)?;
        let down = tool.rise() + self.overreach;
        let ways = FlankWays {
            extension: 0.0, // the strip is longer by it
            lead: self.lead_length,
            cut: context.common.feeds.cut,
            plunge: context.common.feeds.plunge,
            leads: [context.common.feeds.approaching(), context.common.feeds.leaving()],
        };
        let wide = context.tool.body(None).max_radius();
        let free = |pose: &FlankPose| {
            // the lower side of a flat end lies below the tip
            let below = wide * libm::hypot(pose.axis.x, pose.axis.y);
            (context.scene.clearance + below - pose.tip.z) / pose.axis.z
        };
        let mut moves = Vec::new();
        let lifts = self.lifts(&tool, &stands, path)?;
        for (pass, lift) in lifts.iter().enumerate() {
            let mut poses: Vec<FlankPose> = stands.iter().map(|stand| pose(stand, lift - down)).collect();
            if is_reversed(context.common.direction, pass, &poses) {
                poses.reverse();
            }
            moves.extend(flank_pass(&poses, &ways, &free).map_err(refused)?);
        }
        Ok(Milled { moves, positions: stands.len(), passes: lifts.len() })
    }
}

/// A side of a tool that is shorter is none, mm.
const LEAST_FLANK: f64 = 0.01;
/// Passes over a surface at most.
const MOST_PASSES: f64 = 100.0;
/// A tool that leans by more cannot come down to the part from above, degrees.
const MOST_LEAN_DEG: f64 = 85.0;

/// Refuses tools that lie.
fn check_lean(stands: &[Stand], name: &str, path: &str) -> Result<(), JobError> {
    let lowest = stands.iter().map(|stand| stand.direction().z).fold(1.0, f64::min);
    let leans = libm::acos(lowest.clamp(-1.0, 1.0)).to_degrees();
    if leans <= MOST_LEAN_DEG {
        return Ok(());
    }
    let message =
        format!("{name}: the tool would lean by {leans:.1} degrees from +Z, and it comes down along its axis: {MOST_LEAN_DEG} at most");
    Err(JobError::document(
        "lean",
        path,
        message,
        "turn the part with setup.up, so that its upper rail lies above its lower one",
    ))
}

/// The share of the tolerance by which straight moves between positions may leave the movement: rounding takes of it too.
const CHORDS: f64 = 0.5;

/// What is planned for a surface.
struct Milled {
    moves: Vec<Move>,
    positions: usize,
    passes: usize,
}

/// The tool whose tip is so far up the axis from its point beside the first rail, mm.
fn pose(stand: &Stand, up: f64) -> FlankPose {
    let axis = stand.direction();
    let contact = (stand.contacts[0] + stand.contacts[1]) * 0.5;
    FlankPose { tip: stand.axis[0] + axis * up, axis, contact }
}

/// Whether a pass goes against the rails.
fn is_reversed(direction: Direction, pass: usize, poses: &[FlankPose]) -> bool {
    let [first, second, ..] = poses else { return false };
    // the part lies on the right of a tool that turns clockwise and climbs
    let right = (second.contact - first.contact).cross(&first.axis);
    let climbs = right.dot(&across(first.contact - first.tip, first.axis)) > 0.0;
    match direction {
        Direction::Alternate => pass % 2 == 1,
        Direction::Same => false,
        Direction::Climb => !climbs,
        Direction::Conventional => climbs,
    }
}

fn across(v: Vector, unit: Vector) -> Vector {
    v - unit * unit.dot(&v)
}

impl OperationKind for Flank {
    fn check(&self, common: &OperationKeys, path: &str) -> Result<(), JobError> {
        let refused = [
            ("boundary", common.boundary.is_some()),
            ("max_corner_deg", common.max_corner_deg.is_some()),
            ("edges", common.edges.is_some()),
            ("lead", common.lead != LeadForm::None),
            ("links", common.links != LinkHeight::Clearance),
            ("z_top", common.z_top.is_some()),
            ("z_bottom", common.z_bottom.is_some()),
            ("fit", common.fit != Fit::Lines),
            ("slow_corners", common.slow_corners),
        ];
        keys::refuse(&refused, path, |key| {
            let message = format!("flank milling does not follow {key}: its path is that of the rulings");
            (message, format!("remove {key}; overreach, extension and lead_length shape the ends of its passes"))
        })?;
        if common.leaves_stock() {
            let message = "flank milling leaves stock along the normals of its surface";
            let hint = "set stock_to_leave instead of radial_stock_to_leave and axial_stock_to_leave";
            return Err(JobError::document("conflict", format!("{path}.radial_stock_to_leave"), message, hint));
        }
        if self.side.is_some() && self.rails.is_none() {
            let message = "side belongs to rails; of faces the tool moves outside";
            return Err(JobError::document("conflict", format!("{path}.side"), message, "remove side, or state rails"));
        }
        Ok(())
    }

    fn cuts_upright_walls(&self) -> bool {
        true
    }

    fn leans(&self) -> bool {
        true
    }

    fn plan(&self, context: &Context<'_>) -> Result<Planned, JobError> {
        if context.scene.sheet.is_some() {
            let message = "the side of a tool mills, and this job forms a sheet";
            return Err(JobError::document("conflict", context.path.clone(), message, "remove setup.sheet"));
        }
        if context.machine.rotary.is_none() {
            let message = format!("{} has three axes, and flank milling leans the tool", context.machine.name);
            let hint = "take a machine file with [rotary], such as linuxcnc-trunnion, or extend yours by one";
            return Err(JobError::document("no-rotary-axes", "machine", message, hint));
        }
        let surfaces = context.ruled_surfaces(self.rails.as_ref(), self.side)?;
        let mut moves = Vec::new();
        let (mut count, mut passes) = (0, 0);
        context.watch.begin("planning", surfaces.len());
        for surface in &surfaces {
            let milled = self.passes_over(context, surface)?;
            moves.extend(milled.moves.into_iter().map(|step| step.of_operation(context.operation)));
            count += milled.positions;
            passes += milled.passes;
            context.watch.advance(1)?;
        }
        let words =
            format!("{} over {}", counted(passes, "pass", "passes"), counted(surfaces.len(), "surface", "surfaces"));
        Ok(Planned {
            note: words.clone(),
            words,
            facts: vec![
                Fact::count(surfaces.len(), "surface", "surfaces"),
                Fact::count(passes, "pass", "passes"),
                Fact::count(count, "position", "positions"),
            ],
            events: Vec::new(),
            cycles: Vec::new(),
            surface: None,
            moves,
        })
    }

    fn contact(&self) -> Contact {
        Contact::Clear
    }

    fn check_part(&self, given: &PassContext<'_>, are_named: bool, path: &str) -> Result<(), JobError> {
        let found = RuledSurface::all(self.rails.as_ref(), self.side, (given.scene, given.faces, are_named), path)?;
        if found.is_empty() {
            let message = "none of the faces is known to be ruled between two curves, and no rails are stated";
            let hint = "select ruled faces, or state rails = { edges = [\"Edge3\", \"Edge7\"] }";
            return Err(JobError::document("nothing-reached", format!("{path}.faces"), message, hint));
        }
        Ok(())
    }

    fn passes(&self, given: &PassContext<'_>) -> Passes {
        let surfaces = RuledSurface::all(self.rails.as_ref(), self.side, (given.scene, given.faces, false), "");
        let face = |surface: RuledSurface| FlankFace {
            name: surface.name,
            face: surface.face,
            rails: surface.rails,
            is_left: surface.is_left,
        };
        Passes::Flank(FlankPasses {
            // planning refuses named faces that are not ruled
            faces: surfaces.unwrap_or_default().into_iter().map(face).collect(),
            left: self.stock_to_leave,
            foot: (-self.overreach).max(0.0),
            max_error: self.max_error,
        })
    }

    fn spacing(&self) -> Option<PassSpacing> {
        None
    }

    fn effort(&self, _areas: &Areas) -> Option<Effort> {
        None // a few hundredths of a second a surface
    }
}

fn max_error() -> f64 {
    0.02
}

fn extension() -> f64 {
    2.0
}

fn lead_length() -> f64 {
    5.0
}
