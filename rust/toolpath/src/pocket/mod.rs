//! Pockets cleared with a bounded engagement angle.
//!
//! The tool's centre may move on the boundary of everything that permissible discs cover: discs on whose circles the bound holds,
//! because no material is nearer to their centres than a closed form allows (`bound`). The area that they cover grows as material goes:
//! pieces of its boundary on which the tool cuts are the path, until nothing is left. Clearing more only lowers the angle, so
//! the order of the pieces is free. What the construction guarantees, and where it does not, stands in docs/concepts/pockets.md.

mod areas;
mod bound;
mod boxes;
mod check;
mod contour;
mod contours;
mod cut;
mod entry;
mod error;
mod feeds;
mod finish;
mod fit;
mod frame;
mod ground;
mod growth;
mod links;
mod material;
mod moves;
mod offset;
mod pieces;
mod planner;
pub(crate) mod polygons;
mod request;
mod sequence;
mod steering;
mod window;

#[cfg(test)]
mod tests;

use styluscam_motion::Watch;

use frame::{Frame, Framed};
use ground::check;

pub use areas::CentreArea;
pub use contour::{Contour, Strip};
pub use error::PocketError;
pub use feeds::FeedLaw;
pub use moves::{segments, Layer};
pub use request::{Cleared, EntryForm, EntryRule, Pocket, PocketPath, PocketRun, PocketRunKind, Shape, Stepover};

/// Plans the path.
///
/// # Errors
/// What is not a pocket or a tool, a tool that fits nowhere; `Cancelled` when the watch is cancelled.
pub fn pocket_path(pocket: &Pocket<'_>, watch: &Watch) -> Result<PocketPath, PocketError> {
    check(pocket)?;
    let frame = Frame::new(pocket)?;
    let framed = Framed::new(pocket, frame);
    let path = with_finish(&framed.pocket(), watch).map_err(|error| frame.error(error))?;
    Ok(frame.back(path))
}

/// By climb milling, with a pass along the walls at the end where one is asked for.
fn with_finish(pocket: &Pocket<'_>, watch: &Watch) -> Result<PocketPath, PocketError> {
    if pocket.finish > 0.0 {
        return finish::plan(pocket, watch);
    }
    planner::plan(pocket, watch)
}
