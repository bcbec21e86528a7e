//! What the machine can do, held against the text: axes, feeds, spindle speeds.

use styluscam_motion::{EventKind, MoveKind, Program};

use crate::findings::{Fault, Finding};
use crate::legs::in_this_world;
use crate::{FindingKind, Severity, Subject, SLACK};

/// What the machine can do; what is left out is not judged.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reach {
    /// Lowest and highest place of each axis, of the point that the text moves, mm.
    pub axes: [Option<[f64; 2]>; 3],
    /// Length of each axis, mm.
    pub travel: Option<[f64; 3]>,
    /// Largest feed, mm/min.
    pub feed: Option<f64>,
    /// Smallest and largest speed of the spindle, rev/min.
    pub rpm: Option<[f64; 2]>,
}

/// Faults of single moves, in their order.
pub(crate) fn faults(program: &Program, subject: &Subject, reach: &Reach) -> Vec<Fault> {
    let mut faults = Vec::new();
    let most = reach.feed.unwrap_or(f64::INFINITY);
    let mut heights = Heights::new(program);
    for (index, (start, step)) in program.segments().enumerate() {
        let height = heights.before(index);
        let fault = |kind, value: f64, limit: f64| Fault {
            kind,
            severity: Severity::Error,
            index,
            line: step.line,
            position: step.end,
            measure: Some((value, limit)),
            weight: (value - limit).abs(),
        };
        if step.kind == MoveKind::Feed && step.feed > most * (1.0 + SLACK) {
            faults.push(fault(FindingKind::FeedLimit, step.feed, most));
        }
        if index < subject.first_placed_move || !in_this_world(step.end) {
            continue;
        }
        let (low, high) = step.bounds(start.filter(|_| index > subject.first_placed_move));
        for (axis, range) in reach.axes.iter().enumerate() {
            let Some([least, most]) = *range else { continue };
            let lift = if axis == 2 { height } else { 0.0 };
            if low[axis] + lift < least - SLACK {
                faults.push(fault(FindingKind::AXIS_LIMITS[axis], low[axis] + lift, least));
            } else if high[axis] + lift > most + SLACK {
                faults.push(fault(FindingKind::AXIS_LIMITS[axis], high[axis] + lift, most));
            }
        }
    }
    faults
}

/// The findings of the whole program: travel, spindle speeds.
pub(crate) fn findings(program: &Program, subject: &Subject, reach: &Reach) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (axis, name) in ['X', 'Y', 'Z'].into_iter().enumerate() {
        let Some(travel) = reach.travel.map(|travel| travel[axis]) else { continue };
        let needed = extent(program, subject, axis);
        if needed > travel + SLACK {
            let message = format!(
                "{name} needs {needed:.3} mm of travel and the machine has {travel:.3}; turn the part, or split the program"
            );
            findings.push(Finding::of_all(FindingKind::Travel, Severity::Error, message));
        }
    }
    let Some([least, most]) = reach.rpm else { return findings };
    let speeds = program.events.iter().filter_map(|event| match event.kind {
        EventKind::SpindleOn { rpm, .. } => Some((event.before, rpm)),
        _ => None,
    });
    for (before, rpm) in speeds.filter(|(_, rpm)| *rpm > most || *rpm < least) {
        let line = program.moves.get(before).map_or(0, |step| step.line);
        let message = format!(
            "before line {line}: the spindle is to turn at {rpm} rev/min, and the machine's turns at {least} to {most}; correct S"
        );
        findings.push(Finding {
            line,
            first_line: line,
            last_line: line,
            ..Finding::of_all(FindingKind::SpindleLimit, Severity::Error, message)
        });
    }
    findings
}

fn extent(program: &Program, subject: &Subject, axis: usize) -> f64 {
    let mut heights = Heights::new(program);
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for (index, (start, step)) in program.segments().enumerate() {
        let lift = if axis == 2 { heights.before(index) } else { 0.0 };
        if index < subject.first_placed_move || !in_this_world(step.end) {
            continue;
        }
        let (low, high) = step.bounds(start.filter(|_| index > subject.first_placed_move));
        (least, most) = (least.min(low[axis] + lift), most.max(high[axis] + lift));
    }
    most - least
}

/// Height of the posted point above the tip, as tools change.
struct Heights<'a> {
    program: &'a Program,
    events: std::iter::Peekable<std::slice::Iter<'a, styluscam_motion::Event>>,
    height: f64,
}

impl<'a> Heights<'a> {
    fn new(program: &'a Program) -> Self {
        // a job's only tool need not be called
        let height = program.tools.first().map_or(0.0, |tool| tool.reference_height);
        Self { program, events: program.events.iter().peekable(), height }
    }

    fn before(&mut self, index: usize) -> f64 {
        while let Some(event) = self.events.next_if(|e| e.before <= index) {
            if let EventKind::ToolChange { tool } = event.kind {
                self.height = self.program.tools.get(tool as usize).map_or(0.0, |tool| tool.reference_height);
            }
        }
        self.height
    }
}
