//! What stays in force from block to block.

use crate::block;
use crate::machine::LengthUnit;

/// G80: no motion in force. Codes are in tenths.
pub(super) const NO_MOTION: u32 = 800;

/// The modal state, as M70 stores it and M72 brings it back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Modes {
    /// The motion code in tenths.
    pub(super) motion: u32,
    pub(super) common: block::Modes,
    /// G7: words of X are diameters.
    pub(super) diameter: bool,
    /// G96, with its limit in rev/min.
    pub(super) surface_speed: Option<f64>,
    /// Index of the coordinate system.
    pub(super) system: usize,
    /// The code of the cutter compensation in tenths, 400 when off.
    pub(super) compensation: u32,
    pub(super) flood: bool,
}

impl Default for Modes {
    /// As LinuxCNC starts, in mm.
    fn default() -> Self {
        Self {
            motion: NO_MOTION,
            common: block::Modes::new(Some(LengthUnit::Mm), true),
            diameter: false,
            surface_speed: None,
            system: 0,
            compensation: 400,
            flood: false,
        }
    }
}

impl Modes {
    /// mm in the unit in force.
    pub(super) fn unit(&self) -> f64 {
        self.common.unit.map_or(1.0, LengthUnit::in_mm)
    }

    /// The feed as written, for the mode in force, mm; 0 when it is not known.
    pub(super) fn feed(&self) -> f64 {
        self.common.feed.value.unwrap_or_default()
    }

    /// rev/min, as far as it is known.
    pub(super) fn revolutions(&self) -> f64 {
        self.surface_speed.filter(|limit| *limit > 0.0).unwrap_or(self.common.speed)
    }
}
