//! Where the part and the tool are when two axes turn them.
//!
//! At angles 0 work and machine have one frame and the tool stands along +Z.

use crate::machine::{Carrier, MachineError, RotaryAxis};

pub(crate) type Vector = [f64; 3];

pub(crate) const UP: Vector = [0.0, 0.0, 1.0];
/// Limits beyond this are none, deg.
const WIDEST_DEG: f64 = 1440.0;
/// What axes that turn are called (ISO 6983-1).
const LETTERS: &str = "ABC";
/// Axes with a smaller sine between them are parallel.
const PARALLEL: f64 = 1e-6;

/// Both axes. Where they carry the same, the first carries the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotaryAxes {
    axes: [RotaryAxis; 2],
}

impl RotaryAxes {
    /// Axes with directions of any length.
    ///
    /// # Errors
    /// [`MachineError::Value`]: the key, and what is wrong.
    pub fn new(mut axes: [RotaryAxis; 2]) -> Result<Self, MachineError> {
        for (index, axis) in axes.iter_mut().enumerate() {
            let wrong = |key: &str, problem: &str| MachineError::Value {
                key: format!("rotary.axes[{index}].{key}"),
                problem: problem.into(),
            };
            let length = norm(axis.direction);
            let [low, high] = axis.limits_deg;
            if !LETTERS.contains(axis.letter) {
                return Err(wrong("letter", "A, B or C"));
            }
            if !length.is_normal() {
                return Err(wrong("direction", "three numbers, not all of them 0"));
            }
            if !axis.pivot.iter().all(|x| x.is_finite()) {
                return Err(wrong("pivot", "three lengths, in mm"));
            }
            if !(low <= high && low.abs().max(high.abs()) <= WIDEST_DEG) {
                return Err(wrong("limits_deg", "the lowest angle, then the highest, within 1440 deg"));
            }
            axis.direction = axis.direction.map(|x| x / length);
        }
        let [first, second] = &axes;
        let wrong = |key: &str, problem: &str| Err(MachineError::Value { key: key.into(), problem: problem.into() });
        if first.letter == second.letter {
            return wrong("rotary.axes[1].letter", "both axes have one letter: name them as the control does");
        }
        if norm(cross(first.direction, second.direction)) < PARALLEL {
            return wrong("rotary.axes[1].direction", "both axes turn about one direction: they cannot point a tool");
        }
        Ok(Self { axes })
    }

    /// The axes.
    #[must_use]
    pub fn axes(&self) -> &[RotaryAxis; 2] {
        &self.axes
    }

    /// Where the linear axes stand, mm, when the tip is at a point of the part: at angles 0 there.
    #[must_use]
    pub fn linear(&self, tip: [f64; 3], angles_deg: [f64; 2]) -> [f64; 3] {
        let aside = self.carried(Carrier::Head, [0.0; 3], angles_deg);
        let carried = self.carried(Carrier::Table, tip, angles_deg);
        [0, 1, 2].map(|i| carried[i] - aside[i])
    }

    /// The tip in work coordinates, mm, where the linear axes stand there: the inverse of [`linear`](Self::linear).
    #[must_use]
    pub fn tip(&self, linear: [f64; 3], angles_deg: [f64; 2]) -> [f64; 3] {
        let aside = self.carried(Carrier::Head, [0.0; 3], angles_deg);
        let carried = [0, 1, 2].map(|i| linear[i] + aside[i]);
        let tables = self.axes.iter().zip(angles_deg).filter(|(axis, _)| axis.carries == Carrier::Table);
        tables.fold(carried, |point, (axis, angle)| about(axis, point, -angle))
    }

    /// The tool's direction in work coordinates.
    #[must_use]
    pub fn direction(&self, angles_deg: [f64; 2]) -> [f64; 3] {
        let turned = |carrier, sign: f64, from: Vector, backwards: bool| {
            let order = if backwards { [1, 0] } else { [0, 1] };
            order
                .into_iter()
                .filter(|i| self.axes[*i].carries == carrier)
                .fold(from, |tool, i| turn(self.axes[i].direction, tool, sign * angles_deg[i].to_radians()))
        };
        let tool = turned(Carrier::Head, 1.0, UP, true);
        turned(Carrier::Table, -1.0, tool, false)
    }

    /// A point that is carried, in the machine.
    fn carried(&self, carrier: Carrier, point: Vector, angles_deg: [f64; 2]) -> Vector {
        let axes = self.axes.iter().zip(angles_deg).rev().filter(|(axis, _)| axis.carries == carrier);
        axes.fold(point, |point, (axis, angle)| about(axis, point, angle))
    }
}

fn about(axis: &RotaryAxis, point: Vector, degrees: f64) -> Vector {
    let from = [0, 1, 2].map(|i| point[i] - axis.pivot[i]);
    let turned = turn(axis.direction, from, degrees.to_radians());
    [0, 1, 2].map(|i| turned[i] + axis.pivot[i])
}

/// A vector turned about a unit vector (Rodrigues).
fn turn(about: Vector, from: Vector, angle: f64) -> Vector {
    let (sin, cos) = libm::sincos(angle);
    let (across, along) = (cross(about, from), dot(about, from));
    [0, 1, 2].map(|i| from[i] * cos + across[i] * sin + about[i] * along * (1.0 - cos))
}

/// A vector of length 1 in the same direction.
pub(crate) fn unit(a: Vector) -> Vector {
    let length = norm(a).max(f64::MIN_POSITIVE);
    a.map(|x| x / length)
}

pub(crate) fn between<const N: usize>(from: [f64; N], to: [f64; N], share: f64) -> [f64; N] {
    std::array::from_fn(|i| from[i] + share * (to[i] - from[i]))
}

/// The larger of two turns, deg.
pub(crate) fn larger_turn(from: [f64; 2], to: [f64; 2]) -> f64 {
    (to[0] - from[0]).abs().max((to[1] - from[1]).abs())
}

pub(crate) fn difference(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] - b[i])
}

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
