//! Why the rotary axes of a machine cannot follow a program.

use crate::faults::faults;

faults! {
    /// A path that this machine's rotary axes cannot follow. Moves count from 0.
    pub enum RotaryError;
    /// No angles point the tool so.
    Unreachable {
        /// The move.
        index: usize,
    } = "rotary-unreachable", ("no angles of this machine's rotary axes point the tool as move {index} asks"),
        "turn the part in the setup, or take another machine";
    /// The angles lie beyond the limits.
    Limit {
        /// The move.
        index: usize,
    } = "rotary-limit", ("move {index} needs angles beyond the limits of the rotary axes"),
        "turn the part in the setup, or take another machine";
    /// An axis turns far where the tool hardly does: there it does not keep to its move, however many poses lie between.
    Turn {
        /// The move.
        index: usize,
        /// The axis.
        letter: char,
        /// How far in the last part of the move, deg.
        degrees: f64,
    } = "rotary-turn", ("in move {index} axis {letter} would turn by {degrees:.1} deg at once: the tool passes the direction of an axis, or an axis comes to its limit"),
        "turn the part in the setup, so that the tool leans more, or stays within the limits";
}

impl RotaryError {
    /// The move.
    #[must_use]
    pub fn index(&self) -> usize {
        match *self {
            Self::Unreachable { index } | Self::Limit { index } | Self::Turn { index, .. } => index,
        }
    }
}
