//! Positions of the faces that the tools cannot get to: how much the program leaves there, and on how much of the area.
//!
//! A position is looked at with the tool where it touches the position's own triangle. Where that tool is in the part elsewhere, it
//! is pushed out of it, and pulled to the position again, by turns; what lies between tool and position at best is bridged. Where it
//! cannot be pushed out, since the position lies between walls that are nearer than the tool is wide, what the program's moves
//! leave there counts. What lies between passes is no bridge: there the tool can touch.

use rayon::prelude::*;
use styluscam_geometry::{Bvh, Mesh, Sheet, Tool, Vector};
use styluscam_motion::{Cancelled, Watch};

use crate::body::Body;
use crate::clearance::Prober;
use crate::coverage::Sweeps;
use crate::expectation::{Contact, Expectation, ExpectedOperation};
use crate::findings::{Finding, FindingKind, Severity};
use crate::probes::{self, Probe};
use crate::segments::Segment;
use crate::subject::{Limits, Subject};
use crate::sweep::Guess;
use crate::tolerances::ROOM;
use crate::walls_beside::Walls;

/// Points that are looked at.
const POINTS: usize = 2000;
/// Points in a piece of work. Fixed, so that the result does not depend on the number of threads.
const CHUNK: usize = 64;
/// How often a tool is pushed out of the part, or pulled to the position.
const PUSHES: usize = 48;
/// A start is given up when so many pulls, or pushes, in a row left more than this share of what was left before.
const IN_VAIN: usize = 5;
const NEARER: f64 = 0.99;
/// A tool that looks at a point along the triangle's normal by more, a cosine, stands behind the triangle.
const BEYOND: f64 = 1e-6;

/// The findings of what cannot be reached.
///
/// # Errors
/// `Cancelled` when the watch is cancelled.
pub(crate) fn findings(
    segments: &[Segment],
    subject: &Subject,
    limits: &Limits,
    watch: &Watch,
) -> Result<Vec<Finding>, Cancelled> {
    let most = limits.bridged.min(limits.unreached_from);
    if most.is_infinite() {
        return Ok(Vec::new());
    }
    let tasks: Vec<Task> = subject.expected.iter().filter_map(|operation| Task::new(operation, subject)).collect();
    let is_selected = |triangle: &usize| tasks.iter().any(|task| task.expectation.selects(*triangle));
    let selected: Vec<usize> = (0..subject.mesh.triangles().len()).filter(is_selected).collect();
    let probes = probes::spread(subject.mesh, &selected, POINTS);
    watch.begin("reach", probes.len().div_ceil(CHUNK));
    let gaps: Result<Vec<Vec<Option<f64>>>, Cancelled> = probes
        .par_chunks(CHUNK)
        .map(|chunk| {
            watch.advance(1)?;
            Ok(chunk.iter().map(|probe| gap(&tasks, probe, subject, most)).collect())
        })
        .collect();
    let asked: Vec<(&Probe, f64)> =
        probes.iter().zip(gaps?.concat()).filter_map(|(probe, gap)| Some((probe, gap?))).collect();
    let mut positions: Vec<Spot> =
        asked.iter().filter(|(_, gap)| *gap > most).map(|(probe, gap)| Spot { probe, left: *gap }).collect();
    if !positions.is_empty() {
        let sweeps = Sweeps::of_all(segments, subject);
        let mut last = None;
        for spot in &mut positions {
            spot.left = spot.left.min(sweeps.left(spot.probe.point, &mut last));
        }
    }
    let area: f64 = selected.iter().map(|triangle| subject.mesh.area(*triangle)).sum();
    Ok(findings_of(&positions, asked.len(), area / probes.len().max(1) as f64, subject, limits))
}

/// A position that no tool can touch.
struct Spot<'a> {
    probe: &'a Probe,
    /// What is left there, mm; infinite where the program does nothing.
    left: f64,
}

