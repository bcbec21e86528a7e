//! Corners of the path: where a cutting move goes on in another direction than the one before it.

use styluscam_geometry::Vector;
use styluscam_motion::Program;

use crate::assignment::Assignment;
use crate::faults::{self, Fault};
use crate::segments::{Segment, SegmentKind};
use crate::subject::Limits;

/// What is shorter than so many of the machine's units shows no direction: it is taken together with what follows.
const UNITS: f64 = 20.0;
/// Share of an arc in which its direction is measured at an end.
const END: f64 = 1e-4;

/// A stretch of the path that is long enough to show its direction.
struct Stretch {
    leaving: Vector,
    length: f64,
    end: [f64; 3],
}

/// Cutting moves that begin in another direction than the one in which those before them end, by more than is asked for. The
/// path may have an edge of the part there.
pub(crate) fn faults(program: &Program, segments: &[Segment], assignment: &Assignment, limits: &Limits) -> Vec<Fault> {
    let mut faults = Vec::new();
    let mut before: Option<Stretch> = None;
    // where what is too short for a direction begins
    let mut short: Option<[f64; 3]> = None;
    let mut operation = None;
    for segment in segments {
        let most = assignment.of(segment.operation).and_then(|expected| expected.max_corner);
        let is_cut = segment.kind != SegmentKind::Rapid && program.moves[segment.index].is_along_pass();
        let (Some(most), Some(start), true) = (most, segment.start, is_cut) else {
            (before, short) = (None, None);
            continue;
        };
        if operation.replace(segment.operation) != Some(segment.operation) {
            (before, short) = (None, None);
        }
        let begin = short.unwrap_or(start);
        let chord = Vector::from(segment.end) - Vector::from(begin);
        let length = chord.norm().max(segment.length());
        if length < UNITS * limits.unit {
            short = Some(begin);
            continue;
        }
        let [entering, leaving] = if short.is_some() { [chord; 2] } else { directions(segment, chord) };
        if let Some(Stretch { leaving, length: long, end }) = before {
            let turn = libm::atan2(leaving.cross(&entering).norm(), leaving.dot(&entering));
            let rounding = limits.unit * (1.0 / long + 1.0 / length);
            if turn > most + rounding {
                let fault = Fault { position: end, ..segment.fault(&faults::CORNER) };
                faults.push(fault.measured(turn.to_degrees(), most.to_degrees()).warning());
            }
        }
        (before, short) = (Some(Stretch { leaving, length, end: segment.end }), None);
    }
    faults
}

/// In which directions a segment begins and ends.
fn directions(segment: &Segment, chord: Vector) -> [Vector; 2] {
    if segment.bend.is_none() {
        return [chord; 2];
    }
    let between = |from: f64, to: f64| Vector::from(segment.at(to)) - Vector::from(segment.at(from));
    [between(0.0, END), between(1.0 - END, 1.0)]
}
