//! Springback: the part is formed bent the other way by what it was measured, or simulated, to spring back.
//!
//! P' = P - c (sum of d_i(P)): d_i is how far the i-th formed part deviates from the one that is wanted, at the wanted part's points.

use std::collections::BTreeMap;
use std::sync::Arc;

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_geometry::{warped, DisplacementField, Frame, Mesh, Vector};

use super::Shaped;
use crate::faces;
use crate::operations::Fact;
use crate::resolve::faces_in;
use crate::{JobDocument, JobError, Part, Units};

const SECTION: &str = "part.springback";

/// Sheets spring back by millimetres. What is more than this share of the part's diagonal is positions, or in another unit.
const LARGEST: f64 = 0.2;
/// Share of a face that may be turned to face down and is no undercut: as where faces are named.
const LEAST_UNDERCUT: f64 = 5e-3;
/// Steps back from a formed point to the wanted one at most: each leaves the deviation's gradient of the error, and 0.3 to the 20th
/// is 3e-11.
const STEPS: usize = 20;
/// A step that leads no farther than this, mm, is the last.
const ARRIVED: f64 = 1e-9;
/// Points that lie no deeper than this under the sheet's plane are on it, mm: the rounding of arithmetic.
const ON_PLANE: f64 = 1e-6;

/// What formed parts were measured, or simulated, to deviate by; the part is formed the other way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpringbackSection {
    /// One entry for each trial, in their order; each trial was formed with the entries before it compensated. A table
    /// ("trial-1.csv": x, y, z, dx, dy, dz at points of this part, d being measured minus wanted), or two meshes with the same
    /// triangles: { wanted = "cup.stl", measured = "scan.stl" }. In the frame of the part's file.
    pub deviations: Vec<Deviation>,
    /// Share of the deviations that is compensated, above 0 to 1.
    #[serde(default = "whole")]
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0.0, "maximum" = 1.0))]
    pub factor: f64,
    /// Unit of the tables, and of meshes whose files do not state one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub units: Option<Units>,
    /// Farthest that a position of the selected faces may lie from the nearest measured point, mm.
    #[serde(default = "max_gap")]
    #[schemars(extend("x-unit" = "mm", "exclusiveMinimum" = 0.0, "maximum" = 1000.0))]
    pub max_gap: f64,
}

/// Where a trial's deviation is read from; paths are relative to the job file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected a file's name, or { wanted = \"...\", measured = \"...\" }")]
pub enum Deviation {
    /// A table of points and deviations.
    Table(String),
    /// Two meshes with the same triangles.
    Meshes(MeshPair),
}

/// The part as it is wanted, and as it was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshPair {
    /// STL, OBJ, PLY or 3MF: the part as it is wanted.
    pub wanted: String,
    /// The same triangles as they were measured.
    pub measured: String,
}

fn whole() -> f64 {
    1.0
}

fn max_gap() -> f64 {
    5.0
}

/// Checks what the schema cannot state of the section.
///
/// # Errors
/// No deviation, a process that forms nothing.
pub fn check(job: &JobDocument) -> Result<(), JobError> {
    let Some(section) = &job.part.springback else { return Ok(()) };
    if section.deviations.is_empty() {
        let (message, hint) = ("no deviation is named", "name a table: deviations = [\"trial-1.csv\"]");
        return Err(JobError::document("empty", format!("{SECTION}.deviations"), message, hint));
    }
    let process = &job.process.process;
    if !process.as_kind().forms() {
        let message = format!("process.kind = {:?} cuts, and what is cut does not spring back", process.name());
        return Err(JobError::document("conflict", SECTION, message, "remove [part.springback]"));
    }
    Ok(())
}

/// What becomes of a point.
#[derive(Clone, Debug)]
pub struct Compensation {
    fields: Arc<[DisplacementField]>,
    factor: f64,
    max_gap: f64,
    up: Vector,
    /// Height of the sheet's plane along `up`: nothing is formed above it.
    plane: f64,
}

impl Compensation {
    fn moved(&self, point: Vector) -> Vector {
        point - self.factor * self.fields.iter().map(|field| self.known(field, point)).sum::<Vector>()
    }

    /// The deviation at a point. It fades to nothing over the largest gap beyond it: what no one measured stays as it is, and
    /// inside a block deviations of opposite walls do not meet.
    fn known(&self, field: &DisplacementField, point: Vector) -> Vector {
        let (deviation, gap) = field.at(point);
        let beyond = (gap / self.max_gap - 1.0).clamp(0.0, 1.0);
        deviation * (1.0 - beyond * beyond * (3.0 - 2.0 * beyond))
    }

