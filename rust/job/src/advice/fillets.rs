//! Hollow faces as rounded corners: followed from some points of each, as far as the face turns to both sides of them.

use std::collections::BTreeMap;

use styluscam_geometry::Vector;

use super::{corner::Corner, creases::CREASE_DEG, patch::Patch};
use styluscam_geometry::wall_axes;

/// Points of each hollow face from which its fillet is followed to both ends.
const POINTS: usize = 12;
/// Curvature (1/mm) from which a point is hollow.
const HOLLOW: f64 = 1e-6;
/// Of the fillet's radius times the sine of half a turn: what lies farther off (2 on a circle) is another fillet.
const REACH: f64 = 2.6;
/// Sine of the angle by which a normal may deviate from the section in which a fillet is followed.
const ASIDE: f64 = 0.05;

/// A hollow patch: where its fillet is followed from.
struct Start {
    /// Radius across the fillet, mm.
    radius: f64,
    /// The most hollow direction.
    across: Vector,
    /// Normal of the surface.
    middle: Vector,
    /// mm.
    point: Vector,
}

/// The fillets of all hollow faces.
pub fn fillets(patches: &[Patch]) -> Vec<Corner> {
    let mut hollow: BTreeMap<u32, Vec<&Patch>> = BTreeMap::new();
    for patch in patches.iter().filter(|patch| patch.bend.most_hollow().0 < -HOLLOW) {
        hollow.entry(patch.face).or_default().push(patch);
    }
    hollow.values().flat_map(|own| of_face(own)).collect()
}

fn of_face(own: &[&Patch]) -> Vec<Corner> {
    let picked: Vec<Start> = own.iter().step_by(own.len().div_ceil(POINTS)).map(|patch| start(patch)).collect();
    let area = own.iter().map(|patch| patch.area).sum::<f64>() / picked.len() as f64;
    picked.iter().filter_map(|start| followed(start, own, area)).collect()
}

fn start(patch: &Patch) -> Start {
    let (bend, [cos, sin]) = patch.bend.most_hollow();
    let [up, level] = wall_axes(patch.middle);
    Start {
        radius: -1.0 / bend,
        across: cos * up + sin * level,
        middle: patch.middle,
        point: patch.corners.iter().sum::<Vector>() / 3.0,
    }
}

/// The corner that the face makes in the section through `start`; `area` (mm^2) is the share of the face that counts for it.
fn followed(start: &Start, own: &[&Patch], area: f64) -> Option<Corner> {
    let aside = start.middle.cross(&start.across);
    let mut ends: [Option<(f64, Vector)>; 2] = [None; 2];
    for (point, normal) in own.iter().flat_map(|patch| patch.corners.into_iter().zip(patch.normals)) {
        let turn = libm::atan2(normal.dot(&start.across), normal.dot(&start.middle));
        let offset = point - start.point;
        let along = libm::hypot(offset.dot(&start.across), offset.dot(&start.middle));
        let reach = REACH * start.radius * libm::sin(0.5 * turn).abs() + 1e-3 * start.radius;
        if normal.dot(&aside).abs() >= ASIDE || along >= reach {
            continue;
        }
        if ends[0].is_none_or(|(least, _)| turn < least) {
            ends[0] = Some((turn, normal));
        }
        if ends[1].is_none_or(|(most, _)| turn > most) {
            ends[1] = Some((turn, normal));
        }
    }
    let [(least, low), (most, high)] = [ends[0]?, ends[1]?];
    let angle = most - least;
    (angle.to_degrees() > CREASE_DEG).then(|| Corner {
        sides: [low, high],
        radius: start.radius,
        length: area / (start.radius * angle),
    })
}
