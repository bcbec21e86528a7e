//! The part as it lies on the machine: turned, moved to the program's zero, indexed.

use std::collections::{BTreeMap, HashSet};
use std::sync::Arc;

use styluscam_geometry::{Bvh, Frame, Mesh, Sheet, Stock};
use styluscam_toolpath::offset::Index;

use crate::earlier::Earlier;
use crate::faces::FaceView;
use crate::operations::Fact;
use crate::{Curves, FixtureSection};

/// The part, the sheet and the zero point of one channel, ready for planning and for verification.
pub struct Scene {
    /// The channel whose programs are in these coordinates.
    pub channel: &'static str,
    /// Triangles in work coordinates.
    pub mesh: Mesh,
    /// Their index for tools from above.
    pub index: Index,
    /// Their index for the verifier.
    pub bvh: Bvh,
    /// From the file's frame to work coordinates.
    pub frame: Frame,
    /// The sheet.
    pub sheet: Option<Sheet>,
    /// How far the triangles lie inside the material at most, mm.
    pub inward: f64,
    /// How far they lie outside it at most, mm.
    pub outward: f64,
    /// What holds the sheet.
    pub fixture: Option<FixtureSection>,
    /// Of a tool that comes from the other side of the sheet: the sheet left between it and the main tool, mm, by the sheet's law
    /// along the normal or the vertical.
    pub opposite: Option<f64>,
    /// What the part is cut from; none where a sheet is formed.
    pub stock: Option<Stock>,
    /// The stock in words, where the job states it.
    pub(crate) stock_words: Option<String>,
    /// What was cut of it before.
    pub(crate) earlier: Option<Arc<Earlier>>,
    /// The highest point of stock and sheet, mm.
    pub top: f64,
    /// Height of the flat sheet's face that the tool comes to, mm; of the part's top without a sheet.
    pub flat: f64,
    /// Height at which rapids cross, mm.
    pub clearance: f64,
    /// Height down to which rapids go before a plunge, mm.
    pub retract: f64,
    /// Which of the part's intermediate stages it shows, from 1; none for the part itself.
    pub stage: Option<usize>,
    /// That stage's wall angle, degrees; 0 of the part itself.
    pub stage_angle_deg: f64,
    /// The part's intermediate stages, in their order.
    pub stages: Vec<Scene>,
    /// What was changed of the part in the file.
    pub changes: Vec<Fact>,
    /// Which triangles lie where the part was cut off.
    pub(crate) rims: Vec<bool>,
    /// The curves of the part, in the file's frame.
    pub(crate) curves: Arc<Curves>,
    /// The faces of the part by their numbers.
    pub(crate) views: BTreeMap<u32, FaceView>,
    /// The zero point in words.
    pub(crate) zero: String,
}

impl Scene {
    /// What an operation with an id in the job is called in programs.
    #[must_use]
    pub fn operation_id(&self, id: String) -> String {
        match self.stage {
            Some(stage) => format!("{id}-stage-{stage}"),
            None => id,
        }
    }

    /// Which triangles belong to some faces and do not face down.
    pub(crate) fn facing_up(&self, faces: &[u32]) -> Vec<bool> {
        let faces: HashSet<u32> = faces.iter().copied().collect();
        // where a sheet was cut off it is upright too: no tool forms that
        let is_rim = |triangle: usize| self.sheet.is_some() && self.rims[triangle];
        let faces_up = |(triangle, face): (usize, &u32)| {
            faces.contains(face) && !self.mesh.looks_down(triangle) && !is_rim(triangle)
        };
        self.mesh.faces().iter().enumerate().map(faces_up).collect()
    }

    /// The steepest slope of some triangles, rad; 0 of none.
    pub(crate) fn steepest(&self, selected: &[bool]) -> f64 {
        // facets lean by their deviation: where the model's normals are known, those tell
        let slope = |t: usize| {
            let normals = self.mesh.corner_normals(t);
            normals.map(|n| libm::acos(n.z.clamp(-1.0, 1.0))).into_iter().fold(0.0, f64::max)
        };
        (0..selected.len()).filter(|t| selected[*t]).map(slope).fold(0.0, f64::max)
    }

    /// Its triangles with their index.
    pub(crate) fn solid(&self) -> (&Mesh, &Bvh) {
        (&self.mesh, &self.bvh)
    }

    /// Height of the part's lowest point, mm.
    pub(crate) fn foot(&self) -> f64 {
        self.mesh.bounds().0.z
    }
}
