//! Moves in the planes of layers: they press sheet that hangs free, and owe the part no contact. As passes over the part count
//! those alone that touch it: else a row that stays in its plane would stand for the one below it.

use styluscam_geometry::Vector;

use crate::body::Body;
use crate::clearance::Prober;
use crate::expectation::Layers;
use crate::segments::Segment;
use crate::subject::{Limits, Subject};
use crate::tolerances::SLACK;

/// The pieces of some moves of an operation that are not in a plane of its layers, or touch the part there.
pub(crate) fn touching(
    segments: &[&Segment],
    layers: &Layers,
    (body, subject, limits): (&Body, &Subject, &Limits),
) -> Vec<Segment> {
    let prober = Prober { body, mesh: subject.mesh, bvh: subject.bvh };
    let touches = |piece: &Segment| {
        let excess = limits.excess_of(piece.operation).unwrap_or(0.0) + SLACK;
        let places = [0.0, 0.5, 1.0].map(|share| piece.at(share));
        let is_at_part = |tip: [f64; 3]| {
            let position: Vector = body.position(tip);
            prober.at(position, None).is_some_and(|touch| touch.value + subject.deviation_outward <= excess)
        };
        places.iter().any(|tip| layers.off_plane(tip[2]) > excess) || places.into_iter().any(is_at_part)
    };
    segments.iter().flat_map(|segment| segment.pieces()).filter(touches).collect()
}
