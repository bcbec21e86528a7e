//! The CAD kernels' elementary surfaces: plane, cylinder, cone, sphere and torus.
//!
//! Each knows its signed distance and normal, its own parameters (u about the axis, v along or around it), and how far apart
//! points on it may lie. The formulas are those of analytic geometry; names of kinds follow STEP (ISO 10303-42, section 4.5).

mod axes;
mod meridian;
mod spacing;

use std::f64::consts::FRAC_PI_2;

pub use axes::Axes;
use meridian::Meridian;
use rayon::prelude::*;
pub use spacing::Spacing;

use crate::{GeometryError, Vector};

/// The shape of an elementary surface, mm and rad, about the third axis of its [`Axes`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ElementaryKind {
    /// Spanned by the first two axes. Parameters: along both, mm.
    Plane,
    /// Parameters: angle, height.
    Cylinder {
        /// Above 0.
        radius: f64,
    },
    /// One nappe: `radius` at the origin, growing with the height by the tangent of `semi_angle`, which may be negative.
    /// Parameters: angle, height.
    Cone {
        /// At the origin.
        radius: f64,
        /// Between -90 and 90 degrees, not 0.
        semi_angle: f64,
    },
    /// Parameters: longitude, latitude.
    Sphere {
        /// Above 0.
        radius: f64,
    },
    /// The tube may reach over the axis (`minor` above `major`). Parameters: angle, angle around the tube from its outside up.
    Torus {
        /// Of the tube's centre line.
        major: f64,
        /// Of the tube.
        minor: f64,
    },
}

/// An unbounded elementary surface, oriented so that its normal leaves the material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElementarySurface {
    kind: ElementaryKind,
    axes: Axes,
    /// 1.0 with the material inside (below a plane's third axis), -1.0 outside.
    sign: f64,
}

impl ElementarySurface {
    /// A surface about `axes`, with the material inside (below a plane), or outside where `sign` is negative.
    ///
    /// # Errors
    /// `NotFinite`: a radius or angle is none.
    pub fn new(kind: ElementaryKind, axes: Axes, sign: f64) -> Result<Self, GeometryError> {
        let sizes = match kind {
            ElementaryKind::Plane => [1.0, 1.0],
            ElementaryKind::Cylinder { radius } | ElementaryKind::Sphere { radius } => [radius, 1.0],
            ElementaryKind::Cone { radius, semi_angle } => [radius, 1.0 / libm::tan(semi_angle)],
            ElementaryKind::Torus { major, minor } => [major, minor],
        };
        match sizes.iter().position(|size| !size.is_finite()) {
            Some(index) => Err(GeometryError::NotFinite { what: "size of a surface", index }),
            None => Ok(Self { kind, axes, sign: if sign < 0.0 { -1.0 } else { 1.0 } }),
        }
    }

    /// Its shape.
    #[must_use]
    pub const fn kind(&self) -> ElementaryKind {
        self.kind
    }

    /// How far a point lies outside the material, mm; below 0 inside.
    #[must_use]
    pub fn distance(&self, point: Vector) -> f64 {
        let away = self.axes.away(point);
        let unsigned = match self.kind {
            ElementaryKind::Plane => away.z,
            ElementaryKind::Sphere { radius } => away.norm() - radius,
            ElementaryKind::Cylinder { radius } => Meridian::radius_of(away) - radius,
            ElementaryKind::Cone { radius, semi_angle } => {
                from_cone(Meridian::radius_of(away), away.z, radius, semi_angle)
            }
            ElementaryKind::Torus { major, minor } => {
                from_tube_centre(Meridian::radius_of(away), away.z, major, minor).1 - minor
            }
        };
        self.sign * unsigned
    }

    /// The distances of points between the corners of triangles, at each of the barycentric `weights`: triangle by triangle.
    ///
    /// # Errors
    /// `NoSuchVertex`.
    pub fn distances_between(
        &self,
        nodes: &[Vector],
        triangles: &[[i64; 3]],
        weights: &[[f64; 3]],
    ) -> Result<Vec<f64>, GeometryError> {
        let node = |i: i64| usize::try_from(i).ok().and_then(|i| nodes.get(i));
        let missing = |triangle: &[i64; 3]| triangle.iter().copied().find(|i| node(*i).is_none());
        if let Some((triangle, vertex)) = triangles.iter().enumerate().find_map(|(t, it)| Some((t, missing(it)?))) {
            return Err(GeometryError::NoSuchVertex { triangle, vertex, count: nodes.len() });
        }
        let between = |triangle: &[i64; 3]| {
            let [a, b, c] = triangle.map(|i| node(i).copied().unwrap_or_default());
            weights.iter().map(move |[i, j, k]| self.distance(a * *i + b * *j + c * *k))
        };
        Ok(triangles.par_iter().with_min_len(512).flat_map_iter(between).collect())
    }

