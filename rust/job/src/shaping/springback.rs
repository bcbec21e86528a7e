//! Springback: the part is formed bent the other way by what it was measured, or simulated, to spring back.
//!
//! P' = P - c (sum of d_i(P)): d_i is how far the i-th formed part deviates from the target, at points of the target.

use std::collections::BTreeMap;
use std::sync::Arc;

use rayon::prelude::*;
use styluscam_geometry::{warped, DisplacementField, Frame, Mesh, Vector};

use super::compensation::Compensation;
use super::SpringbackSection;
use crate::faces;
use crate::operations::Fact;
use crate::part::Undone;
use crate::resolve::faces_in;
use crate::{JobDocument, JobError, Part, Shaped};

const SECTION: &str = "part.springback";

/// Sheets spring back by millimetres. What is more than this share of the part's diagonal is positions, or in another unit.
const LARGEST: f64 = 0.2;
/// Share of a face that may be turned to face down and is no undercut: as where faces are named.
const LEAST_UNDERCUT: f64 = 5e-3;

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

/// The part bent the other way.
pub fn compensated(
    job: &JobDocument,
    section: &SpringbackSection,
    part: &Part,
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
    let frame = job.setup.turn();
    let plane = part.mesh.bounds_in(&frame).1.z;
    let spacing = deviations.iter().map(DisplacementField::spacing).fold(f64::INFINITY, f64::min);
    let (factor, max_gap, up) = (section.factor, section.max_gap, job.setup.to_spindle());
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
    let undone = Undone::Springback(compensation);
    let shaped = Some(Shaped {
        target: warped.source,
        facts,
        linear: warped.linear,
        undone,
        names: Vec::new(),
        trim: Vec::new(),
    });
    Ok(Part { mesh: warped.mesh, inward, outward, shaped, curves: Arc::default() })
}

fn not_absurd(index: usize, field: &DisplacementField, diagonal: f64) -> Result<(), JobError> {
    if field.largest() <= LARGEST * diagonal {
        return Ok(());
    }
    let message = format!("it reaches {:.3} mm, on a part of {diagonal:.3} mm", field.largest());
    let hint = "give measured minus target, not positions, with its unit, in the frame of the part's file";
    Err(JobError::document("too-large", format!("{SECTION}.deviations[{index}]"), message, hint))
}

fn folded(at: Vector) -> JobError {
    let message = format!(
        "compensated, the part would be turned inside out at X{:.3} Y{:.3} Z{:.3} of its file: the deviation changes by more \
         than a distance over that distance",
        at.x, at.y, at.z
    );
    JobError::document(
        "folded",
        SECTION,
        message,
        "smooth the deviation there, let it reach beyond the part or further (max_gap), or lower factor",
    )
}

/// the target and the formed part as they lie under the tool.
struct Lying {
    target: Mesh,
    formed: Mesh,
    rims: Vec<bool>,
}

impl Lying {
    fn new(target: &Mesh, formed: &Mesh, frame: &Frame) -> Self {
        let (target, formed) = (target.placed(frame), formed.placed(frame));
        let rims = faces::rims(&target);
        Self { target, formed, rims }
    }

    /// The triangles that some operation is for.
    fn selected(&self, job: &JobDocument) -> Result<Vec<bool>, JobError> {
        let views = faces::views(&self.target, &self.rims);
        let mut selected = vec![false; self.rims.len()];
        for (index, operation) in job.operations.iter().enumerate() {
            let faces = faces_in(job, &views, operation, index)?;
            for (triangle, is_selected) in selected.iter_mut().enumerate() {
                let is_formed = !self.rims[triangle] && !self.target.looks_down(triangle);
                *is_selected |= is_formed && faces.binary_search(&self.target.faces()[triangle]).is_ok();
            }
        }
        Ok(selected)
    }

    /// No face may be turned to face down.
    fn require_no_undercut(&self, is_allowed: bool) -> Result<(), JobError> {
        let before = faces::views(&self.target, &self.rims);
        let mut turned: BTreeMap<u32, f64> = BTreeMap::new();
        let is_new = |t: usize| self.formed.looks_down(t) && !self.target.looks_down(t) && !self.rims[t];
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

/// What was compensated: where `points` of the target are formed.
fn facts(points: &[Vector], formed: &[Vector], compensation: &Compensation, reached: f64) -> Vec<Fact> {
    let pairs = || points.iter().zip(formed);
    let moved = pairs().map(|(point, formed)| (formed - point).norm()).fold(0.0, f64::max);
    let on_plane = pairs().filter(|(_, formed)| compensation.is_on_plane(**formed));
    let above = on_plane.map(|(point, _)| compensation.above(compensation.moved(*point))).fold(0.0, f64::max);
    let words = format!("springback compensated, factor {}, by up to", compensation.factor);
    let mut facts = vec![
        Fact::length("springback", moved, &words),
        Fact::length("springback_gap", reached, "springback measured within"),
    ];
    if above > 0.0 {
        let words = "springback left as it is above the sheet's plane, of up to";
        facts.push(Fact::length("springback_above_sheet", above, words));
    }
    facts
}
