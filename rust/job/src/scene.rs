//! The part as it lies on the machine: turned, moved to the program's zero, indexed.

use std::collections::{BTreeMap, HashSet};

use styluscam_geometry::{Bvh, Frame, Mesh, Sheet, Tool, ToolDocument, Vector};
use styluscam_motion::{SetupRecord, ToolRecord, ToolReference};
use styluscam_toolpath::offset::Index;

use crate::{
    faces::{self, FaceView},
    JobDocument, JobError, ToolSection, Zero,
};

/// The part as its reader hands it over.
#[derive(Clone, Debug)]
pub struct Part {
    /// Triangles in the file's frame, mm.
    pub mesh: Mesh,
    /// How far the triangles lie inside the material at most, mm; checked by the reader.
    pub inward: f64,
    /// How far they lie outside it at most, mm.
    pub outward: f64,
}

/// The part, the sheet and the zero point, ready for planning and for judging.
pub struct Scene {
    /// Triangles in work coordinates.
    pub mesh: Mesh,
    /// Their index for tools from above.
    pub index: Index,
    /// Their index for the judge.
    pub bvh: Bvh,
    /// From the file's frame to work coordinates.
    pub frame: Frame,
    /// The sheet.
    pub sheet: Option<Sheet>,
    /// How far the triangles lie inside the material at most, mm.
    pub inward: f64,
    /// How far they lie outside it at most, mm.
    pub outward: f64,
    /// The highest point of part and sheet, mm.
    pub top: f64,
    pub(crate) views: BTreeMap<u32, FaceView>,
    zero: String,
}

impl Scene {
    /// Which triangles belong to some faces and do not look down.
    pub(crate) fn looking_up(&self, faces: &[u32]) -> Vec<bool> {
        let faces: HashSet<u32> = faces.iter().copied().collect();
        // where a sheet was cut off it is upright too: no tool forms that
        let rims = if self.sheet.is_some() { faces::rims(&self.mesh) } else { vec![false; self.mesh.faces().len()] };
        let looks_up = |(triangle, face): (usize, &u32)| {
            faces.contains(face) && !self.mesh.looks_down(triangle) && !rims[triangle]
        };
        self.mesh.faces().iter().enumerate().map(looks_up).collect()
    }

    /// Height of the part's lowest point, mm.
    pub(crate) fn foot(&self) -> f64 {
        self.mesh.bounds().0.z
    }

    /// Places the part.
    ///
    /// # Errors
    /// A sheet that is out of range.
    pub fn new(job: &JobDocument, part: &Part) -> Result<Self, JobError> {
        let sheet = sheet(job)?;
        let raise = sheet.map_or(0.0, |s| s.raise());
        let turned = Frame::turning_up(job.setup.up.vector(), job.setup.rotation.to_radians());
        let (low, high) = part.mesh.placed(&turned).bounds();
        let chosen = job.setup.zero.unwrap_or(if sheet.is_some() { Zero::SheetTop } else { Zero::Model });
        let zero = match chosen {
            Zero::SheetTop => Vector::new(0.0, 0.0, high.z + raise),
            Zero::Model => Vector::zeros(),
            Zero::Point(point) => point.into(),
        };
        let frame = turned.shifted(-zero);
        let mesh = part.mesh.placed(&frame);
        let (index, (bvh, views)) =
            rayon::join(|| Index::new(&mesh), || rayon::join(|| Bvh::new(&mesh), || faces::views(&mesh)));
        Ok(Self {
            index,
            bvh,
            views,
            mesh,
            frame,
            sheet,
            inward: part.inward,
            outward: part.outward,
            top: high.z - zero.z + raise,
            zero: described(chosen, low - zero, high - zero, raise),
        })
    }

