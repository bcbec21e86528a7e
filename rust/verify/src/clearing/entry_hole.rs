//! Whether the hole in which an operation begins is there.

use super::work::Work;
use crate::findings::{Finding, FindingKind, Severity};
use crate::opened::{Opened, Opening};
use crate::segments::Segment;
use crate::subject::Subject;

/// The finding of a hole that neither the stock has, nor feeds before the operation cut down to its last level.
pub(super) fn missing(work: &Work<'_>, segments: &[Segment], subject: &Subject) -> Option<Finding> {
    let hole = work.clearing.hole.filter(|hole| !hole.is_in_stock)?;
    let bottom = *work.heights.last()?;
    let first = work.own.iter().map(|own| own.segment.index).min()?;
    let opened = Opened::before(first, segments, subject)?;
    let opening = Opening { at: hole.at, radius: hole.radius, top: work.clearing.top, bottom };
    (!opened.has(&opening)).then(|| {
        let message = format!(
            "operation {:?} goes down in a hole of {:.3} mm at X{:.3} Y{:.3}, which neither the stock nor what is cut before has \
             down to Z{bottom:.3}; drill it before with its full diameter to that depth, or state entry_hole.in_stock = true where \
             the stock comes with it",
            work.operation.id,
            2.0 * hole.radius,
            hole.at[0],
            hole.at[1]
        );
        Finding::of_all(FindingKind::MissingHole, Severity::Error, message)
    })
}
