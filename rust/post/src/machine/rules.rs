//! The tables of a machine file: plain data, one struct per table.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The kind of text that the controller reads; it chooses the writer and the reader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// Words of a letter and a number (ISO 6983, RS-274).
    Gcode,
}

/// What the file's facts were taken from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Source {
    /// Manuals and sources that were read.
    pub read: Vec<String>,
    /// What is assumed, or surprising.
    #[serde(default)]
    pub notes: Vec<String>,
}

/// A unit of length in posted text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LengthUnit {
    /// Millimetres, feeds in mm/min.
    Mm,
    /// Inches, feeds in inch/min.
    Inch,
}

impl LengthUnit {
    /// Millimetres in one unit.
    #[must_use]
    pub fn in_mm(self) -> f64 {
        match self {
            Self::Mm => 1.0,
            Self::Inch => 25.4,
        }
    }
}

/// Units of the posted text.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Units {
    /// What is posted.
    pub output: LengthUnit,
    /// The word that selects millimetres: `G21`.
    pub mm: Option<String>,
    /// The word that selects inches: `G20`.
    pub inch: Option<String>,
}

/// Decimal places by kind of number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Decimals {
    /// Of coordinates.
    pub linear: u8,
    /// Of feeds.
    pub feed: u8,
}

/// When a number carries a decimal point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Point {
    /// Only before a fraction: `10`, `10.5`.
    #[default]
    IfFraction,
    /// On every coordinate, feed and dwell: `10.`; controls that read `10` as 10 least increments need it.
    Always,
}

/// What happens to zeros at a fraction's end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TrailingZeros {
    /// Left out: `10.5`.
    #[default]
    Strip,
    /// Written: `10.500`.
    Keep,
}

/// How numbers are written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NumberRules {
    /// Decimal places when the output is in mm.
    pub mm: Decimals,
    /// Decimal places when the output is in inches.
    pub inch: Decimals,
    /// Decimal places of spindle speeds.
    #[serde(default)]
    pub rpm: u8,
    /// When a number carries a decimal point.
    #[serde(default)]
    pub point: Point,
    /// What happens to zeros at a fraction's end.
    #[serde(default)]
    pub trailing_zeros: TrailingZeros,
    /// Whether the zero before a fraction is written: `0.5` or `.5`.
    #[serde(default = "yes")]
    pub leading_zero: bool,
    /// Whether positive numbers carry a `+`.
    #[serde(default)]
    pub plus_sign: bool,
}

/// What the controller counts against the length of a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Counted {
    /// Every character.
    #[default]
    All,
    /// Neither spaces nor comments.
    Code,
}

/// The mark at a line's end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LineEnd {
    /// A line feed.
    #[default]
    Lf,
    /// A carriage return and a line feed.
    Crlf,
}

/// What a line of text may be.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LineRules {
    /// Longest line, in characters without the end mark.
    pub max_chars: u32,
    /// What counts.
    #[serde(default)]
    pub counted: Counted,
    /// The end mark.
    #[serde(default)]
    pub eol: LineEnd,
    /// Characters that must not stand anywhere, over and above all that is not printable ASCII.
    #[serde(default)]
    pub forbidden: String,
}

/// How a remark is marked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CommentForm {
    /// `(text)`.
    Paren,
    /// `; text`, to the line's end.
    Semicolon,
    /// The controller takes none: remarks are left out.
    None,
}

/// How remarks are written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CommentRules {
    /// The marks.
    pub form: CommentForm,
    /// Longest text inside the marks, in characters; the line's length when left out.
    pub max_len: Option<u32>,
    /// Whether letters are made capitals.
    #[serde(default)]
    pub uppercase: bool,
    /// Characters that may stand, with ranges: `A-Z0-9 .,-` (a `-` at an end is itself). All printable ASCII when left out.
    pub charset: Option<String>,
    /// What stands for characters outside the set; anything else becomes `_`, or is dropped where `_` is outside too.
    #[serde(default)]
    pub substitutions: BTreeMap<char, String>,
    /// First words that the controller takes as orders when a comma or the end follows: a `-` is put before them.
    #[serde(default)]
    pub active: Vec<String>,
}

/// Numbers before the blocks (N words).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BlockNumber {
    /// The first.
    pub start: u32,
    /// From one to the next.
    pub step: u32,
    /// The last; numbering starts again after it.
    #[serde(default = "largest_block_number")]
    pub max: u32,
}

fn largest_block_number() -> u32 {
    99_999
}

/// What stands between words.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Separator {
    /// One space.
    #[default]
    Space,
    /// Nothing.
    None,
}

/// When a word is written again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Repeat {
    /// When it changes.
    #[default]
    Modal,
    /// In every block.
    Always,
}

/// How words are put together.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WordRules {
    /// What stands between them.
    #[serde(default)]
    pub separator: Separator,
    /// When G0 and G1 are written again.
    #[serde(default)]
    pub repeat_g: Repeat,
    /// When axis words are written again.
    #[serde(default)]
    pub repeat_axes: Repeat,
}

/// How a tool comes into the spindle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ToolChange {
    /// `T1 M6`: the machine changes it, or asks for it.
    M6,
    /// The program stops and the operator changes it; lengths must be equal, since nothing corrects them.
    Pause,
    /// The one tool is in the spindle before the start; a second one is an error.
    LoadBeforeStart,
}

