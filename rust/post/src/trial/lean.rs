//! Whether a program whose tool leans comes back.

use styluscam_motion::{EventKind, Move, MoveKind, Program};

use crate::machine::Machine;
use crate::reader::Reading;
use crate::rotary::{between, difference, dot, norm};
use crate::trial::slack::feed_slack;
use crate::trial::words;
use crate::writer::Posted;

/// How far the tip of a read move may be beside its line over and above what the writer and the reader allow, mm.
const BESIDE: f64 = 2e-4;
/// How far a feed that follows from a length may come back from the planned one, as a share: the path is bent.
const BENT: f64 = 2e-3;

/// Whether the tool leans anywhere.
pub(super) fn leans(program: &Program) -> bool {
    program.moves.iter().any(|step| !step.end.axis.is_up())
}

/// The first move that does not come back: its line, and what is wrong.
pub(super) fn move_difference(
    program: &Program,
    posted: &Posted,
    reading: &Reading,
    machine: &Machine,
) -> Option<(u32, String)> {
    let rules = machine.rotary.as_ref()?;
    let mut upcoming = program.upcoming();
    let mut read = reading.program.segments().peekable();
    for (index, ((start, step), line)) in program.segments().zip(&posted.line_of_move).enumerate() {
        let is_fresh = upcoming.before(index).any(|event| matches!(event, EventKind::ToolChange { .. })) || index == 0;
        let slack = slack(machine, step.end.tip);
        let (mut arrived, mut length) = (None, 0.0);
        while let Some((from, found)) = read.next_if(|(_, found)| found.line <= *line) {
            let start = start.filter(|_| !is_fresh);
            let away = start.map_or(0.0, |start| beside(found.end.tip, start, step.end.tip));
            if away > slack + rules.tip_tolerance + BESIDE || found.kind != step.kind {
                return Some((found.line, format!("{} was read and not posted", to(found))));
            }
            if arrived.is_none_or(|last: &Move| last.line != found.line) {
                length = 0.0;
            }
            length += from.map_or(0.0, |from| norm(difference(found.end.tip, from)));
            arrived = Some(found);
        }
        let Some(found) = arrived else { continue };
        let turned = norm(difference(found.end.axis.vector(), step.end.axis.vector()));
        if norm(difference(found.end.tip, step.end.tip)) > slack || turned > 4.0 * unit(machine) {
            return Some((*line, format!("{} was posted and {} was read", to(step), to(found))));
        }
        let near = feed_slack(machine, step.feed, length.max(machine.resolution_mm()), 0.0) + BENT * step.feed;
        if step.kind == MoveKind::Feed && (step.feed - found.feed).abs() > near {
            return Some((*line, format!("a feed of {} mm/min was posted and {} was read", step.feed, found.feed)));
        }
    }
    read.next().map(|(_, found)| (found.line, format!("{} was read and not posted", to(found))))
}

fn to(step: &Move) -> String {
    let [x, y, z] = step.end.axis.vector();
    format!("a {} to {}, axis {x:.5} {y:.5} {z:.5},", words::motion(step.kind), words::position(step.end.tip))
}

/// One unit of the last decimal of an angle, rad.
fn unit(machine: &Machine) -> f64 {
    machine.angle_format().per_one().recip().to_radians()
}

/// How far rounding moves a tip, mm.
fn slack(machine: &Machine, tip: [f64; 3]) -> f64 {
    let arms = machine
        .rotary
        .iter()
        .flat_map(|rules| rules.axes)
        .map(|axis| norm(difference(tip, axis.pivot)) + norm(axis.pivot));
    machine.resolution_mm() + unit(machine) * arms.sum::<f64>() + 1e-9
}

/// How far a point is from a straight line between two others, mm.
fn beside(point: [f64; 3], from: [f64; 3], to: [f64; 3]) -> f64 {
    let (along, there) = (difference(to, from), difference(point, from));
    let share = dot(along, there) / dot(along, along).max(f64::MIN_POSITIVE);
    norm(difference(point, between(from, to, share.clamp(0.0, 1.0))))
}
