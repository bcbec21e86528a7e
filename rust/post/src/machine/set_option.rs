//! Options of a machine, set.

use std::collections::BTreeMap;

use super::error::{most_similar, MachineError};
use super::option::{OptionValue, BUILT_IN_OPTIONS};
use super::rules::{BlockNumber, CommentForm, Family, FeedMode, LengthUnit};
use super::values::Machine;

impl Machine {
    /// Sets an option: one that every machine has (see [`BUILT_IN_OPTIONS`]), or one of its own.
    ///
    /// # Errors
    /// [`MachineError::UnknownOption`], [`MachineError::Option`], [`MachineError::Value`]; the machine stays as it was.
    pub fn set_option(&mut self, name: &str, value: OptionValue) -> Result<(), MachineError> {
        let mut machine = self.clone();
        if !set_built_in(&mut machine, name, &value)? {
            machine.set_own_option(name, value)?;
        }
        machine.check()?;
        *self = machine;
        Ok(())
    }

    /// Sets options, the unit before the others: decimals are those of the unit that is posted.
    ///
    /// # Errors
    /// Those of [`set_option`](Self::set_option); the machine stays as it was.
    pub fn set_options(&mut self, options: BTreeMap<String, OptionValue>) -> Result<(), MachineError> {
        let mut machine = self.clone();
        let (units, others): (Vec<_>, Vec<_>) = options.into_iter().partition(|(name, _)| name == "units");
        units.into_iter().chain(others).try_for_each(|(name, value)| machine.set_option(&name, value))?;
        *self = machine;
        Ok(())
    }

    fn set_own_option(&mut self, name: &str, value: OptionValue) -> Result<(), MachineError> {
        let Some(rule) = self.options.get_mut(name) else {
            let built_in = BUILT_IN_OPTIONS.iter().map(|(name, _)| (*name).to_owned());
            let known: Vec<String> = self.options.keys().cloned().chain(built_in).collect();
            let similar = most_similar(name, known.iter().map(String::as_str));
            return Err(MachineError::UnknownOption { name: name.into(), similar, known });
        };
        if let Some(problem) = rule.refuses(&value) {
            return Err(MachineError::Option { name: name.into(), problem });
        }
        rule.value = value;
        Ok(())
    }
}

/// Sets an option that every machine has; returns whether there is one of this name.
fn set_built_in(machine: &mut Machine, name: &str, value: &OptionValue) -> Result<bool, MachineError> {
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

/// Klartext always has them.
fn set_block_numbers(machine: &mut Machine, on: bool) -> bool {
    if machine.family == Family::Klartext {
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
