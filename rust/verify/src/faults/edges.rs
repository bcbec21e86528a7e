//! Faults of edges that are chamfered, and of passes along edges.

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
pub(crate) static CONTOUR_LEFT: FaultKind = FaultKind::on_part(
    FindingKind::Excess,
    |fault| {
        let (value, limit) = (fault.value(), fault.limit());
        format!("the pass along this edge is {value:.4} mm too far from it (limit {limit:.4} mm)")
    },
    "correct the coordinate, or post the operation again",
);
pub(crate) static CONTOUR_MISSING: FaultKind = FaultKind::on_part(
    FindingKind::MissingPass,
    |fault| format!("no pass goes along this edge at Z{:.3}, and the tool has room there", fault.value()),
    "post the whole operation",
);
pub(crate) static CONTOUR_LEVEL: FaultKind = FaultKind::on_part(
    FindingKind::MissingLevel,
    |fault| format!("nothing goes along these edges at Z{:.3}, where a level is expected", fault.value()),
    "post the whole operation, or correct step, z_top and z_bottom",
);
pub(crate) static CONTOUR_CROSSED: FaultKind = FaultKind::on_part(
    FindingKind::Gouge,
    |fault| format!("the tool comes {:.4} mm over the edge that it goes along", fault.value()),
    "correct the coordinate, or post the operation again",
);
