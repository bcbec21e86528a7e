//! Machines: everything about a controller that a post or a reader needs, as data from a TOML file.

mod check;
mod document;
mod error;
mod inherit;
mod option;
mod rules;
mod set_option;
mod shipped;
mod values;

pub(crate) use error::most_similar;
pub use error::MachineError;
pub use option::{OptionRule, OptionValue, BUILT_IN_OPTIONS};
pub use rules::*;
pub use shipped::shipped;
pub use values::{Machine, MACHINE_SCHEMA};
