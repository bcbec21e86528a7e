//! Profiles as tool and job documents write them, and what becomes of each kind.

use std::f64::consts::FRAC_PI_2;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::formula::{self, FormulaDocument, TracedPart};
use super::{points, Arc, Builder, Clothoid, Curve, Cycloid, Ellipse, Parabola, Power, Profile};
use crate::error::{length, positive_area, positive_length};
use crate::GeometryError;

/// What is left of a curve must be at least this wide, mm.
const LEAST: f64 = 1e-6;
/// Largest radius or height of a profile, mm.
const MOST: f64 = 1e4;

/// A profile as tool and job documents write it. Lengths in mm, angles in degrees. `diameter` is the base's, tip flat
/// included, and ends the curve where nothing else does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum ProfileDocument {
    /// A half circle, the ball-end tool; or with `radius` the part of a larger circle that the diameter cuts off.
    Ball {
        /// Diameter of the base, mm.
        #[schemars(extend("x-unit" = "mm"))]
        diameter: f64,
        /// Radius of the circle, mm; half the diameter when left out.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("x-unit" = "mm"))]
        radius: Option<f64>,
        /// Radius of the flat at the tip, mm.
        #[serde(default)]
        #[schemars(extend("x-unit" = "mm"))]
        tip_flat: f64,
    },
    /// Curvature grows linearly with arc length from the tip: R L = A.
    Clothoid {
        /// Diameter of the base, mm; leave it out when `scale` is given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("x-unit" = "mm"))]
        diameter: Option<f64>,
        /// The constant A, mm^2; needs `end_slope_deg`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("x-unit" = "mm^2"))]
        scale: Option<f64>,
        /// Slope at which the curve ends, degrees; 90 unless given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("x-unit" = "deg"))]
        end_slope_deg: Option<f64>,
        /// Radius of the flat at the tip, mm.
        #[serde(default)]
        #[schemars(extend("x-unit" = "mm"))]
        tip_flat: f64,
    },
    /// z = r^2 / 2 R0.
    Parabola {
        /// Radius of curvature at the tip (R0), mm.
        #[schemars(extend("x-unit" = "mm"))]
        apex_radius: f64,
        /// Diameter of the base, mm.
        #[schemars(extend("x-unit" = "mm"))]
        diameter: f64,
        /// Radius of the flat at the tip, mm.
        #[serde(default)]
        #[schemars(extend("x-unit" = "mm"))]
        tip_flat: f64,
    },
    /// Half an ellipse.
    Ellipse {
        /// Semi-axis across the tool's axis, mm.
        #[schemars(extend("x-unit" = "mm"))]
        radial: f64,
        /// Semi-axis along the tool's axis, mm.
        #[schemars(extend("x-unit" = "mm"))]
        axial: f64,
        /// Diameter of the base, mm, if the ellipse ends before its equator.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("x-unit" = "mm"))]
        diameter: Option<f64>,
        /// Radius of the flat at the tip, mm.
        #[serde(default)]
        #[schemars(extend("x-unit" = "mm"))]
        tip_flat: f64,
    },
    /// r = a (t + sin t), z = a (1 - cos t).
    Cycloid {
        /// Diameter of the base, mm.
        #[schemars(extend("x-unit" = "mm"))]
        diameter: f64,
        /// Radius of the flat at the tip, mm.
        #[serde(default)]
        #[schemars(extend("x-unit" = "mm"))]
        tip_flat: f64,
    },
    /// z = c r^p.
    Power {
        /// The coefficient c, mm^(1 - p).
        #[schemars(extend("x-unit" = "mm^(1-p)"))]
        coefficient: f64,
        /// The exponent p, above 1.
        #[schemars(extend("x-unit" = "1"))]
        exponent: f64,
        /// Diameter of the base, mm.
        #[schemars(extend("x-unit" = "mm"))]
        diameter: f64,
        /// Radius of the flat at the tip, mm.
        #[serde(default)]
        #[schemars(extend("x-unit" = "mm"))]
        tip_flat: f64,
    },
    /// A rectangle with rounded corners, as the forming stylus: flat, arc, vertical side.
    RoundedRectangle {
        /// Diameter of the base, mm.
        #[schemars(extend("x-unit" = "mm"))]
        diameter: f64,
        /// Radius of the corners, mm.
        #[schemars(extend("x-unit" = "mm"))]
        corner_radius: f64,
        /// Radius of a flat that is added at the tip, mm.
        #[serde(default)]
        #[schemars(extend("x-unit" = "mm"))]
        tip_flat: f64,
    },
    /// A flat with a rounded corner, as the milling cutter.
    BullNose {
        /// Diameter of the cutter, mm.
        #[schemars(extend("x-unit" = "mm"))]
        diameter: f64,
        /// Radius of the corners, mm.
        #[schemars(extend("x-unit" = "mm"))]
        corner_radius: f64,
        /// Radius of a flat that is added at the tip, mm.
        #[serde(default)]
        #[schemars(extend("x-unit" = "mm"))]
        tip_flat: f64,
    },
    /// A ball that runs tangentially into an arc of a larger circle.
    Barrel {
        /// Diameter at the widest place, mm.
        #[schemars(extend("x-unit" = "mm"))]
        diameter: f64,
        /// Radius of the generating arc, mm.
        #[schemars(extend("x-unit" = "mm"))]
        radius: f64,
        /// Radius of the ball at the tip, mm.
        #[schemars(extend("x-unit" = "mm"))]
        tip_radius: f64,
        /// Radius of the flat at the tip, mm.
        #[serde(default)]
        #[schemars(extend("x-unit" = "mm"))]
        tip_flat: f64,
    },
    /// A cone, its tip rounded by a ball unless `tip_radius` is 0.
    Cone {
        /// Radius of the ball at the tip, mm.
        #[serde(default)]
        #[schemars(extend("x-unit" = "mm"))]
        tip_radius: f64,
        /// Angle between axis and side, degrees.
        #[schemars(extend("x-unit" = "deg"))]
        half_angle_deg: f64,
        /// Diameter of the base, mm.
        #[schemars(extend("x-unit" = "mm"))]
        diameter: f64,
        /// Radius of the flat at the tip, mm.
        #[serde(default)]
        #[schemars(extend("x-unit" = "mm"))]
        tip_flat: f64,
    },
    /// A ball with a conical side.
    TaperedBall {
        /// Radius of the ball at the tip, mm.
        #[schemars(extend("x-unit" = "mm"))]
        tip_radius: f64,
        /// Angle between axis and side, degrees.
        #[schemars(extend("x-unit" = "deg"))]
        half_angle_deg: f64,
        /// Diameter of the base, mm.
        #[schemars(extend("x-unit" = "mm"))]
        diameter: f64,
        /// Radius of the flat at the tip, mm.
        #[serde(default)]
        #[schemars(extend("x-unit" = "mm"))]
        tip_flat: f64,
    },
    /// A V-shaped engraver with a flat tip.
    V {
        /// Diameter of the tip, mm.
        #[serde(default)]
        #[schemars(extend("x-unit" = "mm"))]
        tip_diameter: f64,
        /// Included angle, degrees.
        #[schemars(extend("x-unit" = "deg"))]
        angle_deg: f64,
        /// Diameter of the base, mm.
        #[schemars(extend("x-unit" = "mm"))]
        diameter: f64,
        /// Radius of a flat that is added at the tip, mm.
        #[serde(default)]
        #[schemars(extend("x-unit" = "mm"))]
        tip_flat: f64,
    },
    /// A flat end with a sharp corner.
    Flat {
        /// Diameter of the cutter, mm.
        #[schemars(extend("x-unit" = "mm"))]
        diameter: f64,
        /// Part of the end, which is flat as a whole: at most half the diameter, and without effect.
        #[serde(default)]
        #[schemars(extend("x-unit" = "mm"))]
        tip_flat: f64,
    },
    /// A convex curve through measured points.
    Points {
        /// (r, z) from the tip outwards, mm; moved so that the first is the tip.
        #[schemars(extend("x-unit" = "mm"))]
        points: Vec<[f64; 2]>,
        /// How far the points may be from the profile, inside or outside, mm.
        #[serde(default = "fit_tolerance")]
        #[schemars(extend("x-unit" = "mm"))]
        fit_tolerance: f64,
        /// Radius of a flat that is added at the tip, mm.
        #[serde(default)]
        #[schemars(extend("x-unit" = "mm"))]
        tip_flat: f64,
    },
    /// A curve by formula: explicit, parametric or implicit.
    Formula(FormulaDocument),
}

