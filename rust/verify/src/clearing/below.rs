//! Moves below the last level, under which nothing is known of the stock.

use super::work::Work;
use crate::faults::{self, Fault};
use crate::segments::{Segment, SegmentKind};
use crate::subject::Limits;
use crate::tolerances::SAME_LEVEL;

/// The faults of moves that go on below the last level, or, where there is none, below the height at which the operation begins.
pub(super) fn faults(work: &Work<'_>, limits: &Limits) -> Vec<Fault> {
    let last = work.heights.last().copied().unwrap_or(work.clearing.top);
    let is_below = |segment: &&Segment| segment.lowest() < last - SAME_LEVEL.max(limits.unit);
    let below =
        work.own.iter().map(|own| own.segment).filter(|segment| !segment.goes_straight_up() && is_below(segment));
    let fault = |kind| match kind {
        SegmentKind::Rapid => &faults::RAPID_BELOW_LEVELS,
        SegmentKind::Plunge | SegmentKind::Retract | SegmentKind::Still | SegmentKind::Lateral => {
            &faults::FEED_BELOW_LEVELS
        }
    };
    below.map(|segment| segment.fault(fault(segment.kind)).measured(segment.lowest(), last)).collect()
}
