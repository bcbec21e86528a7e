//! What a machine file is about, and what it was taken from.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::charset::ranges;

/// The kind of text that the controller reads; it chooses the writer and the reader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// Words of a letter and a number (ISO 6983, RS-274).
    Gcode,
    /// The same with assignments: `CR=5`, `TURN=2`, `T="MILL"` (Sinumerik).
    Siemens,
    /// Heidenhain's conversational blocks: `L X+10 R0 FMAX`.
    Klartext,
}

/// How well a machine file's facts are known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Evidence {
    /// Every fact was read in the sources named.
    Read,
    /// All but those listed in `unconfirmed`.
    Partly,
    /// Facts are guessed, or taken from another machine: the header and `machine list` state it.
    #[default]
    Unverified,
}

/// What the file's facts were taken from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Source {
    /// How well they are known.
    #[serde(default)]
    pub evidence: Evidence,
    /// Manuals and sources that were read: document and section, or repository and file.
    pub read: Vec<String>,
    /// What could not be confirmed.
    #[serde(default)]
    pub unconfirmed: Vec<String>,
    /// What is assumed, or surprising.
    #[serde(default)]
    pub notes: Vec<String>,
}

/// How a program is named on the controller.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProgramRules {
    /// Numbers of programs; a machine without them names programs by their files.
    pub number: Option<ProgramNumber>,
    /// Names inside the text, `program.name` in the templates, made from the title; none when left out.
    pub name: Option<ProgramName>,
}

/// The number of a program: `program.number` in the templates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProgramNumber {
    /// The number, unless a job sets the option `program_number`.
    pub value: u32,
    /// Smallest that the controller takes.
    pub least: u32,
    /// Largest that it takes.
    pub most: u32,
    /// Digits, filled up with zeros: 4 for `O0001`.
    pub digits: u8,
}

/// The name of a program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProgramName {
    /// Longest, in characters.
    pub max_len: u8,
    /// Characters that may stand, with ranges: `A-Z0-9_`; others become `_`.
    pub charset: String,
}

impl ProgramName {
    /// Whether the controller takes this name.
    #[must_use]
    pub fn takes(&self, name: &str) -> bool {
        name.chars().count() <= usize::from(self.max_len) && name.chars().all(|c| self.takes_character(c))
    }

    /// The name made of these words.
    pub(crate) fn of(&self, title: &str) -> String {
        let fit = |c: char| [c, c.to_ascii_uppercase(), '_'].into_iter().find(|c| self.takes_character(*c));
        let name = |text: &str| text.chars().filter_map(fit).take(usize::from(self.max_len)).collect::<String>();
        Some(name(title)).filter(|name| !name.is_empty()).unwrap_or_else(|| name("PROGRAM"))
    }

    fn takes_character(&self, c: char) -> bool {
        ranges(&self.charset).iter().any(|(a, b)| (*a..=*b).contains(&c))
    }
}
