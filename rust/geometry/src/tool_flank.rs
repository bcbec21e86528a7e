//! The side of a tool: where its profile is straight at its end.

use std::f64::consts::FRAC_PI_2;

use crate::{GeometryError, Tool};

/// A profile that ends this near to upright goes on as a cylinder, rad.
const UPRIGHT: f64 = 1e-9;
/// A straight part that is narrower than this is none, mm across the axis.
const STRAIGHT: f64 = 1e-6;

/// A cylinder, or a cone that widens upwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolFlank {
    /// Across the axis at its lower end, mm.
    pub radius: f64,
    /// Between the axis and a line of it, rad; 0 of a cylinder.
    pub half_angle: f64,
    /// Height of its lower end over the tip, mm.
    pub height: f64,
    /// How high it reaches over the tip, mm; infinite where that is not known.
    pub top: f64,
}

impl ToolFlank {
    /// How much its radius grows for each mm of the axis.
    #[must_use]
    pub fn growth(&self) -> f64 {
        libm::tan(self.half_angle)
    }

    /// Height over the tip, mm, at which the normals of its lower end meet the axis.
    #[must_use]
    pub fn rise(&self) -> f64 {
        self.height + self.radius * self.growth()
    }

    /// Height over the tip, mm, at which it touches the second of two rails, where it touches the first at its lower end and the axis
    /// between the normals of both is so long, mm.
    #[must_use]
    pub fn needed(&self, axis: f64) -> f64 {
        let (sine, cosine) = libm::sincos(self.half_angle);
        // of a cone that normal meets the axis higher up than where it is touched
        self.rise() + axis - (self.radius / cosine + axis * sine) * sine
    }
}

impl Tool {
    /// The straight part at the end of the profile: a cylinder where that is upright, or where the profile is flat; it reaches up to
    /// the tool's length, or a wider shank.
    ///
    /// # Errors
    /// The profile ends round and slanting.
    pub fn flank(&self) -> Result<ToolFlank, GeometryError> {
        let (profile, document) = (self.profile(), self.document());
        let (slope, (radius, rim)) = (profile.max_slope(), profile.base());
        let length = document.length.unwrap_or(f64::INFINITY);
        if slope <= 0.0 || slope >= FRAC_PI_2 - UPRIGHT {
            let wider = document.shank_diameter.is_some_and(|diameter| diameter > 2.0 * radius);
            let shank = if wider { rim + document.base.map_or(0.0, |base| base.height()) } else { f64::INFINITY };
            return Ok(ToolFlank { radius, half_angle: 0.0, height: rim, top: length.min(shank) });
        }
        let (inner, height) = profile.inner_point_at(slope);
        if radius - inner < STRAIGHT {
            let key = "its profile";
            let allowed = "an upright end, or a straight one, for milling with the side: flat, ball, cone, v, ...";
            return Err(GeometryError::OutOfRange { key, value: slope.to_degrees(), allowed });
        }
        Ok(ToolFlank { radius: inner, half_angle: FRAC_PI_2 - slope, height, top: rim })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flank(profile: &str) -> Result<ToolFlank, GeometryError> {
        Tool::new(serde_json::from_str(&format!(r#"{{"profile": {profile}}}"#)).unwrap()).unwrap().flank()
    }

    #[test]
    fn balls_and_flats_end_in_cylinders_and_cones_in_themselves() {
        let cylinder = |height| ToolFlank { radius: 5.0, half_angle: 0.0, height, top: f64::INFINITY };
        assert_eq!(flank(r#"{"kind": "flat", "diameter": 10.0}"#).unwrap(), cylinder(0.0));
        let ball = flank(r#"{"kind": "ball", "diameter": 10.0}"#).unwrap();
        assert!((ball.height - 5.0).abs() < 1e-12 && (ball.radius - 5.0).abs() < 1e-12);
        let cone = r#"{"kind": "tapered-ball", "tip_radius": 3.0, "half_angle_deg": 5.0, "diameter": 12.0}"#;
        let found = flank(cone).unwrap();
        let (sine, cosine) = 5.0_f64.to_radians().sin_cos();
        assert!((found.radius - 3.0 * cosine).abs() < 1e-9 && (found.height - 3.0 * (1.0 - sine)).abs() < 1e-9);
        assert!((found.half_angle.to_degrees() - 5.0).abs() < 1e-9);
        assert!((found.top - found.height - (6.0 - found.radius) / found.growth()).abs() < 1e-9);
        assert!((found.rise() - 3.0).abs() < 1e-9, "the ball's middle");
    }

    #[test]
    fn a_round_end_is_no_flank() {
        let error = flank(r#"{"kind": "parabola", "apex_radius": 2.0, "diameter": 10.0}"#).unwrap_err();
        assert!(error.to_string().contains("milling with the side"), "{error}");
    }

    #[test]
    fn a_wider_shank_ends_it() {
        let text = r#"{"profile": {"kind": "flat", "diameter": 6.0}, "shank_diameter": 10.0, "length": 40.0,
                       "base": {"kind": "cylindrical", "height": 25.0}}"#;
        let flank = Tool::new(serde_json::from_str(text).unwrap()).unwrap().flank().unwrap();
        assert!((flank.top - 25.0).abs() < 1e-12, "{flank:?}");
    }
}
