//! What there is to draw of a forming job.

use crate::{Die, Holder};

/// What a shape stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShapeKind {
    /// The flat sheet before the first move.
    Blank,
    /// The sheet as it is to be formed, both of its faces.
    FormedSheet,
    /// The frame on the sheet.
    Clamp,
    /// The plate under the sheet.
    Backing,
    /// The die under the sheet.
    Die(Die),
}

impl ShapeKind {
    /// A name for scripts: one for both dies.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::Blank => "blank",
            Self::FormedSheet => "formed-sheet",
            Self::Clamp => "clamp",
            Self::Backing => "backing",
            Self::Die(_) => "die",
        }
    }

    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Blank => "blank",
            Self::FormedSheet => "formed sheet",
            Self::Clamp => Holder::Clamp.name(),
            Self::Backing => Holder::Backing.name(),
            Self::Die(Die::Male) => "male die",
            Self::Die(Die::Female) => "female die",
        }
    }
}
