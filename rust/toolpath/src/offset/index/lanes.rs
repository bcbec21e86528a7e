//! Eight boxes side by side, each with a plane over what it holds, and the bound that they give for a tool's tip.

use styluscam_geometry::Cutter;
use wide::f32x8;

use super::lines::Lines;
use super::width::WIDTH;

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

/// The position for which bounds are asked, relative to the index's centre, mm.
#[derive(Clone, Copy, Debug)]
pub struct Probe {
    pub x: f32,
    pub y: f32,
    /// Heights are counted from here, so that rounding is that of differences.
    pub z: f32,
    /// Square of the distance beyond which the cutter touches nothing, mm^2.
    pub reach: f32,
}

/// A straight line through a probe, or near it.
#[derive(Clone, Copy, Debug)]
pub struct HalfLine {
    /// From its middle to its end, in plan, mm,
    pub half: [f32; 2],
    /// and in height.
    pub rise: f32,
    /// How far its middle may lie beside the probe, mm.
    pub aside: [f32; 2],
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
            let [gx, gy] = [gx[lane], gy[lane]].map(f64::from);
            let rise = (gx * gx + gy * gy).sqrt();
            let (radius, height) = cutter.at_rise(rise);
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
        let [in_box, free] = self.both_bounds(matched, probe, lines);
        let freely = free.value.simd_lt(in_box.value);
        let either = |free: f32x8, in_box: f32x8| freely.bitselect(free, in_box);
        Bounds {
            value: either(free.value, in_box.value),
            along: [0, 1].map(|i| either(free.along[i], in_box.along[i])),
        }
    }

    /// The bounds over a probe, and what the tips do not exceed within `half` mm of it in each direction.
    #[inline]
    pub fn bounds_about(&self, matched: &Matched, probe: &Probe, lines: &Lines, half: [f32; 2]) -> (Bounds, f32x8) {
        let [in_box, free] = self.both_bounds(matched, probe, lines);
        let most = |bounds: &Bounds| {
            let more = |i: usize| bounds.along[i].abs() * f32x8::splat(half[i]);
            bounds.value + more(0) + more(1)
        };
        (in_box, most(&in_box).fast_min(most(&free)))
    }

    /// How far the tips lie over a straight line at most that is as high as the probe near it.
    #[inline]
    pub fn bounds_over(&self, matched: &Matched, probe: &Probe, lines: &Lines, line: &HalfLine) -> f32x8 {
        let [[dx, dy], [ax, ay]] = [line.half, line.aside].map(|vector| vector.map(f32x8::splat));
        let [in_box, free] = self.both_bounds(matched, probe, lines);
        let most = |&Bounds { value, along: [gx, gy] }: &Bounds| {
            value + (gx * dx + gy * dy - f32x8::splat(line.rise)).abs() + gx.abs() * ax + gy.abs() * ay
        };
        most(&in_box).fast_min(most(&free))
    }

    /// The bound by the tangent in the box and that by the whole plane. Always inlined: as a call it costs rows a fifth of
    /// their time.
    #[inline(always)]
    fn both_bounds(&self, matched: &Matched, probe: &Probe, lines: &Lines) -> [Bounds; 2] {
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
        let zero = f32x8::ZERO;
        let near_x = low_x.fast_max(-high_x).fast_max(zero);
        let near_y = low_y.fast_max(-high_y).fast_max(zero);
        let is_far = (near_x * near_x + near_y * near_y).simd_gt(f32x8::splat(probe.reach));
        let unless_far = |value: f32x8| is_far.bitselect(f32x8::splat(EMPTY), value);
        [
            Bounds { value: unless_far(in_box), along: [fx, fy] },
            Bounds { value: unless_far(free), along: self.gradient },
        ]
    }
}
