//! Passes that follow the part and cut deeper through the stock at once than their tool is wide.
//!
//! They have no levels of their own: where nothing has roughed, they cut as deep as the stock stands. What counts is what stands about the
//! tool's axis, so that a wall whose skin is left may be finished at any height. The tool's front takes that before its axis is there:
//! pieces of the path are held back from the material until the tool has gone on by its radius, lifts, or is deeper by half of it.

use std::collections::VecDeque;

use styluscam_geometry::Stock;
use styluscam_motion::{Cancelled, Watch};

use super::divided::{asked, pieces, LONGEST};
use crate::expectation::Passes;
use crate::faults::{self, Fault};
use crate::segments::{Segment, SegmentKind};
use crate::simulation::{Material, Moved, Overlap};
use crate::subject::Subject;

/// How near to the axis what stands is cut by the tool's middle, as a share of its radius: what is farther off is a skin.
pub const CUT_BY_MIDDLE: f64 = 0.5;
/// Passes that follow the part cut no deeper through the stock at once than this, in diameters of their tool.
pub const DEEPEST_AT_ONCE: f64 = 1.0;
/// Nodes are so far apart, as a share of the narrowest tool's radius.
const SPACING: f64 = 0.5;
/// Chords are nearer to arcs than this share of the tool's radius.
const SAG: f64 = 0.01;
/// Pieces that are higher than the tool by more than this share of its radius are another level's.
const DEEPER: f64 = 0.5;

/// The moves that cut too deep, as warnings.
pub(super) fn faults(
    segments: &[Segment],
    (subject, stock): (&Subject, &Stock),
    watch: &Watch,
) -> Result<Vec<Fault>, Cancelled> {
    let tools: Vec<Moved> = subject.tools.iter().map(Moved::profile).collect();
    let tool_of = |segment: &Segment| tools.get(segment.tool?);
    let may_be_deep = |segment: &Segment| {
        let is_deep = |tool: &Moved| segment.lowest() < stock.top - deepest(tool);
        follows_part(segment, subject) && tool_of(segment).is_some_and(is_deep)
    };
    let cutting = segments.iter().filter(|segment| may_be_deep(segment)).filter_map(tool_of);
    let spacing = SPACING * cutting.map(Moved::radius).fold(f64::INFINITY, f64::min);
    let Some((segments, material)) = asked(segments, may_be_deep, spacing, (subject, stock), watch)? else {
        return Ok(Vec::new());
    };
    let mut path = Path { material, held: VecDeque::new(), length: 0.0 };
    watch.begin("depth in the stock", segments.len());
    let mut faults = Vec::new();
    for segment in segments {
        watch.advance(1)?;
        let Some(tool) = tool_of(segment).filter(|_| segment.lowest() < stock.top) else { continue };
        let limit = may_be_deep(segment).then_some(deepest(tool));
        if let Some(Overlap { by, at: position }) = path.follow(segment, tool, limit) {
            let fault = segment.fault(&faults::DEEP_IN_STOCK).measured(by, deepest(tool));
            faults.push(Fault { position, ..fault }.warning());
        }
    }
    Ok(faults)
}

/// How deep a tool may cut at once, mm.
fn deepest(tool: &Moved) -> f64 {
    DEEPEST_AT_ONCE * 2.0 * tool.radius()
}

/// Whether a move cuts along the part, wherever that takes it; other passes have levels of their own, which are checked.
fn follows_part(segment: &Segment, subject: &Subject) -> bool {
    let is_cutting = matches!(segment.kind, SegmentKind::Lateral | SegmentKind::Plunge);
    let expected = segment.expected.and_then(|number| subject.expected.get(number)).filter(|_| is_cutting);
    expected.is_some_and(|operation| match &operation.expectation.passes {
        Passes::Ordered(_)
        | Passes::Crossed(_)
        | Passes::Flank(_)
        | Passes::Chamfering(_)
        | Passes::Covering { .. }
        | Passes::Unordered { .. } => true,
        Passes::Clearing(_) | Passes::Contouring(_) | Passes::Drilling(_) | Passes::Boring(_) => false,
    })
}

/// A path through the material.
struct Path<'a> {
    material: Material,
    /// Its last pieces, which the material still has, with what cuts them.
    held: VecDeque<(Segment, &'a Moved)>,
    /// Their length, mm.
    length: f64,
}

impl<'a> Path<'a> {
    /// Goes on along a move: where what stands about the axis is higher over the tool than `limit` mm.
    fn follow(&mut self, segment: &Segment, tool: &'a Moved, limit: Option<f64>) -> Option<Overlap> {
        if segment.kind != SegmentKind::Lateral {
            self.settle(0.0, f64::NEG_INFINITY); // it lifts, or comes down
        }
        // where nodes are far apart, one on either side of the axis at least
        let within = (CUT_BY_MIDDLE * tool.radius()).max(0.51 * self.material.spacing()).min(tool.radius());
        let mut worst: Option<Overlap> = None;
        for piece in pieces(segment, LONGEST * tool.radius(), SAG * tool.radius()) {
            self.settle(tool.radius(), piece.lowest() + DEEPER * tool.radius());
            if let Some(limit) = limit {
                let least = worst.map_or(limit, |worst| worst.by);
                worst = self.material.overlap(&piece, tool, within, least).or(worst);
            }
            self.length += piece.length();
            self.held.push_back((piece, tool));
        }
        worst
    }

    /// Takes the pieces that are farther back than `length` mm, and those before one that is higher than `height` mm.
    fn settle(&mut self, length: f64, height: f64) {
        let higher = self.held.iter().rposition(|(piece, _)| piece.lowest() > height).map_or(0, |last| last + 1);
        let mut count = 0;
        while let Some((piece, tool)) = self.held.front() {
            let own = piece.length();
            if count >= higher && self.length - own < length {
                break;
            }
            self.material.cut(piece, tool);
            self.length -= own;
            self.held.pop_front();
            count += 1;
        }
    }
}
