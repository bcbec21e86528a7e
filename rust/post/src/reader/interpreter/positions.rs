//! Where the tool stands, and since when that is not known.

use super::{Axis, Interpreter, AXES, Z};
use crate::machine::Lathe;
use crate::read_error::ReadFault;
use crate::reader::block::Block;
use crate::reader::lexer::{Flaw, Word};

impl Interpreter<'_> {
    /// Where the tip stands, as far as it is known.
    pub(super) fn tip(&self) -> [f64; 3] {
        let [x, y, z] = self.axes;
        [x.position, y.position, z.position - self.height]
    }

    /// How often X is counted: twice where it is a diameter.
    pub(super) fn scale(&self, axis: usize) -> f64 {
        if axis == 0 && self.machine.motion.lathe == Some(Lathe::Diameter) {
            2.0
        } else {
            1.0
        }
    }

    pub(super) fn position_axes(&mut self, block: &Block) -> Result<(), Flaw> {
        for (index, word) in block.axes().iter().enumerate() {
            let Some(word) = *word else { continue };
            let value = self.mm(word)? / self.scale(index);
            let axis = self.axes.get(index).copied().unwrap_or_default();
            if self.modes.incremental && !axis.known {
                return Err((ReadFault::IncrementalFromUnknown, Some(word)));
            }
            self.set_position(index, if self.modes.incremental { axis.position + value } else { value });
        }
        Ok(())
    }

    /// The end of an arc that is given by an angle about its centre.
    pub(super) fn turn_axes(&mut self, block: &Block) -> Result<(), Flaw> {
        let (Some(angle), [Some(x), Some(y), _]) = (block.polar, block.offsets()) else { return Ok(()) };
        let centre = [self.mm(x)?, self.mm(y)?];
        let degrees = angle.number.value();
        let (sin, cos) = libm::sincos(degrees.rem_euclid(360.0).to_radians());
        let [from_x, from_y] = [0, 1].map(|axis| self.axes[axis].position - centre[axis]);
        if degrees.rem_euclid(360.0) != 0.0 {
            self.set_position(0, centre[0] + cos * from_x - sin * from_y);
            self.set_position(1, centre[1] + sin * from_x + cos * from_y);
        }
        if let Some(rise) = block.rise {
            let rise = self.mm(rise)?;
            self.set_position(Z, self.axes[Z].position + rise);
        }
        Ok(())
    }

    pub(super) fn set_position(&mut self, index: usize, position: f64) {
        let moves = self.record.program.moves.len();
        let tip = position - if index == Z { self.height } else { 0.0 };
        let Some(axis) = self.axes.get_mut(index) else { return };
        if !axis.known {
            let since = axis.pending.min(moves);
            self.record.program.moves.iter_mut().skip(since).for_each(|m| m.end.tip[index] = tip);
        }
        *axis = Axis { position, known: true, ever: true, pending: moves };
        if index == Z {
            self.end_unknown_height();
        }
    }

    /// The position of this axis is not known from the next move on.
    pub(super) fn forget(&mut self, index: usize) {
        let moves = self.record.program.moves.len();
        let Some(axis) = self.axes.get_mut(index) else { return };
        if axis.known {
            axis.known = false;
            axis.pending = moves;
        }
        self.unknown_since = self.unknown_since.or(Some(moves));
        if index == Z {
            self.unknown_height_since = self.unknown_height_since.or(Some(moves));
        }
    }

    pub(super) fn end_unknown_height(&mut self) {
        let moves = self.record.program.moves.len();
        self.unknown_heights
            .extend(self.unknown_height_since.take().map(|since| since..moves).filter(|run| !run.is_empty()));
    }

    pub(super) fn require_positions(&self, word: Word) -> Result<(), Flaw> {
        match self.axes.iter().zip(AXES).find(|(axis, _)| !axis.known) {
            Some((_, axis)) => Err((ReadFault::FeedFromUnknown { axis }, Some(word))),
            None => Ok(()),
        }
    }

    /// Ends the run of moves that lack a position, once every axis has one.
    pub(super) fn close_unknown(&mut self) {
        let Some(since) = self.unknown_since else { return };
        if self.axes.iter().all(|a| a.known) {
            self.note_unknown(since);
        }
    }

    pub(super) fn note_unknown(&mut self, since: usize) {
        self.unknown_since = None;
        let moves = self.record.program.moves.len();
        if since < moves {
            self.unknown_positions.push(since..moves);
        }
    }
}
