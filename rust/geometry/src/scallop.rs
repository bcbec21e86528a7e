//! How far apart passes of a convex tool may lie for the scallop that they leave.
//!
//! Level passes on a plane leave the tool's section, and the same section moved along the plane: the two cross where the chord
//! of the section that is parallel to the plane is as long as the distance between them. So the distance for a scallop is the
//! chord at its height, for any convex profile. Of passes in another direction, and on curved faces, the tool and the face
//! count by their curvatures across the passes: derived in docs/concepts/scallops.md.

use std::f64::consts::FRAC_PI_2;

use crate::ToolBody;

/// Of a slope: more than a double distinguishes.
const HALVINGS: usize = 60;
/// Sines of slopes below this belong to a floor: there the tool is as curved in all directions as it is along its meridian.
const FLOOR: f64 = 1e-9;

impl ToolBody {
    /// Distance of the tool's positions on neighbouring passes over a face of a `slope`, mm, at which these leave a scallop of
    /// `height` mm; infinite where no distance leaves as much, 0 where the face is as hollow as the tool.
    ///
    /// On a plane it is the distance along the face. On a curved one the tool travels farther than its contact, or less far.
    ///
    /// `across` has cos and sin of the angle between the direction across the passes and up the wall: [1, 0] for levels. The
    /// face's `curvature` in that direction, 1/mm, is positive where it is convex.
    #[must_use]
    pub fn scallop_travel(&self, slope: f64, height: f64, across: [f64; 2], curvature: f64) -> f64 {
        let [up, level] = across.map(|part| part * part);
        let chord = self.chord(slope, height);
        let along_meridian = chord * chord / (8.0 * height);
        let sin = libm::sin(slope);
        let around = if sin > FLOOR { self.point_at(slope).0 / sin } else { along_meridian };
        // a direction of which the passes have nothing does not count, however flat the tool is in it
        let part = |share: f64, radius: f64| if share > 0.0 { share * radius } else { 0.0 };
        let radius = part(up, along_meridian) + part(level, around);
        // p^2 / 8 (1 / R + k) = h along the face; while the contact goes p, the tool goes p (1 + k R)
        if radius.is_finite() {
            libm::sqrt(8.0 * height * radius * (1.0 + curvature * radius).max(0.0))
        } else {
            f64::INFINITY
        }
    }

    /// Length of the section's chord parallel to a face of a `slope` at `height` mm above it, mm; infinite where the section
    /// does not end below.
    #[must_use]
    pub fn chord(&self, slope: f64, height: f64) -> f64 {
        let (radius, z) = self.point_at(slope);
        let wall = Wall { body: self, slope, foot: [radius, z], normal: libm::sincos(slope), height };
        wall.end(FRAC_PI_2) - wall.end(-FRAC_PI_2)
    }

    /// Width of the tool, seen up along a face of a `slope`, at `height` mm above the face, mm: what passes straight up the wall
    /// cut at that height.
    #[must_use]
    pub fn level_chord(&self, slope: f64, height: f64) -> f64 {
        let (sin, cos) = libm::sincos(slope);
        // half the width and the height over the face, where the face, turned aside by an angle, would touch
        let seen = |angle: f64| {
            let (aside, ahead) = libm::sincos(angle);
            let lean = libm::hypot(ahead * sin, aside);
            let (radius, z) = self.point_at(libm::atan2(lean, ahead * cos));
            if lean > FLOOR {
                [radius * aside / lean, z * cos - radius * ahead * sin * sin / lean]
            } else {
                [radius, z]
            }
        };
        let foot = seen(0.0)[1];
        let (mut near, mut far) = (0.0, FRAC_PI_2);
        if seen(far)[1] - foot < height {
            return 2.0 * self.max_radius();
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (near + far);
            if seen(middle)[1] - foot < height {
                near = middle;
            } else {
                far = middle;
            }
        }
        let ([s0, d0], [s1, d1]) = (seen(near), seen(far));
        let share = if d1 > d0 { ((height + foot - d0) / (d1 - d0)).clamp(0.0, 1.0) } else { 0.0 };
        2.0 * (s0 + share * (s1 - s0))
    }
}

