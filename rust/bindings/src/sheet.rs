//! Names of a sheet's faces.

use pyo3::prelude::*;
use styluscam_geometry::ModelFace;

use crate::errors::raise;

/// The sheet's faces.
const FACES: [ModelFace; 3] = [ModelFace::Tool, ModelFace::Mid, ModelFace::Back];

/// A face of the sheet by its name.
pub fn sheet_face(name: &str) -> PyResult<ModelFace> {
    FACES.into_iter().find(|face| face_name(*face) == name).ok_or_else(|| {
        let message = format!("face = {name:?}: \"tool\", \"mid\" or \"back\" expected");
        raise("GeometryError", &message, "out-of-range", "face", "")
    })
}

/// The name of a face of the sheet.
pub fn face_name(face: ModelFace) -> &'static str {
    match face {
        ModelFace::Tool => "tool",
        ModelFace::Mid => "mid",
        ModelFace::Back => "back",
    }
}
