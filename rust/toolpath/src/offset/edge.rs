//! The highest tip that an edge allows: one concave maximisation, solved in the slope.
//!
//! The contact of drop-cutter with an edge (Yau, Chuang, Lee 2004, see [`super::envelope`]), here for any convex profile.
//! Derivation: docs/concepts/envelope.md.

use styluscam_geometry::{Cutter, Straight, Vector};

/// Steps of a climb at most: two or three do.
const CLIMB: usize = 8;
/// A climb ends where a step gains no more than this share of the position's radius and height: near a sharp tip a step sees
/// no farther than the radius.
const FLAT: f64 = 1e-17;

/// Halvings of an interval of slopes that leave nothing of it.
const STEPS: usize = 120;
/// The tip's height is stationary in the slope, rad: this leaves 1e-16 of the tool's size.
const NEAR: f64 = 1e-9;

/// Where a tool touches an edge: tip height, and the contact as a share of the edge from 0 to 1.
pub struct EdgeContact {
    /// Tip height, mm.
    pub tip: f64,
    /// Contact, as a share of the edge.
    pub share: f64,
}

/// The contact inside the edge from `a` to `b` for the axis at (x, y), if it can be above `best`; `guess` is a position in
/// plan near it.
///
/// Along the edge the tip's height is z0 + m s - Z(sqrt(q^2 + s^2)), q the line's distance in plan,
/// s the position along it, m its steepness: concave in s. At its top tan(slope) s / r = m, which is
/// solved as sin(slope) sqrt(r^2 - q^2) = m r cos(slope), increasing in the slope and finite at a
/// vertical tangent. Tops beyond the ends belong to the vertices.
pub fn touch(
    cutter: &Cutter,
    [a, b]: [Vector; 2],
    [x, y]: [f64; 2],
    guess: [f64; 2],
    best: f64,
) -> Option<EdgeContact> {
    let line = Line::of(a, b, x, y)?;
    if line.q > cutter.max_radius() {
        return None;
    }
    if let Some(ball) = cutter.as_ball() {
        return line.touch_ball(ball);
    }
    if line.steep == 0.0 {
        return line.touch_level(cutter, best);
    }
    let near =
        (line.along[0] * (guess[0] - x) + line.along[1] * (guess[1] - y)).clamp(line.first, line.first + line.run);
    if line.bound(cutter, near) < best {
        return None;
    }
    match line.climbed(cutter, near, best) {
        Climb::Top(along, height) => line.contact(along, height),
        Climb::Beyond => None,
        Climb::Lost => line.touch_by_profile(cutter, best),
    }
}

/// Slope of the contact inside the edge, rad.
pub fn slope(cutter: &Cutter, a: Vector, b: Vector, x: f64, y: f64) -> f64 {
    Line::of(a, b, x, y).map_or(0.0, |line| line.top(cutter, line.near_top(cutter)).slope)
}

/// What became of a climb by polynomials.
enum Climb {
    /// The top: position along the line and the profile's height there.
    Top(f64, f64),
    /// The top is not inside the edge.
    Beyond,
    /// It left the polynomials.
    Lost,
}

/// The position of the cutter that touches an edge's line.
struct Top {
    slope: f64,
    radius: f64,
    height: f64,
}

