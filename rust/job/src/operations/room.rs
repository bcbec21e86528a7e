//! Where a tool with its shank and holder is free of the part.

use styluscam_geometry::Mesh;
use styluscam_toolpath::offset::{Envelope, Index};

use super::Context;

/// Heights that differ by less are the same, mm.
const SAME: f64 = 1e-5;

/// Where the tool is free of the part.
pub(super) struct Room<'a> {
    /// Of the tool's profile, and of what is above it.
    envelopes: Vec<Envelope<'a>>,
    /// How far the tip may be under them, mm.
    under: f64,
    /// The lowest height of the tip, mm.
    lowest: f64,
}

impl<'a> Room<'a> {
    /// Of a profile over a shape, and of what is above it over the part, grown by a margin, mm.
    pub fn new(context: &'a Context<'_>, (shape, index): (&'a Mesh, &'a Index), margin: f64) -> Self {
        let scene = context.scene;
        let above = context.tool.bodies_above(None).into_iter();
        let above = above.map(|(_, solid)| Envelope::of_body(&scene.mesh, &scene.index, solid.grown(margin)));
        let profile = Envelope::new(shape, index, context.tool, None, margin);
        let envelopes = std::iter::once(profile).chain(above).collect();
        Self { envelopes, under: 0.0, lowest: context.heights.bottom }
    }

    /// The same, on whose level floors the tool stands though it is grown by a margin, mm.
    pub fn standing(self, margin: f64) -> Self {
        Self { under: margin, ..self }
    }

    pub fn is_free(&self, [x, y, z]: [f64; 3]) -> bool {
        let height = z + self.under + SAME;
        z >= self.lowest - SAME && !self.envelopes.iter().any(|envelope| envelope.is_over(x, y, height, &mut None))
    }
}
