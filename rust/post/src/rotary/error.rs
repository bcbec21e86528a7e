//! Why a program cannot be given to a machine with rotary axes.

use crate::faults::faults;
use crate::post_error::PostError;

faults! {
    /// A path that this machine's rotary axes cannot follow, or axes that are none. Moves count from 0.
    pub enum RotaryError;
    @transparent
    /// The program cannot be written for another reason.
    Post(PostError);
    /// An axis has no direction, a limit that is no number, or a lower limit above the upper one.
    Axis {
        /// Its letter.
        letter: char,
    } = "rotary-axis", ("axis {letter}: a letter of A, B and C, a direction other than 0 and limits within 1440 deg, the lower one first, are needed"),
        "correct the axis of the machine";
    /// Both axes have one letter.
    Letter {
        /// The letter.
        letter: char,
    } = "rotary-letter", ("both rotary axes are called {letter}"), "name them as the control does";
    /// Both axes turn about one direction: they cannot point a tool.
    Parallel = "rotary-parallel", ("both rotary axes turn about one direction"), "correct their directions";
    /// No angles point the tool so.
    Unreachable {
        /// The move.
        index: usize,
    } = "rotary-unreachable", ("no angles of this machine's axes point the tool as move {index} asks"),
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
    /// A tolerance that is none, or more decimals than a control reads.
    Form = "rotary-form", ("a tolerance above 0 and angles of 1 to 8 decimals are needed"), "correct them";
    /// What only plain moves can follow.
    Move {
        /// The move.
        index: usize,
    } = "rotary-move", ("move {index} is an arc, or its feed is not in mm/min"), "give lines at feeds in mm/min";
    /// A line of text that is not understood.
    Text {
        /// From 1.
        line: usize,
        /// The word.
        word: String,
    } = "rotary-text", ("line {line}: {word:?} is not read here"), "give text that was written for these axes";
}
