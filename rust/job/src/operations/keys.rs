//! The keys that every operation takes, whatever its kind.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_motion::SpindleDirection;

use crate::boundary::BoundaryKeys;
use crate::selection::CheckSelection;
use crate::{JobError, Selection};

/// One operation: what is common to all kinds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OperationKeys {
    /// A name, unique in the job; made from kind and number when left out.
    #[serde(default)]
    pub id: String,
    /// Name of the tool.
    pub tool: String,
    /// Faces of this operation alone; the part's when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub faces: Option<Selection>,
    /// Faces that the tool keeps away from: "rest" (all others that face up, or stand upright where faces = "all" takes upright
    /// walls), or names; the part's when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-not-of" = ["pocket", "drill", "helix-bore", "chamfer", "contour"]))]
    pub check_faces: Option<CheckSelection>,
    /// How far tool, shank and holder, with the sheet under them, stay away from those faces, mm; the part's when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-not-of" = ["pocket", "drill", "helix-bore", "chamfer", "contour"], "x-unit" = "mm", "minimum" = 0.0, "maximum" = 1000.0))]
    pub check_clearance: Option<f64>,
    /// Where passes may run: inside edges in plan, and on contacts of some slopes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-not-of" = ["pocket", "flank", "drill", "helix-bore", "chamfer", "contour"], "x-example" = "{ slope_deg = [30.0, 60.0] }"))]
    pub boundary: Option<BoundaryKeys>,
    /// What happens at the outer edges of the selected faces; when left out, passes stop there, and in forming roll over those
    /// that the tool comes down over.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-not-of" = ["pocket", "flank", "drill", "helix-bore", "chamfer", "contour"]))]
    pub edges: Option<Edges>,
    /// The channel whose program does it, where the process has several; "main" when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub channel: Option<String>,
    /// Height at which the operation begins, mm in work coordinates: what stands above is cut before. The top of the stock or of the part when
    /// left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-not-of" = ["flank", "chamfer"], "x-unit" = "mm", "minimum" = -10000.0, "maximum" = 10000.0))]
    pub z_top: Option<f64>,
    /// Lowest height of the tip, mm in work coordinates; as deep as the tool reaches when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-not-of" = ["flank", "drill", "helix-bore", "chamfer"], "x-unit" = "mm", "minimum" = -10000.0, "maximum" = 10000.0))]
    pub z_bottom: Option<f64>,
    /// Stock that stays on walls, mm, measured across them in plan; a pocket with `finish` takes it last.
    #[serde(default)]
    #[schemars(extend("x-not-of" = ["flank", "drill", "chamfer"], "x-unit" = "mm", "minimum" = 0.0, "maximum" = 100.0))]
    pub radial_stock_to_leave: f64,
    /// Stock that stays under the tool, on floors and slopes, mm in height; a pocket with `finish` takes it last.
    #[serde(default)]
    #[schemars(extend("x-not-of" = ["flank", "drill", "helix-bore", "chamfer"], "x-unit" = "mm", "minimum" = 0.0, "maximum" = 100.0))]
    pub axial_stock_to_leave: f64,
    /// In which direction levels and rows are run.
    #[serde(default)]
    pub direction: Direction,
    /// How far above the exact path the posted one may lie, mm; below it, never more than 0.001.
    #[serde(default = "path_tolerance")]
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.0001, "maximum" = 1.0))]
    pub tolerance: f64,
    /// What the posted path is made of.
    #[serde(default)]
    #[schemars(extend("x-not-of" = ["flank", "drill", "helix-bore", "chamfer"]))]
    pub fit: Fit,
    /// Largest angle by which the path turns from one cutting move to the next, degrees: passes that follow the surface get shorter lines
    /// and arcs for it. Edges of the part, straight links and plunges turn by more; the verification names each. Not limited when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-not-of" = ["pocket", "flank", "drill", "helix-bore", "chamfer", "contour"], "x-advanced" = true, "x-unit" = "deg", "minimum" = 0.1, "maximum" = 90.0))]
    pub max_corner_deg: Option<f64>,
    /// No loop is missed whose inside or surroundings hold a disc of this diameter, mm.
    #[serde(default = "smallest_feature")]
    #[schemars(extend("x-not-of" = ["flank", "drill", "helix-bore", "chamfer", "contour"], "x-advanced" = true, "x-unit" = "mm", "minimum" = 0.01, "maximum" = 100.0))]
    pub smallest_feature: f64,
    /// How high rapids from pass to pass go.
    #[serde(default)]
    #[schemars(extend("x-not-of" = ["pocket", "flank", "drill", "helix-bore", "chamfer"]))]
    pub links: LinkHeight,
    /// Air that rapids below clearance keep above the part, the sheet as it stands and uncut stock, mm.
    #[serde(default = "link_margin")]
    #[schemars(extend("x-not-of" = ["pocket", "flank", "drill", "helix-bore", "chamfer"], "x-advanced" = true, "x-unit" = "mm", "minimum" = 0.1, "maximum" = 1000.0))]
    pub link_margin: f64,
    /// How the tool comes from the air into a pass and leaves it; straight where that does not fit. Loops begin where it fits, unless
    /// their seam is stated.
    #[serde(default)]
    #[schemars(extend("x-not-of" = ["pocket", "flank", "drill", "helix-bore", "chamfer"]))]
    pub lead: LeadForm,
    /// Radius of leads, mm.
    #[serde(default = "lead_radius")]
    #[schemars(extend("x-not-of" = ["pocket", "flank", "drill", "helix-bore", "chamfer"], "x-advanced" = true, "x-unit" = "mm", "minimum" = 0.1, "maximum" = 1000.0))]
    pub lead_radius: f64,
    /// Angle of the arcs of leads, degrees.
    #[serde(default = "lead_angle")]
    #[schemars(extend("x-not-of" = ["pocket", "flank", "drill", "helix-bore", "chamfer"], "x-advanced" = true, "x-unit" = "deg", "minimum" = 1.0, "maximum" = 90.0))]
    pub lead_angle_deg: f64,
    /// Feeds.
    #[serde(default)]
    #[schemars(extend("x-example" = "{ cut = 1500.0, plunge = 300.0 }"))]
    pub feeds: Feeds,
    /// Lower feeds before and behind sharp turns and on small arcs, as far as the machine's acceleration asks for them
    /// (`limits.acceleration` and `limits.corner_tolerance` of its file).
    #[serde(default)]
    #[schemars(extend("x-not-of" = ["flank", "drill", "helix-bore", "chamfer"]))]
    pub slow_corners: bool,
    /// The spindle. Where tools cut it must be stated, unless `process.material` is: its speed then follows from that.
    #[serde(default)]
    #[schemars(extend("x-example" = "{ mode = \"fixed\", rpm = 8000 }"))]
    pub spindle: Spindle,
    /// Coolant or lubricant.
    #[serde(default)]
    pub coolant: Coolant,
}

