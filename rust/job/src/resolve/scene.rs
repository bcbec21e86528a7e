//! From a job and its part to the scene of a channel: the part turned, moved to the program's zero, and indexed.

use styluscam_geometry::{Bvh, Frame, Mesh, ModelFace, Sheet, Stock, Vector};
use styluscam_motion::SetupRecord;
use styluscam_toolpath::offset::Index;

use super::stock::stock_of;
use crate::chuck::turned_over;
use crate::fixture::ClampSection;
use crate::stock::Given;
use crate::{faces, plates, shaping, Chuck, FixtureSection, JobDocument, JobError, Part, Scene, Zero};

impl Scene {
    /// Turns the part and moves it to the program's zero, for one of the job's channels.
    ///
    /// # Errors
    /// A sheet that is out of range, a stage of too many triangles.
    pub fn new(job: &JobDocument, channel: &'static str, part: &Part) -> Result<Self, JobError> {
        Self::with_stock(job, channel, part, Given::Nothing)
    }

    /// As [`new`](Self::new), with what was read for the stock, where the job states it by files.
    ///
    /// # Errors
    /// As [`new`](Self::new); a body that does not close, or out of which the part sticks; a program for another part or zero point.
    pub fn with_stock(
        job: &JobDocument,
        channel: &'static str,
        part: &Part,
        given: Given<'_>,
    ) -> Result<Self, JobError> {
        let mut scene = Self::of(job, channel, part, given)?;
        for (number, angle) in (1..).zip(shaping::stage_angles(job, part)?) {
            // a face that a stage does not have yet keeps its name
            let stage = Self::of(job, channel, &shaping::staged(job, part, angle)?, given)?;
            scene.stages.push(Self {
                stage: Some(number),
                stage_angle_deg: angle,
                views: scene.views.clone(),
                ..stage
            });
        }
        Ok(scene)
    }

