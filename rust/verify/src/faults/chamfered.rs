//! Faults of edges that are chamfered.

use super::FaultKind;
use crate::findings::FindingKind;

pub(crate) static EDGE_LEFT: FaultKind = FaultKind::on_part(
    FindingKind::Excess,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("{value:.4} mm are left over the chamfer of this edge (limit {limit:.4} mm), and the tool can reach it")
    },
    "correct the coordinate where it begins, or post the operation again: a pass along this edge is missing, or lies too high or too far",
);
pub(crate) static PLUNGE_ONTO_EDGE: FaultKind = FaultKind::on_part(
    FindingKind::SteepEntry,
    |fault| format!("the tool comes straight down {:.3} mm into the edge", fault.value()),
    "come down beside the edge or along it",
);
