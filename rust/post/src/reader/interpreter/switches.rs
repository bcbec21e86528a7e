//! Spindle, coolant, waits and stops.

use styluscam_motion::EventKind;

use super::Interpreter;
use crate::block::Stop;
use crate::machine::SpeedUnit;
use crate::read_error::ReadFault;
use crate::reader::block::Block;
use crate::reader::lexer::Flaw;

impl Interpreter<'_> {
    pub(super) fn set_speed(&mut self, block: &Block) -> Result<(), Flaw> {
        let Some(word) = block.words.get(b'S') else { return Ok(()) };
        let rpm = match (self.machine.spindle.unit, self.machine.limits.max_rpm) {
            (SpeedUnit::Percent, Some(most)) => word.number.value() / 100.0 * most,
            _ => word.number.value(),
        };
        if rpm < 0.0 {
            return Err((ReadFault::Negative, Some(word)));
        }
        self.modes.speed = rpm;
        if let (Some(direction), None) = (self.modes.direction, block.spindle()) {
            self.event(EventKind::SpindleOn { rpm, direction });
        }
        Ok(())
    }

    /// Starts, and stops where those come first.
    pub(super) fn set_spindle(&mut self, block: &Block, stops: bool) {
        let direction = match block.spindle() {
            Some((Some(direction), _)) => direction,
            Some((None, _)) if stops => return self.stop_spindle(block),
            _ => return,
        };
        self.modes.direction = Some(direction);
        self.halted = false;
        self.event(EventKind::SpindleOn { rpm: self.modes.speed, direction });
    }

    pub(super) fn stop_spindle(&mut self, block: &Block) {
        if matches!(block.spindle(), Some((None, _))) {
            self.modes.direction = None;
            self.halted = false;
            self.event(EventKind::SpindleOff);
        }
    }

    /// Mist and flood on, and both off where that comes first.
    pub(super) fn set_coolant(&mut self, block: &Block, stops: bool) {
        if block.mist().is_some() {
            self.modes.mist = true;
            self.event(EventKind::Mist { on: true });
        }
        if block.flood().is_some() {
            self.event(EventKind::Flood { on: true });
        }
        if stops {
            self.stop_coolant(block);
        }
    }

    pub(super) fn stop_coolant(&mut self, block: &Block) {
        if block.coolant_off().is_some() {
            if std::mem::take(&mut self.modes.mist) {
                self.event(EventKind::Mist { on: false });
            }
            self.event(EventKind::Flood { on: false });
        }
    }

    pub(super) fn dwell(&mut self, block: &Block) -> Result<(), Flaw> {
        let Some(code) = block.dwell() else { return Ok(()) };
        let Some(rules) = &self.machine.dwell else { return Err((self.refusal(), Some(code))) };
        let word = block.time.ok_or((
            ReadFault::MissingWord { what: "the time of G4, with the letter that [dwell] names," },
            Some(code),
        ))?;
        let seconds = self.seconds(word, rules.unit)?;
        if seconds < 0.0 {
            return Err((ReadFault::Negative, Some(word)));
        }
        self.event(EventKind::Dwell { seconds });
        Ok(())
    }

    pub(super) fn stop(&mut self, block: &Block) -> bool {
        let Some((stop, _)) = block.stop() else { return false };
        if stop != Stop::End {
            self.stops.push(self.record.program.moves.len());
            self.halted = self.machine.stop.stops_spindle && self.modes.direction.is_some();
        }
        match stop {
            Stop::Pause => self.event(EventKind::Stop { optional: false }),
            Stop::OptionalPause => self.event(EventKind::Stop { optional: true }),
            Stop::End => {}
        }
        stop == Stop::End
    }
}
