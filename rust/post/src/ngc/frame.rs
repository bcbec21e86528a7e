//! What a running subroutine has of its own.

use std::collections::HashMap;

use super::modes::Modes;
use super::parameters::LOCALS;

/// What belongs to a subroutine that runs, or to the program.
#[derive(Debug, Default)]
pub(super) struct Frame {
    /// Where it was called from; nothing for the program.
    pub(super) back: Option<Back>,
    /// Named parameters without a leading `_`.
    pub(super) names: HashMap<String, f64>,
    /// How often each loop, by its line, is still to be run.
    pub(super) repeats: HashMap<usize, usize>,
    /// What M70 has stored.
    pub(super) stored: Option<Modes>,
    /// Whether its end brings that back: M73.
    pub(super) restores: bool,
}

#[derive(Debug)]
pub(super) struct Back {
    pub(super) file: usize,
    pub(super) line: usize,
    pub(super) locals: [f64; LOCALS],
    /// The line to begin again at, and how often: L of M98.
    pub(super) entry: usize,
    pub(super) again: u32,
}
