//! Options of a machine file: what a job may set without writing a machine file of its own.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{BlockNumber, CommentForm, FeedMode, LengthUnit, Machine, MachineError};

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
    /// Says in words why `value` cannot be taken, if so.
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

/// Sets an option that every machine has; says whether there is one of this name.
pub(super) fn set_built_in(machine: &mut Machine, name: &str, value: &OptionValue) -> Result<bool, MachineError> {
    let takes = BUILT_IN_OPTIONS.iter().find(|(known, _)| *known == name).map(|(_, takes)| *takes);
    let Some(takes) = takes else { return Ok(false) };
    if set(machine, name, value) {
        return Ok(true);
    }
    Err(MachineError::Option { name: name.into(), problem: format!("on this machine it takes {takes}") })
}

/// Whether the machine takes the value.
fn set(machine: &mut Machine, name: &str, value: &OptionValue) -> bool {
    match (name, value) {
        ("units", OptionValue::Text(text)) => {
            let unit = match text.as_str() {
                "mm" => LengthUnit::Mm,
                "inch" => LengthUnit::Inch,
                _ => return false,
            };
            machine.units.output = unit;
            machine.reader.default_units = machine.reader.default_units.map(|_| unit);
            true
        }
        ("smoothing_tolerance", OptionValue::Number(mm)) if takes_tolerance(machine, *mm) => {
            machine.smoothing.tolerance = *mm;
            true
        }
        ("decimals", OptionValue::Number(places)) => set_decimals(machine, *places),
        ("block_numbers", OptionValue::Switch(on)) => set_block_numbers(machine, *on),
        ("header", OptionValue::Switch(on)) => {
            if !on {
                machine.templates.header = Some(String::new());
            }
            true
        }
        ("comments", OptionValue::Switch(on)) => {
            if !on {
                machine.comment.form = CommentForm::None;
            }
            true
        }
        ("split_rapids", OptionValue::Switch(on)) => {
            machine.motion.split_rapids = *on;
            true
        }
        ("feed_mode", OptionValue::Text(text)) => set_feed_mode(machine, text),
        ("program_number", OptionValue::Number(value)) => set_program_number(machine, *value),
        _ => false,
    }
}

/// A tolerance needs its block, and where there is one an exact path needs one too.
fn takes_tolerance(machine: &Machine, mm: f64) -> bool {
    let smoothing = &machine.smoothing;
    if mm > 0.0 {
        smoothing.on.is_some()
    } else {
        smoothing.on.is_none() || smoothing.off.is_some()
    }
}

fn set_decimals(machine: &mut Machine, places: f64) -> bool {
    let Some(places) = natural(places).and_then(|places| u8::try_from(places).ok()) else { return false };
    match machine.units.output {
        LengthUnit::Mm => machine.number.mm.linear = places,
        LengthUnit::Inch => machine.number.inch.linear = places,
    }
    true
}

/// Klartext cannot do without them.
fn set_block_numbers(machine: &mut Machine, on: bool) -> bool {
    if machine.family == super::Family::Klartext {
        return on;
    }
    let plain = BlockNumber::plain(10, 10, 9990);
    machine.block_number = on.then(|| machine.block_number.clone().unwrap_or(plain));
    true
}

fn set_feed_mode(machine: &mut Machine, text: &str) -> bool {
    let mode = match text {
        "per-minute" => FeedMode::PerMinute,
        "per-revolution" => FeedMode::PerRevolution,
        "inverse-time" => FeedMode::InverseTime,
        _ => return false,
    };
    machine.feed.mode = mode;
    mode == FeedMode::PerMinute || machine.feed.word().is_some()
}

fn set_program_number(machine: &mut Machine, value: f64) -> bool {
    let Some(rules) = machine.program.number.as_mut() else { return false };
    let Some(number) = natural(value).filter(|n| (rules.least..=rules.most).contains(n)) else { return false };
    rules.value = number;
    true
}

/// A whole number of 0 or more.
fn natural(value: f64) -> Option<u32> {
    let whole = value.fract().abs() <= 0.0;
    crate::number::whole(value).filter(|_| whole).and_then(|value| u32::try_from(value).ok())
}
