//! Codes that change what is in force: feed, speed, tool, spindle, coolant, units, planes, distances.

use styluscam_motion::EventKind;

use super::block::Block;
use super::codes;
use super::fault::TraceFault;
use super::modes::Modes;
use super::note::Gap;
use super::tracer::Tracer;
use crate::block::{m_code, Code};
use crate::machine::FeedMode;

/// s: more than a month is no wait.
const LONGEST_WAIT: f64 = 3e6;

impl Tracer<'_> {
    pub(super) fn note_unknown(&mut self, block: &Block) {
        if block.turns() {
            self.note(Gap::OtherAxes);
        }
        for code in block.g.iter().filter(|code| codes::known_g(**code).is_none()) {
            self.note(Gap::Code { code: codes::name_g(*code) });
        }
        for code in block.m.iter().filter(|code| !codes::knows_m(**code)) {
            self.note(Gap::Code { code: format!("M{code}") });
        }
    }

    pub(super) fn set_feed(&mut self, block: &Block) {
        let mode = block.codes().filter(|code| matches!(code, Code::FeedMode(_))).last();
        mode.into_iter().for_each(|mode| self.modes.common.take(mode));
        if let Some(feed) = block.word(b'f') {
            let unit = if self.modes.common.feed.mode == FeedMode::InverseTime { 1.0 } else { self.modes.unit() };
            self.modes.common.feed.value = Some(feed * unit);
        }
    }

    pub(super) fn set_speed(&mut self, block: &Block) {
        if block.has_g(960) {
            self.modes.surface_speed = Some(block.word(b'd').unwrap_or_default());
            self.note(Gap::SurfaceSpeed);
        }
        if block.has_g(970) {
            self.modes.surface_speed = None;
        }
        if let Some(speed) = block.word(b's').filter(|_| block.first_spindle()) {
            self.modes.common.speed = speed.abs();
        }
    }

    pub(super) fn select_tool(&mut self, block: &Block) -> Result<(), TraceFault> {
        self.selected = block.count(b't', "T")?.or(self.selected);
        Ok(())
    }

    pub(super) fn wait_for_input(&mut self, block: &Block) {
        if block.has_m(66) {
            self.note(Gap::Input);
            self.parameters.set_number(5399, 0.0);
        }
    }

    pub(super) fn change_tool(&mut self, block: &Block) -> Result<(), TraceFault> {
        let number = if block.has_m(61) {
            block.count(b'q', "Q of M61")?
        } else if block.has_m(6) {
            self.selected
        } else {
            None
        };
        let Some(number) = number else { return Ok(()) };
        self.loaded = number;
        self.path.load(number)
    }

    pub(super) fn turn_spindle(&mut self, block: &Block) -> Result<(), TraceFault> {
        for code in block.m.iter().filter(|_| block.first_spindle()) {
            let Some(Code::Spindle(direction)) = m_code(*code) else { continue };
            self.modes.common.direction = direction;
            let rpm = self.modes.revolutions();
            let turned = |direction| EventKind::SpindleOn { rpm, direction };
            self.path.event(direction.map_or(EventKind::SpindleOff, turned))?;
        }
        Ok(())
    }

    /// M70 to M73.
    pub(super) fn store_modes(&mut self, block: &Block) {
        let modes = self.modes;
        for code in &block.m {
            match code {
                70 | 73 => {
                    let frame = self.frame();
                    frame.stored = Some(modes);
                    frame.restores = *code == 73;
                }
                71 => self.frame().stored = None,
                72 => {
                    if let Some(modes) = self.frame().stored {
                        self.restore(modes);
                    }
                }
                _ => {}
            }
        }
    }

    /// Brings modes back, but for the motion code.
    pub(super) fn restore(&mut self, modes: Modes) {
        self.modes = Modes { motion: self.modes.motion, ..modes };
        if self.offsets.index != modes.system {
            self.call_system(modes.system);
        }
    }

    pub(super) fn set_coolant(&mut self, block: &Block) -> Result<(), TraceFault> {
        for code in block.m.iter().filter_map(|code| m_code(*code)) {
            match code {
                Code::Mist => {
                    self.modes.common.mist = true;
                    self.path.event(EventKind::Mist { on: true })?;
                }
                Code::Flood | Code::CoolantOff => {
                    let on = code == Code::Flood;
                    self.modes.flood = on;
                    self.modes.common.mist &= on;
                    self.path.event(EventKind::Flood { on })?;
                }
                _ => {}
            }
        }
        Ok(())
    }

    pub(super) fn dwell(&mut self, block: &Block) -> Result<(), TraceFault> {
        if !block.has(Code::Dwell) {
            return Ok(());
        }
        let seconds = block.word(b'p').ok_or(TraceFault::WordMissing { what: "P of G4" })?;
        self.wait(seconds)
    }

    pub(super) fn wait(&mut self, seconds: f64) -> Result<(), TraceFault> {
        if seconds > LONGEST_WAIT {
            return Err(TraceFault::TooLarge);
        }
        self.path.event(EventKind::Dwell { seconds: seconds.max(0.0) })
    }

    pub(super) fn set_modes(&mut self, block: &Block) {
        for tenths in &block.g {
            match (*tenths, codes::known_g(*tenths)) {
                (70 | 80, _) => self.modes.diameter = *tenths == 70,
                (_, Some(code @ Code::Plane(_))) => self.modes.common.take(code),
                (_, Some(code @ Code::Unit(_))) => {
                    self.modes.common.take(code);
                    self.unit_stated = true;
                }
                (_, Some(Code::Compensation(on))) => {
                    self.modes.compensation = *tenths;
                    if on {
                        self.note(Gap::Compensation);
                    }
                }
                _ => {}
            }
        }
    }

    pub(super) fn set_distance_modes(&mut self, block: &Block) {
        let distance =
            |code: &Code| matches!(code, Code::Incremental(_) | Code::AbsoluteCentre(_) | Code::LowReturn(_));
        block.codes().filter(distance).for_each(|code| self.modes.common.take(code));
    }
}
