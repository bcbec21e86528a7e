//! What a picture of a forming job shows beside path and tools: blank, formed sheet, what holds it, die. One source for the
//! report, PNG pictures and FreeCAD.

mod formed;
mod holders;
mod kind;
mod standing;
#[cfg(test)]
mod tests;

use styluscam_geometry::{Creased, Facets};

use formed::Formed;
pub use kind::ShapeKind;
pub use standing::Travel;

use crate::{JobDocument, Scene};

/// A closed body for drawing, in the work coordinates of a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// What it stands for.
    pub kind: ShapeKind,
    /// Its triangles.
    pub drawn: Creased,
}

/// The shapes of a job's sheet; none without a sheet. The points of the part that are left out for the drawing are at most
/// `tolerance` mm off what is drawn.
///
/// The sheet's two faces follow from the model's face by the sheet's law: along the normals, or along the vertical. The blank is
/// as large as what holds it, and as the part at least. The die's upper side is the formed sheet's back; it ends at the part's
/// border. Seen from a channel whose tool comes from below, all is turned with its coordinates.
#[must_use]
pub fn shapes(job: &JobDocument, scene: &Scene, tolerance: f64) -> Vec<Shape> {
    let Some(Formed { tool_face, back_face, sheet, bounds, flat }) = formed::of(job, scene, tolerance) else {
        return Vec::new();
    };
    let body = tool_face.body_to(&back_face);
    let holders = holders::of(job.setup.fixture.as_ref(), bounds, flat, sheet.thickness);
    let mut bodies = vec![(ShapeKind::Blank, holders.blank), (ShapeKind::FormedSheet, body)];
    bodies.extend(holders.plates);
    bodies.extend(job.process.process.as_kind().die().map(|die| (ShapeKind::Die(die), formed::die_under(&back_face))));
    let turned = formed::turn_of(job, scene);
    let drawn = |body: Facets| match &turned {
        Some(turned) => body.placed(turned).creased(),
        None => body.creased(),
    };
    bodies.into_iter().map(|(kind, body)| Shape { kind, drawn: drawn(body) }).collect()
}

/// How far every vertex of the formed sheet of [`shapes`] stands above its formed height, mm, at each moment of a travel over it:
/// what is not formed yet is flat, or hangs as low as the loop around it. None without a sheet, and from below.
#[must_use]
pub fn standing(job: &JobDocument, scene: &Scene, tolerance: f64, travel: &Travel<'_>) -> Option<Vec<Vec<f64>>> {
    if formed::turn_of(job, scene).is_some() {
        return None;
    }
    let Formed { tool_face, back_face, flat, .. } = formed::of(job, scene, tolerance)?;
    let heights = standing::heights(&tool_face, flat, job.process.process.as_kind().support(), travel);
    // both faces have the same points
    let points = tool_face.body_to(&back_face).creased().points;
    let of_vertices = |heights: Vec<f64>| points.iter().map(|point| heights[*point as usize % heights.len()]).collect();
    Some(heights.into_iter().map(of_vertices).collect())
}
