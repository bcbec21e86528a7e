//! From geometry to motion: where the tool may stand, and in which order it goes there.

#![cfg_attr(test, allow(clippy::disallowed_methods))] // what tests expect may come from std

mod arcs;
pub mod boring;
pub mod budget;
pub mod chamfer;
pub mod contouring;
mod corners;
mod error;
mod fitting;
pub mod flank;
pub mod forming;
mod lattice;
mod lead_seams;
mod leads;
mod linking;
pub mod offset;
mod ordering;
mod pass;
pub mod plan;
mod planes;
pub mod pocket;
mod region;
mod seam;
mod segment;
mod standing;
mod surface;
mod tabs;

pub use arcs::{Arcs, Fitted};
pub use corners::slowed;
pub use error::PlanError;
pub use lattice::{Cells, Lattice};
pub use leads::{LeadRule, LeadShape, Leading};
pub use linking::{
    join, link, link_with_arcs, AlongSurface, AtDepth, Entered, Followed, Heights, Lead, LinkRules, Links,
    OverClearance, Position, Rates, Run,
};
pub use ordering::{ordered, shortly_ordered, Air, Freedom, Ordered};
pub use pass::{Pass, PathPoint, Sense};
pub use planes::Planes;
pub use region::{Boundary, Inside, Region, GRAZES};
pub use seam::Seam;
pub use segment::{Curve, Pace, Segment};
pub use standing::{Across, Low, Standing};
pub use surface::Surface;
pub use tabs::{lifted, tabs, Tab, TabError, TabNumber, TabRule};
