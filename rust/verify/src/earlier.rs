//! A program as what it has cut before another one.

use rstar::primitives::Line;
use styluscam_motion::{ArcPath, Program};

use crate::before::{Before, Stretch};
use crate::segments::{placed, Segment, SegmentKind};
use crate::subject::{Limits, Subject};

/// What a program cuts: all its moves of upright tools whose positions are known.
#[must_use]
pub fn cut_by(program: &Program, subject: &Subject, limits: &Limits) -> Before {
    let segments = placed(program, subject, limits);
    Before { stretches: segments.iter().flat_map(stretches).collect(), tools: subject.tools.to_vec() }
}

/// The pieces of a segment.
pub(crate) fn stretches(segment: &Segment) -> impl Iterator<Item = Stretch> + '_ {
    segment.pieces().map(|piece| Stretch {
        start: piece.start,
        end: piece.end,
        bend: piece.bend,
        tool: piece.tool,
        is_rapid: piece.kind == SegmentKind::Rapid,
    })
}

/// A path in plan in chords that are no farther from it than `sag`, mm.
pub(crate) fn plan_chords(
    [start, end]: [[f64; 3]; 2],
    bend: Option<ArcPath>,
    sag: f64,
) -> impl Iterator<Item = Line<[f64; 2]>> {
    let count = bend.map_or(1, |bend| bend.chords(sag).max(1));
    let at = move |i: usize| {
        let straight = if i == 0 { start } else { end };
        let [x, y, _] = bend.map_or(straight, |bend| bend.at(i as f64 / count as f64));
        [x, y]
    };
    (0..count).map(move |i| Line::new(at(i), at(i + 1)))
}
