//! A program as what it has cut before another one.

use styluscam_motion::Program;

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
