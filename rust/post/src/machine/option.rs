//! Options of a machine file: what a job may set without writing a machine file of its own.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Options that every machine has besides its own, and what they take.
pub const BUILT_IN_OPTIONS: [(&str, &str); 9] = [
    ("header", "true or false"),
    ("units", "\"mm\" or \"inch\""),
    ("smoothing_tolerance", "mm; 0 for an exact path"),
    ("decimals", "decimal places of coordinates"),
    ("block_numbers", "true or false"),
    ("comments", "true or false"),
    ("split_rapids", "true or false"),
    ("feed_mode", "\"per-minute\", \"per-revolution\" or \"inverse-time\""),
    ("program_number", "a whole number"),
];

/// A value of an option.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum OptionValue {
    /// Yes or no.
    Switch(bool),
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
}

impl std::fmt::Display for OptionValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Switch(on) => write!(f, "{on}"),
            Self::Number(number) => write!(f, "{number}"),
            Self::Text(text) => f.write_str(text),
        }
    }
}

impl OptionValue {
    /// Its kind, in words.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Switch(_) => "true or false",
            Self::Number(_) => "a number",
            Self::Text(_) => "a text",
        }
    }
}

/// An option that the templates read as `options.name`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OptionRule {
    /// What it does, and its unit.
    pub description: String,
    /// Its value; a job may set another of the same kind.
    pub value: OptionValue,
    /// Smallest number allowed.
    pub min: Option<f64>,
    /// Largest number allowed.
    pub max: Option<f64>,
}

impl OptionRule {
    /// States in words why `value` cannot be taken, if so.
    pub(crate) fn refuses(&self, value: &OptionValue) -> Option<String> {
        if value.kind() != self.value.kind() {
            return Some(format!("it takes {}, not {}", self.value.kind(), value.kind()));
        }
        let OptionValue::Number(number) = *value else { return None };
        if !number.is_finite() {
            return Some("it takes a finite number".into());
        }
        let [min, max] = [self.min.unwrap_or(f64::NEG_INFINITY), self.max.unwrap_or(f64::INFINITY)];
        (!(min..=max).contains(&number)).then(|| format!("{number} is outside {min} to {max}"))
    }
}
