//! Faults of passes along edges.

use super::FaultKind;
use crate::findings::FindingKind;

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