/// The sense of levels and rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Direction {
    /// Every other one in the other direction: counters the twist of a formed sheet.
    #[default]
    Alternate,
    /// All in the same direction: the higher ground on the right of levels, rows along `angle_deg`.
    Same,
    /// All so that the turning tool meets the material from its uncut side: on the right of a tool that turns clockwise.
    Climb,
    /// All the other way round than `climb`.
    Conventional,
}

/// What passes do at the outer edges of the selected faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Edges {
    /// The tool rolls over them, its contact on the edge, until it touches another face or leaves the edge.
    Roll,
    /// They end where the contact reaches the edge.
    Stop,
}

/// What the posted path along passes is made of, within the tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Fit {
    /// Lines.
    #[default]
    Lines,
    /// Arcs and lines, of which fewer are needed; lines where the machine has no arc for it.
    Arcs,
}

/// How high rapids from pass to pass go.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LinkHeight {
    /// To clearance.
    #[default]
    Clearance,
    /// `link_margin` above what stands under the line that they cross, clearance at most: for machines whose rapids go straight.
    Low,
}

impl OperationKeys {
    /// Stock that stays on walls, and under the tool, mm.
    #[must_use]
    pub fn stock_to_leave(&self) -> [f64; 2] {
        [self.radial_stock_to_leave, self.axial_stock_to_leave]
    }

    /// Whether any stays.
    #[must_use]
    pub fn leaves_stock(&self) -> bool {
        self.stock_to_leave().iter().any(|left| *left > 0.0)
    }

