//! Where the part and the tool are when two axes turn them.
//!
//! At angles 0 work and machine have one frame and the tool stands along +Z. A positive angle turns what the axis carries by the
//! right-hand rule about its direction: where a control counts a table's angle by the tool's turn as seen from the part, the
//! direction is the opposite one.

use super::error::RotaryError;

pub(super) type Vector = [f64; 3];

pub(super) const UP: Vector = [0.0, 0.0, 1.0];
/// Limits beyond this are none, deg.
const WIDEST_DEG: f64 = 1440.0;
/// What axes that turn are called (ISO 6983-1).
const LETTERS: &str = "ABC";
/// Axes with a smaller sine between them are parallel.
const PARALLEL: f64 = 1e-6;

/// What an axis turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carrier {
    /// The part.
    Table,
    /// The tool.
    Head,
}

/// An axis that turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotaryAxis {
    /// `A`, `B` or `C`.
    pub letter: char,
    /// What it turns.
    pub carrier: Carrier,
    /// About which direction, at angles 0.
    pub direction: [f64; 3],
    /// A point that it does not move, mm: of tables in work coordinates, of heads from the tool's tip, both at angles 0.
    pub pivot: [f64; 3],
    /// Lowest and highest angle, deg.
    pub limits_deg: [f64; 2],
}

/// Both axes. Where they carry the same, the first carries the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotaryAxes {
    axes: [RotaryAxis; 2],
}

impl RotaryAxes {
    /// Axes with directions of any length.
    ///
    /// # Errors
    /// [`RotaryError::Axis`], [`RotaryError::Letter`], [`RotaryError::Parallel`].
    pub fn new(mut axes: [RotaryAxis; 2]) -> Result<Self, RotaryError> {
        for axis in &mut axes {
            let length = norm(axis.direction);
            let [low, high] = axis.limits_deg;
            let is_sound = length.is_normal()
                && axis.pivot.iter().all(|x| x.is_finite())
                && low <= high
                && low.abs().max(high.abs()) <= WIDEST_DEG
                && LETTERS.contains(axis.letter);
            if !is_sound {
                return Err(RotaryError::Axis { letter: axis.letter });
            }
            axis.direction = axis.direction.map(|x| x / length);
        }
        let [first, second] = &axes;
        if first.letter == second.letter {
            return Err(RotaryError::Letter { letter: first.letter });
        }
        let across = cross(first.direction, second.direction);
        if norm(across) < PARALLEL {
            return Err(RotaryError::Parallel);
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
        let tables = self.axes.iter().zip(angles_deg).filter(|(axis, _)| axis.carrier == Carrier::Table);
        tables.fold(carried, |point, (axis, angle)| about(axis, point, -angle))
    }

    /// The tool's direction in work coordinates.
    #[must_use]
    pub fn direction(&self, angles_deg: [f64; 2]) -> [f64; 3] {
        let turned = |carrier, sign: f64, from: Vector, backwards: bool| {
            let order = if backwards { [1, 0] } else { [0, 1] };
            order
                .into_iter()
                .filter(|i| self.axes[*i].carrier == carrier)
                .fold(from, |tool, i| turn(self.axes[i].direction, tool, sign * angles_deg[i].to_radians()))
        };
        let tool = turned(Carrier::Head, 1.0, UP, true);
        turned(Carrier::Table, -1.0, tool, false)
    }

    /// A point that is carried, in the machine.
    fn carried(&self, carrier: Carrier, point: Vector, angles_deg: [f64; 2]) -> Vector {
        let axes = self.axes.iter().zip(angles_deg).rev().filter(|(axis, _)| axis.carrier == carrier);
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

pub(super) fn difference(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] - b[i])
}

pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

pub(super) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
