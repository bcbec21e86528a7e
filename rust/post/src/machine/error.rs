//! What can be wrong with a machine file.

use thiserror::Error;

use super::shipped::shipped;

/// A machine that cannot be used.
///
/// Each variant states when it occurs and what to do about it; [`code`](Self::code) is stable.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MachineError {
    /// No machine of this name is shipped. Take one of the names listed, or give a file.
    #[error("there is no machine {name:?}")]
    UnknownMachine {
        /// The key that names it: `name` of what takes a machine, `extends` of a machine file.
        key: &'static str,
        /// The name asked for.
        name: String,
        /// The shipped name most like it.
        similar: Option<String>,
    },
    /// The file is not TOML, or a key is unknown, missing or of the wrong kind. Correct the key or line named.
    #[error("{place}: {message}")]
    Document {
        /// Key, or line of the file.
        place: String,
        /// What is wrong with it.
        message: String,
        /// The known key most like an unknown one.
        similar: Option<String>,
    },
    /// The file was written for a newer release. Update `StylusCAM`.
    #[error("schema {found} is newer than {known}, the one that this release reads")]
    Schema {
        /// What the file states.
        found: u32,
        /// What this release reads.
        known: u32,
    },
    /// A value is outside what makes sense. Correct the key named.
    #[error("{key}: {problem}")]
    Value {
        /// The key.
        key: String,
        /// What is wrong with it.
        problem: String,
    },
    /// A template cannot be compiled, or fails when it is filled in: a name that does not exist, a loop without end.
    #[error("template {name}, line {line}: {message}")]
    Template {
        /// The template's key.
        name: String,
        /// The line in it, from 1.
        line: usize,
        /// What is wrong with it.
        message: String,
    },
    /// The machine has no such option. Take one of its own.
    #[error("the machine has no option {name:?}")]
    UnknownOption {
        /// The name given.
        name: String,
        /// The option most like it.
        similar: Option<String>,
        /// The options that the machine has.
        known: Vec<String>,
    },
    /// An option was given a value that it does not take.
    #[error("option {name}: {problem}")]
    Option {
        /// The option.
        name: String,
        /// Why the value cannot be taken.
        problem: String,
    },
}

impl MachineError {
    /// A stable name for scripts.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Self::UnknownMachine { .. } => "machine-unknown",
            Self::Document { .. } => "machine-document",
            Self::Schema { .. } => "machine-schema",
            Self::Value { .. } => "machine-value",
            Self::Template { .. } => "machine-template",
            Self::UnknownOption { .. } => "machine-unknown-option",
            Self::Option { .. } => "machine-option",
        }
    }

    /// Where: a key of the machine file, or a line of it; an option's key is that of the section that sets it.
    #[must_use]
    pub fn location(&self) -> String {
        match self {
            Self::UnknownMachine { key, .. } => (*key).into(),
            Self::Document { place, .. } => place.clone(),
            Self::Schema { .. } => "schema".into(),
            Self::Value { key, .. } => key.clone(),
            Self::Template { name, line, .. } => format!("{name}, line {line}"),
            Self::UnknownOption { name, .. } | Self::Option { name, .. } => format!("options.{name}"),
        }
    }

    /// Whether the name or an option is at fault, keys of the section that takes a machine, not of the machine's file.
    #[must_use]
    pub fn is_of_section(&self) -> bool {
        matches!(self, Self::UnknownMachine { .. } | Self::UnknownOption { .. } | Self::Option { .. })
    }

    /// What to do, in a sentence.
    #[must_use]
    pub fn hint(&self) -> String {
        let advice = match self {
            Self::UnknownMachine { .. } => {
                format!("shipped: {}; else a machine file", shipped().join(", "))
            }
            Self::Document { .. } => "correct this key or line of the machine file".into(),
            Self::Schema { .. } => "update StylusCAM, or write the file for this release".into(),
            Self::Value { .. } => "correct this key of the machine file".into(),
            Self::Template { .. } => "correct the template at this line".into(),
            Self::UnknownOption { known, .. } => format!("the machine's options: {}", known.join(", ")),
            Self::Option { .. } => "give a value that the option takes".into(),
        };
        match self.similar() {
            Some(similar) => format!("did you mean {similar:?}? Otherwise: {advice}"),
            None => advice,
        }
    }

    fn similar(&self) -> Option<&str> {
        match self {
            Self::UnknownMachine { similar, .. }
            | Self::Document { similar, .. }
            | Self::UnknownOption { similar, .. } => similar.as_deref(),
            _ => None,
        }
    }
}

/// The candidate most like `name`, if one is like it at all.
pub(crate) fn most_similar<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<String> {
    candidates
        .into_iter()
        .map(|c| (strsim::jaro_winkler(name, c), c))
        .filter(|(likeness, _)| *likeness > 0.8)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, c)| c.to_string())
}