    fn of(job: &JobDocument, channel: &'static str, part: &Part, given: Given<'_>) -> Result<Self, JobError> {
        let placed = Placed::new(job, part)?;
        let thickness = placed.sheet.map_or(0.0, |sheet| sheet.thickness);
        let opposite = job.opposite(channel).map(|opposite| opposite.squeeze * thickness);
        let placed = match opposite {
            Some(left) => placed.turned_over(thickness, left)?,
            None => placed,
        };
        let Placed { mesh, target, frame, sheet, fixture, flat, top, zero } = placed;
        let stock = sheet.is_none().then(|| stock_of(job, &mesh, (part.inward.max(part.outward), &frame), given));
        let stock = stock.transpose()?;
        let (stock, stock_words) = stock.unzip();
        let top = stock.as_ref().map_or(top, |stock: &Stock| stock.top.max(top));
        let sorted = || {
            // what a face is for does not change with its shape
            let target = target.as_ref().unwrap_or(&mesh);
            let rims = faces::rims(target);
            let mut views = faces::views(target, &rims);
            for (face, name) in part.names() {
                views.entry(*face).and_modify(|view| view.name = Some(name));
            }
            (views, rims)
        };
        let (index, (bvh, (views, rims))) =
            rayon::join(|| Index::new(&mesh), || rayon::join(|| Bvh::new(&mesh), sorted));
        Ok(Self {
            channel,
            index,
            bvh,
            views,
            rims,
            stage: None,
            stage_angle_deg: 0.0,
            stages: Vec::new(),
            changes: part.changes().to_vec(),
            curves: part.curves.clone(),
            mesh,
            frame,
            sheet,
            fixture,
            opposite,
            inward: if opposite.is_none() { part.inward } else { part.outward },
            outward: if opposite.is_none() { part.outward } else { part.inward },
            stock,
            stock_words: stock_words.flatten(),
            earlier: match given {
                Given::Program(earlier) => Some(earlier.clone()),
                Given::Nothing | Given::Body(_) => None,
            },
            top,
            flat,
            clearance: top + job.setup.clearance,
            retract: top + job.setup.retract,
            zero,
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

/// A part in work coordinates, with what belongs to it.
struct Placed {
    mesh: Mesh,
    /// The part before its shape was changed, where it was: the same triangles.
    target: Option<Mesh>,
    frame: Frame,
    sheet: Option<Sheet>,
    fixture: Option<FixtureSection>,
    /// Height of the face of the flat sheet that the tool comes to, mm; of the part's top without a sheet.
    flat: f64,
    /// The highest point of part and sheet, mm.
    top: f64,
    zero: String,
}

impl Placed {
    fn new(job: &JobDocument, part: &Part) -> Result<Self, JobError> {
        let sheet = sheet(job)?;
        let raise = sheet.map_or(0.0, |s| s.raise());
        let turned = job.setup.turn();
        let (low, high) = part.target().bounds_in(&turned);
        let chosen = job.setup.zero.unwrap_or(if sheet.is_some() { Zero::SheetTop } else { Zero::Model });
        let zero = match chosen {
            Zero::SheetTop => Vector::new(0.0, 0.0, high.z + raise),
            Zero::Model => Vector::zeros(),
            Zero::Point(point) => job.setup.chuck.turn().point(point.into()),
        };
        let frame = turned.shifted(-zero);
        let top = high.z - zero.z + raise;
        Ok(Self {
            mesh: part.mesh.placed(&frame),
            target: part.shaped.as_ref().map(|shaped| shaped.target.placed(&frame)),
            frame,
            sheet,
            fixture: job.setup.fixture,
            flat: top,
            top,
            zero: described(chosen, low - zero, high - zero, raise) + axes(job.setup.chuck),
        })
    }

    /// The same for the machine of a tool that comes from below: turned half about X, so that this tool comes from +Z too. Of
    /// the part there is the other side of what looked up. Of the sheet, `left` mm are between the tools; what of it is not on
    /// the main tool's side of the model is on this one's.
    fn turned_over(self, thickness: f64, left: f64) -> Result<Self, JobError> {
        let half = turned_over();
        let model = self.target.as_ref().unwrap_or(&self.mesh);
        let rims = faces::rims(model);
        let looks_up = |triangle: usize| !model.looks_down(triangle) && !rims[triangle];
        let turned = |mesh: &Mesh| {
            let side = mesh.other_side(looks_up).map_err(JobError::geometry("part.faces"))?;
            Ok::<_, JobError>(side.placed(&half))
        };
        let mesh = turned(&self.mesh)?;
        let target = self.target.as_ref().map(turned).transpose()?;
        let sheet = self.sheet.map(|sheet| Sheet {
            thickness: left - sheet.share() * thickness,
            model_face: ModelFace::Back,
            ..sheet
        });
        let fixture = self.fixture.map(|fixture| FixtureSection {
            center: fixture.center.map(|[x, y]| [x, -y]),
            clamp: fixture.backing.map(|backing| ClampSection {
                opening: backing.opening,
                height: plates::DEEP,
                follows: false,
            }),
            backing: None,
            ..fixture
        });
        Ok(Self {
            top: mesh.bounds().1.z + sheet.map_or(0.0, |sheet| sheet.raise()),
            mesh,
            target,
            frame: self.frame.then(&half),
            sheet,
            fixture,
            flat: thickness - self.flat,
            zero: match self.zero.strip_suffix(BELOW) {
                Some(above) => above.to_owned(),
                None => self.zero + BELOW,
            },
        })
    }
}

fn sheet(job: &JobDocument) -> Result<Option<Sheet>, JobError> {
    let (Some(section), Some(model_face)) = (job.setup.sheet, job.part.model_face) else { return Ok(None) };
    let sheet = Sheet { thickness: section.thickness, law: section.law, model_face };
    sheet.checked().map(Some).map_err(JobError::geometry("setup.sheet"))
}

/// What is added to the zero point's words where the tool comes from below.
const BELOW: &str = ", all turned half about X: Y and Z the other way, the tool comes from below";

/// How the machine's axes lie, in words behind the zero point's.
fn axes(chuck: Chuck) -> &'static str {
    match chuck {
        Chuck::Above => "",
        Chuck::Below => BELOW,
    }
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
