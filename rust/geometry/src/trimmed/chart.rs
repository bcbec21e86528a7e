//! Maps of an elementary surface into the plane on which equilateral triangles of side 1 leave the surface equally far.
//!
//! Planes are taken as they are. On cylinders, cones and tori the parameters are scaled by the lattice's sides. A sphere's
//! latitude is stretched as on Mercator's map, which keeps angles: a Delaunay triangulation of the map is nearly one of the
//! sphere. Beside the poles, where that map has no end, the scale stays that of a ring of few points.

use crate::{ElementaryKind, ElementarySurface, Spacing};

/// A map of parameters into the plane.
#[derive(Clone, Copy, Debug)]
pub enum Chart {
    /// Lengths, mm.
    Plane,
    /// Scaled by the lattice's sides.
    Scaled(Spacing),
    /// Of a sphere.
    Mercator {
        /// The lattice's side, rad.
        side: f64,
        /// The latitude from which the map goes on evenly, and the map there.
        limit: [f64; 2],
    },
}

impl Chart {
    /// For triangles that leave the surface by `deviation` mm, where the second parameter lies within `range`.
    pub fn of(surface: &ElementarySurface, deviation: f64, range: [f64; 2]) -> Self {
        let Some(spacing) = surface.spacing(deviation, range) else { return Self::Plane };
        if !matches!(surface.kind(), ElementaryKind::Sphere { .. }) {
            return Self::Scaled(spacing);
        }
        let side = spacing.u;
        let latitude = libm::acos(side);
        Self::Mercator { side, limit: [latitude, mercator(latitude)] }
    }

    /// Where parameters lie.
    pub fn flat(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        match *self {
            Self::Plane => [u, v],
            Self::Scaled(spacing) => [u / spacing.u, v / spacing.v],
            Self::Mercator { side, limit: [latitude, there] } => {
                let beyond = (v.abs() - latitude).max(0.0);
                let north = mercator(v.abs().min(latitude)).min(there) + beyond / side;
                [u / side, north.copysign(v) / side]
            }
        }
    }
}

/// The map's ordinate of a latitude (Snyder, Map Projections, USGS 1395, equation 7-2).
fn mercator(latitude: f64) -> f64 {
    libm::asinh(libm::tan(latitude))
}
