//! Programs to look at: an interpreter of the whole RS-274NGC language as LinuxCNC speaks it.
//!
//! Where [`read`](crate::read) refuses what it does not know, because a judgement stands on it, [`trace`] shows what it
//! can and notes what it leaves out. Sources: LinuxCNC's manual, chapters "G-Code Overview", "G-Codes", "M-Codes" and
//! "O-Codes"; T. Kramer, F. Proctor, E. Messina, "The NIST RS274NGC Interpreter - Version 3", NISTIR 6556, 2000.

mod block;
mod codes;
mod coordinates;
mod curves;
mod cycles;
mod expression;
mod fault;
mod flow;
mod modes;
mod motion;
mod note;
mod offsets;
mod parameters;
mod path;
mod settings;
mod source;
mod threads;
mod tracer;

pub use fault::{TraceError, TraceFault};
pub use note::{Gap, Note};

use styluscam_motion::{Program, Watch};

/// What a program may need before it is given up.
#[derive(Clone, Copy)]
struct Limits {
    /// Lines that are run: more of them are an endless loop.
    blocks: u64,
    /// Moves and events that are kept.
    moves: usize,
}

/// The moves take half a gigabyte.
const LIMITS: Limits = Limits { blocks: 20_000_000, moves: 5_000_000 };

/// mm/min: of feed moves whose feed is not known.
const FEED_UNKNOWN: f64 = 1000.0;

/// A program as far as it can be shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// Its moves and events. Places are those of the tips, in the coordinates in force at the first move: where work
    /// offsets change later, what follows is shown where it lies in space.
    pub program: Program,
    /// What is left out or taken for granted.
    pub notes: Vec<Note>,
}

/// Runs a program and records its moves.
///
/// `find` gives the text of a subroutine's file by its name, in lower case, or nothing. The machine starts at zero in
/// mm, with all work offsets at 0 and an empty tool table; blocks with `/` are run.
///
/// # Errors
/// [`TraceError`] for the first line that cannot be understood, a program without end, and one that moves nothing.
pub fn trace(text: &str, find: &dyn Fn(&str) -> Option<String>, watch: &Watch) -> Result<Trace, TraceError> {
    tracer::Tracer::new(text, find, watch, LIMITS).run()
}

#[cfg(test)]
mod tests;
