//! Eight boxes side by side, each with a plane over what it holds, and the bound that they give for a tool's tip.

use styluscam_geometry::Cutter;
use wide::f32x8;

use super::lines::Lines;
use super::WIDTH;

/// Eight boxes, relative to the index's centre, mm. A lane without content is low enough for any search to pass over it.
#[derive(Clone, Copy, Debug)]
pub struct Lanes {
    pub low: [f32x8; 2],
    pub high: [f32x8; 2],
    /// Gradient dz/dx, dz/dy of the planes.
    pub gradient: [f32x8; 2],
    /// Height of the planes over the middle of the boxes: no point in a box is above its plane.
    pub lift: f32x8,
}

/// Where a cutter would touch the planes of eight boxes.
#[derive(Clone, Copy, Debug)]
pub struct Matched {
    /// Contact from the axis in plan, as a multiple of the gradient, mm.
    pub share: f32x8,
    /// Tip over the plane at the axis, mm: no position of the cutter over the plane is higher.
    pub peak: f32x8,
}

/// The place for which bounds are asked, relative to the index's centre, mm.
#[derive(Clone, Copy, Debug)]
pub struct Probe {
    pub x: f32,
    pub y: f32,
    /// Heights are counted from here, so that rounding is that of differences.
    pub z: f32,
    /// Square of the distance beyond which the cutter touches nothing, mm^2.
    pub reach: f32,
}

/// Tip heights that no triangle of eight boxes exceeds: `value` over the probe, and by how much more beside it.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    pub value: f32x8,
    pub along: [f32x8; 2],
}

/// Height of a lane without content.
const EMPTY: f32 = -1e30;

impl Lanes {
    /// Eight lanes without content.
    pub const NOTHING: Self = Self {
        low: [f32x8::ZERO; 2],
        high: [f32x8::ZERO; 2],
        gradient: [f32x8::ZERO; 2],
        lift: f32x8::new([EMPTY; 8]),
    };

    /// Where a cutter touches the planes.
    pub fn matched(&self, cutter: &Cutter) -> Matched {
        let [gx, gy] = self.gradient.map(f32x8::to_array);
        let (mut share, mut peak) = ([0.0; WIDTH], [0.0; WIDTH]);
        for lane in 0..WIDTH {
            let rise = libm::hypot(f64::from(gx[lane]), f64::from(gy[lane]));
            let (radius, height) = cutter.point_at(libm::atan(rise));
            share[lane] = if rise > 0.0 { (radius / rise) as f32 } else { 0.0 };
            peak[lane] = (rise * radius - height) as f32;
        }
        Matched { share: f32x8::new(share), peak: f32x8::new(peak) }
    }

    /// The bounds over a probe.
    ///
    /// For a point p of a box under the plane of gradient g, tip <= plane(p) - Z(|p - axis|). The best p of the plane
    /// is where the profile has slope g; clamped into the box (q), the function, concave in p, lies
    /// below its tangent at q. Z is replaced by a line below it, which only raises the bound. The whole plane gives
    /// a second bound; it is the better one where the profile has a kink.
    #[inline]
    pub fn bounds(&self, matched: &Matched, probe: &Probe, lines: &Lines) -> Bounds {
        let [gx, gy] = self.gradient;
        let (x, y) = (f32x8::splat(probe.x), f32x8::splat(probe.y));
        let (low_x, high_x) = (self.low[0] - x, self.high[0] - x);
        let (low_y, high_y) = (self.low[1] - y, self.high[1] - y);
        let qx = (matched.share * gx).fast_max(low_x).fast_min(high_x);
        let qy = (matched.share * gy).fast_max(low_y).fast_min(high_y);
        let distance = (qx * qx + qy * qy).sqrt();
        let (height, rise) = lines.at(distance);
        let fall = rise / distance.fast_max(f32x8::splat(1e-12));
        let (fx, fy) = (fall * qx, fall * qy);
        let (tx, ty) = (gx - fx, gy - fy);
        let rest = (tx * (high_x - qx)).fast_max(tx * (low_x - qx)) + (ty * (high_y - qy)).fast_max(ty * (low_y - qy));
        let half = f32x8::HALF;
        let plane = self.lift - f32x8::splat(probe.z) - gx * (half * (low_x + high_x)) - gy * (half * (low_y + high_y));
        let in_box = plane + gx * qx + gy * qy - height + rest;
        let free = plane + matched.peak;
        let freely = free.simd_lt(in_box);
        let zero = f32x8::ZERO;
        let near_x = low_x.fast_max(-high_x).fast_max(zero);
        let near_y = low_y.fast_max(-high_y).fast_max(zero);
        let is_far = (near_x * near_x + near_y * near_y).simd_gt(f32x8::splat(probe.reach));
        Bounds {
            value: is_far.bitselect(f32x8::splat(EMPTY), freely.bitselect(free, in_box)),
            along: [freely.bitselect(gx, fx), freely.bitselect(gy, fy)],
        }
    }
}
