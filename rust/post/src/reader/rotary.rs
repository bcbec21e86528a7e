//! Where rotary axes stand while a text is read, and whose coordinates it states.

use super::block::Block;
use super::codes::Codes;
use super::lexer::Word;
use super::turned::Stretch;
use crate::machine::Machine;
use crate::rotary::{larger_turn, RotaryAxes};

/// The rotary axes of the machine.
pub(crate) struct Rotary {
    pub axes: RotaryAxes,
    /// Of their words.
    letters: [u8; 2],
    /// deg.
    pub angles: [f64; 2],
    pub known: [bool; 2],
    /// Whether each ever had a position, and the first move that takes the next one.
    ever: [bool; 2],
    pending: [usize; 2],
    /// Whether coordinates are the tip's.
    pub is_tracking: bool,
    /// Whether length offsets decide that.
    pub by_length: bool,
    /// Whether a probe has ended nobody knows where.
    pub has_probed: bool,
    pub is_start_known: bool,
    /// For each move.
    pub stretches: Vec<Stretch>,
}

impl Rotary {
    pub fn of(machine: &Machine) -> Option<Self> {
        let rules = machine.rotary.as_ref()?;
        Some(Self {
            axes: RotaryAxes::new(rules.axes).ok()?,
            letters: rules.axes.map(|axis| u8::try_from(axis.letter).unwrap_or_default()),
            angles: [0.0; 2],
            known: [false; 2],
            ever: [false; 2],
            pending: [0; 2],
            is_tracking: false,
            by_length: Codes::tracks_by_length(machine),
            has_probed: false,
            is_start_known: false,
            stretches: Vec::new(),
        })
    }

    /// Whether work and machine have one frame.
    pub fn is_at_zero(&self) -> bool {
        self.known == [true; 2] && larger_turn(self.angles, [0.0; 2]) == 0.0
    }

    pub fn words(&self, block: &Block) -> [Option<Word>; 2] {
        self.letters.map(|letter| block.words.get(letter))
    }

    pub fn set(&mut self, axis: usize, angle: f64) {
        if !self.known[axis] {
            let since = self.pending[axis].min(self.stretches.len());
            self.stretches.iter_mut().skip(since).for_each(|stretch| stretch.angles[axis] = angle);
        }
        (self.angles[axis], self.known[axis], self.ever[axis]) = (angle, true, true);
        self.pending[axis] = self.stretches.len();
    }

    pub fn forget(&mut self, axis: usize) {
        if std::mem::take(&mut self.known[axis]) {
            self.pending[axis] = self.stretches.len();
        }
    }

    /// The letter of an axis that has not been commanded, or never was.
    pub fn unknown(&self, known: [bool; 2]) -> Option<char> {
        self.letters.into_iter().zip(known).find(|(_, known)| !known).map(|(letter, _)| char::from(letter))
    }

    pub fn never_placed(&self) -> Option<char> {
        self.unknown(self.ever)
    }
}
