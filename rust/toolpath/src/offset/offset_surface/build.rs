//! The offset of triangles, split where something stops the tool.

use styluscam_geometry::{Sheet, Tool};
use styluscam_motion::{Cancelled, Watch};

use super::super::{patches::Patches, Envelope};
use super::{checks::Checks, corners::welded, splits::Splits, OffsetSurface};

/// Sides of triangles at which something stops the tool are halved down to this share of the tool's radius: what is
/// stopped is as narrow as the tool, planes have triangles of any size.
const FINE: f64 = 0.25;

impl OffsetSurface {
    /// The offset of some `triangles` of the envelope's mesh, every position checked against the whole mesh.
    ///
    /// Triangles with a corner from which something keeps the tool, or with corners of several flags, are split until they
    /// are small beside the tool, as far as a budget of `most` points more goes: the longest first.
    ///
    /// Positions are exact for the normals that the mesh knows at its corners, else for its facets'. A position is free
    /// if the tool, lifted off by `tolerance` (mm) along the normal, enters nothing: then it enters nothing deeper than
    /// that where it stands. (What it grazes beside it may move it by twice as much again.) So vertical walls, where
    /// heights jump, are checked by the same measure as floors. The tolerance has to cover how far the triangles lie
    /// outside the surface that the normals belong to.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn new(
        envelope: &Envelope<'_>,
        tool: &Tool,
        sheet: Option<&Sheet>,
        triangles: &[u32],
        tolerance: f64,
        most: usize,
        watch: &Watch,
    ) -> Result<Self, Cancelled> {
        let patches = Patches::of(envelope);
        let checks = Checks { envelope, tool, sheet, patches: &patches, tolerance };
        let (corners, connection) = welded(envelope.mesh(), &patches, triangles);
        let points = checks.points(&corners, watch)?;
        let fine = FINE * envelope.cutter().max_radius();
        let numbers = triangles.to_vec();
        let mut surface = Self { points, triangles: connection, numbers, fine, is_coarse: false };
        let most = surface.points.len() + most;
        loop {
            let splits = Splits::of(&surface, surface.fine);
            if splits.middles.is_empty() {
                break;
            }
            if surface.points.len() + splits.middles.len() > most {
                (surface.fine, surface.is_coarse) = (2.0 * surface.fine, true);
                watch.advance(0)?;
                continue;
            }
            surface.points.extend(checks.points(&splits.middles, watch)?);
            splits.apply(&mut surface);
        }
        Ok(surface)
    }
}
