//! The moves on the levels of operations that form a sheet from the top down.

use styluscam_motion::{MoveKind, Program};

use crate::assignment::Assignment;
use crate::expectation::{ExpectedOperation, OrderedPasses};
use crate::segments::{Segment, SegmentKind};
use crate::subject::Limits;
use crate::tolerances::SAME_LEVEL;

/// A level counts as lower from this share of the step on.
pub(crate) const LOWER: f64 = 0.25;

/// The moves of an operation that run on its levels, in pieces.
///
/// Straight up or down at the path's feed the tool climbs over what stands there, or falls beside it, and comes back: that is
/// no level.
pub(crate) fn level_moves<'a>(
    program: &'a Program,
    segments: &'a [Segment],
    assignment: &'a Assignment,
    (order, passes): (&'a ExpectedOperation, &'a OrderedPasses),
    limits: &'a Limits,
) -> impl Iterator<Item = Segment> + 'a {
    let mut away_from: Option<f64> = None;
    segments.iter().flat_map(|segment| segment.pieces()).filter(move |segment| {
        let along = at_cut(program, segment, order, limits)
            && matches!(segment.kind, SegmentKind::Plunge | SegmentKind::Retract);
        match (segment.kind, away_from, segment.start) {
            (SegmentKind::Rapid, ..) => away_from = None,
            (_, Some(level), _) if (segment.end[2] - level).abs() <= SAME_LEVEL => away_from = None,
            (_, None, Some(start)) if along => away_from = Some(start[2]),
            _ => {}
        }
        let is_level = segment.kind == SegmentKind::Lateral
            && program.moves[segment.index].is_along_pass()
            && (passes.continuous || !segment.falls());
        is_level && away_from.is_none() && assignment.is(segment.operation, order)
    })
}

/// Whether a move along a pass has the feed of the path.
pub(crate) fn at_cut(program: &Program, segment: &Segment, order: &ExpectedOperation, limits: &Limits) -> bool {
    let (step, cut) = (&program.moves[segment.index], order.cut);
    let before = segment.index.checked_sub(1).map(|before| program.moves[before].kind);
    let is_slow = order.slows_at_corners && step.feed < cut && before == Some(MoveKind::Feed);
    step.is_along_pass() && (is_slow || (step.feed - cut).abs() <= limits.feed_slack(cut, segment.length()))
}