    /// Largest angle by which the path is to turn from one cutting move to the next, rad; infinite where it is not limited.
    #[must_use]
    pub fn corner(&self) -> f64 {
        self.max_corner_deg.map_or(f64::INFINITY, f64::to_radians)
    }
}

/// The form of leads into passes and out of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LeadForm {
    /// None: straight down and straight up.
    #[default]
    None,
    /// An arc tangent to the pass, in its plane, on the free side.
    Tangent,
    /// An arc tangent to the pass in the vertical plane, from above.
    Vertical,
}

/// Feeds, mm/min.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Feeds {
    /// Along the path.
    #[schemars(extend("x-unit" = "mm/min", "minimum" = 0.1, "maximum" = 100000.0))]
    pub cut: f64,
    /// Straight down onto it.
    #[schemars(extend("x-unit" = "mm/min", "minimum" = 0.1, "maximum" = 100000.0))]
    pub plunge: f64,
    /// Along leads into a pass; as `cut` when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm/min", "minimum" = 0.1, "maximum" = 100000.0))]
    pub approach: Option<f64>,
    /// Along leads out of a pass; as `cut` when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm/min", "minimum" = 0.1, "maximum" = 100000.0))]
    pub exit: Option<f64>,
}

impl Feeds {
    /// Along leads into a pass, mm/min.
    #[must_use]
    pub fn approaching(&self) -> f64 {
        self.approach.unwrap_or(self.cut)
    }

    /// Along leads out of a pass, mm/min.
    #[must_use]
    pub fn leaving(&self) -> f64 {
        self.exit.unwrap_or(self.cut)
    }
}

impl Default for Feeds {
    fn default() -> Self {
        Self { cut: 1500.0, plunge: 300.0, approach: None, exit: None }
    }
}

/// What the spindle does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "mode", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Spindle {
    /// It stands: a stylus slides.
    #[default]
    Off,
    /// It is not driven and turns as the sheet takes it along; the operator releases its brake.
    Free,
    /// It rolls along the steepest of the walls instead of sliding: its speed follows from the feed.
    Rolling,
    /// It turns.
    Fixed {
        /// Speed, rev/min.
        #[schemars(extend("x-unit" = "rev/min", "exclusiveMinimum" = 0.0, "maximum" = 1000000.0))]
        rpm: f64,
        /// Sense, seen from above.
        #[serde(default = "clockwise")]
        direction: SpindleDirection,
    },
}

impl Spindle {
    /// The speed at which it is driven, rev/min, where it is.
    #[must_use]
    pub fn rpm(&self) -> Option<f64> {
        match self {
            Self::Fixed { rpm, .. } => Some(*rpm),
            Self::Off | Self::Free | Self::Rolling => None,
        }
    }

    /// Its sense; none while it is not driven.
    #[must_use]
    pub fn direction(&self) -> Option<SpindleDirection> {
        match self {
            Self::Off | Self::Free => None,
            Self::Rolling => Some(SpindleDirection::Clockwise),
            Self::Fixed { direction, .. } => Some(*direction),
        }
    }
}

/// Coolant or lubricant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Coolant {
    /// None.
    #[default]
    Off,
    /// Flood.
    Flood,
}

/// Refuses the first of some keys that is stated; `why` names it in a message and a hint, and `path` is the operation's.
///
/// # Errors
/// One is stated.
pub(super) fn refuse(
    keys: &[(&str, bool)],
    path: &str,
    why: impl Fn(&str) -> (String, String),
) -> Result<(), JobError> {
    let Some((key, _)) = keys.iter().find(|(_, is_stated)| *is_stated) else { return Ok(()) };
    let (message, hint) = why(key);
    Err(JobError::document("conflict", format!("{path}.{key}"), message, hint))
}

fn path_tolerance() -> f64 {
    0.005
}

fn link_margin() -> f64 {
    1.0
}

fn lead_radius() -> f64 {
    2.0
}

fn lead_angle() -> f64 {
    90.0
}

fn smallest_feature() -> f64 {
    1.0
}

fn clockwise() -> SpindleDirection {
    SpindleDirection::Clockwise
}