    /// The record of the set-up that travels with a program.
    #[must_use]
    pub fn record(&self, job: &JobDocument) -> SetupRecord {
        let (low, high) = self.mesh.bounds();
        // arithmetic's last bits are nobody's measure, and -0 is none at all
        let plain = |corner: Vector| <[f64; 3]>::from(corner).map(|x| (x * 1e9).round() / 1e9 + 0.0);
        SetupRecord {
            title: if job.title.is_empty() { job.part.file.clone() } else { job.title.clone() },
            wcs: job.setup.wcs.clone(),
            zero: self.zero.clone(),
            part_min: plain(low),
            part_max: plain(high),
            clearance: self.clearance(job),
            notes: Vec::new(),
        }
    }

    /// Height at which rapids cross, work coordinates, mm.
    #[must_use]
    pub fn clearance(&self, job: &JobDocument) -> f64 {
        self.top + job.setup.clearance
    }
}

fn sheet(job: &JobDocument) -> Result<Option<Sheet>, JobError> {
    let (Some(section), Some(model_face)) = (job.setup.sheet, job.part.model_face) else { return Ok(None) };
    let sheet = Sheet { thickness: section.thickness, law: section.law, model_face };
    sheet.checked().map(Some).map_err(JobError::geometry("setup.sheet"))
}

/// The zero point in words that a person at the machine can check.
fn described(zero: Zero, low: Vector, high: Vector, raise: f64) -> String {
    let from_top = high.z + raise;
    match zero {
        Zero::SheetTop => {
            format!(
                "XY model origin ({:.3} from the part's left, {:.3} from its front), Z top of the sheet",
                0.0 - low.x,
                0.0 - low.y
            )
        }
        Zero::Model => format!("model origin: {from_top:.3} below the highest point"),
        Zero::Point([x, y, z]) => {
            format!("model point {x} {y} {z}: {from_top:.3} below the highest point")
        }
    }
}

/// The checked tools of a job, by name, and their records.
pub fn tools(job: &JobDocument) -> Result<BTreeMap<String, (Tool, ToolRecord)>, JobError> {
    job.tools.iter().map(|(name, section)| Ok((name.clone(), tool(name, section, job)?))).collect()
}

fn tool(name: &str, section: &ToolSection, job: &JobDocument) -> Result<(Tool, ToolRecord), JobError> {
    let Some(profile) = section.profile.clone() else {
        let place = format!("tools.{name}.library");
        let message = "the tool's file or library has not been read";
        return Err(JobError::document("unresolved", place, message, "read the job from its file, or give a profile"));
    };
    let document = ToolDocument {
        profile,
        base: section.base,
        shank_diameter: section.shank_diameter,
        length: section.length,
        holder: section.holder,
    };
    let tool = Tool::new(document).map_err(JobError::geometry(format!("tools.{name}")))?;
    let reference_height = match section.reference {
        ToolReference::Tip => 0.0,
        ToolReference::Center => tool.center_height().ok_or_else(|| {
            JobError::document(
                "conflict",
                format!("tools.{name}.reference"),
                format!("reference = \"center\": a {} has no centre", tool.description()),
                "write reference = \"tip\"",
            )
        })?,
    };
    let (_, profile_height) = tool.point_at(tool.profile().max_slope());
    let long = section.length.unwrap_or(f64::INFINITY);
    if let Some(sheet) = job.setup.sheet.filter(|s| s.thickness >= long.min(profile_height.max(tool.diameter()))) {
        return Err(JobError::document(
            "conflict",
            "setup.sheet.thickness",
            format!(
                "thickness = {}: the sheet is thicker than tool {name} ({}) is long",
                sheet.thickness,
                tool.description()
            ),
            "give the thickness in mm, or a longer tool",
        ));
    }
    let record = ToolRecord {
        name: name.to_owned(),
        number: section.number,
        length_offset: section.length_offset.unwrap_or(section.number),
        description: tool.description(),
        reference: section.reference,
        reference_height,
        diameter: tool.diameter(),
    };
    Ok((tool, record))
}
