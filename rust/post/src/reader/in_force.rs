//! What must stand before a program may move for its job: the tool's length offset, and how closely the path is kept.

use styluscam_motion::ToolRecord;

use super::block::Block;
use super::lexer::{Flaw, Word};
use crate::machine::Machine;
use crate::read_error::ReadFault;

/// G61 and G61.1 in tenths: the path is kept exactly.
const EXACT: [i64; 2] = [610, 611];
/// Tolerances are compared with this slack, mm: they were rounded to be posted.
const ROUNDED: f64 = 1e-9;

/// The controller's modal states that decide where the tip really goes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InForce {
    /// H of the G43 in force.
    length: Option<u32>,
    /// How far the controller may round the path off, mm; infinite where nothing was stated.
    path: f64,
}

impl InForce {
    pub(crate) fn new() -> Self {
        Self { length: None, path: f64::INFINITY }
    }

    /// G43 and G49; a bare G43 takes `loaded`, the loaded tool's offset. The number's letter is `letter`.
    pub(crate) fn take_length(&mut self, block: &Block, loaded: Option<u32>, letter: u8) -> Result<(), Flaw> {
        match (block.length(), block.length_number(letter)) {
            (Some((true, _)), Some(h)) => {
                let found = h.number.natural().ok_or((ReadFault::NotNatural, Some(h)))?;
                if let Some(expected) = loaded.filter(|expected| *expected != found) {
                    return Err((ReadFault::LengthOffset { found, expected }, Some(h)));
                }
                self.length = Some(found);
            }
            (Some((true, _)), None) => self.length = loaded.or(Some(0)),
            (Some((false, _)), _) => self.length = None,
            (None, _) => {}
        }
        Ok(())
    }

    /// Whether a length offset is in force.
    pub(crate) fn has_length(&self) -> bool {
        self.length.is_some()
    }

    /// No length offset is in force.
    pub(crate) fn drop_length(&mut self) {
        self.length = None;
    }

    /// G61, G64; `mm` gives a word's length.
    pub(crate) fn take_path(&mut self, block: &Block, mm: impl Fn(Word) -> Result<f64, Flaw>) -> Result<(), Flaw> {
        let Some(code) = block.smoothing() else { return Ok(()) };
        let exact = code.number.tenths().is_some_and(|tenths| EXACT.contains(&tenths));
        self.path = match (block.words.get(b'P'), block.words.get(b'Q')) {
            _ if exact => 0.0,
            // Q is what lines near to one another may be joined by; left out, it is P
            (Some(p), q) => q.map_or(Ok(0.0), &mm)?.max(mm(p)?),
            (None, _) => f64::INFINITY,
        };
        Ok(())
    }

    /// A block of the machine's own that sets how closely the path is kept, mm.
    pub(crate) fn keep_path(&mut self, tolerance: f64) {
        self.path = tolerance;
    }

    /// Whether `tool` may be moved on `machine` as things stand; `word` is the move's.
    pub(crate) fn allows(&self, machine: &Machine, tool: &ToolRecord, word: Word) -> Result<(), Flaw> {
        let expected = tool.length_offset;
        match self.length {
            _ if machine.tool.length.is_none() => {}
            Some(found) if found != expected => {
                return Err((ReadFault::LengthOffset { found, expected }, Some(word)));
            }
            Some(_) => {}
            None => return Err((ReadFault::NoLengthOffset { expected }, Some(word))),
        }
        let limit = machine.path_tolerance_mm();
        if machine.smoothing.on.is_some() && self.path > limit + ROUNDED {
            return Err((ReadFault::PathTolerance { limit }, Some(word)));
        }
        Ok(())
    }
}
