//! Where the tool is and how it leans.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The sine of the angle by which an axis may differ from +Z and still be it: rounding only.
const UPRIGHT: f64 = 1e-9;

/// By how much the square of a unit vector's length may differ from 1: rounding of its coordinates to seven decimals.
const UNIT: f64 = 1e-6;

/// The direction of a tool's axis, from the tip to the shank: a unit vector in work coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "[f64; 3]", into = "[f64; 3]")]
pub struct UnitAxis([f64; 3]);

/// A vector that is no direction: its length is not 1 (within 5e-7), or a coordinate is not a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotUnit(pub [f64; 3]);

impl UnitAxis {
    /// Of an axis whose Z is less there is no use in going up along it: it leans by more than 85 deg.
    pub const LEAST_RISE: f64 = 0.087;

    /// +Z: the tool stands upright.
    pub const UP: Self = Self([0.0, 0.0, 1.0]);

    /// A direction; its coordinates are kept as they are.
    ///
    /// # Errors
    /// [`NotUnit`] when its length differs from 1 by more than 5e-7: divide it by its length first.
    pub fn new(vector: [f64; 3]) -> Result<Self, NotUnit> {
        let [x, y, z] = vector;
        let unit = (x * x + y * y + z * z - 1.0).abs() <= UNIT;
        unit.then_some(Self(vector)).ok_or(NotUnit(vector))
    }

    /// Its coordinates.
    #[must_use]
    pub fn vector(self) -> [f64; 3] {
        self.0
    }

    /// Whether it is +Z, within 1e-9 rad.
    #[must_use]
    pub fn is_up(self) -> bool {
        let [x, y, z] = self.0;
        z > 0.0 && x.abs() <= UPRIGHT && y.abs() <= UPRIGHT
    }
}

impl Default for UnitAxis {
    fn default() -> Self {
        Self::UP
    }
}

impl TryFrom<[f64; 3]> for UnitAxis {
    type Error = NotUnit;

    fn try_from(vector: [f64; 3]) -> Result<Self, NotUnit> {
        Self::new(vector)
    }
}

impl From<UnitAxis> for [f64; 3] {
    fn from(axis: UnitAxis) -> Self {
        axis.0
    }
}

impl std::fmt::Display for NotUnit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [x, y, z] = self.0;
        write!(f, "the tool axis ({x}, {y}, {z}) is not a unit vector: divide it by its length")
    }
}

impl std::error::Error for NotUnit {}

/// Position of the controlled point and direction of the tool's axis there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The controlled point, in planned programs the tool's tip, work coordinates, mm.
    pub tip: [f64; 3],
    /// The tool's axis.
    pub axis: UnitAxis,
}

impl Pose {
    /// An upright tool, mm.
    #[must_use]
    pub const fn upright(tip: [f64; 3]) -> Self {
        Self { tip, axis: UnitAxis::UP }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_is_a_unit_vector_and_keeps_its_coordinates() {
        let tilted = [0.6, 0.0, 0.8];
        assert_eq!(UnitAxis::new(tilted).map(UnitAxis::vector), Ok(tilted));
        // written with seven decimals
        assert!(UnitAxis::new([0.577_350_3, 0.577_350_3, 0.577_350_3]).is_ok());
        for bad in [[0.0; 3], [0.0, 0.0, 2.0], [f64::NAN, 0.0, 1.0], [0.6, 0.0, 0.79]] {
            assert!(UnitAxis::new(bad).is_err(), "{bad:?}");
        }
    }

    #[test]
    fn up_is_plus_z_but_for_rounding() {
        assert!(UnitAxis::UP.is_up());
        let axis = |vector| UnitAxis::new(vector).unwrap();
        assert!(axis([1e-10, -1e-10, 1.0]).is_up());
        assert!(!axis([0.0, 0.0, -1.0]).is_up());
        assert!(!axis([1e-8, 0.0, 1.0]).is_up());
    }
}
