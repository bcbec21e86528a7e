//! Which faces are meant: by a rule, or by their names.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Faces by rule or by name.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "SelectionText", into = "SelectionText")]
pub enum Selection {
    /// All faces that face up.
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

/// Faces that the tool keeps away from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "CheckText", into = "CheckText")]
pub enum CheckSelection {
    /// All that are not selected.
    Rest,
    /// These.
    Named(Vec<String>),
}

#[derive(Clone, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected \"rest\" or a list of face names like [\"Face3\", \"Face4\"]")]
enum CheckText {
    Word(String),
    Names(Vec<String>),
}

impl TryFrom<CheckText> for CheckSelection {
    type Error = String;

    fn try_from(text: CheckText) -> Result<Self, String> {
        match text {
            CheckText::Word(word) if word == "rest" => Ok(Self::Rest),
            CheckText::Word(word) => {
                Err(format!("{word:?} names no check faces: write \"rest\" or a list of names like [\"Face3\"]"))
            }
            CheckText::Names(names) => Ok(Self::Named(names)),
        }
    }
}

impl From<CheckSelection> for CheckText {
    fn from(selection: CheckSelection) -> Self {
        match selection {
            CheckSelection::Rest => Self::Word("rest".to_owned()),
            CheckSelection::Named(names) => Self::Names(names),
        }
    }
}

/// The number in a face's name: 3 of "Face3", and of "3".
pub(crate) fn face_number(name: &str) -> Option<u32> {
    name.strip_prefix("Face").unwrap_or(name).parse().ok()
}
