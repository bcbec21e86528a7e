//! A clamp frame that goes down with the path ([`Support::DieAndFrame`]): where it stands during each move, and whether that
//! is where the path needs it.
//!
//! Derived in docs/concepts/forming-processes.md.

use styluscam_motion::Program;

use crate::assignment::Assignment;
use crate::faults::{self, Fault};
use crate::level_moves::{level_moves, LOWER};
use crate::segments::{Segment, SegmentKind};
use crate::subject::{Limits, Subject, Support};
use crate::tolerances::{ROUGH, WIDE};

/// Heights of the sheet in the frame.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Frame {
    /// Before and after each move of the program, mm.
    heights: Vec<[f64; 2]>,
    /// Before the first move, mm.
    top: f64,
}

impl Frame {
    /// Where the text states that it stands; where it states nothing, as low as a feed has been so far. None where the sheet's
    /// rim stays.
    pub fn of(program: &Program, segments: &[Segment], subject: &Subject, limits: &Limits) -> Option<Self> {
        let forming = limits.forming.filter(|forming| match forming.support {
            Support::Rim => false,
            Support::DieAndFrame | Support::Mandrel => true,
        })?;
        let stated = subject.text.map_or(&[][..], |text| &text.frame_levels);
        let heights = if stated.is_empty() {
            carried(program.moves.len(), segments, forming.top)
        } else {
            let height = |index| {
                let count = stated.partition_point(|level| level.before <= index);
                stated[..count].last().map_or(forming.top, |level| level.z)
            };
            (0..program.moves.len()).map(|index| [height(index); 2]).collect()
        };
        Some(Self { heights, top: forming.top })
    }

    /// Heights before and after a move of the program, mm.
    pub fn at(&self, index: usize) -> [f64; 2] {
        self.heights.get(index).copied().unwrap_or([self.top; 2])
    }

    /// How far below its first height it stands before and after a move, mm.
    pub fn fallen(&self, index: usize) -> [f64; 2] {
        self.at(index).map(|height| self.top - height)
    }
}

/// A frame that the path takes along: it lies on the sheet, and does not come up again.
fn carried(moves: usize, segments: &[Segment], top: f64) -> Vec<[f64; 2]> {
    let mut feeds = segments.iter().filter(|segment| segment.kind != SegmentKind::Rapid).peekable();
    let mut height = top;
    let of_move = |index| {
        let before = height;
        while let Some(segment) = feeds.next_if(|segment| segment.index <= index) {
            height = height.min(segment.lowest());
        }
        [before, height]
    };
    (0..moves).map(of_move).collect()
}

/// Passes that the frame is below, or too far above.
pub(crate) fn faults(
    frame: &Frame,
    program: &Program,
    segments: &[Segment],
    assignment: &Assignment,
    subject: &Subject,
    limits: &Limits,
) -> Vec<Fault> {
    let mut faults = Vec::new();
    if limits.forming.is_some_and(|forming| forming.support == Support::Mandrel) {
        return faults; // no frame is there to be moved
    }
    for order in subject.expected.iter().filter(|order| order.expectation.forms) {
        let Some(passes) = order.expectation.descending() else { continue };
        for segment in level_moves(program, segments, assignment, (order, passes), limits) {
            let ([_, stands], path) = (frame.at(segment.index), segment.end[2]);
            let step = passes.step_at(segment.end);
            if path > stands + LOWER * step {
                faults.push(segment.fault(&faults::FRAME_BELOW).measured(stands, path));
            } else if path < stands - WIDE * step - ROUGH {
                faults.push(segment.fault(&faults::FRAME_ABOVE).measured(stands, path));
            }
        }
    }
    faults.sort_by_key(|fault| fault.index);
    faults
}
