//! The faces and the heights of an operation: resolved here for planning, verification and the summary alike.

use std::collections::BTreeMap;

use styluscam_geometry::Tool;
use styluscam_verify::{Layers, OrderedPasses, Passes};

use crate::faces::{chosen, FaceView, Look};
use crate::heights::TipHeights;
use crate::operations::PassContext;
use crate::{JobDocument, JobError, OperationSection, Scene, Selection};

/// The selection of an operation, its own or the part's, and its path in the document. `index` is the operation's number in
/// the job.
pub fn selection_of<'a>(job: &'a JobDocument, section: &'a OperationSection, index: usize) -> (&'a Selection, String) {
    match &section.common.faces {
        Some(selection) => (selection, format!("operations[{index}].faces")),
        None => (&job.part.faces, "part.faces".to_owned()),
    }
}

/// The faces that an operation is for, in order of their numbers: its own selection, or the part's. `index` is its number in
/// the job.
///
/// # Errors
/// A name that no face has, a face that faces down.
pub fn faces_of(
    job: &JobDocument,
    scene: &Scene,
    section: &OperationSection,
    index: usize,
) -> Result<Vec<u32>, JobError> {
    faces_in(job, &scene.views, section, index)
}

/// As [`faces_of`], among the faces of `views`.
pub fn faces_in(
    job: &JobDocument,
    views: &BTreeMap<u32, FaceView>,
    section: &OperationSection,
    index: usize,
) -> Result<Vec<u32>, JobError> {
    let (selection, path) = selection_of(job, section, index);
    let all = match (job.process.process.as_kind().forms(), section.kind().cuts_upright_walls()) {
        (true, _) => Look::UpButRims,
        (false, true) => Look::UpOrAside,
        (false, false) => Look::Up,
    };
    let allows_undercuts = job.part.allow_undercuts || section.kind().leans();
    chosen(selection, views, all, allows_undercuts, &path)
}

/// How the passes of an operation lie that a tool makes.
pub fn passes_of(
    job: &JobDocument,
    (scene, faces): (&Scene, &[u32]),
    tool: &Tool,
    section: &OperationSection,
) -> Passes {
    with_passes(job, (scene, faces), tool, section, |given| section.kind().passes(given))
}

/// Checks that the part has what an operation's passes follow beyond faces; `index` is its number in the job.
///
/// # Errors
/// It has not.
pub fn check_part(
    job: &JobDocument,
    (scene, faces): (&Scene, &[u32]),
    tool: &Tool,
    section: &OperationSection,
    index: usize,
) -> Result<(), JobError> {
    let are_named = matches!(selection_of(job, section, index).0, Selection::Named(_));
    let path = format!("operations[{index}]");
    with_passes(job, (scene, faces), tool, section, |given| section.kind().check_part(given, are_named, &path))
}

/// The layers in which they form a sheet, if any.
pub fn layers_of(job: &JobDocument, scene: &Scene, tool: &Tool, section: &OperationSection) -> Option<Layers> {
    with_passes(job, (scene, &[]), tool, section, |given| section.kind().layers(given))
}

fn with_passes<T>(
    job: &JobDocument,
    (scene, faces): (&Scene, &[u32]),
    tool: &Tool,
    section: &OperationSection,
    asked: impl FnOnce(&PassContext<'_>) -> T,
) -> T {
    asked(&PassContext {
        scene,
        faces,
        tolerance: section.common.tolerance,
        smallest_feature: section.common.smallest_feature,
        top: heights_of(job, scene, section).top.unwrap_or(scene.top),
        bottom: section.common.z_bottom,
        body: &section.touching(tool).body(scene.sheet.as_ref()),
        to_leave: section.common.stock_to_leave(),
        direction: section.common.direction,
    })
}

/// The passes of an operation of which each lies below the one before it; none of other operations.
pub fn descent_of(job: &JobDocument, scene: &Scene, tool: &Tool, section: &OperationSection) -> Option<OrderedPasses> {
    match passes_of(job, (scene, &[]), tool, section) {
        Passes::Ordered(passes) => Some(passes).filter(|passes| passes.scalar.descends()),
        Passes::Crossed(_)
        | Passes::Clearing(_)
        | Passes::Flank(_)
        | Passes::Drilling(_)
        | Passes::Boring(_)
        | Passes::Chamfering(_)
        | Passes::Contouring(_)
        | Passes::Covering { .. }
        | Passes::Unordered { .. } => None,
    }
}

/// Between which heights an operation's tip stays: its own, and in milling no lower than the part's foot, on which it
/// stands, unless the job states so.
pub fn heights_of(job: &JobDocument, scene: &Scene, section: &OperationSection) -> TipHeights {
    // a sheet hangs free: it is formed as low as it goes
    let foot = if job.process.process.as_kind().rests_on_table() { scene.foot() } else { f64::NEG_INFINITY };
    let common = &section.common;
    if scene.opposite.is_some() {
        return TipHeights { bottom: f64::NEG_INFINITY, top: None }; // they are the main tool's
    }
    TipHeights { bottom: common.z_bottom.unwrap_or(foot), top: common.z_top }
}