fn fit_tolerance() -> f64 {
    1e-3
}

/// What was done to a document's curve to make it a profile.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ProfileReport {
    /// Sentences: moved, mirrored, how exact.
    pub notes: Vec<String>,
    /// Largest distance of a given point from the profile, mm; points only.
    #[serde(rename = "fit_deviation_mm")]
    pub fit_deviation: Option<f64>,
}

impl ProfileDocument {
    /// The kind's name as the document writes it.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Ball { .. } => "ball",
            Self::Clothoid { .. } => "clothoid",
            Self::Parabola { .. } => "parabola",
            Self::Ellipse { .. } => "ellipse",
            Self::Cycloid { .. } => "cycloid",
            Self::Power { .. } => "power",
            Self::RoundedRectangle { .. } => "rounded-rectangle",
            Self::BullNose { .. } => "bull-nose",
            Self::Barrel { .. } => "barrel",
            Self::Cone { .. } => "cone",
            Self::TaperedBall { .. } => "tapered-ball",
            Self::V { .. } => "v",
            Self::Flat { .. } => "flat",
            Self::Points { .. } => "points",
            Self::Formula(_) => "formula",
        }
    }

    /// Radius of the flat at the tip, mm.
    #[must_use]
    pub fn tip_flat(&self) -> f64 {
        match self {
            Self::Ball { tip_flat, .. }
            | Self::Clothoid { tip_flat, .. }
            | Self::Parabola { tip_flat, .. }
            | Self::Ellipse { tip_flat, .. }
            | Self::Cycloid { tip_flat, .. }
            | Self::Power { tip_flat, .. }
            | Self::RoundedRectangle { tip_flat, .. }
            | Self::BullNose { tip_flat, .. }
            | Self::Barrel { tip_flat, .. }
            | Self::Cone { tip_flat, .. }
            | Self::TaperedBall { tip_flat, .. }
            | Self::V { tip_flat, .. }
            | Self::Flat { tip_flat, .. }
            | Self::Points { tip_flat, .. } => *tip_flat,
            Self::Formula(formula) => formula.tip_flat,
        }
    }

    /// Builds the profile.
    ///
    /// # Errors
    /// A length or angle out of range, keys that exclude each other, a flat that leaves no curve, points that are not
    /// convex.
    pub fn build(&self) -> Result<(Profile, ProfileReport), GeometryError> {
        let flat = length("tip_flat", self.tip_flat())?;
        let mut tip = Builder::default();
        if !matches!(self, Self::Flat { .. }) {
            tip.straight(flat);
        }
        match self {
            Self::Points { points, fit_tolerance, .. } => {
                let fit = points::fit(points, length("fit_tolerance", *fit_tolerance)?, &tip)?;
                Ok((fit.profile, ProfileReport { notes: fit.notes, fit_deviation: Some(fit.deviation) }))
            }
            Self::Formula(document) => formula(tip, document, flat),
            _ => Ok((self.led(tip, flat)?, ProfileReport::default())),
        }
        .and_then(|(profile, report)| Ok((self.based(sane(profile)?), report)))
    }

    /// The profile with its base at the very diameter that the document gives, where it is that but for rounding.
    fn based(&self, profile: Profile) -> Profile {
        let radius = self.diameter().map(|diameter| diameter / 2.0);
        match radius.filter(|radius| (profile.base().0 - radius).abs() <= 1e-13 * radius) {
            Some(radius) => profile.ending_at(radius),
            None => profile,
        }
    }

    /// Diameter of the base, mm, where the document gives it.
    fn diameter(&self) -> Option<f64> {
        match self {
            Self::Ball { diameter, .. }
            | Self::Parabola { diameter, .. }
            | Self::Cycloid { diameter, .. }
            | Self::Power { diameter, .. }
            | Self::RoundedRectangle { diameter, .. }
            | Self::BullNose { diameter, .. }
            | Self::Barrel { diameter, .. }
            | Self::Cone { diameter, .. }
            | Self::TaperedBall { diameter, .. }
            | Self::V { diameter, .. }
            | Self::Flat { diameter, .. } => Some(*diameter),
            Self::Clothoid { diameter, .. } | Self::Ellipse { diameter, .. } => *diameter,
            Self::Formula(document) => document.diameter,
            Self::Points { .. } => None,
        }
    }

    /// The kinds with a closed form, from the end of the tip's flat.
    fn led(&self, tip: Builder, flat: f64) -> Result<Profile, GeometryError> {
        match self {
            Self::Ball { diameter, radius, .. } => ball(tip, beyond_flat(*diameter, flat)?, *radius),
            Self::Clothoid { diameter, scale, end_slope_deg, .. } => {
                clothoid(tip, diameter.map(|d| beyond_flat(d, flat)).transpose()?, *scale, *end_slope_deg)
            }
            Self::Parabola { apex_radius, diameter, .. } => {
                let curve = Parabola::new(positive_length("apex_radius", *apex_radius)?);
                Ok(ended(tip, Curve::Parabola(curve), beyond_flat(*diameter, flat)?))
            }
            Self::Ellipse { radial, axial, diameter, .. } => {
                let diameter = diameter.map(|d| beyond_flat(d, flat)).transpose()?;
                ellipse(tip, *radial, *axial, diameter)
            }
            Self::Cycloid { diameter, .. } => {
                Ok(whole(tip, Curve::Cycloid(Cycloid::from_radius(beyond_flat(*diameter, flat)?))))
            }
            Self::Power { coefficient, exponent, diameter, .. } => {
                let curve = power(*coefficient, *exponent)?;
                Ok(ended(tip, Curve::Power(curve), beyond_flat(*diameter, flat)?))
            }
            Self::RoundedRectangle { diameter, corner_radius, .. } | Self::BullNose { diameter, corner_radius, .. } => {
                bull_nose(tip, beyond_flat(*diameter, flat)?, *corner_radius)
            }
            Self::Barrel { diameter, radius, tip_radius, .. } => {
                barrel(tip, beyond_flat(*diameter, flat)?, *radius, *tip_radius)
            }
            Self::Cone { tip_radius, half_angle_deg, diameter, .. } => {
                let side = angle("half_angle_deg", *half_angle_deg, 90.0)?;
                cone(tip, length("tip_radius", *tip_radius)?, FRAC_PI_2 - side, beyond_flat(*diameter, flat)?)
            }
            Self::TaperedBall { tip_radius, half_angle_deg, diameter, .. } => {
                let side = angle("half_angle_deg", *half_angle_deg, 90.0)?;
                cone(tip, positive_length("tip_radius", *tip_radius)?, FRAC_PI_2 - side, beyond_flat(*diameter, flat)?)
            }
            Self::V { tip_diameter, angle_deg, diameter, .. } => {
                v(tip, length("tip_diameter", *tip_diameter)?, *angle_deg, beyond_flat(*diameter, flat)?)
            }
            Self::Flat { diameter, .. } => {
                let (radius, mut end) = (positive_length("diameter", *diameter)? / 2.0, tip);
                if flat > radius {
                    let allowed = "must be at most half the diameter";
                    return Err(GeometryError::OutOfRange { key: "tip_flat", value: flat, allowed });
                }
                end.straight(radius);
                Ok(end.finish())
            }
            Self::Points { .. } | Self::Formula(_) => Ok(tip.finish()),
        }
    }
}

