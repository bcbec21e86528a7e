//! Templates, and how text of a machine is read.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{CommentForm, LengthUnit};

/// Text around the moves, in minijinja. A line that comes out empty is left out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Templates {
    /// What `header` holds in the other templates; a summary of the set-up when left out.
    pub header: Option<String>,
    /// Before everything else: the header, units, modes, work offset.
    pub program_start: String,
    /// For every tool change; the words of `[tool]` when left out.
    pub tool_change: Option<String>,
    /// Where an operation begins, after its tool change.
    #[serde(default)]
    pub operation_start: String,
    /// Where an operation ends.
    #[serde(default)]
    pub operation_end: String,
    /// Where the work offset changes between operations; its words when left out.
    pub work_offset: Option<String>,
    /// Where the program stops for the operator; the word of `[stop]` when left out. `optional` states which stop it is.
    pub stop: Option<String>,
    /// Where the two programs of a pair wait for one another, at `mark`; a machine without it takes no pairs.
    pub sync: Option<String>,
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
    /// Codes that move no axis, over and above those that the reader knows: `M10`. Their blocks are handed on as they stand.
    #[serde(default)]
    pub passed: Vec<String>,
    /// Forms of remarks that it takes besides `comment.form`.
    #[serde(default)]
    pub comments: Vec<CommentForm>,
    /// Whether a block of axis words may leave out its G0 to G3.
    #[serde(default = "super::yes")]
    pub modal_motion: bool,
    /// Whether M5 and M9 act before the move of their block; they act behind it elsewhere.
    #[serde(default)]
    pub stops_first: bool,
    /// What the first line begins with where it names the program: `%` of `%PART,MX,`.
    #[serde(default)]
    pub head: String,
    /// Where G28 and G30 send an axis, in machine coordinates, mm; a machine without it refuses them.
    pub home: Option<[f64; 3]>,
}