/// How a tool's length is applied.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LengthOffset {
    /// `G43 H1`.
    G43H,
    /// The controller has none, or applies it by itself.
    None,
}

/// Tools.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ToolRules {
    /// How a tool comes into the spindle.
    pub change: ToolChange,
    /// How its length is applied.
    pub length: LengthOffset,
    /// Largest tool number.
    pub max_number: u32,
}

/// Spindle words; a word left out is a direction that the machine does not have.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpindleRules {
    /// Turn clockwise: `M3`; the speed comes before it.
    pub clockwise: Option<String>,
    /// Turn counterclockwise: `M4`.
    pub counterclockwise: Option<String>,
    /// Stop: `M5`.
    pub off: Option<String>,
}

/// Coolant words; a word left out is something that the machine does not have.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CoolantRules {
    /// Mist on: `M7`.
    pub mist: Option<String>,
    /// Flood on: `M8`.
    pub flood: Option<String>,
    /// Everything off: `M9`.
    pub off: Option<String>,
}

/// Rounding of the path by the controller. The tolerance is part of the path's error: planning subtracts it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SmoothingRules {
    /// How far the controller may leave the programmed path, mm; 0 is exact.
    #[serde(default)]
    pub tolerance: f64,
    /// Template of the block that sets it; `tolerance` is in output units, rounded down.
    pub on: Option<String>,
    /// The block for an exact path.
    pub off: Option<String>,
}

/// A unit of time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TimeUnit {
    /// Seconds, with a fraction.
    S,
    /// Milliseconds, whole.
    Ms,
}

/// The wait, `G4`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DwellRules {
    /// The letter that carries the time: P, X or S.
    pub word: char,
    /// Its unit.
    pub unit: TimeUnit,
}

/// How far an arc's ends may differ in their distance from its centre, mm: text is rounded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RadiusError {
    /// A difference that is always taken, mm.
    pub absolute: f64,
    /// A larger one is taken up to this share of the radius,
    pub relative: f64,
    /// and never beyond this, mm.
    pub most: f64,
}

impl RadiusError {
    /// Whether the controller takes an arc of this radius whose ends differ so much, mm.
    #[must_use]
    pub fn takes(&self, mismatch: f64, radius: f64) -> bool {
        mismatch <= self.absolute || mismatch <= (self.relative * radius).min(self.most)
    }
}

/// Arcs: G2 and G3 in G17, G18 and G19, the centre given from the start by I, J and K.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArcRules {
    /// How exact an arc must be.
    pub radius_error: RadiusError,
    /// Whether a P word gives the number of turns.
    #[serde(default)]
    pub turns: bool,
    /// Whether a full circle needs an axis word.
    #[serde(default)]
    pub needs_axis: bool,
}

/// What the machine can do. Lengths mm in work coordinates, feeds mm/min, speeds rev/min.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Lowest and highest posted X, mm, with the zero point where the job puts it.
    pub x: Option<[f64; 2]>,
    /// Lowest and highest posted Y, mm.
    pub y: Option<[f64; 2]>,
    /// Lowest and highest posted Z, mm.
    pub z: Option<[f64; 2]>,
    /// Lengths of the axes, mm, wherever the zero point is.
    pub travel: Option<[f64; 3]>,
    /// Largest feed, mm/min.
    pub max_feed: Option<f64>,
    /// Speed of rapids, mm/min: for estimates of time.
    pub rapid_rate: f64,
    /// Acceleration along the path, mm/s^2: for estimates of time; without it speeds change at once.
    pub acceleration: Option<f64>,
    /// How far the controller cuts corners, mm: for estimates of time; the smoothing's tolerance when left out.
    pub corner_tolerance: Option<f64>,
    /// Blocks that the controller reads in a second: for estimates of time.
    pub blocks_per_second: Option<f64>,
    /// Smallest spindle speed, rev/min.
    pub min_rpm: Option<f64>,
    /// Largest spindle speed, rev/min.
    pub max_rpm: Option<f64>,
}

/// Text around the moves, in minijinja. A line that comes out empty is left out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Templates {
    /// What `header` holds in the other templates; a summary of the set-up when left out.
    pub header: Option<String>,
    /// Before everything else: the header, units, modes, work offset.
    pub program_start: String,
    /// For every tool change; what `[tool]` says when left out.
    pub tool_change: Option<String>,
    /// Where an operation begins, after its tool change.
    #[serde(default)]
    pub operation_start: String,
    /// After everything else.
    pub program_end: String,
}

/// What a `/` at a block's start does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BlockDelete {
    /// The block is left out.
    Skip,
    /// The mark is ignored and the block runs.
    Run,
    /// The controller refuses it.
    Error,
}

/// What text after the program's end does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AfterEnd {
    /// It is not read.
    Ignore,
    /// The controller would run it: code there is an error.
    Error,
}

/// How text of this machine is read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReaderRules {
    /// Whether `%` lines around the program are taken.
    pub percent: bool,
    /// What a `/` at a block's start does.
    pub block_delete: BlockDelete,
    /// Whether a program must end with M2, M30 or a closing `%`.
    pub end_required: bool,
    /// What text after the end does.
    pub after_end: AfterEnd,
    /// The unit before G20 or G21; left out, motion before either is an error.
    pub default_units: Option<LengthUnit>,
    /// Codes that the reader knows and this controller refuses: `M6`.
    #[serde(default)]
    pub refused: Vec<String>,
}

fn yes() -> bool {
    true
}
