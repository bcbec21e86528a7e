//! What the tips of eight triangles do not exceed, computed side by side.

use wide::f32x8;

use super::super::contact::Seen;
use super::super::index::{Lines, WIDTH};

/// What rounding to single precision makes of a sum, as a share of its largest term.
const ROUNDING: f32 = 2e-6;

type Row = [f32; WIDTH];

/// Triangles, each seen from a position.
#[derive(Default)]
pub struct Eight {
    corners: [[Row; 3]; 3],
    contact: [Row; 2],
    plane: Row,
    gradient: [Row; 2],
    bend: Row,
}

impl Eight {
    /// Puts a triangle into a lane.
    #[inline]
    pub fn put(&mut self, lane: usize, seen: &Seen) {
        for (rows, corner) in self.corners.iter_mut().zip(&seen.corners) {
            for (row, coordinate) in rows.iter_mut().zip(corner) {
                row[lane] = *coordinate as f32;
            }
        }
        for i in 0..2 {
            self.contact[i][lane] = seen.contact[i] as f32;
            self.gradient[i][lane] = seen.gradient[i] as f32;
        }
        self.plane[lane] = seen.plane as f32;
        self.bend[lane] = seen.bend as f32;
    }

    /// Heights that the tips on the triangles do not exceed; infinite for walls.
    ///
    /// The tip on a triangle is max of z(q) - Z(|q|) over its points q. With any plane below Z instead of Z the
    /// maximum, now at a corner, is no lower. It is the higher by the less, the nearer to the contact the plane touches Z:
    /// here, at the point of the border nearest to the contact with the triangle's whole plane, as Z bends. That
    /// contact's own height is a bound as well.
    #[inline]
    pub fn most(&self, lines: &Lines) -> f32x8 {
        let corners = self.corners.map(|rows| rows.map(f32x8::new));
        let [wx, wy] = self.nearest(&corners);
        let distance = (wx * wx + wy * wy).sqrt();
        let (height, rise) = lines.at(distance);
        let fall = rise / distance.fast_max(f32x8::splat(1e-12));
        let (fx, fy) = (fall * wx, fall * wy);
        let (mut most, mut size) = (f32x8::splat(f32::NEG_INFINITY), height.abs() + rise * distance);
        for [x, y, z] in corners {
            let (along_x, along_y) = (fx * x, fy * y);
            most = most.fast_max(z - along_x - along_y);
            size = size.fast_max(z.abs() + along_x.abs() + along_y.abs());
        }
        let tangent = most - height + rise * distance + size * f32x8::splat(ROUNDING);
        let plane = f32x8::new(self.plane);
        // never where the nearest point is not known
        tangent.simd_lt(plane).bitselect(tangent, plane)
    }

    /// The points of the borders nearest to the contacts, in the metric of the profile's second derivatives there.
    #[inline]
    fn nearest(&self, corners: &[[f32x8; 3]; 3]) -> [f32x8; 2] {
        let [[cx, cy], [gx, gy]] = [self.contact, self.gradient].map(|rows| rows.map(f32x8::new));
        let bend = f32x8::new(self.bend);
        let [[ax, ay, _], [bx, by, _], [tx, ty, _]] = *corners;
        let turn = (bx - ax) * (ty - ay) - (by - ay) * (tx - ax);
        let (mut nearest, mut least) = ([f32x8::ZERO; 2], f32x8::splat(f32::INFINITY));
        for i in 0..3 {
            let ([px, py, _], [qx, qy, _]) = (corners[i], corners[(i + 1) % 3]);
            let ([ex, ey], [vx, vy]) = ([qx - px, qy - py], [cx - px, cy - py]);
            let square = ex * ex + ey * ey;
            let area = ex * vy - ey * vx;
            // beyond the side that is farthest
            let gap = (area * area.abs() / square).flip_signs(turn);
            let is_farther = gap.simd_lt(least);
            least = is_farther.bitselect(gap, least);
            let along = ex * gx + ey * gy;
            let weighed = bend * along;
            let share = (ex * vx + ey * vy + weighed * (vx * gx + vy * gy)) / (square + weighed * along);
            let share = share.fast_max(f32x8::ZERO).fast_min(f32x8::ONE);
            nearest =
                [is_farther.bitselect(px + share * ex, nearest[0]), is_farther.bitselect(py + share * ey, nearest[1])];
        }
        nearest
    }
}
