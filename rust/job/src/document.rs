//! The job document as people write it. Lengths in mm, angles in degrees, feeds in mm/min.
//!
//! Every number's unit stands in its schema as `x-unit`: by these a document in inches becomes one in mm (`units`).
//! Defaults and descriptions stand here and nowhere else; ranges stand in `check`.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::{Base, Holder, ModelFace, ProfileDocument, SheetLaw};
use styluscam_motion::{SpindleDirection, ToolReference};

use crate::{FixtureSection, Risk};

/// A whole job: from a part's faces to a machine's program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JobDocument {
    /// Version of this document: 1.
    pub schema: u32,
    /// A name for people; the part's file name when left out.
    #[serde(default)]
    pub title: String,
    /// Risks that are taken: what the judge would refuse for them becomes a warning.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub accept: Vec<Risk>,
    /// The unit of every length in this document: "mm" or "inch", and feeds in it per minute. What is left out is as in mm; a
    /// part's file, tool files and machine files have units of their own.
    #[serde(default, skip_serializing_if = "LengthUnit::is_mm")]
    pub units: LengthUnit,
    /// The part and what of it is wanted.
    pub part: PartSection,
    /// How the part lies on the machine.
    #[serde(default)]
    pub setup: SetupSection,
    /// What is done to it.
    #[serde(default)]
    pub process: ProcessSection,
    /// The tools, by name.
    pub tools: BTreeMap<String, ToolSection>,
    /// What is done, in order.
    pub operations: Vec<OperationSection>,
    /// The machine.
    pub machine: MachineSection,
    /// What is written.
    #[serde(default)]
    pub output: OutputSection,
}

/// The unit of a document's lengths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LengthUnit {
    /// Millimetres, feeds in mm/min.
    #[default]
    Mm,
    /// Inches, feeds in inch/min.
    #[serde(alias = "in")]
    Inch,
}

/// The part and what of it is wanted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PartSection {
    /// STEP, BREP, IGES, STL, OBJ, PLY or 3MF; relative to the job file.
    pub file: String,
    /// Unit of a file that does not state one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub units: Option<Units>,
    /// "all" (the faces that look up; for levels in milling upright walls too), or names: ["Face3", "Face4"].
    #[serde(default)]
    pub faces: Selection,
    /// Which face of the sheet the model shows; required with a sheet.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub model_face: Option<ModelFace>,
    /// Largest deviation of the triangles from the model's surfaces, mm; checked by sampling.
    #[serde(default = "part_tolerance")]
    #[schemars(extend("x-unit" = "mm"))]
    pub tolerance: f64,
    /// Plan what can be reached of named faces that partly look down.
    #[serde(default)]
    pub allow_undercuts: bool,
}

/// Units of a mesh file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Units {
    /// Millimetres.
    Mm,
    /// Centimetres.
    Cm,
    /// Metres.
    M,
    /// Inches.
    #[serde(alias = "inch")]
    In,
    /// Feet.
    Ft,
    /// Micrometres.
    Um,
}

/// Faces by rule or by name.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "SelectionText", into = "SelectionText")]
pub enum Selection {
    /// All faces that look up.
    #[default]
    All,
    /// These.
    Named(Vec<String>),
}

#[derive(Clone, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected \"all\" or a list of face names like [\"Face3\", \"Face4\"]")]
enum SelectionText {
    Word(String),
    Names(Vec<String>),
}

impl TryFrom<SelectionText> for Selection {
    type Error = String;

    fn try_from(text: SelectionText) -> Result<Self, String> {
        match text {
            SelectionText::Word(word) if word == "all" => Ok(Self::All),
            SelectionText::Word(word) => {
                Err(format!("{word:?} is not a selection: write \"all\" or a list of names like [\"Face3\"]"))
            }
            SelectionText::Names(names) => Ok(Self::Named(names)),
        }
    }
}

impl From<Selection> for SelectionText {
    fn from(selection: Selection) -> Self {
        match selection {
            Selection::All => Self::Word("all".to_owned()),
            Selection::Named(names) => Self::Names(names),
        }
    }
}

/// How the part lies on the machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SetupSection {
    /// Axis of the model that points to the spindle.
    pub up: UpAxis,
    /// Turn about the machine's Z after that, degrees.
    #[schemars(extend("x-unit" = "deg"))]
    pub rotation: f64,
    /// Where the program's zero is; "sheet-top" with a sheet, else "model", when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm"))]
    pub zero: Option<Zero>,
    /// Work offset.
    pub wcs: String,
    /// Height above the part's (or the sheet's) highest point at which rapids cross it, mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub clearance: f64,
    /// Height above that point down to which rapids go before a plunge, mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub retract: f64,
    /// The blank.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sheet: Option<SheetSection>,
    /// What holds it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fixture: Option<FixtureSection>,
}