/// Refuses what no machine could hold: power laws grow fast.
fn sane(profile: Profile) -> Result<Profile, GeometryError> {
    let (radius, height) = profile.base();
    if radius <= MOST && height <= MOST {
        return Ok(profile);
    }
    Err(GeometryError::Profile {
        place: "the base".to_owned(),
        reason: format!("the profile reaches r = {radius:.6} mm and z = {height:.6} mm, more than {MOST} mm"),
        hint: "end it at a smaller diameter".to_owned(),
    })
}

/// What a diameter leaves beyond the tip's flat, as a radius, mm.
fn beyond_flat(diameter: f64, flat: f64) -> Result<f64, GeometryError> {
    let radius = positive_length("diameter", diameter)? / 2.0 - flat;
    if radius > LEAST {
        return Ok(radius);
    }
    Err(GeometryError::OutOfRange {
        key: "tip_flat",
        value: flat,
        allowed: "less than half the diameter: it leaves no curve",
    })
}

fn angle(key: &'static str, degrees: f64, below: f64) -> Result<f64, GeometryError> {
    // closer to 0 or to the end than this the side is a flat or a cylinder
    if degrees >= 0.01 && degrees <= below - 0.01 {
        return Ok(degrees.to_radians());
    }
    let allowed =
        if below < 100.0 { "an angle from 0.01 to 89.99 degrees" } else { "an angle from 0.01 to 179.99 degrees" };
    Err(GeometryError::OutOfRange { key, value: degrees, allowed })
}

