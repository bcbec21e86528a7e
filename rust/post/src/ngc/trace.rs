//! What comes of a trace, and how much it may take.

use styluscam_motion::Program;

use super::note::Note;

/// What a program may need before it is given up.
#[derive(Clone, Copy)]
pub(super) struct Limits {
    /// Lines that are run: more of them are an endless loop.
    pub(super) blocks: u64,
    /// Moves and events that are kept.
    pub(super) moves: usize,
}

/// The moves take half a gigabyte.
pub(super) const LIMITS: Limits = Limits { blocks: 20_000_000, moves: 5_000_000 };

/// A program as far as it can be shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// Its moves and events. Positions are those of the tips, in the coordinates in force at the first move: where work
    /// offsets change later, what follows is shown where it lies in space.
    pub program: Program,
    /// What is left out or assumed.
    pub notes: Vec<Note>,
}
