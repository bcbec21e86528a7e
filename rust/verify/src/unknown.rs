//! Moves whose position is not known: at the start, after a tool change, and in the machine's own coordinates.

use styluscam_motion::{MachineMove, Program};

use crate::faults::{self, Fault};
use crate::segments::{last_before, Segment, SegmentKind};
use crate::subject::{run_of, Limits, Subject, TextFacts};
use crate::tolerances::SLACK;

/// The share of the Z axis' length, from the machine's zero down, in which a machine position counts as its top.
const TOP: f64 = 0.1;
/// It is no more than this, mm.
const NEAR_TOP: f64 = 10.0;

/// Moves across before the tool is known to be up, and down before it is known where.
pub(crate) fn faults(program: &Program, segments: &[Segment], subject: &Subject, limits: &Limits) -> Vec<Fault> {
    let first = segments.iter().filter(|segment| segment.start.is_none() && segment.kind == SegmentKind::Rapid);
    let low = first.filter(|segment| segment.end[2] < limits.clearance - SLACK);
    let begins = subject.unknown_positions.first().filter(|run| run.start == 0).map_or(0, |run| run.end);
    let fault = |index: usize, height: f64| {
        let kind = if index <= begins { &faults::UNSAFE_START } else { &faults::UNKNOWN_POSITION };
        Fault::of(kind, index, &program.moves[index]).measured(height, limits.clearance)
    };
    let mut faults: Vec<Fault> = low.map(|segment| fault(segment.index, segment.end[2])).collect();
    let Some(text) = subject.text else { return faults };
    for index in subject.unknown_positions.iter().flat_map(Clone::clone) {
        let height = program.moves.get(index).map_or(f64::NAN, |step| step.end.tip[2]);
        let known = run_of(&text.unknown_heights, index).is_none();
        if known && height < limits.clearance - SLACK {
            faults.push(fault(index, height));
        } else if !known && !at_the_top(text, index, limits) {
            faults.push(fault(index, f64::NAN));
        }
    }
    faults.extend(text.machine_moves.iter().filter_map(|step| machine_fault(program, step, segments, subject, limits)));
    faults.sort_by_key(|fault| fault.index);
    faults
}

/// Machine coordinates do not give a position in work coordinates: the tool goes up to the machine's top, and only there across.
fn machine_fault(
    program: &Program,
    step: &MachineMove,
    segments: &[Segment],
    subject: &Subject,
    limits: &Limits,
) -> Option<Fault> {
    let text = subject.text?;
    let across = step.coordinates[..2].iter().any(Option::is_some);
    let down = step.coordinates[2].is_some() && !goes_up(step, limits);
    let low = || {
        let unknown = step.before == 0 || run_of(&text.unknown_heights, step.before.saturating_sub(1)).is_some();
        let raised = unknown && at_the_top(text, step.before, limits);
        !raised && (unknown || standing_low(segments, step.before, subject, limits).is_some())
    };
    if !(down || across && low()) {
        return None;
    }
    let nowhere = [f64::NAN; 3];
    let position = last_before(segments, step.before).map_or(nowhere, |segment| segment.end);
    let index = step.before.min(program.moves.len().saturating_sub(1));
    let fault = Fault::new(&faults::MACHINE_POSITION, index, step.line, position);
    Some(fault.measured(step.coordinates[2].unwrap_or(f64::NAN), f64::NAN))
}

/// Whether a move in machine coordinates ends at the machine's top: at its zero, over it, or a little under it where the
/// axis' length is known. The range of Z is one of the work's coordinates and does not state where that zero is.
fn goes_up(step: &MachineMove, limits: &Limits) -> bool {
    let range = limits.reach.axes[2].map(|[low, high]| high - low);
    let length = range.or(limits.reach.travel.map(|travel| travel[2]));
    step.coordinates[2].is_some_and(|z| z >= -(TOP * length.unwrap_or(0.0)).min(NEAR_TOP) - SLACK)
}

/// Whether the tool, whose height in the work is not known after a move, was sent to the machine's top before.
fn at_the_top(text: &TextFacts, index: usize, limits: &Limits) -> bool {
    let since = run_of(&text.unknown_heights, index).map_or(index, |run| run.start);
    let last = text
        .machine_moves
        .iter()
        .rev()
        .find(|step| step.coordinates[2].is_some() && (since..=index).contains(&step.before));
    last.is_some_and(|step| goes_up(step, limits))
}

/// The move that left the tool below the clearance height where it stands before a move, unless it went to the
/// machine's top since.
pub(crate) fn standing_low<'a>(
    segments: &'a [Segment],
    before: usize,
    subject: &Subject,
    limits: &Limits,
) -> Option<&'a Segment> {
    let segment = last_before(segments, before).filter(|segment| segment.end[2] < limits.clearance - SLACK)?;
    let since = subject.text.iter().flat_map(|text| &text.machine_moves);
    let raised =
        since.filter(|step| step.before > segment.index && step.before <= before).any(|step| goes_up(step, limits));
    (!raised).then_some(segment)
}
