//! How much of a part can be seen from each of six directions.

use styluscam_geometry::Vector;

use super::samples::Sample;
use super::Body;
use crate::UpAxis;

/// The directions, +Z first.
pub const SIDES: [UpAxis; 6] =
    [UpAxis::PlusZ, UpAxis::MinusZ, UpAxis::PlusX, UpAxis::MinusX, UpAxis::PlusY, UpAxis::MinusY];
/// Sine of the angle by which a face may be turned away and still count as a wall.
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
    /// Share of the area that faces up, walls left out.
    pub up_share: f64,
}

impl Body<'_> {
    /// What can be seen from each of the six directions of [`SIDES`].
    #[must_use]
    pub fn sides(&self) -> [Side; 6] {
        SIDES.map(|up| side(self, up))
    }

    /// Whether nothing stands between a point of the surface and a tool that comes from `up`.
    pub(super) fn is_seen(&self, sample: &Sample, up: Vector) -> bool {
        if sample.normal.dot(&up) < -AWAY {
            return false;
        }
        let off = OFF * self.size() + f64::min(BULGE[0], BULGE[1] * self.size());
        let start = sample.point + off * sample.normal;
        self.rays.first(start, up, 0.0, |_| true).is_none()
    }
}

fn side(body: &Body<'_>, axis: UpAxis) -> Side {
    let up = axis.vector();
    let (low, high) = body.bounds();
    let foot = up.zip_map(&low.zip_zip_map(&high, &up, |l, h, u| if u < 0.0 { h } else { l }), |u, x| u * x).sum();
    let stands = |sample: &Sample| sample.normal.dot(&up) < -FLAT && sample.point.dot(&up) - foot < 1e-3 * body.size();
    let (mut all, mut hidden, mut faces_up) = (0.0, 0.0, 0.0);
    for sample in body.samples.iter().filter(|sample| !stands(sample)) {
        all += 1.0;
        hidden += f64::from(!body.is_seen(sample, up));
        faces_up += f64::from(sample.normal.dot(&up) > AWAY);
    }
    let all = f64::max(all, 1.0);
    Side { up: axis, hidden: hidden / all, up_share: faces_up / all }
}