    /// How far a position lies above the sheet's plane, mm; 0 below it.
    fn above(&self, position: Vector) -> f64 {
        (self.up.dot(&position) - self.plane).max(0.0)
    }

    /// Where a point of the wanted part is formed.
    fn formed(&self, point: Vector) -> Vector {
        let moved = self.moved(point);
        moved - self.above(moved) * self.up
    }

    /// The point of the wanted part that is formed there; none in the sheet's plane, where several may be.
    pub fn undone(&self, formed: Vector) -> Option<Vector> {
        if self.up.dot(&formed) > self.plane - ON_PLANE {
            return None;
        }
        let mut point = formed;
        for _ in 0..STEPS {
            let step = formed - self.moved(point);
            point += step;
            if step.norm() < ARRIVED {
                break;
            }
        }
        Some(point)
    }
}

/// The part bent the other way.
pub fn compensated(
    job: &JobDocument,
    section: &SpringbackSection,
    part: Part,
    deviations: Vec<DisplacementField>,
) -> Result<Part, JobError> {
    if deviations.len() != section.deviations.len() {
        let message = format!("{} of {} deviations have been read", deviations.len(), section.deviations.len());
        return Err(JobError::document("unresolved", SECTION, message, "read the job from its file"));
    }
    let (low, high) = part.mesh.bounds();
    for (index, field) in deviations.iter().enumerate() {
        not_absurd(index, field, (high - low).norm())?;
    }
    let frame = Frame::turning_up(job.setup.up.vector(), job.setup.rotation.to_radians());
    let plane = part.mesh.bounds_in(&frame).1.z;
    let spacing = deviations.iter().map(DisplacementField::spacing).fold(f64::INFINITY, f64::min);
    let (factor, max_gap, up) = (section.factor, section.max_gap, job.setup.up.vector());
    let compensation = Compensation { fields: deviations.into(), factor, max_gap, up, plane };
    let warped = warped(&part.mesh, &|point| compensation.formed(point), job.part.tolerance, spacing)
        .map_err(JobError::geometry(format!("{SECTION}.deviations")))?;
    let lying = Lying::new(&warped.source, &warped.mesh, &frame);
    if let Some(triangle) = warped.folded {
        return Err(folded(warped.source.corners(triangle)[0]));
    }
    lying.require_no_undercut(job.part.allow_undercuts)?;
    let selected = lying.selected(job)?;
    let used = corners(&warped.source, &selected);
    let points: Vec<Vector> = used.iter().map(|corner| warped.source.vertices()[*corner]).collect();
    let reached = covered(&points, &compensation.fields, max_gap)?;
    let formed: Vec<Vector> = used.iter().map(|corner| warped.mesh.vertices()[*corner]).collect();
    let facts = facts(&points, &formed, &compensation, reached);
    let [inward, outward] = [part.inward, part.outward].map(|deviation| deviation * warped.stretch);
    let shaped = Some(Shaped { target: warped.source, facts, linear: warped.linear, compensation });
    Ok(Part { mesh: warped.mesh, inward, outward, shaped })
}

fn not_absurd(index: usize, field: &DisplacementField, diagonal: f64) -> Result<(), JobError> {
    if field.largest() <= LARGEST * diagonal {
        return Ok(());
    }
    let message = format!("it reaches {:.3} mm, on a part of {diagonal:.3} mm", field.largest());
    let hint = "give measured minus wanted, not positions, with its unit, in the frame of the part's file";
    Err(JobError::document("too-large", format!("{SECTION}.deviations[{index}]"), message, hint))
}

fn folded(at: Vector) -> JobError {
    let message = format!(
        "compensated, the part would be turned inside out at X{:.3} Y{:.3} Z{:.3} of its file: the deviation changes by more \
         than a distance over that distance",
        at.x, at.y, at.z
    );
    JobError::document("folded", SECTION, message, "smooth the deviation there, or lower factor")
}

/// The wanted and the formed part as they lie under the tool.
struct Lying {
    wanted: Mesh,
    formed: Mesh,
    rims: Vec<bool>,
}

impl Lying {
    fn new(wanted: &Mesh, formed: &Mesh, frame: &Frame) -> Self {
        let (wanted, formed) = (wanted.placed(frame), formed.placed(frame));
        let rims = faces::rims(&wanted);
        Self { wanted, formed, rims }
    }