/// What an operation's tool is to touch.
struct Task<'a> {
    expectation: &'a Expectation,
    body: Body,
}

impl<'a> Task<'a> {
    fn new(operation: &'a ExpectedOperation, subject: &Subject) -> Option<Self> {
        let expectation = Some(&operation.expectation).filter(|it| it.contact == Contact::Touch)?;
        Some(Self { expectation, body: subject.touching(operation)? })
    }

    /// What lies between a point and the tool, where it is as near as it can get or leaves no more than `enough`, mm; none
    /// where that is not asked for.
    fn gap(&self, probe: &Probe, subject: &Subject, enough: f64) -> Option<f64> {
        if !self.expectation.selects(probe.triangle) {
            return None;
        }
        let up = subject.mesh.normal(probe.triangle);
        let position = probe.point - self.body.farthest(up).0;
        let takes = self.expectation.region.takes(&self.body, position, (probe.point, up));
        if !takes || !self.expectation.reaches(self.body.tip(position)[2]) {
            return None;
        }
        let prober = Prober { body: &self.body, mesh: subject.mesh, bvh: subject.bvh };
        Some(nearest(&prober, (probe.point, up), position, enough))
    }
}

/// What lies between a point, given with its triangle's normal, and a tool that starts from a position, or from beside it,
/// where it is as near as it can get or leaves no more than `enough`, mm; infinite where it only stands on the other side of
/// the triangle. From one start it may end between two walls though there is space on another side.
fn nearest(prober: &Prober, point: (Vector, Vector), position: Vector, enough: f64) -> f64 {
    let radius = prober.body.radius();
    let mut least = nearest_from(prober, point, position, enough);
    for aside in [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]] {
        if least <= enough {
            break;
        }
        let start = position + radius * Vector::new(aside[0], aside[1], 0.0);
        least = least.min(nearest_from(prober, point, start, enough));
    }
    least
}

/// The same from one start: the tool is pushed out of the part and pulled to the point by turns.
fn nearest_from(prober: &Prober, (point, up): (Vector, Vector), mut position: Vector, enough: f64) -> f64 {
    let mut least = f64::INFINITY;
    let (mut pulls, mut pushes) = (Attempts::new(), Attempts::new());
    let (mut guess, mut walls) = (None, Walls::default());
    for _ in 0..PUSHES {
        let touch = prober.at(position, guess);
        guess = touch.map(|touch| Guess::like(&touch, position));
        match touch {
            Some(touch) if touch.value < -ROOM => {
                if pushes.are_in_vain(-touch.value) {
                    // between two walls that leave it no space
                    break;
                }
                walls.push(-touch.away);
                position += touch.value * touch.away;
            }
            _ => {
                let gap = prober.body.distance(point - position);
                if gap.value <= enough || gap.away.dot(&up) < BEYOND {
                    least = least.min(gap.value.max(0.0));
                }
                if least <= enough || pulls.are_in_vain(gap.value) {
                    break;
                }
                position += walls.along(gap.value * gap.away);
                walls.pulled();
                pushes = Attempts::new();
            }
        }
    }
    least
}

/// What attempts to make a distance smaller came to.
struct Attempts {
    /// The least so far, mm.
    least: f64,
    /// How many since then did not make it smaller.
    in_vain: usize,
}

impl Attempts {
    fn new() -> Self {
        Self { least: f64::INFINITY, in_vain: 0 }
    }

    /// Whether too many in a row, with this one, did not make the distance smaller.
    fn are_in_vain(&mut self, distance: f64) -> bool {
        self.in_vain = if distance < NEARER * self.least { 0 } else { self.in_vain + 1 };
        self.least = self.least.min(distance);
        self.in_vain == IN_VAIN
    }
}

/// What a tool gets to, whatever its program.
pub struct ToolReach<'a> {
    body: Body,
    mesh: &'a Mesh,
    bvh: &'a Bvh,
}

