//! Units, numbers, lines, remarks and words: how text looks.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
    /// Of feeds per revolution.
    #[serde(default = "four")]
    pub feed_per_revolution: u8,
    /// Of inverse time, moves in a minute.
    #[serde(default = "four")]
    pub inverse_time: u8,
}

fn four() -> u8 {
    4
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
    #[serde(default = "super::yes")]
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
    /// `: text`, to the line's end.
    Colon,
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
    /// What stands for characters outside the set, over and above the common ones (`°` becomes ` deg`); anything else becomes
    /// `_`, or is dropped where `_` is outside too.
    #[serde(default)]
    pub substitutions: BTreeMap<char, String>,
    /// First words that the controller takes as commands when a comma or the end follows: a `-` is put before them.
    #[serde(default)]
    pub active: Vec<String>,
}

/// Which blocks carry a number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Numbered {
    /// Every block, remarks alone not.
    #[default]
    Blocks,
    /// Every line.
    Lines,
    /// The first block of every tool change: where an operator starts again.
    ToolChanges,
}

/// Numbers before the blocks (N words).
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BlockNumber {
    /// What stands before the number.
    #[serde(default = "letter_n")]
    pub prefix: String,
    /// Which blocks carry one.
    #[serde(default)]
    pub which: Numbered,
    /// Digits at least, filled up with zeros.
    #[serde(default)]
    pub digits: u8,
    /// The first.
    pub start: u32,
    /// From one to the next.
    pub step: u32,
    /// The last; numbering starts again after it.
    #[serde(default = "largest_block_number")]
    pub max: u32,
}

impl BlockNumber {
    /// N words on every block.
    #[must_use]
    pub fn plain(start: u32, step: u32, max: u32) -> Self {
        Self { prefix: letter_n(), which: Numbered::Blocks, digits: 0, start, step, max }
    }
}

fn letter_n() -> String {
    "N".into()
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
    /// Whether a line takes no more than one G or M.
    #[serde(default)]
    pub one_command: bool,
}
