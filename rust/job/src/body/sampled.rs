//! A part's triangles with their index and the points from which it is measured.

use styluscam_geometry::{Bvh, Mesh, Vector};

use super::rays::Rays;
use super::samples::{samples, Sample};

/// Points from which a body is measured: shares are right to about two percent of the area.
const SAMPLES: usize = 2000;

/// A mesh with its index and the points from which it is measured.
pub struct Body<'a> {
    pub(super) rays: Rays<'a>,
    pub(super) samples: Vec<Sample>,
    /// Lowest and highest corner of the box.
    bounds: (Vector, Vector),
}

impl<'a> Body<'a> {
    /// Of a mesh that lies as the tool sees it, +Z towards the spindle, and its index.
    #[must_use]
    pub fn new(mesh: &'a Mesh, bvh: &'a Bvh) -> Self {
        Self { rays: Rays::new(mesh, bvh), samples: samples(mesh, SAMPLES), bounds: mesh.bounds() }
    }

    /// The mesh.
    #[must_use]
    pub fn mesh(&self) -> &'a Mesh {
        self.rays.mesh
    }

    /// The mesh's index.
    #[must_use]
    pub fn bvh(&self) -> &'a Bvh {
        self.rays.bvh
    }

    /// Lowest and highest corner of its box, mm.
    #[must_use]
    pub fn bounds(&self) -> (Vector, Vector) {
        self.bounds
    }

    /// The box's diagonal, mm.
    pub(super) fn size(&self) -> f64 {
        (self.bounds.1 - self.bounds.0).norm()
    }

    /// Length below which two points are one, mm.
    pub(super) fn fine(&self) -> f64 {
        1e-6 * self.size()
    }
}
