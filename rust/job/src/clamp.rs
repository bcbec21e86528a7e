//! A clamp frame that goes down with the path: where it has to stand, as the program's remarks tell the operator.

use styluscam_motion::{Event, EventKind, Move, MoveKind, Program};
use styluscam_verify::{FrameLevel, OrderedPasses, Support};

use crate::operations::{counted, Fact};
use crate::JobDocument;

/// What a remark with a height begins with, in the letters that a machine without small ones leaves, and its end.
const REMARK: (&str, &str) = ("clamp frame to Z", " mm");
/// Decimals of the height.
const DECIMALS: usize = 3;
/// Heights that differ by less are one, mm: half of the last decimal.
const SAME: f64 = 0.5e-3;

/// Whether the job's clamp frame goes down with the path.
pub(crate) fn goes_down(job: &JobDocument) -> bool {
    match job.process.process.as_kind().support() {
        Support::Rim | Support::Mandrel => false,
        Support::DieAndFrame => true,
    }
}

/// Where the frame goes during an operation whose passes lie one below the other: heights, mm, each with the number of the
/// move, among its `moves`, before which the frame is to be there. It stands at `stands` before, mm.
///
/// The frame follows the tool, never the other way round: it goes to a level once the tool is there, and along a continuous
/// descent at each step.
pub(crate) fn heights(passes: &OrderedPasses, moves: &[Move], stands: f64) -> Vec<FrameLevel> {
    let step = passes.pitch.smallest();
    let mut levels: Vec<FrameLevel> = Vec::new();
    for (index, made) in moves.iter().enumerate().filter(|(_, made)| made.kind != MoveKind::Rapid) {
        let (z, stands) = (made.end.tip[2], levels.last().map_or(stands, |level| level.z));
        let stays = moves.get(index + 1).is_some_and(|next| (next.end.tip[2] - z).abs() < SAME);
        if z <= stands - step || stays && z < stands - SAME {
            levels.push(FrameLevel { before: index + 1, z });
        }
    }
    levels
}

/// The remark on a height, in a program in which the operation begins with move number `first`.
pub(crate) fn remark(level: FrameLevel, first: usize) -> Event {
    let ((begin, end), z) = (REMARK, level.z);
    Event { before: first + level.before, kind: EventKind::Comment { text: format!("{begin}{z:.DECIMALS$}{end}") } }
}

/// What an operation makes of the frame, for its summary; none where it leaves the frame where it is.
pub(crate) fn fact(levels: &[FrameLevel]) -> Option<Fact> {
    let z = levels.last()?.z;
    let steps = counted(levels.len(), "step", "steps");
    let words = format!("the clamp frame goes down with the tool, to Z{z:.DECIMALS$} in {steps}");
    Some(Fact { fact: "clamp_frame_lowest", value: z, unit: "mm", words })
}

/// The heights that a program's remarks state.
pub(crate) fn stated(program: &Program) -> Vec<FrameLevel> {
    let level = |event: &Event| match &event.kind {
        EventKind::Comment { text } => height(text).map(|z| FrameLevel { before: event.before, z }),
        _ => None,
    };
    program.events.iter().filter_map(level).collect()
}

/// The height of a remark that states one, mm.
fn height(remark: &str) -> Option<f64> {
    let (begin, end) = REMARK;
    let head = remark.get(..begin.len())?;
    let tail = remark.get(remark.len().checked_sub(end.len())?..)?;
    let is_ours = head.eq_ignore_ascii_case(begin) && tail.eq_ignore_ascii_case(end);
    remark.get(begin.len()..remark.len() - end.len()).filter(|_| is_ours)?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_height_is_read_as_it_is_written_and_nothing_else_is() {
        assert_eq!(height("clamp frame to Z-3.500 mm"), Some(-3.5));
        assert_eq!(height("CLAMP FRAME TO Z0.125 MM"), Some(0.125));
        for other in ["", "mm", "clamp frame to Z mm", "clamp frame to Z-3.5", "the clamp frame to Z-3.5 mm", "ä mm"] {
            assert_eq!(height(other), None, "{other}");
        }
    }
}
