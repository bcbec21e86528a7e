//! The formed sheet and the die under it.

use styluscam_geometry::{Facets, Frame, Sheet, SheetLaw, Vector};

use crate::{JobDocument, Scene};

/// How far a die goes on under the sheet, as a share of the part's larger side in plan.
const BASE: f64 = 0.08;

/// Steps of height, and along the part's larger side, in which the formed sheet is drawn at least: so it can be shown half formed.
const STEPS: f64 = 20.0;
const SPANS: f64 = 32.0;
/// A side of triangles stays flat that is lower than the highest by no more than this, mm.
const FLAT: f64 = 1e-3;

/// A formed sheet in the main channel's coordinates.
pub(super) struct Formed {
    /// The face that the main tool touches.
    pub tool_face: Facets,
    /// The face away from it: the same points, each moved.
    pub back_face: Facets,
    pub sheet: Sheet,
    /// Lower and upper corner of the model's face.
    pub bounds: (Vector, Vector),
    /// Height of the flat sheet's upper side, mm.
    pub flat: f64,
}

/// The formed sheet of a job; none without a sheet.
pub(super) fn of(job: &JobDocument, scene: &Scene, tolerance: f64) -> Option<Formed> {
    let (section, model_face) = (job.setup.sheet?, job.part.model_face?);
    let sheet = Sheet { thickness: section.thickness, law: section.law, model_face };
    let turned = turn_of(job, scene);
    let model = model_of(scene, turned.as_ref()).simplified(0.5 * tolerance, |_, _| false);
    let (low, high) = model.bounds();
    let rise = ((high.z - low.z) / STEPS).max(tolerance);
    let span = spacing(&model).max(tolerance);
    let is_long =
        |a: &Vector, b: &Vector| a.z.min(b.z) < high.z - FLAT && ((a.z - b.z).abs() > rise || (a - b).norm() > span);
    // the slivers of the first step become even triangles
    let model = model.divided(is_long).simplified(0.5 * tolerance, is_long);
    let (tool_face, back_face) = faces(&model, &sheet);
    let flat = if turned.is_some() { sheet.thickness - scene.flat } else { scene.flat };
    Some(Formed { tool_face, back_face, sheet, bounds: (low, high), flat })
}

/// How far apart the points of a formed sheet are at most, mm.
pub(super) fn spacing(face: &Facets) -> f64 {
    let (low, high) = face.bounds();
    (high.x - low.x).max(high.y - low.y) / SPANS
}

/// How a channel's coordinates are turned from the main one's, if they are.
pub(super) fn turn_of(job: &JobDocument, scene: &Scene) -> Option<Frame> {
    job.opposite(scene.channel).is_some().then(|| Frame::turning_up(-Vector::z(), 0.0))
}

/// The face of the sheet that the model shows, in the main channel's coordinates.
fn model_of(scene: &Scene, turned: Option<&Frame>) -> Facets {
    let mesh = &scene.mesh;
    match turned {
        // the other side of just these triangles is what the scene is made of
        Some(turned) => {
            let below = Facets::of(mesh, |_| true).placed(turned);
            let triangles = below.triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
            Facets { triangles, ..below }
        }
        None => Facets::of(mesh, |triangle| !mesh.looks_down(triangle) && !scene.rims[triangle]),
    }
}

/// The face that the tool touches and the one away from it, of a sheet whose face, middle or back the model is.
fn faces(model: &Facets, sheet: &Sheet) -> (Facets, Facets) {
    let outward = match sheet.law {
        SheetLaw::Constant => model.outward(),
        SheetLaw::Sine => vec![Vector::z(); model.points.len()],
    };
    let above = sheet.share() * sheet.thickness;
    let face = |off: f64| model.moved(|i| outward[i] * off);
    (face(above), face(above - sheet.thickness))
}

/// The body under a face of the sheet, down to a plane.
pub(super) fn die_under(back: &Facets) -> Facets {
    let (low, high) = back.bounds();
    let floor = low.z - BASE * (high.x - low.x).max(high.y - low.y);
    back.body_to(&back.moved(|i| Vector::new(0.0, 0.0, floor - back.points[i].z)))
}
