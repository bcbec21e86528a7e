//! How far apart points of an elementary surface may lie, so that the triangles between them stay close to it.

use super::{ElementaryKind, ElementarySurface};

/// A triangle whose corners lie on a surface of normal curvature k leaves it by k rho^2 / 2 at most, where rho is its
/// circumradius. In a lattice of equilateral triangles of side s, rho is s / sqrt(3): s^2 = 6 deviation / k. Where the curvatures
/// along u and v differ, the lattice is stretched so that both give the same.
const SIDES: f64 = 6.0;

/// The largest angle between neighbours, rad: it decides only on radii of a few deviations.
const TURN: f64 = 0.35;

/// A surface that is straight along v has triangles this many times as long along v as along u, at most.
const STRETCH: f64 = 16.0;

/// The side of an equilateral triangle of the lattice, in units of each parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spacing {
    /// Along u, where that is smallest.
    pub u: f64,
    /// Along v.
    pub v: f64,
}

impl ElementarySurface {
    /// The lattice's side for triangles within `deviation` mm, where v lies between the two values; none on a plane, whose
    /// triangles need no points inside.
    #[must_use]
    pub fn spacing(&self, deviation: f64, [low, high]: [f64; 2]) -> Option<Spacing> {
        let side = |curved: f64| (SIDES * deviation / curved).sqrt();
        let straight = |radius: f64, curved: f64| {
            let u = side(curved).min(TURN);
            Spacing { u, v: STRETCH * radius * u }
        };
        match self.kind {
            ElementaryKind::Plane => None,
            ElementaryKind::Cylinder { radius } => Some(straight(radius, radius)),
            ElementaryKind::Cone { semi_angle, .. } => {
                let radius = self.radius_at(low).max(self.radius_at(high));
                Some(straight(radius, radius * libm::cos(semi_angle)))
            }
            ElementaryKind::Sphere { radius } => {
                let angle = side(radius).min(TURN);
                Some(Spacing { u: angle, v: angle })
            }
            ElementaryKind::Torus { major, minor } => {
                let curved = |v: f64| (libm::cos(v) * (major + minor * libm::cos(v))).abs();
                let steps = (0..=16).map(|i| curved(low + (high - low) * f64::from(i) / 16.0));
                Some(Spacing { u: side(steps.fold(0.0, f64::max)).min(TURN), v: side(minor).min(TURN) })
            }
        }
    }
}