/// The tool's section as it stands on a wall.
struct Wall<'a> {
    body: &'a ToolBody,
    slope: f64,
    /// Radius and height at which it touches.
    foot: [f64; 2],
    /// Sine and cosine of the slope.
    normal: (f64, f64),
    height: f64,
}

impl Wall<'_> {
    /// Where the section is at the height over the wall, towards its upright side at `far`: the distance from the foot along
    /// the wall, upwards.
    fn end(&self, far: f64) -> f64 {
        let (mut near, mut far) = (self.slope, far);
        let last = self.seen(self.point(far));
        if last[1] < self.height {
            return self.on_cylinder(far);
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (near + far);
            if self.seen(self.point(middle))[1] < self.height {
                near = middle;
            } else {
                far = middle;
            }
        }
        // between neighbouring slopes the section is straight: a part of the profile, or so short
        let ([s0, d0], [s1, d1]) = (self.seen(self.point(near)), self.seen(self.point(far)));
        let share = if d1 > d0 { ((self.height - d0) / (d1 - d0)).clamp(0.0, 1.0) } else { 0.0 };
        s0 + share * (s1 - s0)
    }

    /// The same where the cylinder above the profile is at that height first.
    fn on_cylinder(&self, side: f64) -> f64 {
        let (sin, cos) = self.normal;
        let across = self.body.max_radius().copysign(side) - self.foot[0];
        if cos <= FLOOR {
            return f64::INFINITY.copysign(side);
        }
        let rise = (self.height + across * sin) / cos;
        across * cos + rise * sin
    }

    /// Radius and height of the section by slope, from -90 degrees, the far side, to 90; the end of a straight part away from
    /// the tip.
    fn point(&self, slope: f64) -> [f64; 2] {
        let (radius, height) = self.body.point_at(slope.abs());
        [radius.copysign(slope), height]
    }

    /// From radius and height to the distances along the wall and over it.
    fn seen(&self, [radius, height]: [f64; 2]) -> [f64; 2] {
        let ((sin, cos), [r, z]) = (self.normal, [radius - self.foot[0], height - self.foot[1]]);
        [r * cos + z * sin, z * cos - r * sin]
    }
}

#[cfg(test)]
mod tests {
    use crate::{kinds, ProfileDocument, Tool, ToolDocument};

    use super::*;

    const LEVELS: [f64; 2] = [1.0, 0.0];

    fn body(profile: ProfileDocument) -> ToolBody {
        Tool::new(ToolDocument::of(profile)).unwrap().body(None)
    }

    fn ball(diameter: f64) -> ToolBody {
        body(kinds::Ball { diameter, radius: None, tip_flat: 0.0 }.into())
    }

    #[test]
    fn a_balls_chord_is_that_of_its_circle() {
        let ball = ball(10.0);
        for slope in [0.0, 0.3, 0.8, 1.2] {
            for height in [0.001, 0.05, 0.3] {
                let chord = 2.0 * (25.0_f64 - (5.0 - height) * (5.0 - height)).sqrt();
                assert!((ball.scallop_travel(slope, height, LEVELS, 0.0) - chord).abs() < 1e-9, "{slope} {height}");
            }
        }
    }

