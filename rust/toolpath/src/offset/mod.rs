//! Where the tool stands: slope-matched offset and the gouge-free envelope.

mod bending;
mod bridging;
mod contact;
mod edge;
mod envelope;
mod features;
mod index;
mod normal;
mod offset_surface;
mod patches;
mod push;
mod regions;
mod search;
mod selection;
mod slices;
mod slope_matched;
mod tiles;

pub use bridging::{bridges, Bridge, Bridges, Stopped};
pub use envelope::{Contact, Envelope};
pub use index::Index;
pub use offset_surface::{OffsetPoint, OffsetSurface, SurfaceFlag};
pub use push::Line;
pub use regions::Region;
pub use search::{Keeping, Verdict};
pub use selection::Rolling;
pub use slices::{Slice, Slices};
pub use slope_matched::{slope_matched_offset, OffsetFlag};
