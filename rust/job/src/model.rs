//! The model against the job: whether what is to be formed is a sheet, of the job's thickness, with the face that the job
//! names, and with its border where the sheet is clamped.

use styluscam_geometry::{ModelFace, Sheet};
use styluscam_verify::{FindingKind, Found, Severity, Support};

use crate::body::{Body, Unformable};
use crate::resolve::selection_of;
use crate::{JobDocument, Scene, Selection};

/// A model whose thickness differs from the sheet's by more than this share of it, and by more than so many mm, is
/// another sheet.
const OTHER: f64 = 0.1;
const OTHER_MM: f64 = 0.03;

/// What does not agree, each with a sentence: what was measured, and what to write.
pub fn mismatches(job: &JobDocument, scene: &Scene) -> Vec<Found> {
    let wrong = found_wrong(job, scene).into_iter();
    wrong.map(|(kind, words)| (kind, Severity::Error, words)).collect()
}

fn found_wrong(job: &JobDocument, scene: &Scene) -> Vec<(FindingKind, String)> {
    let Some(sheet) = scene.sheet else { return Vec::new() };
    let body = Body::new(&scene.mesh, &scene.bvh);
    let thickness = body.thickness();
    let of_sheet = thickness.filter(|thickness| thickness.is_sheet()).map(|thickness| thickness.median);
    let formed = match job.process.process.as_kind().support() {
        Support::Rim => body.formed_depth(of_sheet),
        Support::DieAndFrame | Support::Mandrel => body.laid_depth(of_sheet),
    };
    let solid = thickness.filter(|_| of_sheet.is_none() && takes_all(job)).zip(formed.err());
    if let Some((thickness, why)) = solid {
        let over = match why {
            Unformable::LowBorder { .. } => {
                ", form over it as over a die (process = { kind = \"tpif\", die = \"male\" })"
            }
            Unformable::Unseen | Unformable::Flat | Unformable::Steep(_) | Unformable::Stepped => "",
        };
        let words = format!(
            "the model is a solid, {:.2} to {:.2} mm thick, and no sheet, and {why}: set process.kind = \"milling\" \
             (`styluscam new` writes such a job){over}, name the faces that the sheet takes in part.faces, or accept = \
             [\"solid\"]",
            thickness.thin, thickness.thick
        );
        return vec![(FindingKind::SolidFormed, words)];
    }
    let mut found = Vec::new();
    found.extend(of_sheet.and_then(|measured| other_thickness(measured, sheet)));
    found.extend(of_sheet.and_then(|measured| other_face(measured, sheet)));
    if let Err(Unformable::LowBorder { below, is_lowest }) = formed {
        let turn = if is_lowest { "turn the model over with setup.up, " } else { "" };
        let words = format!(
            "the model's border, where the sheet is clamped, lies {below:.2} mm below its highest point: the sheet lies \
             flat at the border's height, and the tool only pushes down; {turn}form over a die (process = \
             {{ kind = \"tpif\", die = \"male\" }}), or accept = [\"flange\"]"
        );
        found.push((FindingKind::FlangeHeight, words));
    }
    found
}

/// Whether no face is chosen: all that faces up is to be formed.
fn takes_all(job: &JobDocument) -> bool {
    let mut sections = job.operations.iter().enumerate();
    sections.any(|(index, section)| *selection_of(job, section, index).0 == Selection::All)
}

fn other_thickness(measured: f64, sheet: Sheet) -> Option<(FindingKind, String)> {
    let off = (measured - sheet.thickness).abs();
    if off <= f64::max(OTHER * measured, OTHER_MM) {
        return None;
    }
    let words = format!(
        "the model is a sheet {measured:.2} mm thick, and the job's is {} mm: write thickness = {measured:.2} in \
         [setup.sheet], or accept = [\"thickness\"]",
        sheet.thickness
    );
    Some((FindingKind::SheetThickness, words))
}

/// A model with both faces shows the tool the one that it touches.
fn other_face(measured: f64, sheet: Sheet) -> Option<(FindingKind, String)> {
    let name = match sheet.model_face {
        ModelFace::Tool => return None,
        ModelFace::Back => "back",
        ModelFace::Mid => "mid",
    };
    let words = format!(
        "the model is a sheet {measured:.2} mm thick with both its faces, and the tool comes to the upper one: with \
         model_face = \"{name}\" another sheet would lie on top of it; write model_face = \"tool\", or accept = \
         [\"model-face\"]"
    );
    Some((FindingKind::SheetFace, words))
}
