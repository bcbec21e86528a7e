//! Where the tool stands: slope-matched offset and the gouge-free envelope.

mod bridging;
mod edge;
mod envelope;
mod features;
mod slope_matched;

pub use bridging::{bridges, Bridge};
pub use envelope::{Contact, Envelope};
pub use slope_matched::{slope_matched_offset, OffsetFlag};
