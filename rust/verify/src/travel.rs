//! Checks that need no distances: rapids' heights, feeds, tools, known positions.

use styluscam_motion::{EventKind, FeedMode, Move, MoveKind, Program};

use crate::assignment::Assignment;
use crate::expectation::ExpectedOperation;
use crate::faults::{self, Fault};
use crate::findings::{Finding, FindingKind, Severity};
use crate::segments::{is_in_range, Segment, SegmentKind};
use crate::subject::{Limits, Subject, ToolCalls};
use crate::tolerances::SLACK;
use crate::unknown::{self, standing_low};
use crate::{holes, low_links};

/// Faults of the moves' text, in the order of the moves.
pub(crate) fn faults(
    program: &Program,
    segments: &[Segment],
    assignment: &Assignment,
    subject: &Subject,
    limits: &Limits,
) -> Vec<Fault> {
    let mut faults = Vec::new();
    for (index, step) in program.moves.iter().enumerate() {
        let leans = assignment.leans(step.operation);
        faults.extend(text_faults(index, step, subject, leans));
    }
    // those that the job allows are checked with what stands under them
    let high = |segment: &&Segment| low_links::margin(segment, assignment, limits).is_none();
    faults.extend(segments.iter().filter(high).filter_map(|segment| height_fault(segment, limits)));
    faults.extend(
        segments.iter().filter(|segment| segment.tool.is_none()).map(|segment| segment.fault(&faults::UNKNOWN_TOOL)),
    );
    faults.extend(missing_tool_change(program, subject));
    faults.extend(unknown::faults(program, segments, subject, limits));
    faults.extend(unsafe_end(program, segments, subject, limits));
    faults.extend(dwells(program, segments, subject, limits));
    faults.extend(stops(segments, subject, limits));
    faults.extend(segments.iter().filter(high).filter_map(|segment| deep_rapid(segment, subject, limits)));
    faults.extend(planes_not_needed(program, subject));
    faults.extend(no_end(program, subject));
    faults
}

/// Positions at which the program ends, or changes the tool, with the tool down.
fn unsafe_end(program: &Program, segments: &[Segment], subject: &Subject, limits: &Limits) -> Vec<Fault> {
    let changes = program.events.iter().filter(|event| matches!(event.kind, EventKind::ToolChange { .. }));
    let stops = changes.map(|event| event.before).chain([program.moves.len()]);
    let left = stops.filter_map(|before| {
        let segment = standing_low(segments, before, subject, limits).filter(|segment| segment.index + 1 == before)?;
        Some(segment.fault(&faults::UNSAFE_END).measured(segment.end[2], limits.clearance))
    });
    left.collect()
}

/// Waits with the tool down.
fn dwells(program: &Program, segments: &[Segment], subject: &Subject, limits: &Limits) -> Vec<Fault> {
    let waits = program.events.iter().filter_map(|event| match event.kind {
        EventKind::Dwell { seconds } if seconds > 0.0 => Some((event.before, seconds)),
        _ => None,
    });
    let down = waits.filter_map(|(before, seconds)| {
        let segment = standing_low(segments, before, subject, limits)?;
        if holes::may_wait(segment, seconds, subject, limits) {
            return None;
        }
        Some(segment.fault(&faults::DWELL).measured(seconds, 0.0))
    });
    down.collect()
}

/// Stops with the tool down.
fn stops(segments: &[Segment], subject: &Subject, limits: &Limits) -> Vec<Fault> {
    let stops = subject.text.iter().flat_map(|text| &text.stops);
    let down = stops.filter_map(|before| standing_low(segments, *before, subject, limits));
    down.map(|segment| segment.fault(&faults::STOP_BELOW)).collect()
}

/// A rapid down to where only feeds should go.
fn deep_rapid(segment: &Segment, subject: &Subject, limits: &Limits) -> Option<Fault> {
    let deep = segment.kind == SegmentKind::Rapid && segment.descends() && segment.end[2] < limits.retract - SLACK;
    // how deep one may go in a hole follows from how far it is drilled: `holes`; over stock that is cleared, from what stands: `clearing`
    let is_elsewhere = || holes::hole_of(segment, subject, limits).is_some() || clears_stock(segment, subject);
    let deep = deep && !is_elsewhere();
    deep.then(|| segment.fault(&faults::DEEP_RAPID).measured(segment.end[2], limits.retract))
}

/// Whether a straight move belongs to an operation whose stock is followed layer by layer.
fn clears_stock(segment: &Segment, subject: &Subject) -> bool {
    let operation = segment.expected.and_then(|number| subject.expected.get(number));
    let clearing = operation.and_then(|operation| operation.expectation.clearing());
    !segment.travels() && subject.stock.is_some() && clearing.is_some()
}

fn planes_not_needed(program: &Program, subject: &Subject) -> Vec<Fault> {
    let runs = subject.text.iter().flat_map(|text| &text.planes_not_needed);
    let moves = runs.flat_map(Clone::clone).filter_map(|index| Some((index, program.moves.get(index)?)));
    let feeds = moves.filter(|(_, step)| step.kind == MoveKind::Feed);
    feeds.map(|(index, step)| Fault::of(&faults::PLANE_NOT_NEEDED, index, step)).collect()
}

/// A text without its end may be cut off; what it has switched on stays on.
fn no_end(program: &Program, subject: &Subject) -> Option<Fault> {
    let text = subject.text.filter(|text| !text.ended)?;
    let step = program.moves.last()?;
    Some(Fault { line: text.lines, ..Fault::of(&faults::NO_END, program.moves.len() - 1, step) })
}

