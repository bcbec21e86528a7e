//! Between which heights the tool touches upright walls: in plan only their top shows.

use styluscam_geometry::Vector;
use styluscam_motion::{Cancelled, Watch};

use crate::Surface;

/// Positions looked at along one triangle at most.
const PLACES: usize = 64;
/// The tool stands this far off the wall, mm: where it touched the wall itself, it would meet the wall's top.
const OFF: f64 = 1e-6;
/// Or, far from the origin, so many times what rounding makes of a position.
const ROUNDINGS: f64 = 4.0;
/// What other triangles of the same wall may lie before or behind the one asked, mm.
const UNEVEN: f64 = 0.01;

/// Where the tool stands beside a wall.
struct Stand {
    /// Its position in plan where it touches the wall.
    position: Vector,
    /// Out of the wall, level.
    outward: Vector,
    /// It is asked so far off the wall, mm.
    off: f64,
}

impl Stand {
    /// The position so far off the wall, mm.
    fn at(&self, off: f64) -> [f64; 2] {
        let position = self.position + self.outward * off;
        [position.x, position.y]
    }
}

/// A point of a wall beside which the tool may stand.
struct Beside {
    stand: Stand,
    /// Lowest and highest tip with which its side touches the wall there, mm.
    tips: [f64; 2],
    /// Length of the wall in plan that the point stands for, mm.
    length: f64,
}

/// A point of a wall that the tool touches.
pub(super) struct Touched {
    stand: Stand,
    /// Lowest and highest tip with which a triangle of the wall is touched there, mm.
    pub tips: (f64, f64),
    /// Length of the wall in plan that the point stands for, mm.
    pub length: f64,
    /// Whether what lies before the wall keeps the tool from going lower, and not the triangle's lower end.
    pub is_stopped: bool,
}

impl Touched {
    /// The same up to the top of the whole wall there, mm.
    pub fn to_top(&self, surface: &Surface<'_>) -> (f64, f64) {
        let within = [self.stand.off, UNEVEN].map(|off| self.stand.at(-off));
        let tops = within.iter().filter_map(|[x, y]| surface.at(*x, *y, &mut None)).map(|point| point.tip.z);
        (self.tips.0, tops.fold(self.tips.1, f64::max))
    }

    /// Whether the wall is touched there with the tip at a height.
    pub fn is_touched_at(&self, surface: &Surface<'_>, z: f64) -> bool {
        let is_over = |off: f64| {
            let [x, y] = self.stand.at(off);
            surface.envelope().is_over(x, y, z, &mut None)
        };
        is_over(-UNEVEN) && !is_over(UNEVEN)
    }
}

/// Lowest and highest tip with which the tool touches selected upright walls, mm; none where it touches none.
///
/// # Errors
/// `Cancelled` when `watch` is cancelled.
pub(super) fn range(surface: &Surface<'_>, spacing: f64, watch: &Watch) -> Result<Option<(f64, f64)>, Cancelled> {
    let mesh = surface.envelope().mesh();
    let walls: Vec<usize> = surface.triangles().filter(|triangle| mesh.is_upright(*triangle)).collect();
    let touched = touched(surface, &walls, spacing, ("walls", watch))?.into_iter().map(|touched| touched.tips);
    Ok(touched.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))))
}

/// Where the tool touches upright triangles.
///
/// Beside each of them, positions `spacing` mm apart are asked how low the tool comes there; `phase` names this work to
/// the watch.
///
/// # Errors
/// `Cancelled` when `watch` is cancelled.
pub(super) fn touched(
    surface: &Surface<'_>,
    triangles: &[usize],
    spacing: f64,
    (phase, watch): (&'static str, &Watch),
) -> Result<Vec<Touched>, Cancelled> {
    let beside: Vec<Beside> = triangles.iter().flat_map(|triangle| positions(surface, *triangle, spacing)).collect();
    let asked: Vec<[f64; 2]> = beside.iter().map(|beside| beside.stand.at(beside.stand.off)).collect();
    watch.begin(phase, asked.len());
    let contacts = surface.envelope().contacts(&asked, watch)?;
    let touched = beside.into_iter().zip(&contacts).filter_map(|(beside, contact)| {
        let [lowest, highest] = beside.tips;
        let floor = contact.as_ref().map_or(f64::NEG_INFINITY, |contact| contact.tip);
        let Beside { stand, length, .. } = beside;
        let tips = (lowest.max(floor), highest);
        (tips.0 <= highest).then_some(Touched { stand, tips, length, is_stopped: floor >= lowest })
    });
    Ok(touched.collect())
}

/// Positions beside an upright triangle, at the middles of equal shares of its length in plan.
fn positions(surface: &Surface<'_>, triangle: usize, spacing: f64) -> Vec<Beside> {
    let (envelope, mesh) = (surface.envelope(), surface.envelope().mesh());
    let normal = mesh.normal(triangle);
    let outward = Vector::new(normal.x, normal.y, 0.0).normalize();
    let along = Vector::new(-outward.y, outward.x, 0.0);
    let corners = mesh.corners(triangle).map(|corner| [corner.dot(&along), corner.z]);
    let [first, last] = [f64::min, f64::max].map(|of| corners.iter().map(|c| c[0]).reduce(of).unwrap_or(0.0));
    let touching = envelope.touching_point(Vector::zeros(), outward);
    let off = OFF.max(ROUNDINGS * envelope.rounding());
    let count = (((last - first) / spacing).ceil() as usize).clamp(1, PLACES);
    let beside = (0..count).filter_map(|i| {
        let at = first + (last - first) * (i as f64 + 0.5) / count as f64;
        let [foot, top] = heights(&corners, at)?;
        let wall = mesh.corners(triangle)[0] + along * (at - corners[0][0]);
        let stand = Stand { position: wall - touching, outward, off };
        Some(Beside { stand, tips: [foot - touching.z, top - touching.z], length: (last - first) / count as f64 })
    });
    beside.collect()
}

/// Lower and upper height of a triangle (along, height) at a position along it.
fn heights(corners: &[[f64; 2]; 3], at: f64) -> Option<[f64; 2]> {
    let crossings = (0..3).filter_map(|i| {
        let ([a, za], [b, zb]) = (corners[i], corners[(i + 1) % 3]);
        ((a < at) != (b < at)).then(|| za + (zb - za) * (at - a) / (b - a))
    });
    let (low, high) = crossings.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| (low.min(z), high.max(z)));
    (low <= high).then_some([low, high])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_is_cut_between_its_corners() {
        let corners = [[0.0, 0.0], [4.0, 0.0], [0.0, 8.0]];
        assert_eq!(heights(&corners, 1.0), Some([0.0, 6.0]));
        assert_eq!(heights(&corners, 5.0), None);
    }
}
