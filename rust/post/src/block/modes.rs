//! What stays in force from block to block.

use styluscam_motion::{Plane, SpindleDirection};

use super::codes::Code;
use crate::machine::{FeedMode, LengthUnit};

/// The modal state that every controller has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Modes {
    /// None before the first code for it.
    pub unit: Option<LengthUnit>,
    pub plane: Plane,
    /// G91.
    pub incremental: bool,
    /// G90.1.
    pub absolute_centre: bool,
    /// G99: a cycle ends at its R, not where it came from.
    pub low_return: bool,
    pub feed: Feed,
    /// rev/min.
    pub speed: f64,
    /// None while the spindle stands.
    pub direction: Option<SpindleDirection>,
    pub mist: bool,
}

impl Modes {
    /// Before the first block.
    pub fn new(unit: Option<LengthUnit>, low_return: bool) -> Self {
        Self {
            unit,
            plane: Plane::Xy,
            incremental: false,
            absolute_centre: false,
            low_return,
            feed: Feed::default(),
            speed: 0.0,
            direction: None,
            mist: false,
        }
    }

    /// Takes over what a code sets of it.
    pub fn take(&mut self, code: Code) {
        match code {
            Code::Unit(unit) => self.unit = Some(unit),
            Code::Plane(plane) => self.plane = plane,
            Code::Incremental(on) => self.incremental = on,
            Code::AbsoluteCentre(on) => self.absolute_centre = on,
            Code::LowReturn(on) => self.low_return = on,
            Code::FeedMode(mode) => self.feed.set_mode(mode),
            _ => {}
        }
    }
}

/// The feed in force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Feed {
    pub mode: FeedMode,
    /// mm/min, mm in a revolution, or moves in a minute, by the mode.
    pub value: Option<f64>,
}

/// Why a feed is not known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FeedFault {
    NoFeed,
    /// The spindle stands.
    NoRevolutions,
}

impl Feed {
    /// A feed of one mode means nothing in another.
    pub fn set_mode(&mut self, mode: FeedMode) {
        if mode != self.mode {
            *self = Self { mode, value: None };
        }
    }

    /// The feed of a move of this length in mm, mm/min; `revolutions` are the spindle's in a minute, none while it stands.
    pub fn per_minute(&self, length: f64, revolutions: Option<f64>) -> Result<f64, FeedFault> {
        let value = self.value.ok_or(FeedFault::NoFeed)?;
        match self.mode {
            FeedMode::PerMinute => Ok(value),
            FeedMode::PerRevolution => revolutions.map(|turns| value * turns).ok_or(FeedFault::NoRevolutions),
            FeedMode::InverseTime => Ok(value * length),
        }
    }
}
