//! The moves of an operation that clears stock.

use styluscam_motion::{FeedMode, Program, Role};

use crate::segments::{Segment, SegmentKind};
use crate::tolerances::SAME_LEVEL;

/// A move, with what is known of it besides its way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Own<'a> {
    pub segment: &'a Segment,
    /// Its feed, mm/min; none of a rapid.
    pub feed: Option<f64>,
    /// Whether it is to cut nothing: because the text calls it a link, or because the tool has been lifted at a feed and not come down since.
    pub is_link: bool,
}

/// The moves of an operation in their order.
pub(super) fn moves_of<'a>(program: &Program, segments: impl Iterator<Item = &'a Segment>) -> Vec<Own<'a>> {
    let mut is_lifted = false;
    let own = segments.map(|segment| {
        let step = program.moves.get(segment.index);
        let rises = segment.start.is_some_and(|start| segment.end[2] > start[2] + SAME_LEVEL);
        is_lifted = segment.kind != SegmentKind::Rapid && (rises || is_lifted && !segment.descends());
        let feed = step.filter(|step| segment.kind != SegmentKind::Rapid && step.feed_mode == FeedMode::PerMinute);
        let is_link = is_lifted || step.is_some_and(|step| step.role == Some(Role::Link));
        Own { segment, feed: feed.map(|step| step.feed), is_link }
    });
    own.collect()
}
