//! How much of a part can be seen from each of six directions.

use styluscam_geometry::Vector;

use super::{Body, Sample};
use crate::UpAxis;

/// The directions, +Z first.
pub const SIDES: [UpAxis; 6] =
    [UpAxis::PlusZ, UpAxis::MinusZ, UpAxis::PlusX, UpAxis::MinusX, UpAxis::PlusY, UpAxis::MinusY];
/// Sine of the angle by which a face may look away and still count as a wall.
const AWAY: f64 = 0.01;
/// Cosine from which a face at the bottom is the one that the part stands on.
const FLAT: f64 = 0.999;
/// Rays start this far off the surface, as a share of the part's size.
const OFF: f64 = 1e-5;
/// And farther, mm and as a share of the size: triangles of a curved upright wall bulge by their deviation over those under them.
const BULGE: [f64; 2] = [0.06, 2e-3];

/// What a direction shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// The direction.
    pub up: UpAxis,
    /// Share of the area that a tool from there does not reach, the face that the part then stands on left out.
    pub hidden: f64,
    /// Share of the area that looks up, walls left out.
    pub up_share: f64,
}

pub fn of(body: &Body<'_>) -> [Side; 6] {
    SIDES.map(|up| side(body, up))
}

fn side(body: &Body<'_>, axis: UpAxis) -> Side {
    let up = axis.vector();
    let (low, high) = body.bounds();
    let foot = up.zip_map(&low.zip_zip_map(&high, &up, |l, h, u| if u < 0.0 { h } else { l }), |u, x| u * x).sum();
    let stands = |place: &Sample| place.normal.dot(&up) < -FLAT && place.point.dot(&up) - foot < 1e-3 * body.size();
    let (mut all, mut hidden, mut looks_up) = (0.0, 0.0, 0.0);
    for place in body.places.iter().filter(|place| !stands(place)) {
        all += 1.0;
        hidden += f64::from(!is_seen(body, place, up));
        looks_up += f64::from(place.normal.dot(&up) > AWAY);
    }
    let all = f64::max(all, 1.0);
    Side { up: axis, hidden: hidden / all, up_share: looks_up / all }
}

/// Whether nothing stands between a place and a tool that comes from `up`.
pub fn is_seen(body: &Body<'_>, place: &Sample, up: Vector) -> bool {
    if place.normal.dot(&up) < -AWAY {
        return false;
    }
    let off = OFF * body.size() + f64::min(BULGE[0], BULGE[1] * body.size());
    let start = place.point + off * place.normal;
    body.rays.first(start, up, 0.0, |_| true).is_none()
}