impl Default for SetupSection {
    fn default() -> Self {
        Self {
            up: UpAxis::default(),
            rotation: 0.0,
            zero: None,
            wcs: "G54".to_owned(),
            clearance: 10.0,
            retract: 2.0,
            sheet: None,
            fixture: None,
        }
    }
}

/// An axis of the model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum UpAxis {
    /// +X.
    #[serde(rename = "+x")]
    PlusX,
    /// -X.
    #[serde(rename = "-x")]
    MinusX,
    /// +Y.
    #[serde(rename = "+y")]
    PlusY,
    /// -Y.
    #[serde(rename = "-y")]
    MinusY,
    /// +Z.
    #[default]
    #[serde(rename = "+z")]
    PlusZ,
    /// -Z: the model upside down.
    #[serde(rename = "-z")]
    MinusZ,
}

/// Where the program's zero is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "ZeroText", into = "ZeroText")]
pub enum Zero {
    /// X and Y of the model's origin; Z on the sheet's face towards the tool, where it is highest.
    SheetTop,
    /// The model's origin.
    Model,
    /// This point of the turned model, mm.
    Point([f64; 3]),
}

#[derive(Clone, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected \"sheet-top\", \"model\" or a point [x, y, z]")]
enum ZeroText {
    Word(String),
    Point([f64; 3]),
}

impl TryFrom<ZeroText> for Zero {
    type Error = String;

    fn try_from(text: ZeroText) -> Result<Self, String> {
        match text {
            ZeroText::Word(word) if word == "sheet-top" => Ok(Self::SheetTop),
            ZeroText::Word(word) if word == "model" => Ok(Self::Model),
            ZeroText::Word(word) => {
                Err(format!("{word:?} is not a zero point: write \"sheet-top\", \"model\" or a point [x, y, z]"))
            }
            ZeroText::Point(point) => Ok(Self::Point(point)),
        }
    }
}

impl From<Zero> for ZeroText {
    fn from(zero: Zero) -> Self {
        match zero {
            Zero::SheetTop => Self::Word("sheet-top".to_owned()),
            Zero::Model => Self::Word("model".to_owned()),
            Zero::Point(point) => Self::Point(point),
        }
    }
}

/// The blank.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SheetSection {
    /// Thickness, mm.
    #[schemars(extend("x-unit" = "mm"))]
    pub thickness: f64,
    /// How the thickness behaves as the sheet is formed.
    #[serde(default)]
    pub law: SheetLaw,
    /// Thinnest that the sheet may become, by the sine law, mm; not judged when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm"))]
    pub min_thickness: Option<f64>,
    /// Steepest wall that may be formed, degrees; when left out, what is known of `process.material`, or of any sheet, judges.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "deg"))]
    pub max_wall_angle_deg: Option<f64>,
}

/// What is done to the part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ProcessSection {
    /// Forming a sheet, or milling.
    pub kind: Process,
    /// What the sheet is made of, by the name of a shipped material: says how steep a wall it bears.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    /// Most that may be left on the faces where the tool cannot get, mm; 1 mm of a sheet, and not judged in milling, when left
    /// out.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm"))]
    pub max_bridged: Option<f64>,
    /// Share of the faces, 0 to 1, that the tool may be unable to get to.
    #[schemars(extend("x-unit" = "1"))]
    pub max_unreached: f64,
}

impl Default for ProcessSection {
    fn default() -> Self {
        Self { kind: Process::default(), material: None, max_bridged: None, max_unreached: 0.1 }
    }
}

/// Processes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Process {
    /// Single-point incremental forming: a sheet, no die.
    #[default]
    #[schemars(extend("x-takes-sheet" = true))]
    Spif,
    /// Milling: no sheet.
    Milling,
}

/// A tool of the job.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ToolSection {
    /// Its place in the machine's tool table.
    #[serde(default = "one")]
    pub number: u32,
    /// Number of its length offset; the tool's number when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length_offset: Option<u32>,
    /// Which point the program moves: the tip, or the centre of a ball.
    #[serde(default)]
    pub reference: ToolReference,
    /// The curve from tip to base; this or `library`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub profile: Option<ProfileDocument>,
    /// A shipped tool by its name ("clothoid:medium"), or a tool file (.json, .fctb); the other keys go before its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub library: Option<String>,
    /// What joins the profile's base to the shank.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub base: Option<Base>,
    /// Diameter of the shank, mm; the base's when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm"))]
    pub shank_diameter: Option<f64>,
    /// Length from tip to holder, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm"))]
    pub length: Option<f64>,
    /// The holder above it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub holder: Option<Holder>,
}

