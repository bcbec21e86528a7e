//! Moves below the last level, under which nothing is known of the stock.

use super::work::Work;
use crate::faults::{self, Fault};
use crate::segments::SegmentKind;
use crate::subject::Limits;
use crate::tolerances::SAME_LEVEL;

/// The faults of moves that go on below the last level, or, where there is none, below the height at which the operation begins.
pub(super) fn faults(work: &Work<'_>, limits: &Limits) -> Vec<Fault> {
    let last = work.heights.last().copied().unwrap_or(work.clearing.top);
    let below = work.own.iter().map(|own| own.segment).filter(|segment| {
        let goes_up = segment.start.is_some_and(|start| !segment.travels() && segment.end[2] >= start[2]);
        !goes_up && segment.lowest() < last - SAME_LEVEL.max(limits.unit)
    });
    let fault = |kind| match kind {
        SegmentKind::Rapid => &faults::RAPID_BELOW_LEVELS,
        SegmentKind::Plunge | SegmentKind::Retract | SegmentKind::Still | SegmentKind::Lateral => {
            &faults::FEED_BELOW_LEVELS
        }
    };
    below.map(|segment| segment.fault(fault(segment.kind)).measured(segment.lowest(), last)).collect()
}
