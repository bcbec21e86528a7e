//! The moves of an operation that clears stock.

use styluscam_motion::{FeedMode, Program, Role};

use crate::segments::{Segment, SegmentKind};
use crate::tolerances::{SAME_LEVEL, SLACK};

/// Falls that rounding may hide, units at most: of a descent whose moves are rounded to none.
const ROUNDED_FALL: f64 = 2.0;

/// A move, with what is known of it besides its way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Own<'a> {
    pub segment: &'a Segment,
    /// Its feed, mm/min; none of a rapid.
    pub feed: Option<f64>,
    /// Whether it is to cut nothing: because the text calls it a link, or because the tool has been lifted at a feed and not come down since.
    pub is_link: bool,
    /// Whether it is part of a descent: it goes down, or would but for rounding.
    pub descends: bool,
}

/// The moves of an operation in their order; `unit` is what the text's last decimal counts, mm, and `radius` the tool's, mm.
pub(super) fn moves_of<'a>(
    program: &Program,
    segments: impl Iterator<Item = &'a Segment>,
    unit: f64,
    radius: f64,
) -> Vec<Own<'a>> {
    let mut is_lifted = false;
    let own = segments.map(|segment| {
        let step = program.moves.get(segment.index);
        let rises = segment.start.is_some_and(|start| segment.end[2] > start[2] + SAME_LEVEL);
        is_lifted = segment.kind != SegmentKind::Rapid && (rises || is_lifted && !segment.descends());
        let feed = step.filter(|step| segment.kind != SegmentKind::Rapid && step.feed_mode == FeedMode::PerMinute);
        let is_link = is_lifted || step.is_some_and(|step| step.role == Some(Role::Link));
        Own { segment, feed: feed.map(|step| step.feed), is_link, descends: segment.descends() }
    });
    let mut own: Vec<Own> = own.collect();
    rounded_descents(&mut own, unit, radius);
    own
}

/// Marks level moves that are part of a descent: shorter together than the tool's radius, between two moves that fall by hardly more than a
/// unit, or so steeply that over the length of the level ones they would by no more. Moves of slow descents, and short ones of others,
/// are rounded to such.
fn rounded_descents(own: &mut [Own], unit: f64, radius: f64) {
    let is_level = |own: &Own| own.segment.kind == SegmentKind::Lateral && !own.segment.falls();
    let fall = |own: &Own| own.segment.start.map_or(0.0, |start| start[2] - own.segment.end[2]);
    let falls = |own: &Own| own.segment.kind == SegmentKind::Lateral && own.descends;
    let mut first = 0;
    while first < own.len() {
        let count = own.iter().skip(first).take_while(|own| is_level(own)).count();
        let after = first + count;
        let around = first.checked_sub(1).and_then(|before| Some([own.get(before)?, own.get(after)?]));
        let length: f64 = own.iter().skip(first).take(count).map(|own| own.segment.length()).sum();
        let is_rounded = |around: [&Own; 2]| {
            let slopes = around.map(|own| fall(own) / own.segment.length());
            let are_slow = around.into_iter().all(|own| fall(own) <= ROUNDED_FALL * unit + SLACK);
            around.into_iter().all(falls) && (are_slow || length * slopes[0].min(slopes[1]) <= ROUNDED_FALL * unit)
        };
        if length < radius && around.is_some_and(is_rounded) {
            own.iter_mut().skip(first).take(count).for_each(|own| own.descends = true);
        }
        first = after.max(first + 1);
    }
}
