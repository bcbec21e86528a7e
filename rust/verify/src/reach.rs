//! What the machine can do, compared with the text: axes, feeds, spindle speeds.

use styluscam_motion::EventKind;

use crate::faults::{self, Fault};
use crate::findings::{Finding, FindingKind, Severity};
use crate::segments::is_in_range;
use crate::subject::{run_of, Axes, Reach};
use crate::tolerances::SLACK;

/// Faults of single moves, in their order.
pub(crate) fn faults(axes: &Axes, reach: &Reach) -> Vec<Fault> {
    let most = reach.feed.unwrap_or(f64::INFINITY);
    let program = axes.program;
    let too_fast = program.moves.iter().enumerate().filter(|(_, step)| step.feed > most * (1.0 + SLACK));
    let mut faults: Vec<Fault> =
        too_fast.map(|(index, step)| Fault::of(&faults::FEED_LIMIT, index, step).measured(step.feed, most)).collect();
    for (index, low, high) in boxes(axes) {
        let fault = |axis: usize| Fault::of(&faults::AXES[axis], index, &program.moves[index]);
        for (axis, range) in reach.axes.iter().enumerate() {
            let Some([least, most]) = *range else { continue };
            if low[axis] < least - SLACK {
                faults.push(fault(axis).measured(low[axis], least));
            } else if high[axis] > most + SLACK {
                faults.push(fault(axis).measured(high[axis], most));
            }
        }
    }
    faults
}

/// The findings of the whole program: travel, spindle speeds.
pub(crate) fn findings(axes: &Axes, reach: &Reach) -> Vec<Finding> {
    let mut findings = Vec::new();
    let program = axes.program;
    let travel = reach.travel.iter().flat_map(|travel| extent(axes).into_iter().zip(*travel));
    for ((needed, travel), name) in travel.zip(['X', 'Y', 'Z']) {
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
            "before line {line}: the spindle is set to {rpm} rev/min, and the machine's turns at {least} to {most}; correct S"
        );
        findings.push(Finding::of_all(FindingKind::SpindleLimit, Severity::Error, message).at_line(line));
    }
    findings
}

/// The boxes of the moves whose position is known.
fn boxes<'a>(axes: &'a Axes) -> impl Iterator<Item = (usize, [f64; 3], [f64; 3])> + 'a {
    let is_known = |index: usize| run_of(axes.unknown_positions, index).is_none();
    let placed = axes.program.posted_boxes().enumerate().filter(move |(index, _)| is_known(*index));
    placed
        .filter(|(_, (low, high))| is_in_range(*low) && is_in_range(*high))
        .map(|(index, (low, high))| (index, low, high))
}

/// Length of each axis that the program needs, mm.
fn extent(axes: &Axes) -> [f64; 3] {
    let (mut least, mut most) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for (_, low, high) in boxes(axes) {
        for axis in 0..3 {
            (least[axis], most[axis]) = (least[axis].min(low[axis]), most[axis].max(high[axis]));
        }
    }
    [0, 1, 2].map(|axis| most[axis] - least[axis])
}
