//! What comes of reading a program.

use std::ops::Range;

use styluscam_motion::{MachineMove, Program};

/// A program read from text.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// The program; positions are those of the tips, mm. The set-up holds the work offset only.
    pub program: Program,
    /// The moves of the linear axes, one for each of the program, where rotary axes are turned: these are then not those of the tip in
    /// the part.
    pub axes: Option<Program>,
    /// Index of the first move at whose end all three axes have been commanded; the number of moves when none is.
    pub first_known_move: usize,
    /// Moves at whose end the position of Z is not known, in runs.
    pub unknown_heights: Vec<Range<usize>>,
    /// Moves in the machine's own coordinates.
    pub machine_moves: Vec<MachineMove>,
    /// Lines that were passed over and that run where the operator's switch for optional blocks is set so.
    pub optional_lines: Vec<u32>,
    /// The line of the first feed move with no length offset in force, on machines that have them.
    pub bare_line: Option<u32>,
    /// Moves at whose end the position of some axis is not known, in runs: at the start, after a tool change (Z), after G53.
    ///
    /// There the axis stands at the next position commanded, or at the last one when none follows.
    pub unknown_positions: Vec<Range<usize>>,
    /// Modal codes that the first move relies on and that the text does not state: G90, G54.
    pub not_stated: Vec<&'static str>,
    /// Moves made while G18 or G19 was in force and no arc used it, in runs.
    pub planes_not_needed: Vec<Range<usize>>,
    /// Moves before which M0 or M1 stops the program.
    pub stops: Vec<usize>,
    /// Lines of the text, up to its end.
    pub lines: u32,
    /// Whether the text came to M2 or M30.
    pub ended: bool,
}
