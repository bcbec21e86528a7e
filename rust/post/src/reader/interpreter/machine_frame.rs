//! Paths to positions that the work's zero states nothing about: the machine's own, and where a probe touches.

use styluscam_motion::{EventKind, MachineMove};

use super::{Interpreter, AXES, Z};
use crate::block::Motion;
use crate::read_error::ReadFault;
use crate::reader::block::Block;
use crate::reader::lexer::{Flaw, Word};

impl Interpreter<'_> {
    /// A path until the probe touches: where it ends is not known.
    pub(super) fn probe(&mut self, block: &Block, must_touch: bool, code: Word) -> Result<(), Flaw> {
        if self.modes.incremental {
            return Err((ReadFault::NotRead { what: "probing moves with G91" }, Some(code)));
        }
        self.load_only_tool(code)?;
        self.series = None;
        let feed = self.feed_of(block, 1.0, code)?;
        self.note_probe(block, code)?;
        let mut end = [None; 3];
        for (axis, word) in block.axes().iter().enumerate() {
            let Some(word) = *word else { continue };
            end[axis] = Some(self.mm(word)? - if axis == Z { self.height } else { 0.0 });
            self.forget(axis);
        }
        if end.iter().all(Option::is_none) {
            return Err((ReadFault::MissingWord { what: "an axis word of the probing move" }, Some(code)));
        }
        self.motion = None;
        self.event(EventKind::Probe { end, feed, must_touch });
        Ok(())
    }

    /// G28 through where the axis stands: `G91 G28 Z0`. Over any other position it may cut through the work.
    pub(super) fn go_home(&mut self, block: &Block, code: Word, line: u32) -> Result<(), Flaw> {
        let home = self.machine.reader.home.unwrap_or_default();
        let straight = self.modes.incremental && block.axes().iter().flatten().all(|word| word.number.value() == 0.0);
        if !straight || block.any_axis().is_none() {
            return Err((ReadFault::HomeByWay, Some(code)));
        }
        let coordinates = std::array::from_fn(|axis| block.axes()[axis].map(|_| home[axis]));
        self.series = None;
        self.forget_turned(block);
        self.leave_work("G28, work position unknown".into(), coordinates, line);
        Ok(())
    }

    /// A move in the machine's own coordinates ends at a position that the work's zero states nothing about.
    pub(super) fn go_to_machine_position(&mut self, block: &Block, code: Word, line: u32) -> Result<(), Flaw> {
        let moves = matches!(self.motion, Some(Motion::Rapid | Motion::Feed));
        if !moves || self.modes.incremental {
            return Err((ReadFault::MachineCoordinates, Some(code)));
        }
        if block.any_axis().is_none() {
            return Err((ReadFault::MissingWord { what: "an axis word of G53" }, Some(code)));
        }
        let mut text = String::from("G53, work position unknown:");
        let mut coordinates = [None; 3];
        for (index, (word, name)) in block.axes().iter().zip(AXES).enumerate() {
            let Some(word) = *word else { continue };
            let position = self.mm(word)?;
            text.push_str(&format!(" {name}{position} mm"));
            coordinates[index] = Some(position);
        }
        self.forget_turned(block);
        self.leave_work(text, coordinates, line);
        Ok(())
    }

    /// The axes that have a position of the machine's own go there; a comment states it.
    ///
    /// Controllers that name the length offset with Z lose it with that move (Fanuc 0i-MB, p. 204).
    fn leave_work(&mut self, remark: String, coordinates: [Option<f64>; 3], line: u32) {
        (0..3).filter(|axis| coordinates[*axis].is_some()).for_each(|axis| self.forget(axis));
        let with_z = self.machine.tool.length.as_ref().is_some_and(|length| length.with_z);
        if with_z && coordinates[Z].is_some() {
            self.in_force.drop_length();
        }
        self.event(EventKind::Comment { text: remark });
        self.machine_moves.push(MachineMove { before: self.record.program.moves.len(), line, coordinates });
    }
}
