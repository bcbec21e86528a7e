//! Faults of holes that are drilled.

use super::FaultKind;
use crate::findings::FindingKind;

pub(crate) static MISSING_HOLE: FaultKind = FaultKind::on_part(
    FindingKind::MissingHole,
    |fault| match (fault.value(), fault.limit()) {
        (depth, bottom) if depth.is_infinite() => {
            format!("no feed goes down this hole of the operation, which ends at Z{bottom:.3}")
        }
        (depth, bottom) => format!("this hole is drilled down to Z{depth:.3}, and it ends at Z{bottom:.3}"),
    },
    "post the whole operation: a hole, or the end of one, is missing",
);
pub(crate) static NO_CORE_HOLE: FaultKind = FaultKind::on_part(
    FindingKind::MissingHole,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!(
            "a tap or boring tool of {value:.3} mm goes down to Z{limit:.3}, and nothing has drilled this hole before"
        )
    },
    "drill it in an operation before, or state a stock that comes with the hole",
);
pub(crate) static NO_HOLE_HERE: FaultKind = FaultKind::on_part(
    FindingKind::ExtraHole,
    |fault| {
        format!("a feed of a drill goes to where the operation has no hole, {:.3} mm from the nearest", fault.value())
    },
    "correct X and Y, or post the operation again",
);
pub(crate) static TOO_DEEP: FaultKind = FaultKind::on_part(
    FindingKind::ExtraHole,
    |fault| format!("the drill goes down to Z{:.3}, and its hole ends at Z{:.3}", fault.value(), fault.limit()),
    "correct Z, or post the operation again",
);
pub(crate) static DEEP_PECK: FaultKind = FaultKind::on_part(
    FindingKind::Peck,
    |fault| format!("the drill goes {:.3} mm deep at once, and a peck is {:.3} mm", fault.value(), fault.limit()),
    "post the operation again: a peck is missing",
);
pub(crate) static PECK_NOT_CLEARED: FaultKind = FaultKind::on_part(
    FindingKind::Peck,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("the drill came up to Z{value:.3} only before this peck, and its hole begins at Z{limit:.3}")
    },
    "post the operation again: after each peck the drill comes out of the hole",
);
pub(crate) static RAPID_OUT_OF_HOLE: FaultKind = FaultKind::in_text(
    FindingKind::RapidIntoMaterial,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!(
            "a rapid comes up from Z{value:.3} in a hole that begins at Z{limit:.3}, and this tool comes up at a feed"
        )
    },
    "come up at the operation's feed",
);
pub(crate) static RAPID_IN_HOLE: FaultKind = FaultKind::in_text(
    FindingKind::RapidPlunge,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("a rapid goes down to Z{value:.3}, and the hole is open down to Z{limit:.3} so far")
    },
    "come down at a feed from there",
);
pub(crate) static CUT_DIRECTION: FaultKind = FaultKind::in_text(
    FindingKind::CutDirection,
    |fault| {
        let [found, asked] = if fault.limit() > 0.5 { ["conventional", "climb"] } else { ["climb", "conventional"] };
        format!("this move is {found} milling, and the operation asks for {asked} milling")
    },
    "swap G2 and G3, turn the spindle the other way, or post the operation again",
);
pub(crate) static WALL_SKIPPED: FaultKind = FaultKind::on_part(
    FindingKind::Excess,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("on {value:.3} mm of height no turn comes up to the hole's wall, and a turn falls by {limit:.3} mm")
    },
    "correct this coordinate, or post the operation again",
);
pub(crate) static CORE_LEFT: FaultKind = FaultKind::on_part(
    FindingKind::Uncleared,
    |fault| format!("{:.3} mm of stock are left between the tool's circles in this hole", fault.value()),
    "post the operation again: a helix is missing, or lies too far from the next",
);