/// A curve up to a right angle.
fn whole(mut tip: Builder, curve: Curve) -> Profile {
    tip.curve(curve, 0.0, FRAC_PI_2);
    tip.finish()
}

/// A curve up to a radius.
fn ended(mut tip: Builder, curve: Curve, radius: f64) -> Profile {
    let end = curve.slope_at_radius(radius, [0.0, FRAC_PI_2]);
    tip.curve(curve, 0.0, end);
    tip.finish()
}

fn ball(tip: Builder, base: f64, radius: Option<f64>) -> Result<Profile, GeometryError> {
    let radius = positive_length("radius", radius.unwrap_or(base))?;
    if radius < base {
        return Err(GeometryError::OutOfRange {
            key: "radius",
            value: radius,
            allowed: "at least half the diameter: the circle must reach the base",
        });
    }
    let curve = Curve::Arc(Arc::new(radius, 0.0));
    Ok(if radius <= base { whole(tip, curve) } else { ended(tip, curve, base) })
}

fn clothoid(
    mut tip: Builder,
    base: Option<f64>,
    scale: Option<f64>,
    end_slope_deg: Option<f64>,
) -> Result<Profile, GeometryError> {
    let end = match end_slope_deg {
        None => FRAC_PI_2,
        Some(value) if value > 0.0 && value <= 90.0 => value.to_radians(),
        Some(value) => {
            let allowed = "above 0 and up to 90 degrees";
            return Err(GeometryError::OutOfRange { key: "end_slope_deg", value, allowed });
        }
    };
    let curve = match (base, scale) {
        (Some(radius), None) => Clothoid::from_radius(radius, end),
        (None, Some(scale)) if end_slope_deg.is_some() => Clothoid::from_scale(positive_area("scale", scale)?),
        _ => return Err(GeometryError::Keys("clothoid takes diameter, or scale with end_slope_deg".to_owned())),
    };
    tip.curve(Curve::Clothoid(curve), 0.0, end);
    Ok(tip.finish())
}