    /// The triangles that some operation is for.
    fn selected(&self, job: &JobDocument) -> Result<Vec<bool>, JobError> {
        let views = faces::views(&self.wanted, &self.rims);
        let mut selected = vec![false; self.rims.len()];
        for (index, operation) in job.operations.iter().enumerate() {
            let faces = faces_in(job, &views, operation, index)?;
            for (triangle, is_selected) in selected.iter_mut().enumerate() {
                let is_formed = !self.rims[triangle] && !self.wanted.looks_down(triangle);
                *is_selected |= is_formed && faces.binary_search(&self.wanted.faces()[triangle]).is_ok();
            }
        }
        Ok(selected)
    }

    /// No face may be turned to face down.
    fn require_no_undercut(&self, is_allowed: bool) -> Result<(), JobError> {
        let before = faces::views(&self.wanted, &self.rims);
        let mut turned: BTreeMap<u32, f64> = BTreeMap::new();
        let is_new = |t: usize| self.formed.looks_down(t) && !self.wanted.looks_down(t) && !self.rims[t];
        for triangle in (0..self.rims.len()).filter(|t| is_new(*t)) {
            *turned.entry(self.formed.faces()[triangle]).or_default() += self.formed.area(triangle);
        }
        let share = |face: &u32, area: f64| before.get(face).map_or(0.0, |view| area / view.area);
        let worst = turned.iter().map(|(face, area)| (*face, share(face, *area))).max_by(|a, b| a.1.total_cmp(&b.1));
        match worst.filter(|(_, share)| *share > LEAST_UNDERCUT && !is_allowed) {
            Some((face, share)) => {
                let message = format!(
                    "compensated, Face{face} faces down on {:.1} % of its area: no vertical tool reaches that",
                    100.0 * share
                );
                let hint = "lower factor, or set part.allow_undercuts = true to form what can be reached";
                Err(JobError::document("undercut", SECTION, message, hint))
            }
            None => Ok(()),
        }
    }
}

/// How far points lie from the nearest measured one at most, mm.
fn covered(points: &[Vector], fields: &[DisplacementField], most: f64) -> Result<f64, JobError> {
    let mut farthest = 0.0;
    for (index, field) in fields.iter().enumerate() {
        let gaps: Vec<f64> = points.par_iter().map(|point| field.gap(*point)).collect();
        let Some((at, gap)) = points.iter().zip(gaps).max_by(|a, b| a.1.total_cmp(&b.1)) else { continue };
        farthest = f64::max(farthest, gap);
        if gap > most {
            let message = format!(
                "X{:.3} Y{:.3} Z{:.3} of the selected faces lies {gap:.3} mm from its nearest point, more than max_gap = {most}",
                at.x, at.y, at.z
            );
            let hint = "measure there too, in the frame of the part's file, or raise part.springback.max_gap";
            return Err(JobError::document("gap", format!("{SECTION}.deviations[{index}]"), message, hint));
        }
    }
    Ok(farthest)
}

/// The numbers of the selected triangles' corners, each once.
fn corners(mesh: &Mesh, selected: &[bool]) -> Vec<usize> {
    let mut used = vec![false; mesh.vertices().len()];
    let of = mesh.triangles().iter().zip(selected).filter(|(_, selected)| **selected);
    of.for_each(|(corners, _)| corners.iter().for_each(|corner| used[*corner as usize] = true));
    (0..used.len()).filter(|corner| used[*corner]).collect()
}

/// What was compensated: where `points` of the wanted part are formed.
fn facts(points: &[Vector], formed: &[Vector], compensation: &Compensation, reached: f64) -> Vec<Fact> {
    let pairs = || points.iter().zip(formed);
    let moved = pairs().map(|(point, formed)| (formed - point).norm()).fold(0.0, f64::max);
    let on_plane = pairs().filter(|(_, formed)| compensation.up.dot(formed) > compensation.plane - ON_PLANE);
    let above = on_plane.map(|(point, _)| compensation.above(compensation.moved(*point))).fold(0.0, f64::max);
    let words = format!("springback compensated, factor {}, by up to", compensation.factor);
    let mut facts = vec![
        Fact::length("springback", moved, &words),
        Fact::length("springback_gap", reached, "springback measured within"),
    ];
    if above > ON_PLANE {
        let words = "springback left as it is above the sheet's plane, of up to";
        facts.push(Fact::length("springback_above_sheet", above, words));
    }
    facts
}
