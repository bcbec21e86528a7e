//! Parameters: those that a program sets, and those that report the state of the machine.

use std::collections::HashMap;

use super::offsets::SYSTEMS;

/// The largest number of a parameter.
pub(super) const LARGEST: usize = 5602;

/// How many numbered parameters a subroutine has of its own: #1 to #30.
pub(super) const LOCALS: usize = 30;

/// The first parameter of the coordinate systems, and how many each has: X to W, and its turn.
const SYSTEM_FIRST: usize = 5221;
const SYSTEM_STRIDE: usize = 20;
const TURN: usize = 9;

/// Values that a program has set, but for those that are the machine's.
#[derive(Debug)]
pub(super) struct Parameters {
    numbered: Vec<f64>,
    global: HashMap<String, f64>,
}

impl Parameters {
    pub(super) fn new() -> Self {
        Self { numbered: vec![0.0; LARGEST + 1], global: HashMap::new() }
    }

    /// #1 to #30.
    pub(super) fn locals(&self) -> [f64; LOCALS] {
        std::array::from_fn(|i| self.numbered.get(i + 1).copied().unwrap_or_default())
    }

    pub(super) fn set_locals(&mut self, values: [f64; LOCALS]) {
        self.numbered.iter_mut().skip(1).zip(values).for_each(|(slot, value)| *slot = value);
    }

    /// Sets a run of parameters.
    pub(super) fn set_run(&mut self, first: usize, values: [f64; 3]) {
        self.numbered.iter_mut().skip(first).zip(values).for_each(|(slot, value)| *slot = value);
    }

    /// Three parameters in a row.
    pub(super) fn run(&self, first: usize) -> [f64; 3] {
        std::array::from_fn(|i| self.numbered.get(first + i).copied().unwrap_or_default())
    }

    /// Nothing when there is no such number.
    pub(super) fn number(&self, number: usize) -> Option<f64> {
        self.numbered.get(number).copied()
    }

    pub(super) fn global(&self, name: &str) -> Option<f64> {
        self.global.get(name).copied()
    }

    pub(super) fn set_number(&mut self, number: usize, value: f64) {
        if let Some(slot) = self.numbered.get_mut(number) {
            *slot = value;
        }
    }

    pub(super) fn set_global(&mut self, name: &str, value: f64) {
        if let Some(slot) = self.global.get_mut(name) {
            *slot = value;
        } else {
            self.global.insert(name.into(), value);
        }
    }
}

/// The coordinate system and the item in it that a parameter belongs to.
pub(super) fn of_system(number: usize) -> Option<(usize, usize)> {
    let offset = number.checked_sub(SYSTEM_FIRST)?;
    let (system, item) = (offset / SYSTEM_STRIDE, offset % SYSTEM_STRIDE);
    (system < SYSTEMS && (item < 3 || item == TURN)).then_some((system, item))
}