fn ellipse(tip: Builder, radial: f64, axial: f64, base: Option<f64>) -> Result<Profile, GeometryError> {
    let radial = positive_length("radial", radial)?;
    let curve = Curve::Ellipse(Ellipse::new(radial, positive_length("axial", axial)?));
    match base {
        None => Ok(whole(tip, curve)),
        Some(base) if base <= radial => Ok(ended(tip, curve, base)),
        Some(base) => Err(GeometryError::OutOfRange {
            key: "diameter",
            value: 2.0 * base,
            allowed: "at most twice the radial semi-axis, tip flat added",
        }),
    }
}

fn power(coefficient: f64, exponent: f64) -> Result<Power, GeometryError> {
    if !(1.01..=20.0).contains(&exponent) {
        return Err(GeometryError::OutOfRange { key: "exponent", value: exponent, allowed: "1.01 to 20" });
    }
    if !(1e-9..=1e9).contains(&coefficient) {
        return Err(GeometryError::OutOfRange { key: "coefficient", value: coefficient, allowed: "1e-9 to 1e9" });
    }
    Ok(Power::new(coefficient, exponent))
}

fn bull_nose(mut tip: Builder, base: f64, corner: f64) -> Result<Profile, GeometryError> {
    let corner = positive_length("corner_radius", corner)?;
    if corner > base {
        return Err(GeometryError::OutOfRange {
            key: "corner_radius",
            value: corner,
            allowed: "at most half the diameter",
        });
    }
    tip.straight(base - corner);
    Ok(whole(tip, Curve::Arc(Arc::new(corner, 0.0))))
}