    #[test]
    fn the_level_chord_is_the_width_seen_up_the_face() {
        for profile in [
            kinds::Ball { diameter: 10.0, radius: None, tip_flat: 0.0 }.into(),
            kinds::Parabola { apex_radius: 8.0, diameter: 20.0, tip_flat: 0.0 }.into(),
            kinds::BullNose { diameter: 10.0, corner_radius: 2.0, tip_flat: 0.0 }.into(),
        ] {
            let body = body(profile);
            for slope in [0.0_f64, 0.4, 1.0] {
                let (sin, cos) = slope.sin_cos();
                let (radius, z) = body.point_at(slope);
                let most = z * cos - radius * sin + 0.05;
                // the widest of all points of the tool that are no higher over the face: around the axis by an angle from uphill
                let width = |number: u32| {
                    let (radius, z) = body.point_at(FRAC_PI_2 * f64::from(number) / 20_000.0);
                    let over = z * cos - most;
                    let least = if over > 0.0 { over / (radius * sin) } else { 0.0 };
                    if least <= 1.0 {
                        2.0 * radius * (1.0 - least * least).sqrt()
                    } else {
                        0.0
                    }
                };
                let widest = (0..=20_000).map(width).fold(0.0, f64::max);
                let found = body.level_chord(slope, 0.05);
                assert!((found - widest).abs() < 1e-3 * widest, "{slope}: {found} {widest}");
            }
        }
    }

    #[test]
    fn parabolas_chords_are_those_of_the_closed_form() {
        let parabola = body(kinds::Parabola { apex_radius: 8.0, diameter: 60.0, tip_flat: 0.0 }.into());
        for slope_deg in [20.0_f64, 45.0, 60.0] {
            // h = (p cos a)^2 cos a / (8 R0)
            let cos = slope_deg.to_radians().cos();
            let spacing = parabola.scallop_travel(slope_deg.to_radians(), cos.powi(3) / 64.0, LEVELS, 0.0);
            assert!((spacing - 1.0).abs() < 1e-9, "{slope_deg}: {spacing}");
        }
    }

    #[test]
    fn a_flat_counts_with_its_width_and_a_cylinder_leaves_nothing() {
        let bull = body(kinds::BullNose { diameter: 10.0, corner_radius: 2.0, tip_flat: 0.0 }.into());
        let corner = 2.0 * (4.0_f64 - 1.9 * 1.9).sqrt();
        assert!((bull.scallop_travel(0.0, 0.1, LEVELS, 0.0) - (6.0 + corner)).abs() < 1e-9);
        assert!(ball(4.0).scallop_travel(FRAC_PI_2, 0.01, LEVELS, 0.0).is_infinite());
    }

    #[test]
    fn the_faces_curvature_counts_as_the_tools_does() {
        let ball = ball(6.0);
        let on = |curvature: f64| ball.scallop_travel(0.7, 0.01, LEVELS, curvature);
        // in and around a circle of 60 mm the tool's centre goes on one of 57 and 63 mm: at an angle t between two positions
        // the scallop is 60 - 57 cos(t/2) - sqrt(9 - 57^2 sin^2(t/2)), and its like outside
        for (curvature, centre) in [(-1.0 / 60.0, 57.0_f64), (1.0 / 60.0, 63.0)] {
            let half = 0.5 * on(curvature) / centre;
            let (sin, cos) = half.sin_cos();
            let meet = centre * cos + (60.0 - centre).signum() * (9.0 - (centre * sin).powi(2)).sqrt();
            assert!(((meet - 60.0).abs() / 0.01 - 1.0).abs() < 2e-3, "{curvature}: {meet}");
        }
        assert!(on(-0.4) < 1e-12);
    }

    #[test]
    fn rows_up_the_wall_see_the_tools_other_radius() {
        let parabola = body(kinds::Parabola { apex_radius: 8.0, diameter: 60.0, tip_flat: 0.0 }.into());
        for (slope_deg, height) in [(20.0_f64, 14.683e-3), (45.0, 11.049e-3), (60.0, 7.813e-3)] {
            let spacing = parabola.scallop_travel(slope_deg.to_radians(), height, [0.0, 1.0], 0.0);
            assert!((spacing - 1.0).abs() < 2e-3, "{slope_deg}: {spacing}");
        }
    }
}
