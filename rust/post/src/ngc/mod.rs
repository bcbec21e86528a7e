//! Programs to look at: an interpreter of the whole RS-274NGC language as LinuxCNC speaks it.
//!
//! Where [`read`](crate::read) refuses what it does not know, because verification stands on it, [`trace`] shows what it
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
mod frame;
mod modes;
mod motion;
mod note;
mod offsets;
mod parameters;
mod path;
mod settings;
mod source;
mod threads;
mod trace;
mod tracer;
mod values;

pub use fault::{TraceError, TraceFault};
pub use note::{Gap, Note};
pub use trace::Trace;

use styluscam_motion::Watch;

/// Runs a program and records its moves.
///
/// `find` gives the text of a subroutine's file by its name, in lower case, or nothing. The machine starts at zero in
/// mm, with all work offsets at 0 and an empty tool table; blocks with `/` are run.
///
/// # Errors
/// [`TraceError`] for the first line that cannot be understood, a program without end, and one that moves nothing.
pub fn trace(text: &str, find: &dyn Fn(&str) -> Option<String>, watch: &Watch) -> Result<Trace, TraceError> {
    tracer::Tracer::new(text, find, watch, trace::LIMITS).run()
}

#[cfg(test)]
mod tests;
