//! The job document as people write it. Lengths in mm, angles in degrees, feeds in mm/min.
//!
//! Every number's unit is in its schema as `x-unit`: by these a document in inches becomes one in mm (`units`).
//! Defaults, ranges and descriptions are here and nowhere else; which keys go together is in `check`.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::{Base, CutterMaterial, Holder, ModelFace, ProfileDocument, SheetLaw};
use styluscam_motion::ToolReference;

use crate::selection::CheckSelection;
use crate::{
    AddendumSection, Chuck, FixtureSection, OperationSection, ProcessSection, Risk, Selection, SpringbackSection,
    Stages, StockSection, Units, UpAxis,
};

/// A whole job: from a part's faces to a machine's program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JobDocument {
    /// Version of this document: 1.
    #[schemars(extend("x-example" = "1"))]
    pub schema: u32,
    /// A name for people; the part's file name when left out.
    #[serde(default)]
    pub title: String,
    /// Risks that are taken: what the verifier would report for them as an error becomes a warning.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("x-advanced" = true))]
    pub accept: Vec<Risk>,
    /// The unit of every length in this document: "mm" or "inch", and feeds in it per minute. What is left out is as in mm; a
    /// part's file, tool files and machine files have units of their own.
    #[serde(default, skip_serializing_if = "LengthUnit::is_mm")]
    pub units: LengthUnit,
    /// The part, and which of its faces are selected.
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
    /// The machines of further channels, by channel, where the process has any.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub machines: BTreeMap<String, MachineSection>,
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

/// The part, and which of its faces are selected.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PartSection {
    /// STEP, BREP, IGES, STL, OBJ, PLY or 3MF; relative to the job file.
    pub file: String,
    /// Unit of a file that does not state one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub units: Option<Units>,
    /// "all" (the faces that face up; levels that mill take upright walls too), or names: ["Face3", "Face4"].
    #[serde(default)]
    pub faces: Selection,
    /// Faces that the tool keeps away from: "rest" (all others), or names: ["Face7"].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub check_faces: Option<CheckSelection>,
    /// How far tool, shank and holder, with the sheet under them, stay away from those faces, mm; 0 when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.0, "maximum" = 1000.0))]
    pub check_clearance: Option<f64>,
    /// Which face of the sheet the model shows; required with a sheet.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-takes-sheet" = true))]
    pub model_face: Option<ModelFace>,
    /// Largest deviation of the triangles from the model's surfaces, mm; checked by sampling.
    #[serde(default = "part_tolerance")]
    #[schemars(extend("x-advanced" = true, "x-unit" = "mm", "minimum" = 0.0001, "maximum" = 1.0))]
    pub tolerance: f64,
    /// Plan what can be reached of named faces that partly face down.
    #[serde(default)]
    #[schemars(extend("x-advanced" = true))]
    pub allow_undercuts: bool,
    /// What formed parts were measured, or simulated, to deviate by: the part is formed the other way. The verifier then compares
    /// with the part as it is formed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-takes-sheet" = true, "x-advanced" = true, "x-example" = "{ deviations = [\"trial-1.csv\"], units = \"mm\" }"))]
    pub springback: Option<SpringbackSection>,
    /// What is formed around a part without a flange: a wall from its outer edge to the blank's plane. Its faces have the names
    /// "Addendum" and "Blank".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-takes-sheet" = true, "x-advanced" = true, "x-example" = "{ wall_angle_deg = 45.0 }"))]
    pub addendum: Option<AddendumSection>,
    /// Intermediate stages: their wall angles, degrees, rising, [50.0, 65.0]; or how many, 2, which are then spread evenly between
    /// what the sheet withstands in one pass and the part's steepest wall. All operations are done for each stage first, whose walls
    /// are no steeper, and for the part at last; for walls that the sheet does not withstand in one pass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-takes-sheet" = true, "x-advanced" = true, "x-example" = "[50.0, 65.0]", "minimum" = 1.0, "maximum" = 89.0))]
    pub stages: Option<Stages>,
}

