//! The highest tip that an edge allows: one concave maximisation, solved in the slope.

use styluscam_geometry::{Cutter, Straight, Vector};

/// Where a tool touches an edge: tip height, and the contact as a share of the edge from 0 to 1.
pub struct EdgeContact {
    /// Tip height, mm.
    pub tip: f64,
    /// Contact, as a share of the edge.
    pub share: f64,
    /// Slope of the contact on the tool, rad.
    pub slope: f64,
}

/// The contact inside the edge from `a` to `b` for the axis at (x, y), if it can be above `best`.
///
/// Along the edge the tip's height is z0 + m s - Z(sqrt(q^2 + s^2)), q the line's distance in plan,
/// s the place along it, m its steepness: concave in s. At its top tan(slope) s / r = m, which is
/// solved as sin(slope) sqrt(r^2 - q^2) = m r cos(slope), increasing in the slope and finite at a
/// vertical tangent. Tops beyond the ends belong to the vertices.
pub fn touch(cutter: &Cutter, a: Vector, b: Vector, x: f64, y: f64, best: f64) -> Option<EdgeContact> {
    let line = Line::of(a, b, x, y)?;
    if line.q > cutter.max_radius() {
        return None;
    }
    let near = line.near_top(cutter);
    if line.bound(cutter, near) < best {
        return None;
    }
    let guess = libm::atan(cutter.supporting_line(near.hypot(line.q)).rise);
    let top = top(cutter, line.q, line.steep.abs(), guess);
    let along = (top.radius * top.radius - line.q * line.q).max(0.0).sqrt().copysign(line.steep) - line.first;
    if !(0.0..=line.run).contains(&along) {
        return None;
    }
    let share = along / line.run;
    Some(EdgeContact { tip: a.z + line.steep * along - top.height, share, slope: top.slope })
}

/// The place of the cutter that touches an edge's line.
struct Top {
    slope: f64,
    radius: f64,
    height: f64,
}

/// An edge seen from the axis: places s along its line count from the foot of the axis on it.
struct Line {
    /// Distance of the line from the axis in plan.
    q: f64,
    /// Place of the edge's first end.
    first: f64,
    /// Length in plan.
    run: f64,
    /// Rise along the line, dz/ds.
    steep: f64,
    /// Height of the line at s = 0.
    foot: f64,
}

impl Line {
    fn of(a: Vector, b: Vector, x: f64, y: f64) -> Option<Self> {
        let (ex, ey) = (b.x - a.x, b.y - a.y);
        let run = (ex * ex + ey * ey).sqrt();
        if run <= 1e-12 * (b.z - a.z).abs() || run == 0.0 {
            return None; // vertical: its upper vertex stands for it
        }
        let (ux, uy) = (ex / run, ey / run);
        let (ax, ay) = (a.x - x, a.y - y);
        let (first, steep) = (ux * ax + uy * ay, (b.z - a.z) / run);
        Some(Self { q: (ux * ay - uy * ax).abs(), first, run, steep, foot: a.z - steep * first })
    }

    /// A place of the edge near the top, by table.
    fn near_top(&self, cutter: &Cutter) -> f64 {
        let steep = self.steep.abs();
        let straight = cutter.radius_of_rise(steep);
        let aside = if straight > 0.0 { self.q / straight } else { 0.0 };
        let r = cutter.radius_of_rise(steep * (1.0 + aside * aside).sqrt());
        let s = (r * r - self.q * self.q).max(0.0).sqrt().copysign(self.steep);
        s.clamp(self.first, self.first + self.run)
    }

    /// A height that no tip on this edge exceeds: the tangent at `near` of the concave height, the profile replaced by a
    /// line below it.
    fn bound(&self, cutter: &Cutter, near: f64) -> f64 {
        let d = (near * near + self.q * self.q).sqrt();
        let line = cutter.supporting_line(d);
        let slope = self.steep - if d > 0.0 { line.rise * near / d } else { 0.0 };
        let rest = if slope > 0.0 { self.first + self.run - near } else { self.first - near };
        self.foot + self.steep * near - (line.height + line.rise * (d - line.radius)) + slope * rest
    }
}

/// The place at which sin sqrt(r^2 - q^2) = steep r cos.
fn top(cutter: &Cutter, q: f64, steep: f64, guess: f64) -> Top {
    if steep == 0.0 {
        return Top { slope: cutter.slope_at_radius(q), radius: q, height: cutter.height_at_radius(q) };
    }
    if let Some(top) = cutter.straights().iter().find_map(|straight| top_on(straight, q, steep)) {
        return top;
    }
    let (slope, radius) = top_slope(cutter, q, steep, guess);
    Top { slope, radius, height: cutter.point_at(slope).1 }
}

/// The place if it lies on a straight part: there the slope is one and the radius runs.
fn top_on(straight: &Straight, q: f64, steep: f64) -> Option<Top> {
    let (sin, cos) = libm::sincos(straight.slope);
    let excess = |r: f64| sin * (r * r - q * q).max(0.0).sqrt() - steep * r * cos;
    if excess(straight.inner.0) > 0.0 || excess(straight.outer.0) < 0.0 {
        return None;
    }
    // r^2 (1 - (steep / tan)^2) = q^2; where nothing is left of it every radius will do
    let rest = 1.0 - (steep * cos / sin) * (steep * cos / sin);
    let radius = if rest > 0.0 { q / rest.sqrt() } else { straight.outer.0 };
    let radius = radius.clamp(straight.inner.0.max(q), straight.outer.0.max(q));
    Some(Top { slope: straight.slope, radius, height: straight.height_at(radius) })
}

/// The slope of [`top`] on a curve or a kink, and the radius there.
fn top_slope(cutter: &Cutter, q: f64, steep: f64, guess: f64) -> (f64, f64) {
    let (mut low, mut high) = (0.0, std::f64::consts::FRAC_PI_2);
    let mut slope = guess.clamp(1e-3, high - 1e-3);
    let mut r = 0.0;
    for _ in 0..80 {
        let (sin, cos) = libm::sincos(slope);
        r = cutter.point_at(slope).0;
        let s = (r * r - q * q).max(0.0).sqrt();
        let excess = sin * s - steep * r * cos;
        if excess > 0.0 {
            high = slope;
        } else {
            low = slope;
        }
        let growth = cutter.curvature_radius_at(slope) * cos;
        let rate = cos * s + sin * r * growth / s + steep * (r * sin - growth * cos);
        let next = slope - excess / rate;
        let next = if next > low && next < high { next } else { 0.5 * (low + high) };
        let step = (next - slope).abs();
        slope = next;
        // the tip's height is stationary here: 1e-8 rad leaves 1e-16 of the tool's size
        if step <= 1e-9 {
            r = cutter.point_at(slope).0;
            break;
        }
    }
    (slope, r.max(q))
}
