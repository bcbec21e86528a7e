//! Codes that change what is in force: feed, speed, tool, spindle, coolant, units, planes, distances.

use styluscam_motion::{EventKind, Plane, SpindleDirection};

use super::block::Block;
use super::codes;
use super::fault::TraceFault;
use super::modes::{FeedMode, Modes};
use super::note::Gap;
use super::tracer::Tracer;

/// s: more than a month is no wait.
const LONGEST_WAIT: f64 = 3e6;

impl Tracer<'_> {
    pub(super) fn note_unknown(&mut self, block: &Block) {
        if block.turns() {
            self.note(Gap::OtherAxes);
        }
        for code in block.g.iter().filter(|code| !codes::known_g(**code)) {
            self.note(Gap::Code { code: codes::name_g(*code) });
        }
        for code in block.m.iter().filter(|code| !codes::known_m(**code)) {
            self.note(Gap::Code { code: format!("M{code}") });
        }
    }

    pub(super) fn set_feed(&mut self, block: &Block) {
        let mode = match block.any_g(&[930, 940, 950]) {
            Some(930) => FeedMode::InverseTime,
            Some(950) => FeedMode::PerRevolution,
            Some(_) => FeedMode::PerMinute,
            None => self.modes.feed_mode,
        };
        if mode != self.modes.feed_mode {
            self.modes.feed_mode = mode;
            self.modes.feed = 0.0;
        }
        if let Some(feed) = block.word(b'f') {
            self.modes.feed = if mode == FeedMode::InverseTime { feed } else { feed * self.modes.unit() };
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
            self.modes.speed = speed.abs();
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
            self.modes.direction = match code {
                3 => Some(SpindleDirection::Clockwise),
                4 => Some(SpindleDirection::Counterclockwise),
                5 => None,
                _ => continue,
            };
            let rpm = self.modes.revolutions();
            let turned = |direction| EventKind::SpindleOn { rpm, direction };
            self.path.event(self.modes.direction.map_or(EventKind::SpindleOff, turned))?;
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
        for code in &block.m {
            match code {
                7 => {
                    self.modes.mist = true;
                    self.path.event(EventKind::Mist { on: true })?;
                }
                8 | 9 => {
                    self.modes.flood = *code == 8;
                    self.modes.mist &= *code == 8;
                    self.path.event(EventKind::Flood { on: *code == 8 })?;
                }
                _ => {}
            }
        }
        Ok(())
    }

    pub(super) fn dwell(&mut self, block: &Block) -> Result<(), TraceFault> {
        if !block.has_g(40) {
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
        for code in &block.g {
            match code {
                70 => self.modes.diameter = true,
                80 => self.modes.diameter = false,
                170 => self.modes.plane = Plane::Xy,
                180 => self.modes.plane = Plane::Zx,
                190 => self.modes.plane = Plane::Yz,
                200 | 210 => {
                    self.modes.inch = *code == 200;
                    self.unit_said = true;
                }
                400 => self.modes.compensation = 400,
                410 | 411 | 420 | 421 => {
                    self.modes.compensation = *code;
                    self.note(Gap::Compensation);
                }
                _ => {}
            }
        }
    }

    pub(super) fn set_distance_modes(&mut self, block: &Block) {
        for code in &block.g {
            match code {
                900 => self.modes.incremental = false,
                910 => self.modes.incremental = true,
                901 => self.modes.absolute_centre = true,
                911 => self.modes.absolute_centre = false,
                980 => self.modes.back_to_begin = true,
                990 => self.modes.back_to_begin = false,
                _ => {}
            }
        }
    }
}
