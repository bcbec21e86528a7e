//! Checks that need no distances: rapids' heights, feeds, tools, known places.

use styluscam_motion::{EventKind, Move, MoveKind, Program};

use crate::findings::{Fault, Finding};
use crate::legs::{in_this_world, Leg, LegKind};
use crate::{FindingKind, Limits, Severity, Subject, SLACK};

/// Faults of the moves' text, in the order of the moves.
pub(crate) fn faults(program: &Program, legs: &[Leg], subject: &Subject, limits: &Limits) -> Vec<Fault> {
    let mut faults = Vec::new();
    for (index, step) in program.moves.iter().enumerate() {
        faults.extend(text_faults(index, step, subject));
    }
    faults.extend(legs.iter().filter_map(|leg| height_fault(leg, limits)));
    faults.extend(legs.iter().filter(|leg| leg.tool.is_none()).map(unknown_tool));
    faults.extend(missing_tool_change(program));
    faults
}

/// The finding of a program that never feeds.
pub(crate) fn no_feed_moves(program: &Program) -> Option<Finding> {
    let none = program.moves.iter().all(|m| m.kind == MoveKind::Rapid);
    none.then(|| Finding {
        kind: FindingKind::NoFeedMoves,
        severity: Severity::Error,
        line: 0,
        first_line: 0,
        last_line: 0,
        moves: 0,
        position: None,
        value_mm: None,
        limit: None,
        message: "the program has no feed move; post an operation that has a path".to_owned(),
    })
}

/// The finding of a program in another work offset than the part's.
pub(crate) fn work_offset(program: &Program, wcs: &str) -> Option<Finding> {
    let found = &program.setup.wcs;
    let line = program.moves.first().map_or(0, |m| m.line);
    (found != wcs).then(|| Finding {
        kind: FindingKind::WorkOffset,
        severity: Severity::Error,
        line,
        first_line: line,
        last_line: line,
        moves: program.moves.len(),
        position: None,
        value_mm: None,
        limit: None,
        message: format!("line {line}: the moves are in {found}, the part stands in {wcs}; write {wcs} before them"),
    })
}

fn text_faults(index: usize, step: &Move, subject: &Subject) -> impl Iterator<Item = Fault> {
    let feeds = step.kind != MoveKind::Rapid;
    let absurd = !in_this_world(step.end);
    let fault = |kind| fault_of(kind, index, step);
    [
        (feeds && !(step.feed > 0.0 && step.feed.is_finite())).then(|| fault(FindingKind::MissingFeed)),
        (feeds && index <= subject.first_placed_move).then(|| fault(FindingKind::UnplacedFeed)),
        (absurd && index >= subject.first_placed_move).then(|| fault(FindingKind::NotFinite)),
    ]
    .into_iter()
    .flatten()
}

fn fault_of(kind: FindingKind, index: usize, step: &Move) -> Fault {
    Fault { kind, severity: Severity::Error, index, line: step.line, position: step.end, measure: None, weight: 0.0 }
}

/// A rapid that goes sideways below the clearance height.
fn height_fault(leg: &Leg, limits: &Limits) -> Option<Fault> {
    let start = leg.start?;
    let lowest = start[2].min(leg.end[2]);
    if leg.kind != LegKind::Rapid || !leg.travels() || lowest >= limits.clearance - SLACK {
        return None;
    }
    Some(Fault {
        kind: if leg.descends() { FindingKind::DogLegRapid } else { FindingKind::LowRapid },
        severity: Severity::Error,
        index: leg.index,
        line: leg.line,
        position: if start[2] < leg.end[2] { start } else { leg.end },
        measure: Some((lowest, limits.clearance)),
        weight: limits.clearance - lowest,
    })
}

fn unknown_tool(leg: &Leg) -> Fault {
    Fault {
        kind: FindingKind::UnknownTool,
        severity: Severity::Error,
        index: leg.index,
        line: leg.line,
        position: leg.end,
        measure: None,
        weight: 0.0,
    }
}

/// A feed move before any tool change: harmless only where there is but one tool.
fn missing_tool_change(program: &Program) -> Option<Fault> {
    let index = program.moves.iter().position(|m| m.kind != MoveKind::Rapid)?;
    let changed = |kind: &EventKind| matches!(kind, EventKind::ToolChange { .. });
    if program.events.iter().any(|e| e.before <= index && changed(&e.kind)) {
        return None;
    }
    let severity = if program.tools.len() > 1 { Severity::Error } else { Severity::Warning };
    let step = program.moves.get(index)?;
    Some(Fault { severity, ..fault_of(FindingKind::MissingToolChange, index, step) })
}