/// One operation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OperationSection {
    /// A name, unique in the job; made from kind and place when left out.
    #[serde(default)]
    pub id: String,
    /// The strategy.
    pub kind: OperationKind,
    /// Name of the tool.
    pub tool: String,
    /// Faces of this operation alone; the part's when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub faces: Option<Selection>,
    /// Height from which levels are counted, mm in work coordinates; the selected faces' top when left out. Rows (zig-zag) end there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm"))]
    pub z_top: Option<f64>,
    /// Lowest level, mm in work coordinates; as deep as the tool reaches when left out. Rows (zig-zag) end there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm"))]
    pub z_bottom: Option<f64>,
    /// Distance between levels (z-level).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step: Option<Step>,
    /// Distance between rows in plan, mm (zig-zag).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm"))]
    pub stepover: Option<f64>,
    /// Direction of rows from +X, degrees (zig-zag).
    #[serde(default)]
    #[schemars(extend("x-unit" = "deg"))]
    pub angle_deg: f64,
    /// Whether every other level or row is run the other way.
    #[serde(default)]
    pub direction: Direction,
    /// How far above the exact path the posted one may lie, mm; below it, never more than 0.001.
    #[serde(default = "path_tolerance")]
    #[schemars(extend("x-unit" = "mm"))]
    pub tolerance: f64,
    /// No loop is missed whose inside or surroundings hold a disc of this diameter, mm.
    #[serde(default = "smallest_feature")]
    #[schemars(extend("x-unit" = "mm"))]
    pub smallest_feature: f64,
    /// Feeds.
    #[serde(default)]
    pub feeds: Feeds,
    /// The spindle.
    #[serde(default)]
    pub spindle: Spindle,
    /// Coolant or lubricant.
    #[serde(default)]
    pub coolant: Coolant,
}

/// Strategies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum OperationKind {
    /// Loops at constant heights, from the top down.
    ZLevel,
    /// Parallel rows over the surface.
    ZigZag,
}

impl OperationKind {
    /// Its name as the document writes it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::ZLevel => "z-level",
            Self::ZigZag => "zig-zag",
        }
    }
}

/// What sets the distance between levels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Step {
    /// This distance, mm.
    #[schemars(extend("x-unit" = "mm"))]
    Height(f64),
}

/// The sense of levels and rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Direction {
    /// Every other one the other way: counters the twist of a formed sheet.
    #[default]
    Alternate,
    /// All the same way: the higher ground on the right of levels, rows along `angle_deg`.
    Same,
}

/// Feeds, mm/min.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Feeds {
    /// Along the path.
    #[schemars(extend("x-unit" = "mm/min"))]
    pub cut: f64,
    /// Straight down onto it.
    #[schemars(extend("x-unit" = "mm/min"))]
    pub plunge: f64,
}

impl Default for Feeds {
    fn default() -> Self {
        Self { cut: 1500.0, plunge: 300.0 }
    }
}

/// What the spindle does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "mode", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Spindle {
    /// It stands: a stylus slides.
    #[default]
    Off,
    /// It turns.
    Fixed {
        /// Speed, rev/min.
        #[schemars(extend("x-unit" = "rev/min"))]
        rpm: f64,
        /// Sense, seen from above.
        #[serde(default = "clockwise")]
        direction: SpindleDirection,
    },
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

/// The machine: shipped, or a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MachineSection {
    /// Name of a shipped machine: "linuxcnc", "grbl".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// A machine file; relative to the job file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Values for the options that the machine declares.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub options: BTreeMap<String, styluscam_post::OptionValue>,
}

/// What is written. Paths are relative to the job file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct OutputSection {
    /// The G-code; the job's name with the machine's ending when left out.
    pub file: String,
    /// The program as JSON; beside the G-code when left out.
    pub program: String,
    /// The report as an HTML page; none when left out.
    pub report: String,
}

fn one() -> u32 {
    1
}

fn part_tolerance() -> f64 {
    0.001
}

fn path_tolerance() -> f64 {
    0.005
}

fn smallest_feature() -> f64 {
    1.0
}

fn clockwise() -> SpindleDirection {
    SpindleDirection::Clockwise
}
