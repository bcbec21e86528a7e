//! What a starter job is written for: a part's triangles and the list of its faces.

use styluscam_geometry::Mesh;

use crate::cutting::CuttingTable;

/// What a starter job is written for.
pub struct StarterPart<'a> {
    /// The part's file, as the job should name it.
    pub file: &'a str,
    /// Its unit, where the file does not state one.
    pub units: Option<&'a str>,
    /// Its triangles, in the file's frame, mm.
    pub mesh: &'a Mesh,
    /// Its faces.
    pub faces: &'a [StarterFace],
    /// How far the file's own edges lie off its surfaces at most, mm.
    pub edge_gap: f64,
    /// What it is made of, where that is stated: by its name among the materials of the table, or of sheets.
    pub material: Option<&'a str>,
    /// Cutting data.
    pub table: &'a CuttingTable,
    /// The file with the shop's own part of them, as the job should name it.
    pub cutting_data: Option<&'a str>,
}

/// A face as the job's comment lists it.
#[derive(Clone, Debug, PartialEq)]
pub struct StarterFace {
    /// `Face1` and so on.
    pub name: String,
    /// plane, cone, ...
    pub kind: String,
    /// Area, mm^2.
    pub area: f64,
    /// Smallest and largest slope with the file's +Z up, degrees.
    pub slope_deg: [f64; 2],
}
