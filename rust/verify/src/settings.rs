//! Feeds, spindle, coolant and tool of the moves, compared with what the job states for their operations.

use styluscam_motion::{EventKind, Program, Role, SpindleDirection};

use crate::assignment::Assignment;
use crate::expectation::ExpectedOperation;
use crate::faults::{self, Fault};
use crate::segments::{Segment, SegmentKind};
use crate::subject::Limits;

/// Feeds that differ by less than this share are the same: what arithmetic may cost, as units change.
const SAME_FEED: f64 = 1e-6;

/// Faults of the moves, in their operation.
pub(crate) fn faults(program: &Program, segments: &[Segment], assignment: &Assignment, limits: &Limits) -> Vec<Fault> {
    let mut upcoming = program.upcoming();
    let mut machine = Machine { spindle: None, flood: false, mist: false };
    let mut faults = Vec::new();
    let mut last: Option<SegmentKind> = None;
    for segment in segments {
        upcoming.before(segment.index).for_each(|event| machine.take(event));
        let before = last.replace(segment.kind);
        if segment.kind == SegmentKind::Rapid {
            continue;
        }
        let comes_down = before.is_none_or(|kind| kind == SegmentKind::Rapid);
        let step = &program.moves[segment.index];
        let Some(operation) = assignment.of(segment.operation) else { continue };
        let slack = limits.feed_slack(step.feed, segment.length());
        faults.extend(feed_fault(operation, (segment, step.role), comes_down, step.feed, slack));
        faults.extend(spindle_fault(operation, segment, machine.spindle));
        if machine.flood != operation.flood || machine.mist {
            faults.push(segment.fault(&faults::COOLANT));
        }
        if segment.tool.is_some_and(|tool| tool != operation.tool) {
            faults.push(segment.fault(&faults::TOOL));
        }
    }
    faults
}

/// From a rapid the tool comes down at the plunge's feed; on its path along the part straight down is as good as any
/// other direction. Leads have one of
/// their feeds, where the job states them; else leads, ramps and links are no faster than the faster of both. Where the job has
/// the tool slow down at corners, lower feeds are as good; where feeds depend on what is cut, all up to the highest are, and what is cut is
/// looked at with it (`clearing`): there too whether what has the feed of a link cuts nothing.
fn feed_fault(
    operation: &ExpectedOperation,
    (segment, role): (&Segment, Option<Role>),
    comes_down: bool,
    feed: f64,
    slack: f64,
) -> Option<Fault> {
    let is_along_pass = role.is_none_or(|role| role == Role::Cut);
    let of_links = operation.expectation.clearing().map_or(0.0, |clearing| clearing.link_feed);
    let no_faster = feed.min(operation.highest.unwrap_or(operation.cut).max(operation.plunge).max(of_links));
    let nearer = |[a, b]: [f64; 2]| if (feed - a).abs() <= (feed - b).abs() { a } else { b };
    let lead = operation.leads.filter(|_| role == Some(Role::Lead)).map(nearer);
    let expected = lead.unwrap_or(match segment.kind {
        // out of its thread a tap comes at the pitch that it went in with
        SegmentKind::Retract if taps(operation) => operation.plunge,
        SegmentKind::Plunge if comes_down && is_along_pass => operation.plunge,
        // a feed that goes nowhere or up is no faster than any other
        SegmentKind::Still | SegmentKind::Retract => no_faster,
        SegmentKind::Plunge | SegmentKind::Lateral | SegmentKind::Rapid
            if is_along_pass && operation.highest.is_none() =>
        {
            operation.cut
        }
        SegmentKind::Plunge | SegmentKind::Lateral | SegmentKind::Rapid => no_faster,
    });
    let is_slow = operation.slows_at_corners && !comes_down && feed < expected;
    let same = is_slow || (feed - expected).abs() <= slack + SAME_FEED * expected;
    (feed > 0.0 && !same && !operation.keeps_pace).then(|| segment.fault(&faults::FEED).measured(feed, expected))
}

fn taps(operation: &ExpectedOperation) -> bool {
    operation.expectation.drilling().is_some_and(|drilling| drilling.is_tapping)
}

fn spindle_fault(
    operation: &ExpectedOperation,
    segment: &Segment,
    turns: Option<(f64, SpindleDirection)>,
) -> Option<Fault> {
    // a tap turns back on its way up
    let back = if taps(operation) && segment.kind == SegmentKind::Retract { -1.0 } else { 1.0 };
    let (found, expected) = (signed(turns), back * signed(operation.spindle));
    let same = (found - expected).abs() <= 0.5 + SAME_FEED * expected.abs();
    (!same).then(|| segment.fault(&faults::SPINDLE).measured(found, expected))
}

/// Speed, negative counterclockwise, 0 when it stands.
fn signed(turns: Option<(f64, SpindleDirection)>) -> f64 {
    match turns {
        Some((rpm, SpindleDirection::Clockwise)) => rpm,
        Some((rpm, SpindleDirection::Counterclockwise)) => -rpm,
        None => 0.0,
    }
}

/// The states of the machine that events switch.
struct Machine {
    spindle: Option<(f64, SpindleDirection)>,
    flood: bool,
    mist: bool,
}

impl Machine {
    fn take(&mut self, event: &EventKind) {
        match *event {
            EventKind::SpindleOn { rpm, direction } => self.spindle = Some((rpm, direction)),
            EventKind::SpindleOff => self.spindle = None,
            EventKind::Flood { on } => self.flood = on,
            EventKind::Mist { on } => self.mist = on,
            // none of these turns spindle or coolant
            EventKind::ToolChange { .. }
            | EventKind::Stop { .. }
            | EventKind::WorkOffset { .. }
            | EventKind::Probe { .. }
            | EventKind::Raw { .. }
            | EventKind::Sync { .. }
            | EventKind::Comment { .. }
            | EventKind::Dwell { .. } => {}
        }
    }
}
