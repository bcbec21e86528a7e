//! Spindle, coolant, waits and stops.

use styluscam_motion::{EventKind, SpindleDirection};

use super::{Flaw, Interpreter};
use crate::machine::SpeedUnit;
use crate::read_error::ReadFault;
use crate::reader::block::{Block, Spindle, Stop};

impl Interpreter<'_> {
    pub(super) fn set_speed(&mut self, block: &Block) -> Result<(), Flaw> {
        let Some(word) = block.speed else { return Ok(()) };
        let rpm = match (self.machine.spindle.unit, self.machine.limits.max_rpm) {
            (SpeedUnit::Percent, Some(most)) => word.number.value() / 100.0 * most,
            _ => word.number.value(),
        };
        if rpm < 0.0 {
            return Err((ReadFault::Negative, Some(word)));
        }
        self.speed = rpm;
        if let (Some(direction), None) = (self.direction, block.spindle) {
            self.event(EventKind::SpindleOn { rpm, direction });
        }
        Ok(())
    }

    pub(super) fn set_spindle(&mut self, block: &Block) {
        let Some((spindle, _)) = block.spindle else { return };
        self.direction = match spindle {
            Spindle::Clockwise => Some(SpindleDirection::Clockwise),
            Spindle::Counterclockwise => Some(SpindleDirection::Counterclockwise),
            Spindle::Off => None,
        };
        let rpm = self.speed;
        self.event(self.direction.map_or(EventKind::SpindleOff, |direction| EventKind::SpindleOn { rpm, direction }));
    }

    pub(super) fn set_coolant(&mut self, block: &Block) {
        if block.mist.is_some() {
            self.mist = true;
            self.event(EventKind::Mist { on: true });
        }
        if block.flood.is_some() {
            self.event(EventKind::Flood { on: true });
        }
        if block.coolant_off.is_some() {
            if std::mem::take(&mut self.mist) {
                self.event(EventKind::Mist { on: false });
            }
            self.event(EventKind::Flood { on: false });
        }
    }

    pub(super) fn dwell(&mut self, block: &Block) -> Result<(), Flaw> {
        let Some(code) = block.dwell else { return Ok(()) };
        let Some(rules) = &self.machine.dwell else { return Err((self.refusal(), Some(code))) };
        let word = block.time.ok_or((ReadFault::MissingWord { what: "the time of G4" }, Some(code)))?;
        let seconds = self.seconds(word, rules.unit)?;
        if seconds < 0.0 {
            return Err((ReadFault::Negative, Some(word)));
        }
        self.event(EventKind::Dwell { seconds });
        Ok(())
    }

    pub(super) fn stop(&mut self, block: &Block) -> bool {
        let Some((stop, _)) = block.stop else { return false };
        if stop != Stop::End {
            self.stops.push(self.program.moves.len());
        }
        match stop {
            Stop::Pause => self.event(EventKind::Stop { optional: false }),
            Stop::OptionalPause => self.event(EventKind::Stop { optional: true }),
            Stop::End => {}
        }
        stop == Stop::End
    }
}
