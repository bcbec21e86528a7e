//! What several kinds of profile are put together from, and the ranges of their numbers.

use std::f64::consts::FRAC_PI_2;

use super::{arc::Arc, chain::Builder, curve::Curve, kind::Built};
use crate::{error::positive_length, GeometryError};

/// What is left of a curve must be at least this wide, mm.
pub const LEAST: f64 = 1e-6;

/// What a diameter leaves beyond the tip's flat, as a radius, mm.
pub fn beyond_flat(diameter: f64, flat: f64) -> Result<f64, GeometryError> {
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

/// An angle in rad, its bounds kept.
pub fn angle(key: &'static str, degrees: f64, below: f64) -> Result<f64, GeometryError> {
    // closer to 0 or to the end than this the side is a flat or a cylinder
    if degrees >= 0.01 && degrees <= below - 0.01 {
        return Ok(degrees.to_radians());
    }
    let allowed =
        if below < 100.0 { "an angle from 0.01 to 89.99 degrees" } else { "an angle from 0.01 to 179.99 degrees" };
    Err(GeometryError::OutOfRange { key, value: degrees, allowed })
}

/// A curve up to a right angle.
pub fn whole(mut tip: Builder, curve: Curve) -> Built {
    tip.curve(curve, 0.0, FRAC_PI_2);
    tip.finish().into()
}

/// A curve up to a radius.
pub fn ended(mut tip: Builder, curve: Curve, radius: f64) -> Built {
    let end = curve.slope_at_radius(radius, [0.0, FRAC_PI_2]);
    tip.curve(curve, 0.0, end);
    tip.finish().into()
}

/// A flat whose corner is rounded, up to a vertical side.
pub fn round_cornered(mut tip: Builder, base: f64, corner_radius: f64) -> Result<Built, GeometryError> {
    let corner = positive_length("corner_radius", corner_radius)?;
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

/// A conical side of a slope (rad) whose tip is rounded by a ball, or sharp where `tip_radius` is 0.
pub fn round_tipped(mut tip: Builder, tip_radius: f64, slope: f64, base: f64) -> Result<Built, GeometryError> {
    let (sin, cos) = libm::sincos(slope);
    let rest = base - tip_radius * sin;
    if rest < -LEAST {
        return Err(GeometryError::OutOfRange {
            key: "tip_radius",
            value: tip_radius,
            allowed: "less: the ball alone is wider than the diameter where the cone begins",
        });
    }
    if tip_radius > 0.0 {
        tip.curve(Curve::Arc(Arc::new(tip_radius, 0.0)), 0.0, slope);
    } else {
        tip.kink(slope);
    }
    tip.straight(rest.max(0.0) / cos);
    Ok(tip.finish().into())
}
