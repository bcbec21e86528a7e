//! Helical boring: a round hole by a tool narrower than it, down along helices about its axis with a level turn at the end of each.

use std::f64::consts::TAU;

use styluscam_motion::{Arc, Plane};

use crate::PlanError;

/// The widest first helix, in tool radii: less than 1, so that no core stays on the axis.
const CORE: f64 = 0.95;
/// Turns of a hole at most.
const MOST_TURNS: usize = 20_000;

/// A round hole that a tool bores, work coordinates, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bore {
    /// Its axis in plan.
    pub at: [f64; 2],
    /// Radius of the tool.
    pub tool_radius: f64,
    /// Radius of the outermost path of the tool's axis.
    pub radius: f64,
    /// Where the tip begins.
    pub start: f64,
    /// Where it ends.
    pub bottom: f64,
    /// Fall of a turn at most.
    pub pitch: f64,
    /// Distance between helices at most.
    pub stepover: f64,
    /// Whether it turns clockwise, seen from above.
    pub clockwise: bool,
}

/// A turn: where the tip is at its end, mm, and how it gets there.
pub type Turn = ([f64; 3], Arc);

impl Bore {
    /// The radii of its helices from the inside out, mm: evenly spaced, none where a core would stay inside of the first.
    ///
    /// # Errors
    /// [`PlanError::TooMany`].
    pub fn radii(&self) -> Result<Vec<f64>, PlanError> {
        let first = CORE * self.tool_radius;
        let beyond = (self.radius - first).max(0.0);
        let count = steps(beyond, self.stepover, "stepover")?;
        let step = if count > 0 { beyond / count as f64 } else { 0.0 };
        Ok((0..=count).rev().map(|inside| self.radius - inside as f64 * step).collect())
    }

    /// Fall of each of its turns, mm.
    ///
    /// # Errors
    /// [`PlanError::TooMany`].
    pub fn fall(&self) -> Result<f64, PlanError> {
        let depth = (self.start - self.bottom).max(0.0);
        Ok(depth / steps(depth, self.pitch, "pitch")?.max(1) as f64)
    }

    /// Where the tip begins on a helix of a radius, mm.
    #[must_use]
    pub fn begin(&self, radius: f64) -> [f64; 3] {
        [self.at[0] + radius, self.at[1], self.start]
    }

    /// The turns of a helix of a radius, mm, of which the last is level.
    ///
    /// # Errors
    /// [`PlanError::TooMany`].
    pub fn turns(&self, radius: f64) -> Result<Vec<Turn>, PlanError> {
        let [x, y, start] = self.begin(radius);
        let depth = (start - self.bottom).max(0.0);
        let count = steps(depth, self.pitch, "pitch")?;
        let turn = |z: f64| {
            let centre = [self.at[0], self.at[1], z];
            ([x, y, z], Arc { centre, plane: Plane::Xy, clockwise: self.clockwise, turns: 0 })
        };
        let falling = (1..count).map(|number| turn(start - depth * number as f64 / count as f64));
        let last = (count > 0).then(|| turn(self.bottom));
        Ok(falling.chain(last).chain([turn(self.bottom)]).collect())
    }
}

/// How steeply a helix goes down, rad.
#[must_use]
pub fn ramp(radius: f64, pitch: f64) -> f64 {
    libm::atan2(pitch, TAU * radius)
}

/// Into how many equal steps of at most `step` a length is divided.
fn steps(length: f64, step: f64, what: &'static str) -> Result<usize, PlanError> {
    let count = (length / step - 1e-9).ceil().max(0.0);
    if count > MOST_TURNS as f64 || count.is_nan() {
        return Err(PlanError::TooMany { what, value: step, count: count as usize, limit: MOST_TURNS });
    }
    Ok(count as usize)
}

#[cfg(test)]
#[allow(clippy::float_cmp)] // ends are exact
mod tests {
    use proptest::prelude::*;

    use super::*;

    const BORE: Bore = Bore {
        at: [3.0, -2.0],
        tool_radius: 3.0,
        radius: 2.0,
        start: 1.0,
        bottom: -4.5,
        pitch: 2.0,
        stepover: 1.0,
        clockwise: false,
    };

    #[test]
    fn turns_share_the_depth_and_the_last_is_level() {
        let turns = BORE.turns(2.0).unwrap();
        let heights: Vec<f64> = turns.iter().map(|(end, _)| end[2]).collect();
        let third = 5.5 / 3.0;
        assert_eq!(heights, [1.0 - third, 1.0 - 2.0 * third, -4.5, -4.5]);
        assert!(turns.iter().all(|([x, y, _], arc)| *x == 5.0 && *y == -2.0 && arc.centre[..2] == [3.0, -2.0]));
        assert_eq!(BORE.fall().unwrap(), third);
        let whole = Bore { start: 0.0, bottom: -6.0, ..BORE };
        assert_eq!(whole.turns(2.0).unwrap().len(), 4, "three of exactly the pitch and the level one");
    }

    #[test]
    fn a_tool_wider_than_half_of_the_hole_goes_down_once_and_smaller_ones_in_rings() {
        assert_eq!(BORE.radii().unwrap(), [2.0]);
        assert_eq!(Bore { radius: 2.85, ..BORE }.radii().unwrap(), [2.85]);
        let rings = Bore { radius: 4.85, ..BORE }.radii().unwrap();
        assert!(rings.iter().zip([2.85, 3.85, 4.85]).all(|(a, b)| (a - b).abs() < 1e-12), "{rings:?}");
    }

    #[test]
    fn a_ramp_is_the_pitch_over_the_way_around() {
        assert!((ramp(1.0, TAU) - std::f64::consts::FRAC_PI_4).abs() < 1e-15);
    }

    #[test]
    fn too_many_turns_are_an_error() {
        let error = Bore { pitch: 1e-5, ..BORE }.turns(2.0).unwrap_err();
        assert!(matches!(error, PlanError::TooMany { what: "pitch", .. }), "{error}");
        let error = Bore { radius: 1e6, stepover: 0.01, ..BORE }.radii().unwrap_err();
        assert!(matches!(error, PlanError::TooMany { what: "stepover", .. }), "{error}");
    }

    proptest! {
        /// Whatever the sizes: no core, no ring between the helices, no step above the pitch, both ends exact.
        #[test]
        fn nothing_of_the_hole_is_left_out(
            tool_radius in 0.5f64..10.0, radius in 0.1f64..60.0, start in 0.0f64..5.0, depth in 0.1f64..40.0,
            pitch in 0.05f64..3.0, share in 0.1f64..1.9,
        ) {
            let bore = Bore { tool_radius, radius, start, bottom: start - depth, pitch, stepover: share * tool_radius, ..BORE };
            let radii = bore.radii().unwrap();
            prop_assert!(radii[0] <= CORE * tool_radius + 1e-9);
            prop_assert_eq!(radii[radii.len() - 1], radius);
            for pair in radii.windows(2) {
                prop_assert!(pair[1] > pair[0] && pair[1] - pair[0] <= bore.stepover + 1e-9);
            }
            let turns = bore.turns(radius).unwrap();
            let heights: Vec<f64> = std::iter::once(start).chain(turns.iter().map(|(end, _)| end[2])).collect();
            prop_assert!(heights.windows(2).all(|pair| pair[1] <= pair[0] && pair[0] - pair[1] <= pitch + 1e-9));
            prop_assert_eq!(&heights[heights.len() - 2..], &[bore.bottom, bore.bottom]);
        }
    }
}
