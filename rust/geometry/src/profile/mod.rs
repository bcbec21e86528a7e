//! Convex profiles, parametrised by slope.
//!
//! A profile is the curve from the tool's tip (r = 0, z = 0) to its base. The slope is the angle
//! between the surface's outward normal and -Z on the tool, +Z on the part: 0 at the tip, a right
//! angle where the wall is vertical. By slope everything is finite, also where dz/dr is not.
//!
//! A new kind is one file with an `impl Meridian`, an arm in [`Profile`] and one in [`ProfileDocument`].

mod ball;
mod clothoid;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use ball::Ball;
pub use clothoid::Clothoid;

use crate::GeometryError;

/// What every kind of profile can tell about itself.
///
/// `slope` lies in `[0, max_slope]`; implementors need not clamp it.
pub trait Meridian {
    /// The slope at which the curve ends, rad, at most a right angle.
    fn max_slope(&self) -> f64;

    /// Radius and height at a slope, mm.
    fn point_at(&self, slope: f64) -> (f64, f64);

    /// Radius of curvature of the meridian at a slope, mm; infinite where it is flat.
    fn curvature_radius_at(&self, slope: f64) -> f64;

    /// The slope at a radius between 0 and the base's, to rounding.
    fn slope_at_radius(&self, radius: f64) -> f64;
}

/// A profile of one of the known kinds.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// A half circle.
    Ball(Ball),
    /// A clothoid: curvature grows linearly with arc length from the tip.
    Clothoid(Clothoid),
}

impl std::ops::Deref for Profile {
    type Target = dyn Meridian + Send + Sync;

    fn deref(&self) -> &Self::Target {
        match self {
            Self::Ball(profile) => profile,
            Self::Clothoid(profile) => profile,
        }
    }
}

/// A profile as tool and job documents write it. Lengths in mm, angles in degrees.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum ProfileDocument {
    /// A half circle: the ball-end tool.
    Ball {
        /// Diameter of the base, mm.
        diameter: f64,
        /// Diameter-less flat at the tip: its radius, mm.
        #[serde(default)]
        tip_flat: f64,
    },
    /// Curvature grows linearly with arc length from the tip: R L = A.
    Clothoid {
        /// Diameter of the base, mm; leave it out when `scale` is given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        diameter: Option<f64>,
        /// The constant A, mm^2; needs `end_slope_deg`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        scale: Option<f64>,
        /// Slope at which the curve ends, degrees; 90 unless given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        end_slope_deg: Option<f64>,
        /// Flat at the tip: its radius, mm.
        #[serde(default)]
        tip_flat: f64,
    },
}

impl ProfileDocument {
    /// The kind's name as the document writes it.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Ball { .. } => "ball",
            Self::Clothoid { .. } => "clothoid",
        }
    }

    /// Radius of the flat at the tip, mm.
    #[must_use]
    pub fn tip_flat(&self) -> f64 {
        match self {
            Self::Ball { tip_flat, .. } | Self::Clothoid { tip_flat, .. } => *tip_flat,
        }
    }

    /// Builds the curve beyond the tip flat; the diameter is the base's, flat included.
    ///
    /// # Errors
    /// A length out of range, keys that exclude each other, or a flat that leaves no curve.
    pub fn build(&self) -> Result<Profile, GeometryError> {
        let flat = crate::error::length("tip_flat", self.tip_flat())?;
        let beyond_flat = |diameter: f64| {
            let radius = crate::error::positive_length("diameter", diameter)? / 2.0 - flat;
            if radius > 1e-6 {
                Ok(radius)
            } else {
                Err(GeometryError::OutOfRange {
                    key: "tip_flat",
                    value: flat,
                    allowed: "less than half the diameter: it leaves no curve",
                })
            }
        };
        match self {
            Self::Ball { diameter, .. } => Ok(Profile::Ball(Ball::new(beyond_flat(*diameter)?))),
            Self::Clothoid { diameter, scale, end_slope_deg, .. } => {
                let end = end_slope(*end_slope_deg)?;
                match (diameter, scale) {
                    (Some(diameter), None) => {
                        Ok(Profile::Clothoid(Clothoid::from_radius(beyond_flat(*diameter)?, end)))
                    }
                    (None, Some(scale)) if end_slope_deg.is_some() => Ok(Profile::Clothoid(Clothoid::from_scale(
                        crate::error::positive_length("scale", *scale)?,
                        end,
                    ))),
                    _ => Err(GeometryError::Keys("clothoid takes diameter, or scale with end_slope_deg".to_owned())),
                }
            }
        }
    }
}

fn end_slope(degrees: Option<f64>) -> Result<f64, GeometryError> {
    match degrees {
        None => Ok(std::f64::consts::FRAC_PI_2),
        Some(value) if value > 0.0 && value <= 90.0 => Ok(value.to_radians()),
        Some(value) => {
            Err(GeometryError::OutOfRange { key: "end_slope_deg", value, allowed: "above 0 and up to 90 degrees" })
        }
    }
}
