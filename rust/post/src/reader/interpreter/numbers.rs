//! Units, numbers and feeds.

use super::Interpreter;
use crate::block::{FeedFault, Motion};
use crate::machine::{FeedMode, LengthUnit, Point, TimeUnit};
use crate::read_error::ReadFault;
use crate::reader::block::Block;
use crate::reader::lexer::{Flaw, Word};

impl Interpreter<'_> {
    pub(super) fn set_units(&mut self, block: &Block) -> Result<(), Flaw> {
        let Some(units) = block.unit().map(|(unit, _)| unit) else { return Ok(()) };
        let changes = self.modes.unit.is_some_and(|u| u != units);
        if changes && block.words.get(b'F').is_some() {
            return Err((ReadFault::FeedWithUnits, block.words.get(b'F')));
        }
        self.modes.unit = Some(units);
        Ok(())
    }

    /// The unit in force, mm.
    pub(crate) fn unit_mm(&self) -> Option<f64> {
        self.modes.unit.map(LengthUnit::in_mm)
    }

    pub(super) fn mm(&self, word: Word) -> Result<f64, Flaw> {
        let units = self.modes.unit.ok_or((ReadFault::NoUnits, Some(word)))?;
        Ok(self.real(word)? * units.in_mm())
    }

    /// A number that may have a fraction.
    pub(super) fn real(&self, word: Word) -> Result<f64, Flaw> {
        let value = word.number.value();
        if self.machine.number.point == Point::Always && !word.number.is_pointed() && value != 0.0 {
            return Err((ReadFault::NoPoint, Some(word)));
        }
        Ok(value)
    }

    /// A time as a wait has it, s.
    pub(super) fn seconds(&self, word: Word, unit: TimeUnit) -> Result<f64, Flaw> {
        match unit {
            TimeUnit::S => self.real(word),
            TimeUnit::Ms if self.machine.number.point == Point::Always && word.number.is_pointed() => {
                Err((ReadFault::PointInTime, Some(word)))
            }
            TimeUnit::Ms => Ok(word.number.value() / 1000.0),
        }
    }

    pub(super) fn set_feed(&mut self, block: &Block) -> Result<(), Flaw> {
        let Some(word) = block.words.get(b'F') else { return Ok(()) };
        let feed = match self.modes.feed.mode {
            FeedMode::InverseTime => self.real(word)?,
            _ => self.mm(word)? / self.machine.feed_scale_of(self.modes.unit),
        };
        let motion = block.motion().map(|(motion, _)| motion).or(self.motion);
        let rapid = motion == Some(Motion::Rapid) && block.probe().is_none();
        if self.loose && (rapid || feed <= 0.0) {
            self.modes.feed.value = self.modes.feed.value.filter(|_| rapid); // a feed of 0 is none, not the one before
            return Ok(());
        }
        if feed <= 0.0 {
            return Err((ReadFault::ZeroFeed, Some(word)));
        }
        self.modes.feed.value = Some(feed);
        Ok(())
    }

    /// The feed of a block whose path is so long, mm/min.
    pub(super) fn feed_of(&self, block: &Block, length: f64, word: Word) -> Result<f64, Flaw> {
        let modes = &self.modes;
        if modes.feed.mode == FeedMode::InverseTime && block.words.get(b'F').is_none() {
            return Err((ReadFault::NoFeed, Some(word)));
        }
        let revolutions = modes.direction.map(|_| modes.speed).filter(|speed| *speed > 0.0);
        let fault = |fault| match fault {
            FeedFault::NoFeed => (ReadFault::NoFeed, Some(word)),
            FeedFault::NoRevolutions => (ReadFault::NoRevolutions, Some(word)),
        };
        modes.feed.per_minute(length, revolutions).map_err(fault)
    }
}
