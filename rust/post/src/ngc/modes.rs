//! What stays in force from block to block.

use styluscam_motion::{Plane, SpindleDirection};

/// G80: no motion in force. Codes are in tenths.
pub(super) const NO_MOTION: u32 = 800;

/// The modal state, as M70 stores it and M72 brings it back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Modes {
    /// The motion code in tenths.
    pub(super) motion: u32,
    pub(super) plane: Plane,
    pub(super) inch: bool,
    pub(super) incremental: bool,
    /// G90.1.
    pub(super) absolute_centre: bool,
    /// G7: words of X are diameters.
    pub(super) diameter: bool,
    pub(super) feed_mode: FeedMode,
    /// mm/min, mm per revolution, or moves per minute; 0 when it is not known.
    pub(super) feed: f64,
    /// S: rev/min, or the surface speed of G96.
    pub(super) speed: f64,
    /// G96, with its limit in rev/min.
    pub(super) surface_speed: Option<f64>,
    pub(super) direction: Option<SpindleDirection>,
    /// G98, not G99: cycles go back to where they began.
    pub(super) back_to_begin: bool,
    /// Index of the coordinate system.
    pub(super) system: usize,
    /// The code of the cutter compensation in tenths, 400 when off.
    pub(super) compensation: u32,
    pub(super) flood: bool,
    pub(super) mist: bool,
}

/// What an F word counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FeedMode {
    /// G94.
    PerMinute,
    /// G95.
    PerRevolution,
    /// G93.
    InverseTime,
}

impl Default for Modes {
    /// As LinuxCNC starts, in mm.
    fn default() -> Self {
        Self {
            motion: NO_MOTION,
            plane: Plane::Xy,
            inch: false,
            incremental: false,
            absolute_centre: false,
            diameter: false,
            feed_mode: FeedMode::PerMinute,
            feed: 0.0,
            speed: 0.0,
            surface_speed: None,
            direction: None,
            back_to_begin: false,
            system: 0,
            compensation: 400,
            flood: false,
            mist: false,
        }
    }
}

impl Modes {
    /// mm in the unit in force.
    pub(super) fn unit(&self) -> f64 {
        if self.inch {
            25.4
        } else {
            1.0
        }
    }

    /// rev/min, as far as it is known.
    pub(super) fn revolutions(&self) -> f64 {
        self.surface_speed.filter(|limit| *limit > 0.0).unwrap_or(self.speed)
    }
}
