//! Axes that turn the part or the tool: their angles, and whose coordinates the text states.

use super::{Interpreter, Z};
use crate::block::Length;
use crate::machine::FeedMode;
use crate::read_error::ReadFault;
use crate::reader::block::Block;
use crate::reader::lexer::{Flaw, Word};
use crate::reader::turned::{Place, Stretch};
use crate::rotary::larger_turn;

impl Interpreter<'_> {
    /// Takes over whose coordinates follow, by the codes of a block.
    pub(super) fn set_tracking(&mut self, block: &Block) {
        let Some(rotary) = &mut self.rotary else { return };
        let by_length = block.length_kind().filter(|_| rotary.by_length).map(|(kind, _)| kind == Length::Tip);
        let Some(on) = block.tracking().map(|(on, _)| on).or(by_length) else { return };
        if std::mem::replace(&mut rotary.is_tracking, on) == on || rotary.is_at_zero() {
            return;
        }
        let is_known = rotary.known == [true; 2] && self.axes.iter().all(|axis| axis.known);
        let height = self.height;
        let [x, y, z] = self.axes.map(|axis| axis.position);
        let place = Place { stated: [x, y, z - height], height, angles: rotary.angles, is_tracked: !on };
        let [x, y, z] = place.in_frame(&rotary.axes, on).stated;
        if is_known {
            self.axes.iter_mut().zip([x, y, z + height]).for_each(|(axis, position)| axis.position = position);
        } else {
            // what is stated from here on states nothing about the moves before
            let moves = self.record.program.moves.len();
            (0..3).for_each(|axis| self.forget(axis));
            self.axes.iter_mut().for_each(|axis| axis.pending = moves);
        }
    }

    /// Takes over the angles of a block.
    pub(super) fn turn_to(&mut self, block: &Block) -> Result<(), Flaw> {
        let Some(rotary) = &self.rotary else { return Ok(()) };
        let words = rotary.words(block);
        for (axis, word) in words.into_iter().enumerate() {
            let Some(word) = word else { continue };
            let value = self.real(word)?;
            let Some(rotary) = &mut self.rotary else { continue };
            if self.modes.incremental && !rotary.known[axis] {
                return Err((ReadFault::IncrementalFromUnknown, Some(word)));
            }
            rotary.set(axis, if self.modes.incremental { rotary.angles[axis] + value } else { value });
        }
        Ok(())
    }

    /// Whether a block only turns rotary axes while nobody knows how high the tool stands, as after a tool change: its path is none.
    pub(super) fn only_turns(&self, block: &Block) -> Result<bool, Flaw> {
        let Some(rotary) = &self.rotary else { return Ok(false) };
        let Some(word) = block.turn_word().filter(|_| block.axes().iter().all(Option::is_none)) else {
            return Ok(false);
        };
        if rotary.has_probed && !self.axes[Z].known {
            let what = "turns of rotary axes behind a probe, before Z is stated,";
            return Err((ReadFault::NotRead { what }, Some(word)));
        }
        Ok(!self.axes[Z].known)
    }

    /// Rotary axes of a block go where the work's zero states nothing about; so does the tip, where the text states its
    /// coordinates.
    pub(super) fn forget_turned(&mut self, block: &Block) {
        let Some(rotary) = &mut self.rotary else { return };
        let words = rotary.words(block).map(|word| word.is_some());
        (0..2).filter(|axis| words[*axis]).for_each(|axis| rotary.forget(axis));
        if rotary.is_tracking {
            (0..3).for_each(|axis| self.forget(axis));
        }
    }

    /// Refuses what is read only with the rotary axes at 0.
    pub(super) fn require_upright(&self, what: &'static str, word: Option<Word>) -> Result<(), Flaw> {
        match &self.rotary {
            Some(rotary) if !rotary.is_at_zero() => Err((ReadFault::NotRead { what }, word)),
            _ => Ok(()),
        }
    }

    /// Refuses holes while the control tracks a tip that leans, and angles in their blocks.
    pub(super) fn allow_hole(&self, block: &Block, word: Word) -> Result<(), Flaw> {
        if let Some(word) = block.turn_word() {
            return Err((ReadFault::StrayWord, Some(word)));
        }
        let tracking = self.rotary.as_ref().is_some_and(|rotary| rotary.is_tracking);
        if tracking {
            return self.require_upright("canned cycles while the tool leans", Some(word));
        }
        Ok(())
    }

    /// A probe ends nobody knows where.
    pub(super) fn note_probe(&mut self, block: &Block, code: Word) -> Result<(), Flaw> {
        self.require_upright("probing moves while the tool leans", Some(code))?;
        if let Some(word) = block.turn_word() {
            return Err((ReadFault::StrayWord, Some(word)));
        }
        self.rotary.iter_mut().for_each(|rotary| rotary.has_probed = true);
        Ok(())
    }

    pub(super) fn require_angles(&self, word: Word) -> Result<(), Flaw> {
        match self.rotary.as_ref().and_then(|rotary| rotary.unknown(rotary.known)) {
            Some(axis) => Err((ReadFault::FeedFromUnknown { axis }, Some(word))),
            None => Ok(()),
        }
    }

    /// How long a feed move takes that turns rotary axes, min, where its feed in the part follows from that; its path in its own
    /// coordinates is so long, mm.
    pub(super) fn minutes(&self, from: Option<[f64; 2]>, length: f64, feed: f64) -> Option<f64> {
        let rotary = self.rotary.as_ref()?;
        let turned = larger_turn(from?, rotary.angles);
        if turned == 0.0 || feed.is_nan() {
            return None;
        }
        match self.modes.feed.mode {
            FeedMode::InverseTime => self.modes.feed.value.map(f64::recip),
            _ if rotary.is_tracking => None,
            // F is the linear axes', or the rotary ones' where those stand
            _ => Some(if length > 0.0 { length } else { turned } / feed),
        }
    }

    pub(super) fn angles(&self) -> Option<[f64; 2]> {
        self.rotary.as_ref().map(|rotary| rotary.angles)
    }

    /// Notes whether it is known where the moves of a block begin.
    pub(super) fn note_start(&mut self) {
        let are_known = self.axes.iter().all(|axis| axis.known);
        if let Some(rotary) = &mut self.rotary {
            rotary.is_start_known = are_known && rotary.known == [true; 2];
        }
    }

    /// Notes what belongs to a move beside its record.
    pub(super) fn note_stretch(&mut self, minutes: Option<f64>) {
        let (height, known) = (self.height, self.axes.map(|axis| axis.known));
        let Some(rotary) = &mut self.rotary else { return };
        rotary.has_probed &= !known[Z];
        rotary.stretches.push(Stretch {
            angles: rotary.angles,
            is_tracked: rotary.is_tracking,
            height,
            known,
            are_angles_known: rotary.known == [true; 2],
            is_start_known: rotary.is_start_known,
            minutes,
        });
        self.note_start();
    }

    /// A changer has moved Z, and where the control tracks the tip, all of its coordinates; no probe touches anything any more.
    pub(super) fn note_change(&mut self) {
        let Some(rotary) = &mut self.rotary else { return };
        rotary.has_probed = false;
        if rotary.is_tracking && !rotary.is_at_zero() {
            (0..3).for_each(|axis| self.forget(axis));
        }
    }
}
