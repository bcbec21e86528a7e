//! The region of an operation: its boundary and its check faces.

use std::collections::{BTreeMap, HashSet};

use styluscam_geometry::{Mesh, Vector};

use crate::faces::{chosen, Look};
use crate::region::{Check, Edge, OperationRegion};
use crate::selection::CheckSelection;
use crate::{JobDocument, JobError, OperationSection, Scene, Selection};

/// The region of an operation, whose faces are known; `index` is its number in the job. The tool on the other side of a sheet goes
/// where the main tool does, and has none of its own.
///
/// # Errors
/// A check face that the part does not have, or that is selected; no edge of the faces.
pub fn region_of(
    job: &JobDocument,
    scene: &Scene,
    section: &OperationSection,
    index: usize,
    faces: &[u32],
) -> Result<OperationRegion, JobError> {
    if scene.opposite.is_some() {
        return Ok(OperationRegion::default());
    }
    let common = &section.common;
    let (selection, path) = match &common.check_faces {
        Some(selection) => (Some(selection), format!("operations[{index}].check_faces")),
        None => (job.part.check_faces.as_ref(), "part.check_faces".to_owned()),
    };
    let clearance = common.check_clearance.or(job.part.check_clearance).unwrap_or(0.0);
    let boundary = common.boundary.clone().unwrap_or_default();
    if let Some(file) = &boundary.file {
        let message = format!("the polylines of {file:?} are not read: the engine opens no files");
        let path = format!("operations[{index}].boundary.file");
        return Err(JobError::document(
            "unread",
            path,
            message,
            "write them as boundary.wire, or let Job read the job",
        ));
    }
    let edges = match (boundary.wire.is_empty(), boundary.face_edges) {
        (false, _) => Some(boundary.wire.iter().flat_map(|corners| edges_of(corners)).collect()),
        (true, true) => Some(outline(&scene.mesh, &scene.facing_up(faces))),
        (true, false) => None,
    };
    let check = selection.map(|selection| checked(job, scene, selection, faces, &path)).transpose()?.flatten();
    Ok(OperationRegion {
        check: check.map(|mesh| Check { mesh, clearance }),
        edges,
        inside: boundary.inside,
        slopes: boundary.slope_deg.map(|slopes| slopes.map(f64::to_radians)),
    })
}

/// The triangles of check faces; none where "rest" leaves none, or a stage has none of them.
fn checked(
    job: &JobDocument,
    scene: &Scene,
    selection: &CheckSelection,
    faces: &[u32],
    path: &str,
) -> Result<Option<Mesh>, JobError> {
    let forms = job.process.process.as_kind().forms();
    let all = if forms { Look::UpButRims } else { Look::UpOrAside };
    let kept: HashSet<u32> = match selection {
        CheckSelection::Rest => {
            let all = chosen(&Selection::All, &scene.views, all, true, path)?;
            all.into_iter().filter(|face| !faces.contains(face)).collect()
        }
        CheckSelection::Named(names) => {
            let named = chosen(&Selection::Named(names.clone()), &scene.views, all, true, path)?;
            if let Some(both) = named.iter().find(|face| faces.contains(face)) {
                let message = format!("Face{both} is selected: a tool cannot touch a face and keep away from it");
                return Err(JobError::document("conflict", path, message, "remove it from faces or from check_faces"));
            }
            named.into_iter().collect()
        }
    };
    let is_named = matches!(selection, CheckSelection::Named(_));
    let (mesh, up) = (&scene.mesh, scene.facing_up(&kept.iter().copied().collect::<Vec<_>>()));
    let keep = |triangle: usize| if is_named { kept.contains(&mesh.faces()[triangle]) } else { up[triangle] };
    // a stage has not yet all faces of the part
    if !(0..up.len()).any(keep) {
        return Ok(None);
    }
    mesh.part_of(keep).map(Some).map_err(JobError::geometry(path))
}

fn edges_of(corners: &[[f64; 2]]) -> impl Iterator<Item = Edge> + '_ {
    (0..corners.len()).map(|i| [corners[i], corners[(i + 1) % corners.len()]])
}

/// The sides in plan that an odd number of some triangles have: what is inside of them is inside of the triangles.
fn outline(mesh: &Mesh, selected: &[bool]) -> Vec<Edge> {
    // corners by what they measure: faces of a STEP part share none
    let key = |p: Vector| <[u64; 3]>::from((p + Vector::zeros()).map(f64::to_bits));
    let mut sides: BTreeMap<[[u64; 3]; 2], (Edge, usize)> = BTreeMap::new();
    for triangle in (0..selected.len()).filter(|triangle| selected[*triangle]) {
        let corners = mesh.corners(triangle);
        for i in 0..3 {
            let (a, b) = (corners[i], corners[(i + 1) % 3]);
            let side = if key(a) < key(b) { [a, b] } else { [b, a] };
            sides.entry(side.map(key)).or_insert((side.map(|p| [p.x, p.y]), 0)).1 += 1;
        }
    }
    sides.into_values().filter(|(_, count)| count % 2 == 1).map(|(edge, _)| edge).collect()
}
