//! What a part is, before anything is planned: an open surface or a closed body, a sheet of one thickness or a solid,
//! how it stands in each of six directions, how high its border lies, how hollow and how narrow it is.
//!
//! All of it is measured by rays and nearest points from some thousand places spread evenly over the surface: quick, the
//! same for the same triangles, and told as shares of the area. It chooses and warns; nothing is cut by it.

pub(crate) mod adjacency;
mod formable;
mod heights;
mod hollows;
mod rays;
mod samples;
mod shell;
mod sides;
mod thickness;

#[cfg(test)]
mod tests;

pub use formable::Unformable;
pub use heights::{Border, Heights};
pub use hollows::{FaceLook, Hollows};
pub use shell::Shell;
pub use sides::{Side, SIDES};
pub use thickness::Thickness;

use styluscam_geometry::{Bvh, Mesh, Vector};

use rays::Rays;
pub(crate) use samples::in_triangle;
use samples::{samples, Sample};

/// Places from which a body is measured: shares are right to about two percent of the area.
const PLACES: usize = 2000;

/// From this slope on a wall is upright, degrees.
const UPRIGHT_DEG: f64 = 89.0;

/// A mesh with its index and the places from which it is measured.
pub struct Body<'a> {
    rays: Rays<'a>,
    places: Vec<Sample>,
    /// Lowest and highest corner of the box.
    bounds: (Vector, Vector),
}

impl<'a> Body<'a> {
    /// Of a mesh that lies as the tool sees it, +Z towards the spindle, and its index.
    #[must_use]
    pub fn new(mesh: &'a Mesh, bvh: &'a Bvh) -> Self {
        Self { rays: Rays::new(mesh, bvh), places: samples(mesh, PLACES), bounds: mesh.bounds() }
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
    fn size(&self) -> f64 {
        (self.bounds.1 - self.bounds.0).norm()
    }

    /// Length below which two places are one, mm.
    fn fine(&self) -> f64 {
        1e-6 * self.size()
    }

    /// Whether the surface is open, closed, or wound both ways.
    #[must_use]
    pub fn shell(&self) -> Shell {
        shell::of(self)
    }

    /// How thick a body is that encloses a volume, but for holes where triangles are missing, by place.
    #[must_use]
    pub fn thickness(&self) -> Option<Thickness> {
        matches!(self.shell(), Shell::Closed | Shell::Torn).then(|| thickness::of(self)).flatten()
    }

    /// What can be seen from each of the six directions of [`SIDES`].
    #[must_use]
    pub fn sides(&self) -> [Side; 6] {
        sides::of(self)
    }

    /// Heights as seen from above.
    #[must_use]
    pub fn heights(&self) -> Heights {
        heights::of(self)
    }

    /// The highest place over (x, y), mm; none beside the part.
    #[must_use]
    pub fn height_at(&self, x: f64, y: f64) -> Option<f64> {
        let (low, high) = self.bounds;
        let above = high.z + (high.z - low.z) + 1.0;
        let hit = self.rays.first(Vector::new(x, y, above), -Vector::z(), 0.0, |_| true)?;
        Some(above - hit.distance)
    }

    /// The faces as seen from above, with the concave radii and the gaps that bound a tool.
    #[must_use]
    pub fn hollows(&self) -> Hollows {
        hollows::of(self)
    }

    /// Share of the area seen from above that is steeper than an angle, degrees. Upright walls count where another stands
    /// opposite, as in a pit: those around the whole part are a block's sides, or a sheet's rim.
    #[must_use]
    pub fn steeper(&self, slope_deg: f64) -> f64 {
        let (limit, upright) = (libm::cos(slope_deg.to_radians()), libm::cos(UPRIGHT_DEG.to_radians()));
        let is_steep = |place: &Sample| {
            place.normal.z < limit && (place.normal.z > upright || hollows::gap(self, place).is_some())
        };
        let seen = self.places.iter().filter(|place| sides::is_seen(self, place, Vector::z()));
        let (all, steep) = seen.fold((0, 0), |(all, steep), place| (all + 1, steep + i32::from(is_steep(place))));
        f64::from(steep) / f64::from(all.max(1))
    }

    /// How deep a sheet of a `thickness` (none: a surface without) goes down from its border, mm, where it can be formed
    /// from above.
    ///
    /// # Errors
    /// Why it cannot.
    pub fn formed_depth(&self, thickness: Option<f64>) -> Result<f64, Unformable> {
        formable::depth(self, thickness)
    }
}