fn barrel(mut tip: Builder, base: f64, radius: f64, tip_radius: f64) -> Result<Profile, GeometryError> {
    let (radius, tip_radius) = (positive_length("radius", radius)?, positive_length("tip_radius", tip_radius)?);
    if tip_radius > base || radius < base {
        return Err(GeometryError::Keys(format!(
            "barrel: tip_radius = {tip_radius} <= half the diameter = {base} <= radius = {radius} must hold"
        )));
    }
    // both circles have one tangent where their distances from the axis are equal: R_t sin = D/2 - R + R sin
    let meets = if radius > tip_radius { libm::asin((radius - base) / (radius - tip_radius)) } else { 0.0 };
    tip.curve(Curve::Arc(Arc::new(tip_radius, 0.0)), 0.0, meets);
    tip.curve(Curve::Arc(Arc::new(radius, meets)), meets, FRAC_PI_2);
    Ok(tip.finish())
}

fn cone(mut tip: Builder, tip_radius: f64, slope: f64, base: f64) -> Result<Profile, GeometryError> {
    let (sin, cos) = libm::sincos(slope);
    let rest = base - tip_radius * sin;
    if rest < -LEAST {
        return Err(GeometryError::OutOfRange {
            key: "tip_radius",
            value: tip_radius,
            allowed: "smaller: the ball alone is wider than the diameter where the cone begins",
        });
    }
    if tip_radius > 0.0 {
        tip.curve(Curve::Arc(Arc::new(tip_radius, 0.0)), 0.0, slope);
    } else {
        tip.kink(slope);
    }
    tip.straight(rest.max(0.0) / cos);
    Ok(tip.finish())
}

fn formula(mut tip: Builder, document: &FormulaDocument, flat: f64) -> Result<(Profile, ProfileReport), GeometryError> {
    let mut beyond = document.clone();
    if let Some(diameter) = document.diameter {
        beyond.diameter = Some(2.0 * beyond_flat(diameter, flat)?);
    }
    let traced = formula::trace(&beyond)?;
    for part in traced.parts {
        match part {
            TracedPart::Curve { curve, from, to } => tip.curve(Curve::Fitted(curve.into()), from, to),
            TracedPart::Straight { slope, from, to } => {
                tip.kink(slope);
                tip.straight(libm::hypot(to.0 - from.0, to.1 - from.1));
            }
        }
    }
    Ok((tip.finish(), ProfileReport { notes: traced.notes, fit_deviation: None }))
}

fn v(mut tip: Builder, tip_diameter: f64, angle_deg: f64, base: f64) -> Result<Profile, GeometryError> {
    let side = angle("angle_deg", angle_deg, 180.0)? / 2.0;
    let rest = base - tip_diameter / 2.0;
    if rest <= LEAST {
        return Err(GeometryError::OutOfRange {
            key: "tip_diameter",
            value: tip_diameter,
            allowed: "less than the diameter",
        });
    }
    tip.straight(tip_diameter / 2.0);
    tip.kink(FRAC_PI_2 - side);
    tip.straight(rest / libm::sin(side));
    Ok(tip.finish())
}
