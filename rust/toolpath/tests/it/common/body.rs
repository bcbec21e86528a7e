//! A tool's body at a position, and the proof that a triangle touches it and does not enter it.
//!
//! The body is what lies behind all its supporting planes; of the engine it takes the bare profile's points by slope and
//! nothing else. Two searches, each of which proves its result, whatever path it took:
//! a plane that has the triangle on one side and the body, but for a depth, on the other, proves that the tool moved by
//! that depth is free; a point of the triangle whose distance from the body is known proves that the tool moved by it touches.

use std::f64::consts::FRAC_PI_2;

use styluscam_geometry::{Profile, Sheet, Tool, Vector};

use super::polygon;

/// Halvings of an interval of slopes that leave nothing of it.
const HALVINGS: usize = 54;
/// A proof to this is not made better, mm.
const ENOUGH: f64 = 1e-12;

/// A tool with all that keeps it off the part.
pub struct Body<'a> {
    profile: &'a Profile,
    /// Radius of the ball that the tool is grown by, mm.
    ball: f64,
    /// What the part is raised by, mm.
    raised: f64,
}

/// How far a triangle and a tool are from just touching, mm: proved upper bounds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fault {
    /// The tool moved by this is free.
    pub depth: f64,
    /// The tool moved by this touches.
    pub gap: f64,
}

impl Fault {
    pub fn worst(self) -> f64 {
        self.depth.max(self.gap)
    }
}

impl<'a> Body<'a> {
    /// The tool with a sheet and a margin (mm) under it.
    pub fn new(tool: &'a Tool, sheet: Option<&Sheet>, margin: f64) -> Self {
        Self {
            profile: tool.profile(),
            ball: margin + sheet.map_or(0.0, Sheet::along_normal),
            raised: sheet.map_or(0.0, Sheet::along_vertical),
        }
    }

    /// Radius within which it touches anything, mm.
    pub fn radius(&self) -> f64 {
        self.profile.base().0 + self.ball
    }

    /// How far the body, its tip at `tip`, is from just touching a triangle.
    pub fn fault(&self, corners: [Vector; 3], tip: Vector) -> Fault {
        let corners = corners.map(|p| p - tip + Vector::new(0.0, 0.0, self.raised));
        Fault { depth: self.depth(corners).max(0.0), gap: self.gap(corners).max(0.0) }
    }

    /// Distance in plan from the tool's disc to a triangle, mm; negative where it is under it.
    pub fn aside(&self, corners: [Vector; 3], [x, y]: [f64; 2]) -> f64 {
        let [a, b, c] = corners.map(|p| [p.x - x, p.y - y]);
        let nearest = polygon::least(&TRIANGLE, 0.0, |[s, t]| {
            let p: [f64; 2] = std::array::from_fn(|i| a[i] + s * (b[i] - a[i]) + t * (c[i] - a[i]));
            let distance = p[0].hypot(p[1]);
            let along = |q: [f64; 2]| {
                if distance > 0.0 {
                    (p[0] * (q[0] - a[0]) + p[1] * (q[1] - a[1])) / distance
                } else {
                    0.0
                }
            };
            (distance, [along(b), along(c)])
        });
        nearest - self.radius()
    }

    /// Least distance of a triangle's points from the body, mm, the tip at the origin.
    ///
    /// The triangle is led over along its longest side and across it, so that slivers are no valleys.
    fn gap(&self, corners: [Vector; 3]) -> f64 {
        let [a, b, c] = longest_first(corners);
        let along = b - a;
        let foot = (c - a).dot(&along) / along.norm_squared();
        let across = c - a - along * foot;
        polygon::least(&[[0.0, 0.0], [1.0, 0.0], [foot, 1.0]], ENOUGH, |[s, t]| {
            let (distance, normal) = self.distance(a + along * s + across * t);
            (distance, [normal.dot(&along), normal.dot(&across)])
        })
    }

    /// Distance of a point from the body, with the normal of the nearest plane; within, a distance that is not positive.
    ///
    /// Seen from outside, the nearest point of the meridian is ahead of all points before it and behind all after it.
    pub fn distance(&self, point: Vector) -> (f64, Vector) {
        let radius = point.x.hypot(point.y);
        let (mut low, mut high) = (0.0, FRAC_PI_2);
        for _ in 0..HALVINGS {
            let slope = 0.5 * (low + high);
            let (sin, cos) = libm::sincos(slope);
            let (r, z) = self.profile.point_at(slope);
            if (radius - r) * cos + (point.z - z) * sin > 0.0 {
                low = slope;
            } else {
                high = slope;
            }
        }
        let far = |slope: f64| {
            let (sin, cos) = libm::sincos(slope);
            let (r, z) = self.profile.point_at(slope);
            ((radius - r) * sin - (point.z - z) * cos - self.ball, sin, cos)
        };
        let (low, high) = (far(low), far(high));
        let (distance, sin, cos) = if low.0 > high.0 { low } else { high };
        let out = if radius > 0.0 { sin / radius } else { 0.0 };
        (distance, Vector::new(out * point.x, out * point.y, -cos))
    }

    /// What the best of all separating planes leaves of the body on the triangle's side, mm, the tip at the origin.
    ///
    /// G(v) = min over the corners of v p - h(v), h the support function, is concave in v, any downward vector; a plane of
    /// normal v leaves -G / |v|. Where the largest G is 0 its position does not depend on how long the vectors are, so in each
    /// quadrant they are led over a flat triangle: |vx| + |vy| + |vz| = 1.
    fn depth(&self, corners: [Vector; 3]) -> f64 {
        let mut best = f64::INFINITY;
        for [turn_x, turn_y] in [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]] {
            polygon::least(&TRIANGLE, f64::NEG_INFINITY, |[s, t]| {
                if best <= ENOUGH {
                    return (f64::NEG_INFINITY, [0.0; 2]);
                }
                let v = Vector::new(turn_x * s, turn_y * t, (s + t - 1.0).min(0.0));
                let deepest = self.support(v);
                let nearest = corners.into_iter().fold(corners[0], |p, q| if v.dot(&q) < v.dot(&p) { q } else { p });
                let over = deepest - nearest;
                best = best.min(v.dot(&over) / v.norm());
                (v.dot(&over), [turn_x * over.x + over.z, turn_y * over.y + over.z])
            });
        }
        best
    }

    /// The body's farthest point along a downward vector.
    fn support(&self, v: Vector) -> Vector {
        let across = v.x.hypot(v.y);
        let (r, z) = self.profile.point_at(libm::atan2(across, -v.z));
        let out = if across > 0.0 { r / across } else { 0.0 };
        Vector::new(out * v.x, out * v.y, z) + v * (self.ball / v.norm())
    }
}

/// Shares of a triangle's second and third corner.
const TRIANGLE: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];

/// The corners turned so that the longest side leads from the first to the second.
fn longest_first([a, b, c]: [Vector; 3]) -> [Vector; 3] {
    let turns = [[a, b, c], [b, c, a], [c, a, b]];
    turns.into_iter().fold([a, b, c], |p, q| if (q[1] - q[0]).norm() > (p[1] - p[0]).norm() { q } else { p })
}
