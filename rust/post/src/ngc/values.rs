//! What parameters give: values that a program has set, and the state of the machine.

use styluscam_motion::{Plane, SpindleDirection};

use super::expression::{Key, Values};
use super::fault::TraceFault;
use super::offsets::system_code;
use super::parameters::{of_system, LARGEST};
use super::tracer::Tracer;
use crate::machine::{FeedMode, LengthUnit};

impl Tracer<'_> {
    /// Carries out an assignment.
    pub(super) fn assign(&mut self, key: &Key, value: f64) -> Result<(), TraceFault> {
        match key {
            Key::Numbered(number) if (1..=LARGEST).contains(number) => {
                self.parameters.set_number(*number, value);
                self.set_of_system(*number, value);
            }
            Key::Numbered(_) => return Err(TraceFault::ParameterNumber),
            Key::Named(name) if name.starts_with('_') => self.parameters.set_global(name, value),
            Key::Named(name) => self.set_local(name, value),
        }
        Ok(())
    }

    fn set_of_system(&mut self, number: usize, value: f64) {
        let Some((index, item)) = of_system(number) else { return };
        let Some(system) = self.offsets.stored.get_mut(index) else { return };
        match system.origin.get_mut(item) {
            Some(slot) => *slot = value,
            None => system.turn_deg = value,
        }
    }

    fn system_value(&self, index: usize, item: usize) -> f64 {
        let system = self.offsets.stored.get(index).copied().unwrap_or_default();
        system.origin.get(item).copied().unwrap_or(system.turn_deg)
    }

    /// The position in the unit in force.
    fn position_in_unit(&self, axis: usize) -> f64 {
        self.position.get(axis).copied().unwrap_or_default() / self.modes.unit()
    }

    fn machine_in_unit(&self, axis: usize) -> f64 {
        self.offsets.in_machine(self.position).get(axis).copied().unwrap_or_default() / self.modes.unit()
    }

    /// A parameter that reports the state.
    fn state_of(&self, name: &str) -> Option<f64> {
        let modes = &self.modes;
        let common = &modes.common;
        let inch = common.unit == Some(LengthUnit::Inch);
        let truth = |value: bool| f64::from(u8::from(value));
        let code = |tenths: u32| f64::from(tenths);
        Some(match name {
            "_vmajor" => 2.9,
            "_vminor" => 4.0,
            "_line" => self.line as f64 + 1.0,
            "_motion_mode" => code(modes.motion),
            "_plane" => match common.plane {
                Plane::Xy => 170.0,
                Plane::Zx => 180.0,
                Plane::Yz => 190.0,
            },
            "_ccomp" => code(modes.compensation),
            "_metric" => truth(!inch),
            "_imperial" => truth(inch),
            "_metric_machine" => 1.0,
            "_imperial_machine" => 0.0,
            "_absolute" => truth(!common.incremental),
            "_incremental" => truth(common.incremental),
            "_inverse_time" => truth(common.feed.mode == FeedMode::InverseTime),
            "_units_per_minute" => truth(common.feed.mode == FeedMode::PerMinute),
            "_units_per_rev" => truth(common.feed.mode == FeedMode::PerRevolution),
            "_coord_system" => code(system_code(self.offsets.index)),
            "_tool_offset" => truth(self.offsets.tool.iter().any(|offset| offset.abs() > 0.0)),
            "_retract_r_plane" => truth(common.low_return),
            "_retract_old_z" => truth(!common.low_return),
            "_spindle_rpm_mode" => truth(modes.surface_speed.is_none()),
            "_spindle_css_mode" => truth(modes.surface_speed.is_some()),
            "_ijk_absolute_mode" => truth(common.absolute_centre),
            "_lathe_diameter_mode" => truth(modes.diameter),
            "_lathe_radius_mode" => truth(!modes.diameter),
            "_spindle_on" => truth(common.direction.is_some()),
            "_spindle_cw" => truth(common.direction == Some(SpindleDirection::Clockwise)),
            "_mist" => truth(common.mist),
            "_flood" => truth(modes.flood),
            "_speed_override" | "_feed_override" => 1.0,
            "_adaptive_feed" | "_feed_hold" | "_task" | "_remap_level" => 0.0,
            "_feed" if common.feed.mode == FeedMode::InverseTime => modes.feed(),
            "_feed" => modes.feed() / modes.unit(),
            "_rpm" => common.speed,
            "_x" => self.position_in_unit(0),
            "_y" => self.position_in_unit(1),
            "_z" => self.position_in_unit(2),
            "_abs_x" => self.machine_in_unit(0),
            "_abs_y" => self.machine_in_unit(1),
            "_abs_z" => self.machine_in_unit(2),
            "_a" | "_b" | "_c" | "_u" | "_v" | "_w" => 0.0,
            "_abs_a" | "_abs_b" | "_abs_c" | "_abs_u" | "_abs_v" | "_abs_w" => 0.0,
            "_current_tool" | "_current_pocket" => f64::from(self.loaded),
            "_selected_tool" | "_selected_pocket" => self.selected.map_or(-1.0, f64::from),
            "_call_level" => self.depth() as f64,
            _ => return None,
        })
    }
}

impl Values for Tracer<'_> {
    fn numbered(&self, number: usize) -> Option<f64> {
        if let Some((index, item)) = of_system(number) {
            return Some(self.system_value(index, item));
        }
        match number {
            5220 => Some(self.offsets.index as f64 + 1.0),
            5400 => Some(f64::from(self.loaded)),
            5401..=5403 => self.offsets.tool.get(number - 5401).map(|offset| offset / self.modes.unit()),
            5420..=5422 => Some(self.position_in_unit(number - 5420)),
            _ => self.parameters.number(number),
        }
    }

    fn named(&self, name: &str) -> Option<f64> {
        if !name.starts_with('_') {
            return self.local(name);
        }
        self.state_of(name).or_else(|| self.parameters.global(name))
    }
}
