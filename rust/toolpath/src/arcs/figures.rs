//! What fitting lines and arcs to passes comes to.

use styluscam_geometry::Vector;

use super::directions::of_segment;
use crate::{fitting, Curve, PathPoint, Segment};

/// Pieces of passes, counted, and the corners between them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fitted {
    /// Chords that keep the same tolerance.
    pub chords: usize,
    /// Lines and arcs together.
    pub pieces: usize,
    /// Arcs alone.
    pub arcs: usize,
    /// Largest angle between a piece and the next where one of both is an arc, rad.
    pub corner: f64,
}

impl Fitted {
    /// Of a path through witnesses that its segments keep to within `deviation` mm.
    pub(crate) fn of(witnesses: &[PathPoint], segments: &[Segment], deviation: f64) -> Self {
        let mut found = Self {
            chords: fitting::thinned(witnesses, deviation).len().saturating_sub(1),
            pieces: segments.len(),
            arcs: segments.iter().filter(|segment| segment.curve != Curve::Line).count(),
            corner: 0.0,
        };
        let Some(mut at) = witnesses.first().map(|first| first.tip) else { return found };
        let mut before: Option<(Vector, bool)> = None;
        for segment in segments {
            let is_arc = segment.curve != Curve::Line;
            let [start, end] = of_segment(segment, at);
            if let Some((last, _)) = before.filter(|(_, was_arc)| *was_arc || is_arc) {
                found.corner = found.corner.max(fitting::angle(&last, &start));
            }
            (before, at) = (Some((end, is_arc)), segment.end);
        }
        found
    }

    /// Both together.
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            chords: self.chords + other.chords,
            pieces: self.pieces + other.pieces,
            arcs: self.arcs + other.arcs,
            corner: self.corner.max(other.corner),
        }
    }
}
