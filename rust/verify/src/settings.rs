//! Feeds, spindle, coolant and tool of the moves, compared with what the job states for their operations.

use styluscam_motion::{EventKind, Program, SpindleDirection};

use crate::assignment::Assignment;
use crate::expectation::ExpectedOperation;
use crate::findings::{Fault, FindingKind};
use crate::legs::{Leg, LegKind};
use crate::subject::Limits;

/// Feeds that differ by less than this share are the same: what arithmetic may cost, as units change.
const SAME_FEED: f64 = 1e-6;

/// Faults of the moves, in their operation.
pub(crate) fn faults(program: &Program, legs: &[Leg], assignment: &Assignment, limits: &Limits) -> Vec<Fault> {
    let mut upcoming = program.upcoming();
    let mut machine = Machine { spindle: None, flood: false, mist: false };
    let mut faults = Vec::new();
    let mut last: Option<LegKind> = None;
    for leg in legs {
        upcoming.before(leg.index).for_each(|event| machine.take(event));
        let before = last.replace(leg.kind);
        if leg.kind == LegKind::Rapid {
            continue;
        }
        let comes_down = before.is_none_or(|kind| kind == LegKind::Rapid);
        let step = &program.moves[leg.index];
        let Some(operation) = assignment.of(leg.operation) else { continue };
        faults.extend(feed_fault(operation, leg, comes_down, step.feed, limits.feed_unit));
        faults.extend(spindle_fault(operation, leg, machine.spindle));
        if machine.flood != operation.flood || machine.mist {
            faults.push(leg.fault(FindingKind::CoolantDiffers));
        }
        if leg.tool.is_some_and(|tool| tool != operation.tool) {
            faults.push(leg.fault(FindingKind::ToolDiffers));
        }
    }
    faults
}

/// From a rapid the tool comes down at the plunge's feed; on its way along the part straight down is as good as any
/// other direction.
fn feed_fault(operation: &ExpectedOperation, leg: &Leg, comes_down: bool, feed: f64, unit: f64) -> Option<Fault> {
    let expected = match leg.kind {
        LegKind::Plunge if comes_down => operation.plunge,
        // a feed that goes nowhere or up is no faster than any other
        LegKind::Still | LegKind::Retract => feed.min(operation.cut.max(operation.plunge)),
        _ => operation.cut,
    };
    let same = (feed - expected).abs() <= unit + SAME_FEED * expected;
    (feed > 0.0 && !same).then(|| leg.fault(FindingKind::FeedDiffers).measured(feed, expected))
}

fn spindle_fault(operation: &ExpectedOperation, leg: &Leg, turns: Option<(f64, SpindleDirection)>) -> Option<Fault> {
    let (found, expected) = (signed(turns), signed(operation.spindle));
    let same = (found - expected).abs() <= 0.5 + SAME_FEED * expected.abs();
    (!same).then(|| leg.fault(FindingKind::SpindleDiffers).measured(found, expected))
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
            _ => {}
        }
    }
}