/// The findings of a program that never feeds, and of operations of which no feed goes across.
pub(crate) fn without_feeds(
    program: &Program,
    segments: &[Segment],
    assignment: &Assignment,
    subject: &Subject,
) -> Vec<Finding> {
    if program.moves.iter().all(|m| m.kind == MoveKind::Rapid) {
        let message = "the program has no feed move; post an operation that has a path".to_owned();
        return vec![Finding::of_all(FindingKind::NoFeedMoves, Severity::Error, message)];
    }
    without_passes(segments, assignment, subject)
}

/// The findings of operations that have moves, and none of them is a pass: nothing else is looked at beside passes alone.
fn without_passes(segments: &[Segment], assignment: &Assignment, subject: &Subject) -> Vec<Finding> {
    let goes_across = |expected: &&ExpectedOperation| expected.expectation.drilling().is_none();
    let finding = |expected: &ExpectedOperation| {
        let mut own = segments.iter().filter(|segment| assignment.is(segment.operation, expected));
        let first = own.next()?;
        let has_pass = first.kind == SegmentKind::Lateral || own.any(|segment| segment.kind == SegmentKind::Lateral);
        let (id, line) = (&expected.id, first.line);
        let message =
            format!("line {line}: operation {id:?} has no pass: no feed of it goes across; post the whole operation");
        (!has_pass).then(|| Finding::of_all(FindingKind::MissingPass, Severity::Error, message).at_line(line))
    };
    subject.expected.iter().filter(goes_across).filter_map(finding).collect()
}

/// The finding of lines that run where the machine's switch for optional blocks decides.
pub(crate) fn optional_lines(subject: &Subject) -> Option<Finding> {
    let lines = &subject.text?.optional_lines;
    let (line, last_line) = (*lines.first()?, *lines.last()?);
    let count = lines.len();
    let message = format!(
        "line {line}: {count} of the text's lines begin with / and run only while block delete is off at the machine; \
         remove them, or their /"
    );
    let finding = Finding::of_all(FindingKind::OptionalLines, Severity::Error, message).at_line(line);
    Some(Finding { last_line, ..finding })
}

/// The finding of modal codes that are not stated: the controller is as the last program, or the operator, left it.
pub(crate) fn modes_not_stated(program: &Program, subject: &Subject) -> Option<Finding> {
    let codes = subject.text.map(|text| text.not_stated.join(" and ")).filter(|codes| !codes.is_empty())?;
    let line = program.moves.first().map_or(0, |step| step.line);
    let message = format!(
        "line {line}: modal code not stated ({codes}): the controller keeps what the last program left; write {codes} before the first move"
    );
    Some(Finding::of_all(FindingKind::UnsaidMode, Severity::Warning, message).at_line(line))
}

/// The finding of a program in another work offset than the part's.
pub(crate) fn work_offset(program: &Program, wcs: &str) -> Option<Finding> {
    let found = &program.setup.wcs;
    let line = program.moves.first().map_or(0, |m| m.line);
    let message = format!("line {line}: the moves are in {found}, the part stands in {wcs}; write {wcs} before them");
    (found != wcs).then(|| Finding {
        moves: program.moves.len(),
        ..Finding::of_all(FindingKind::WorkOffset, Severity::Error, message).at_line(line)
    })
}

fn text_faults(index: usize, step: &Move, subject: &Subject, leans: bool) -> impl Iterator<Item = Fault> {
    let feeds = step.kind != MoveKind::Rapid;
    let absurd = !is_in_range(step.end.tip);
    let placed = subject.is_known(index);
    let from_a_place = index.checked_sub(1).is_some_and(|before| subject.is_known(before));
    let fault = |kind| Fault::of(kind, index, step);
    [
        (feeds && !(step.feed > 0.0 && step.feed.is_finite())).then(|| fault(&faults::MISSING_FEED)),
        (feeds && !(placed && from_a_place)).then(|| fault(&faults::UNPLACED_FEED)),
        (absurd && placed).then(|| fault(&faults::NOT_FINITE)),
        (!step.end.axis.is_up() && !leans && feeds).then(|| fault(&faults::TOOL_AXIS)),
        (feeds && step.feed_mode != FeedMode::PerMinute).then(|| fault(&faults::FEED_MODE)),
    ]
    .into_iter()
    .flatten()
}

/// A rapid that goes sideways below the clearance height.
fn height_fault(segment: &Segment, limits: &Limits) -> Option<Fault> {
    let start = segment.start?;
    let lowest = start[2].min(segment.end[2]);
    if segment.kind != SegmentKind::Rapid || !segment.travels() || lowest >= limits.clearance - SLACK {
        return None;
    }
    let kind = if segment.descends() { &faults::DOG_LEG_RAPID } else { &faults::LOW_RAPID };
    let position = if start[2] < segment.end[2] { start } else { segment.end };
    Some(Fault { position, ..segment.fault(kind) }.measured(lowest, limits.clearance))
}

/// A feed move before any tool change: harmless only where there is but one tool, and the operator loads it.
fn missing_tool_change(program: &Program, subject: &Subject) -> Option<Fault> {
    let index = program.moves.iter().position(|m| m.kind != MoveKind::Rapid)?;
    let changed = |kind: &EventKind| matches!(kind, EventKind::ToolChange { .. });
    if program.events.iter().any(|e| e.before <= index && changed(&e.kind)) {
        return None;
    }
    let calls = subject.text.map(|text| text.tool_calls).unwrap_or_default();
    if calls == ToolCalls::NotStated && program.tools.len() <= 1 {
        return None;
    }
    let alone = calls != ToolCalls::Load && program.tools.len() <= 1;
    let step = program.moves.get(index)?;
    let fault = Fault::of(&faults::MISSING_TOOL_CHANGE, index, step);
    Some(if alone { fault.warning() } else { fault })
}
