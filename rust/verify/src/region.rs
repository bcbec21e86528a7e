//! Where an operation's contacts must lie beyond its faces: inside a boundary, on some slopes, clear of check faces; and on its
//! faces at all.
//!
//! Where the tool touches is known no better than how far off the part it may be: a ball of radius R that is d off a plane, or in
//! it, is less than d farther from all within sqrt(2 R d) of its nearest point. By so much a contact may lie outside.

use std::sync::Arc;

use styluscam_geometry::{Bvh, Mesh, Vector};

use crate::body::Body;
use crate::clearance::Prober;

/// A chord may lie beside the exact path by so many times the excess: a fitted path counts a quarter of any distance.
const ASIDE: f64 = 2.0;
/// What rounding takes of a position, mm.
const ROUNDED: f64 = 2e-3;
/// Facets lean by what they deviate, rad.
const LEAN: f64 = 0.01;
/// Nothing is expected this near to check faces beyond their clearance, or to the end of a boundary, mm.
const BESIDE: f64 = 0.05;

/// What of a tool lies inside a boundary.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Inside {
    /// Its axis.
    #[default]
    Centre,
    /// Its contact.
    Contact,
    /// All of its profile.
    Tool,
}

/// Faces that an operation keeps away from.
#[derive(Clone, Debug)]
pub struct CheckFaces {
    /// Their triangles alone, work coordinates, mm.
    pub mesh: Mesh,
    /// The mesh's index.
    pub bvh: Bvh,
    /// How near tool and sheet may come, mm.
    pub clearance: f64,
}

/// Where an operation's contacts must lie.
#[derive(Clone, Debug, Default)]
pub struct Region {
    /// Edges in plan, mm, in any order: inside is where an odd number of them is crossed on the way out; none: everywhere.
    pub edges: Option<Vec<[[f64; 2]; 2]>>,
    /// What of the tool lies inside.
    pub inside: Inside,
    /// Least and greatest slope of contacts, rad.
    pub slopes: Option<[f64; 2]>,
    /// What tool, shank and holder keep away from.
    pub check: Option<Arc<CheckFaces>>,
}

impl Region {
    /// Whether contacts with this slope, rad, are asked for.
    pub(crate) fn takes_slope(&self, slope: f64) -> bool {
        self.slopes.is_none_or(|[least, most]| (least..=most).contains(&slope))
    }

    /// How far a slope lies off those that are asked for, rad; negative where it is one of them.
    pub(crate) fn off_slope(&self, slope: f64) -> f64 {
        self.slopes.map_or(f64::NEG_INFINITY, |[least, most]| (least - slope).max(slope - most))
    }

    /// How far outside what lies inside may be, mm, for a tool of this radius that may be `excess` off the part, mm.
    pub(crate) fn beside(&self, radius: f64, excess: f64) -> f64 {
        let exact = ASIDE * excess + ROUNDED;
        match self.inside {
            Inside::Centre | Inside::Tool => exact,
            Inside::Contact => exact + (2.0 * radius * excess).sqrt(),
        }
    }

    /// Whether passes are expected where a body at a position touches a point with a normal: well inside.
    pub(crate) fn takes(&self, body: &Body, position: Vector, (point, up): (Vector, Vector)) -> bool {
        let is_clear = |check: &Arc<CheckFaces>| {
            let prober = Prober { body, mesh: &check.mesh, bvh: &check.bvh };
            prober.at(position, None).is_none_or(|touch| touch.value > check.clearance + BESIDE)
        };
        let slope = libm::acos(up.z.clamp(-1.0, 1.0));
        self.takes_slope(slope)
            && self.outside(position, point, body.radius()) <= -BESIDE
            && self.check.as_ref().is_none_or(is_clear)
    }

    /// How far outside the edges what must lie inside is, mm; negative inside, by how far.
    pub(crate) fn outside(&self, tip: Vector, contact: Vector, radius: f64) -> f64 {
        let Some(edges) = &self.edges else { return f64::NEG_INFINITY };
        match self.inside {
            Inside::Centre => beyond(edges, tip),
            Inside::Contact => beyond(edges, contact),
            Inside::Tool => beyond(edges, tip) + radius,
        }
    }
}

/// How far off its slopes a contact may be, rad.
pub(crate) fn lean(radius: f64, excess: f64) -> f64 {
    LEAN + (2.0 * excess / radius).sqrt()
}

/// How far a position lies outside of some edges in plan, mm; negative inside.
fn beyond(edges: &[[[f64; 2]; 2]], position: Vector) -> f64 {
    let (mut nearest, mut above) = (f64::INFINITY, 0_usize);
    for [a, b] in edges {
        let (a, b) = (Vector::new(a[0], a[1], 0.0), Vector::new(b[0], b[1], 0.0));
        let (along, to) = (b - a, Vector::new(position.x, position.y, 0.0) - a);
        let share = (to.dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        nearest = nearest.min((to - share * along).norm());
        // of a ray along +Y
        let is_over = (a.x <= position.x) != (b.x <= position.x);
        above += usize::from(is_over && a.y + along.y * (position.x - a.x) / along.x > position.y);
    }
    if above % 2 == 1 {
        -nearest
    } else {
        nearest
    }
}
