//! The machine-independent program: what planning writes, posting turns into text, and verification checks.
//!
//! Positions are the controlled point in work coordinates (mm); in a planned program the
//! controlled point is the tool's tip. Nothing here knows shapes or controllers.

#![cfg_attr(test, allow(clippy::disallowed_methods))] // what tests expect may come from std

mod arc;
mod cycle;
mod dynamics;
mod edit;
mod event;
mod feed_rounding;
mod pose;
mod program;
mod ramps;
mod record;
mod statistics;
mod step;
mod watch;

pub use arc::{Arc, ArcPath, Plane};
pub use cycle::{Cycle, CycleKind, CycleStart, CycleStep, MOST_PECKS};
pub use dynamics::{Cornering, Dynamics};
pub use event::{Event, EventKind, SpindleDirection, Upcoming};
pub use feed_rounding::FeedRounding;
pub use pose::{NotUnit, Pose, UnitAxis};
pub use program::{MachineMove, Program};
pub use record::{OperationRecord, SetupRecord, ToolRecord, ToolReference};
pub use statistics::Statistics;
pub use step::{FeedMode, Move, MoveKind, Role};
pub use watch::{Cancelled, Watch};

/// Version of the program document; older ones migrate, newer ones are refused.
pub const PROGRAM_SCHEMA: u32 = 1;