impl<'a> ToolReach<'a> {
    /// Of a tool, and a sheet under it, over a part as it lies on the machine, and the part's index.
    #[must_use]
    pub fn new(tool: &Tool, sheet: Option<&Sheet>, mesh: &'a Mesh, bvh: &'a Bvh) -> Self {
        Self { body: Body::new(tool, sheet), mesh, bvh }
    }

    /// What the tool leaves at a point of a triangle at best, or no more than `enough`, mm; infinite where it cannot stand
    /// beside the point at all.
    #[must_use]
    pub fn left(&self, triangle: usize, point: Vector, enough: f64) -> f64 {
        let prober = Prober { body: &self.body, mesh: self.mesh, bvh: self.bvh };
        let up = self.mesh.normal(triangle);
        let position = point - self.body.farthest(up).0;
        nearest(&prober, (point, up), position, enough)
    }

    /// Share of some triangles' area, 0 to 1, on which the tool leaves more than `enough` (mm) at best: looked for at
    /// `points` positions.
    #[must_use]
    pub fn share_left(&self, triangles: &[usize], points: usize, enough: f64) -> f64 {
        let probes = probes::spread(self.mesh, triangles, points);
        let is_left = |probe: &&Probe| self.left(probe.triangle, probe.point, enough) > enough;
        probes.par_iter().filter(is_left).count() as f64 / probes.len().max(1) as f64
    }
}

/// What the tool that gets nearest leaves at a point, or one that leaves `enough`, mm; none where no operation asks for it.
fn gap(tasks: &[Task], probe: &Probe, subject: &Subject, enough: f64) -> Option<f64> {
    tasks.iter().filter_map(|task| task.gap(probe, subject, enough)).min_by(f64::total_cmp)
}

fn findings_of(positions: &[Spot], asked: usize, area_each: f64, subject: &Subject, limits: &Limits) -> Vec<Finding> {
    let mut findings = Vec::new();
    let Some(worst) = positions.iter().max_by(|a, b| a.left.total_cmp(&b.left)) else { return findings };
    let face = |spot: &Spot| subject.mesh.faces().get(spot.probe.triangle).copied().unwrap_or(0);
    let left = |left: f64| if left.is_finite() { format!("{left:.3} mm") } else { "everything".to_owned() };
    let [x, y, z]: [f64; 3] = worst.probe.point.into();
    if worst.left > limits.bridged {
        let message = format!(
            "X{x:.3} Y{y:.3} Z{z:.3}: the tool does not reach into Face{}: {} are left there, and {:.3} mm may be left \
             (process.max_bridged); take a smaller tool or a larger radius there, leave the face out, or \
             accept = [\"bridged\"]",
            face(worst),
            left(worst.left),
            limits.bridged
        );
        findings.push(Finding {
            position: Some(worst.probe.point.into()),
            value_mm: Some(worst.left).filter(|left| left.is_finite()),
            value: Some(worst.left).filter(|left| left.is_finite()),
            limit: Some(limits.bridged),
            ..Finding::of_all(FindingKind::Bridged, Severity::Error, message)
        });
    }
    let unreached = positions.iter().filter(|spot| spot.left > limits.unreached_from).count();
    let share = unreached as f64 / asked.max(1) as f64;
    if share > limits.unreached {
        let [unreached, whole] = [unreached, asked].map(|points| points as f64 * area_each);
        let message = format!(
            "the tool does not reach {unreached:.1} of {whole:.1} mm2, {:.0} % of the faces: more than {:.3} mm are left there, \
             and that may be {:.0} % (process.max_unreached); take a smaller tool, leave those faces out, or \
             accept = [\"unreached\"]",
            100.0 * share,
            limits.unreached_from,
            100.0 * limits.unreached
        );
        findings.push(Finding {
            position: Some(worst.probe.point.into()),
            value: Some(share),
            limit: Some(limits.unreached),
            unit: String::new(),
            ..Finding::of_all(FindingKind::Unreached, Severity::Error, message)
        });
    }
    findings
}
