//! From a job and its part to the scene of a channel: the part turned, moved to the program's zero, and indexed.

use styluscam_geometry::{Bvh, Frame, Sheet, Vector};
use styluscam_motion::SetupRecord;
use styluscam_toolpath::offset::Index;

use crate::{faces, JobDocument, JobError, Part, Scene, Zero};

impl Scene {
    /// Turns the part and moves it to the program's zero, for one of the job's channels.
    ///
    /// # Errors
    /// A sheet that is out of range.
    pub fn new(job: &JobDocument, channel: &'static str, part: &Part) -> Result<Self, JobError> {
        let sheet = sheet(job)?;
        let raise = sheet.map_or(0.0, |s| s.raise());
        let turned = Frame::turning_up(job.setup.up.vector(), job.setup.rotation.to_radians());
        let (low, high) = part.target().bounds_in(&turned);
        let chosen = job.setup.zero.unwrap_or(if sheet.is_some() { Zero::SheetTop } else { Zero::Model });
        let zero = match chosen {
            Zero::SheetTop => Vector::new(0.0, 0.0, high.z + raise),
            Zero::Model => Vector::zeros(),
            Zero::Point(point) => point.into(),
        };
        let frame = turned.shifted(-zero);
        let mesh = part.mesh.placed(&frame);
        let sorted = || {
            // what a face is for does not change with its shape
            let target = part.shaped.as_ref().map(|shaped| shaped.target.placed(&frame));
            let target = target.as_ref().unwrap_or(&mesh);
            let rims = faces::rims(target);
            (faces::views(target, &rims), rims)
        };
        let (index, (bvh, (views, rims))) =
            rayon::join(|| Index::new(&mesh), || rayon::join(|| Bvh::new(&mesh), sorted));
        let top = high.z - zero.z + raise;
        Ok(Self {
            channel,
            index,
            bvh,
            views,
            rims,
            changes: part.changes().to_vec(),
            mesh,
            frame,
            sheet,
            fixture: job.setup.fixture,
            inward: part.inward,
            outward: part.outward,
            top,
            clearance: top + job.setup.clearance,
            retract: top + job.setup.retract,
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
            clearance: self.clearance,
            notes: Vec::new(),
        }
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