    /// The unit normal out of the material at the surface's point nearest to `point`.
    ///
    /// Where no point is nearest: at a sphere's centre the first axis, on an axis that of any half-plane through it, on a torus'
    /// centre line along the axis.
    #[must_use]
    pub fn normal(&self, point: Vector) -> Vector {
        let away = self.axes.away(point);
        let local = match self.kind {
            ElementaryKind::Plane => Vector::z(),
            ElementaryKind::Sphere { .. } => away.try_normalize(0.0).unwrap_or_else(Vector::x),
            ElementaryKind::Cylinder { .. } => Meridian::of(away).radial,
            ElementaryKind::Cone { semi_angle, .. } => {
                let (sine, cosine) = libm::sincos(semi_angle);
                Meridian::of(away).radial * cosine - Vector::z() * sine
            }
            ElementaryKind::Torus { major, minor } => {
                let meridian = Meridian::of(away);
                let (offset, distance) = from_tube_centre(meridian.radius, away.z, major, minor);
                let height = if distance > 0.0 { away.z } else { 1.0 };
                (meridian.radial * offset + Vector::z() * height).normalize()
            }
        };
        self.axes.direction(local) * self.sign
    }

    /// The parameters of the surface's point nearest to `point`; an angle about the axis is 0 on it.
    #[must_use]
    pub fn parameters(&self, point: Vector) -> [f64; 2] {
        let away = self.axes.away(point);
        let about = libm::atan2(away.y, away.x);
        match self.kind {
            ElementaryKind::Plane => [away.x, away.y],
            ElementaryKind::Cylinder { .. } | ElementaryKind::Cone { .. } => [about, away.z],
            ElementaryKind::Sphere { .. } => [about, libm::atan2(away.z, Meridian::radius_of(away))],
            ElementaryKind::Torus { major, minor } => {
                let (offset, _) = from_tube_centre(Meridian::radius_of(away), away.z, major, minor);
                [about, libm::atan2(away.z, offset)]
            }
        }
    }

    /// The point at parameters.
    #[must_use]
    pub fn point(&self, [u, v]: [f64; 2]) -> Vector {
        if self.kind == ElementaryKind::Plane {
            return self.axes.point(Vector::new(u, v, 0.0));
        }
        let (sine, cosine) = libm::sincos(u);
        let radius = self.radius_at(v);
        let height = match self.kind {
            ElementaryKind::Sphere { radius } => radius * libm::sin(v),
            ElementaryKind::Torus { minor, .. } => minor * libm::sin(v),
            ElementaryKind::Plane | ElementaryKind::Cylinder { .. } | ElementaryKind::Cone { .. } => v,
        };
        self.axes.point(Vector::new(radius * cosine, radius * sine, height))
    }

    /// How far from the axis the points with parameter `v` lie, mm; a plane's parameters run along lines: infinite.
    #[must_use]
    pub fn radius_at(&self, v: f64) -> f64 {
        match self.kind {
            ElementaryKind::Plane => f64::INFINITY,
            ElementaryKind::Cylinder { radius } => radius,
            ElementaryKind::Cone { radius, semi_angle } => (radius + v * libm::tan(semi_angle)).max(0.0),
            ElementaryKind::Sphere { radius } if v.abs() < FRAC_PI_2 => radius * libm::cos(v),
            ElementaryKind::Sphere { .. } => 0.0,
            ElementaryKind::Torus { major, minor } => major + minor * libm::cos(v),
        }
    }

    /// Which of the parameters come back after a full turn.
    #[must_use]
    pub const fn is_periodic(&self) -> [bool; 2] {
        match self.kind {
            ElementaryKind::Plane => [false, false],
            ElementaryKind::Cylinder { .. } | ElementaryKind::Cone { .. } | ElementaryKind::Sphere { .. } => {
                [true, false]
            }
            ElementaryKind::Torus { .. } => [true, true],
        }
    }
}

/// Distance from a cone's nappe, seen in a half-plane through the axis. Past the apex the nearest point is the apex.
fn from_cone(away: f64, height: f64, radius: f64, semi_angle: f64) -> f64 {
    let (sine, cosine) = libm::sincos(semi_angle);
    let above_apex = height + radius * cosine / sine;
    let along = away * sine.abs() + above_apex * cosine * sine.signum();
    if along >= 0.0 {
        (away - radius) * cosine - height * sine
    } else {
        libm::hypot(away, above_apex)
    }
}

/// The radial offset from the centre of the generating circle whose arc is nearest, and the distance from that centre.
fn from_tube_centre(radius: f64, height: f64, major: f64, minor: f64) -> (f64, f64) {
    let near = radius - major;
    let distance = (near * near + height * height).sqrt();
    if minor <= major {
        return (near, distance);
    }
    let far = radius + major;
    let far_distance = (far * far + height * height).sqrt();
    if (far_distance - minor).abs() < (distance - minor).abs() {
        (far, far_distance)
    } else {
        (near, distance)
    }
}

#[cfg(test)]
mod tests;