/// An edge seen from the axis: positions s along its line count from the foot of the axis on it.
struct Line {
    /// Distance of the line from the axis in plan.
    q: f64,
    /// Position of the edge's first end.
    first: f64,
    /// Length in plan.
    run: f64,
    /// Its direction in plan.
    along: [f64; 2],
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
        Some(Self { q: (ux * ay - uy * ax).abs(), first, run, along: [ux, uy], steep, foot: a.z - steep * first })
    }

    /// The contact, if it lies inside the edge.
    #[inline]
    fn contact(&self, along: f64, height: f64) -> Option<EdgeContact> {
        let from_first = along - self.first;
        let inside = (0.0..=self.run).contains(&from_first);
        inside.then(|| EdgeContact { tip: self.foot + self.steep * along - height, share: from_first / self.run })
    }

    /// The position along the line at which a radius of the cutter lies over it, on the rising side.
    fn place_of(&self, radius: f64) -> f64 {
        (radius * radius - self.q * self.q).max(0.0).sqrt().copysign(self.steep)
    }

    /// A ball over a line is a circle.
    #[inline]
    fn touch_ball(&self, ball: f64) -> Option<EdgeContact> {
        let circle = (ball * ball - self.q * self.q).max(0.0);
        let along = self.steep * (circle / (1.0 + self.steep * self.steep)).sqrt();
        let below = (circle - along * along).max(0.0).sqrt();
        self.contact(along, (self.q * self.q + along * along) / (ball + below))
    }

    /// A level edge is touched where it is nearest to the axis.
    #[inline]
    fn touch_level(&self, cutter: &Cutter, best: f64) -> Option<EdgeContact> {
        if self.foot - cutter.height_bound(self.q) < best {
            return None;
        }
        self.contact(0.0, cutter.quick_height_at_radius(self.q))
    }

    /// The contact where polynomials do not serve.
    #[cold]
    fn touch_by_profile(&self, cutter: &Cutter, best: f64) -> Option<EdgeContact> {
        let near = self.near_top(cutter);
        if self.bound(cutter, near) < best {
            return None;
        }
        let top = self.top(cutter, near);
        self.contact(self.place_of(top.radius), top.height)
    }

    /// Newton's steps from `near` to the top of the edge, on the profile's polynomials; given up when even the tangent
    /// of the concave height stays below `best`.
    fn climbed(&self, cutter: &Cutter, near: f64, best: f64) -> Climb {
        let mut along = near;
        for _ in 0..CLIMB {
            let radius = (self.q * self.q + along * along).sqrt();
            let Some(height) = cutter.height_with_derivatives(radius).filter(|_| radius > 0.0) else {
                return Climb::Lost;
            };
            let (sin, cos) = (self.q / radius, along / radius);
            let slope = self.steep - height.rise * cos;
            let bend = height.bend * cos * cos + height.rise / radius * sin * sin;
            let step = slope / bend;
            if !step.is_finite() {
                return Climb::Lost;
            }
            if (slope * step).abs() <= FLAT * (radius + height.value.abs()) {
                // what the step would still gain, a quarter of this, is below rounding
                return Climb::Top(along, height.value);
            }
            let end = if slope > 0.0 { self.first + self.run } else { self.first };
            let tip = self.foot + self.steep * along - height.value;
            let gain = slope * (end - along);
            if gain <= 0.0 || tip + gain < best {
                return Climb::Beyond;
            }
            let next = if slope > 0.0 { (along + step).min(end) } else { (along + step).max(end) };
            along = next;
        }
        Climb::Lost
    }

    /// The top of the whole line.
    fn top(&self, cutter: &Cutter, near: f64) -> Top {
        let guess = libm::atan(cutter.supporting_line(libm::hypot(near, self.q)).rise);
        top(cutter, self.q, self.steep.abs(), guess)
    }

    /// A position of the edge near the top, by table.
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

/// The position at which sin sqrt(r^2 - q^2) = steep r cos.
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

/// The position if it lies on a straight part: there the slope is one and the radius runs.
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
///
/// With s = steep r / tan(slope) put into r^2 = q^2 + s^2: where r^2 (1 - (steep / tan)^2) = q^2. The left side
/// increases and has no infinite derivative at a vertical tangent.
fn top_slope(cutter: &Cutter, q: f64, steep: f64, guess: f64) -> (f64, f64) {
    let excess = |slope: f64| {
        let (sin, cos) = libm::sincos(slope);
        let r = cutter.point_at(slope).0;
        let (square, cot) = (r * r, steep * cos / sin);
        let growth = 2.0 * r * cutter.curvature_radius_at(slope) * cos * (1.0 - cot * cot);
        let rate = growth + 2.0 * square * steep * cot / (sin * sin);
        (square * (1.0 - cot * cot) - q * q, rate, r)
    };
    let (mut low, mut high) = (libm::atan(steep), std::f64::consts::FRAC_PI_2);
    let mut slope = guess.clamp(low, high);
    let mut steps = [f64::INFINITY; 2];
    for _ in 0..STEPS {
        let (value, rate, _) = excess(slope);
        if value > 0.0 {
            high = slope;
        } else {
            low = slope;
        }
        let next = slope - value / rate;
        let is_inside = next > low && next < high;
        // a step this small is the end only where the other side of the top is as near
        if is_inside && (next - slope).abs() <= NEAR {
            let beyond = next + 2.0 * NEAR * (next - slope).signum();
            if (excess(beyond).0 > 0.0) != (value > 0.0) {
                slope = next;
                break;
            }
        }
        if high - low <= f64::EPSILON {
            break;
        }
        // where the curvature jumps, Newton's steps may go to and fro over the jump for ever
        let is_shorter = 2.0 * (next - slope).abs() < steps[0];
        let next = if is_inside && is_shorter { next } else { 0.5 * (low + high) };
        steps = [steps[1], (next - slope).abs()];
        slope = next;
    }
    (slope, cutter.point_at(slope).0.max(q))
}