/// How the part lies on the machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SetupSection {
    /// Axis of the model that points up, to the spindle of a chuck above.
    pub up: UpAxis,
    /// Turn about the machine's Z after that, degrees.
    #[schemars(extend("x-unit" = "deg", "minimum" = -360.0, "maximum" = 360.0))]
    pub rotation: f64,
    /// Whether the chuck that holds the tool is "above" the sheet or the part, or "below" it. Below, the machine's axes are those
    /// above turned half about X: Z points down to the spindle, Y the other way; positions and heights of the job are in these axes.
    #[schemars(extend("x-advanced" = true))]
    pub chuck: Chuck,
    /// Where the program's zero is; "sheet-top" with a sheet, else "model", when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "mm", "minimum" = -100000.0, "maximum" = 100000.0))]
    pub zero: Option<Zero>,
    /// Work offset.
    pub wcs: String,
    /// Height above the stock's (or the sheet's) highest point at which rapids cross it, mm.
    #[schemars(extend("x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 1000.0))]
    pub clearance: f64,
    /// Height above that point down to which rapids go before a plunge, mm.
    #[schemars(extend("x-unit" = "mm", "minimum" = 0.1, "maximum" = 1000.0))]
    pub retract: f64,
    /// The blank.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-example" = "{ thickness = 1.0 }"))]
    pub sheet: Option<SheetSection>,
    /// What the part is cut from; its box when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-example" = "{ kind = \"box\", sides = 2.0, top = 1.0 }"))]
    pub stock: Option<StockSection>,
    /// What holds it.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-takes-sheet" = true, "x-advanced" = true, "x-example" = "{ clamp = { opening = [200.0, 150.0], height = 8.0 } }"))]
    pub fixture: Option<FixtureSection>,
}

impl Default for SetupSection {
    fn default() -> Self {
        Self {
            up: UpAxis::default(),
            rotation: 0.0,
            chuck: Chuck::default(),
            zero: None,
            wcs: "G54".to_owned(),
            clearance: 10.0,
            retract: 2.0,
            sheet: None,
            stock: None,
            fixture: None,
        }
    }
}

/// Where the program's zero is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "ZeroText", into = "ZeroText")]
pub enum Zero {
    /// X and Y of the model's origin; Z on the sheet's face towards the tool, where that is nearest to the spindle.
    SheetTop,
    /// The model's origin.
    Model,
    /// This point of the turned model, as it lies for a chuck above, mm.
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
    #[schemars(extend("x-example" = "1.0", "x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 50.0))]
    pub thickness: f64,
    /// How the thickness behaves as the sheet is formed.
    #[serde(default)]
    pub law: SheetLaw,
    /// Thinnest that the sheet may become, by the sine law, mm; not checked when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-advanced" = true, "x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 50.0))]
    pub min_thickness: Option<f64>,
    /// Steepest wall that may be formed, degrees; when left out, what is known of `process.material`, or of any sheet, decides.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-advanced" = true, "x-unit" = "deg", "minimum" = 1.0, "maximum" = 90.0))]
    pub max_wall_angle_deg: Option<f64>,
    /// Tensile strength of its material, MPa: for an estimate of the axial force; none is made when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-advanced" = true, "x-unit" = "MPa", "minimum" = 1.0, "maximum" = 3000.0))]
    pub tensile_strength: Option<f64>,
}

/// A tool of the job.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ToolSection {
    /// Its number in the machine's tool table.
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
    #[schemars(extend("x-example" = "{ kind = \"ball\", diameter = 10.0 }"))]
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
    /// How many cutting edges it has.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("minimum" = 1, "maximum" = 100))]
    pub flutes: Option<u32>,
    /// What its cutting edges are made of: "hss" (high-speed steel) or "carbide".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cutter_material: Option<CutterMaterial>,
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
    /// The curve along which a part with an addendum is cut off, as a table of points in work coordinates ("trim.csv": curve, x, y,
    /// z, in mm); none when left out.
    pub trim: String,
}

fn one() -> u32 {
    1
}

fn part_tolerance() -> f64 {
    0.001
}
