//! Between motion and text: machine files, templates, writers and readers of G-code.
//!
//! [`post`] writes a [`Program`](styluscam_motion::Program) for a [`Machine`]; [`read`] reads text as that machine
//! would, and [`trace`] shows what no machine file describes. A controller of this family is a TOML file; nothing here knows geometry, clocks or files.

#![cfg_attr(test, allow(clippy::disallowed_methods))] // what tests expect may come from std

mod arc_blocks;
mod block;
mod cl;
mod comment;
mod faults;
mod freecad;
mod inspect;
pub mod machine;
mod names;
mod ngc;
mod number;
mod path_text;
mod post_error;
mod read_error;
mod reader;
mod repost;
mod role;
mod rotary;
mod rounded;
mod template;
mod trial;
mod writer;

pub use cl::cl_text;
pub use freecad::{read_path, PathError, PathSection};
pub use machine::{shipped, Machine, MachineError, OptionRule, OptionValue, BUILT_IN_OPTIONS};
pub use names::{FUNCTIONS, NAMES, OWN_NAMES};
pub use ngc::{trace, Gap, Note, Trace, TraceError, TraceFault};
pub use path_text::{path_text, PathTextError};
pub use post_error::PostError;
pub use read_error::{ReadError, ReadFault};
pub use reader::{read, Reading};
pub use repost::{read_to_post, RepostError};
pub use rotary::{RotaryAxes, RotaryError};
pub use template::Facts;
pub use trial::{check, difference, try_out, Outcome, Trial, TrialError};
pub use writer::{post, post_to, Posted, Poster};
