//! What tools meet of the stock that no move has taken yet: shank and holder that are in it, and passes along the part that cut
//! deeper through it than their tool is wide.
//!
//! The material is heights over a grid, lowered move by move in the order of the text. At the nodes they are exact but for arcs, which
//! are looked at as chords; what is narrower than two nodes are apart may be missed. Knows nothing of how paths were planned.

mod deep;
mod divided;
mod overhang;

pub use deep::{CUT_BY_MIDDLE, DEEPEST_AT_ONCE};

use std::collections::BTreeSet;

use styluscam_motion::{Cancelled, Watch};

use crate::faults::Fault;
use crate::segments::Segment;
use crate::subject::Subject;

/// The moves on which a tool is in the stock as it must not be, and by how much at most; without those on which the same is known of
/// the part, which is in the stock.
///
/// # Errors
/// `Cancelled`.
pub(crate) fn faults(
    segments: &[Segment],
    subject: &Subject,
    known: &[Fault],
    watch: &Watch,
) -> Result<Vec<Fault>, Cancelled> {
    // of a stock that is not stated nothing is known but that the part is in it
    let Some(stock) = subject.stock.filter(|_| subject.stock_is_stated && subject.sheet.is_none()) else {
        return Ok(Vec::new());
    };
    let known: BTreeSet<_> = known.iter().map(|fault| (fault.kind.finding, fault.index)).collect();
    let mut found = overhang::faults(segments, (subject, stock), watch)?;
    found.retain(|fault| !known.contains(&(fault.kind.finding, fault.index)));
    if subject.expected.iter().any(|operation| operation.expectation.flank().is_some()) {
        // what a leaning tool takes is not known here
        found = found.into_iter().map(Fault::warning).collect();
    }
    found.extend(deep::faults(segments, (subject, stock), watch)?);
    Ok(found)
}
