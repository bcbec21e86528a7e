//! The walls of an operation, and its concave corners.

use styluscam_geometry::Bend;

use super::{
    corner::{alike, Corner},
    creases::creases,
    fillets::fillets,
    patch::Patch,
};
use crate::{
    faces::{chosen, Look},
    resolve::selection_of,
    JobDocument, JobError, Scene, Selection,
};

/// The selected faces that face up, triangle by triangle, and their concave corners.
#[derive(Clone, Debug, PartialEq)]
pub struct Walls {
    /// In the order of the part's triangles.
    pub walls: Vec<Wall>,
    /// Sharp edges and fillets, alike ones put together.
    pub corners: Vec<Corner>,
}

/// A piece of a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// rad: 0 where it is level.
    pub slope: f64,
    /// rad from +X: where it faces.
    pub azimuth: f64,
    /// mm^2.
    pub area: f64,
    /// How it curves.
    pub bend: Bend,
    /// Number of the face.
    pub face: u32,
}

impl From<&Patch> for Wall {
    fn from(patch: &Patch) -> Self {
        let normal = patch.middle;
        Self {
            slope: libm::atan2(libm::hypot(normal.x, normal.y), normal.z),
            azimuth: libm::atan2(normal.y, normal.x),
            area: patch.area,
            bend: patch.bend,
            face: patch.face,
        }
    }
}

/// The walls of the faces that an operation selects.
///
/// # Errors
/// No such operation, a face that the part does not have, nothing selected that faces up (`no-faces`).
pub fn walls(job: &JobDocument, scene: &Scene, index: usize) -> Result<Walls, JobError> {
    let (mut selected, path) = selected(job, scene, index)?;
    let mut patches = Vec::new();
    for (triangle, is_selected) in selected.iter_mut().enumerate().filter(|(_, is_selected)| **is_selected) {
        let patch = Patch::facing_up(&scene.mesh, triangle);
        *is_selected = patch.is_some();
        patches.extend(patch);
    }
    if patches.is_empty() {
        let hint = format!("check setup.up and {path}");
        return Err(JobError::document("no-faces", path, "no selected face faces up", hint));
    }
    let corners = [creases(&scene.mesh, &selected), fillets(&patches)].concat();
    Ok(Walls { walls: patches.iter().map(Wall::from).collect(), corners: alike(&corners) })
}

/// Whether each triangle belongs to a selected face, and the key that selects it. Undercuts are for planning to refuse.
fn selected(job: &JobDocument, scene: &Scene, index: usize) -> Result<(Vec<bool>, String), JobError> {
    let section = job.operations.get(index).ok_or_else(|| {
        let hint = format!("the job has {}", job.operations.len());
        JobError::document("no-such-operation", "operations", format!("no operation {index}"), hint)
    })?;
    let (selection, path) = selection_of(job, section, index);
    let faces = scene.mesh.faces();
    let selected = match selection {
        Selection::All => vec![true; faces.len()],
        Selection::Named(_) => {
            let named = chosen(selection, &scene.views, Look::Up, true, &path)?;
            faces.iter().map(|face| named.binary_search(face).is_ok()).collect()
        }
    };
    Ok((selected, path))
}
