//! What the operations before one have swept of a layer.

use super::own::Own;
use crate::engagement::Swept;
use crate::expectation::Clearing;
use crate::segments::{Segment, SegmentKind};
use crate::subject::Subject;
use crate::tolerances::SAME_LEVEL;

/// The moves before those of an operation that clears rest material; none of another.
pub(super) fn of<'a>(segments: &'a [Segment], own: &[Own], clearing: &Clearing) -> Vec<&'a Segment> {
    let first = own.iter().map(|own| own.segment.index).min().filter(|_| clearing.rest).unwrap_or(0);
    segments.iter().filter(|segment| segment.index < first && segment.kind != SegmentKind::Rapid).collect()
}

/// What they sweep of the layer from its top to its floor, as it looks under its top: moves on which the tip is as low as the floor.
pub(super) fn cleared(before: &[&Segment], [top, floor]: [f64; 2], subject: &Subject) -> Vec<Swept> {
    let pieces = before.iter().flat_map(|segment| segment.pieces());
    let low = pieces.filter_map(|piece| {
        let start = piece.start?;
        let highest = start[2].max(piece.end[2]);
        let tool = subject.tools.get(piece.tool?).filter(|_| highest <= floor + SAME_LEVEL)?;
        let bulge = piece.bend.map_or(0.0, |bend| bend.bulge());
        let points = vec![[start[0], start[1], bulge], [piece.end[0], piece.end[1], 0.0]];
        Some(Swept { points, radius: tool.cutter().at_height(top - highest).0 })
    });
    low.collect()
}
