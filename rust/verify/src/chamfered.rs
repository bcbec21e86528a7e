//! Edges that are chamfered: the cone takes of the part what its chamfers take, no more and no less.
//!
//! No more: feeds of such an operation are measured against the part with these edges chamfered, as all others are against the part
//! itself. No less: the two lines in which each chamfer ends are followed, and what the moving tool leaves over them is measured; where
//! it leaves too much, a tool is put where it would make them. Is that free, then a pass is missing, else the edge is not reached.
//!
//! The method: `docs/concepts/chamfers.md`.

use std::collections::BTreeMap;

use styluscam_geometry::{ChamferEdge, Vector};
use styluscam_motion::{Cancelled, Watch};

use crate::clearance::Prober;
use crate::coverage::Sweeps;
use crate::expectation::{ChamferedEdge, Chamfering};
use crate::faults::{self, Fault};
use crate::findings::{Finding, FindingKind, Severity};
use crate::holding::{colliders, Collider};
use crate::made::Shapes;
use crate::measure::{deepest_of, gouge_level};
use crate::segments::{Segment, SegmentKind};
use crate::subject::{Limits, Subject};
use crate::tolerances::SLACK;

/// Points of an edge that are looked at lie so far apart at most, mm.
const APART: f64 = 0.25;
/// Points of a piece of an edge at most: of longer ones they lie farther apart.
const MOST: usize = 4000;
/// Less of an edge is no length, mm.
const NOTHING: f64 = 0.02;

/// What is found of operations that chamfer edges.
#[derive(Default)]
pub(crate) struct Judged {
    pub faults: Vec<Fault>,
    pub findings: Vec<Finding>,
}

/// Looks at the operations that chamfer edges, in the order of the job's.
///
/// # Errors
/// `Cancelled` when the watch is cancelled.
pub(crate) fn judged(
    segments: &[Segment],
    (subject, shapes): (&Subject, &Shapes),
    limits: &Limits,
    watch: &Watch,
) -> Result<Judged, Cancelled> {
    let mut judged = Judged::default();
    for (number, operation) in subject.expected.iter().enumerate() {
        let Some(chamfering) = operation.expectation.chamfering() else { continue };
        let own: Vec<&Segment> = segments.iter().filter(|segment| segment.expected == Some(number)).collect();
        let Some(last) = own.last() else { continue }; // that the operation is missing is found by itself
        let feeds: Vec<&Segment> = own.iter().copied().filter(|s| s.kind == SegmentKind::Lateral).collect();
        let sweeps = Sweeps::of(&feeds, subject, [0.0; 2]);
        let Some(body) = sweeps.body(operation.tool) else { continue };
        let (mesh, bvh) = shapes.at(number).unwrap_or((subject.mesh, subject.bvh));
        let level = gouge_level(subject, limits);
        let look = Look {
            chamfering,
            subject,
            limits,
            sweeps: &sweeps,
            prober: Prober { body, mesh, bvh },
            excess: limits.excess_of(last.operation).unwrap_or(0.0),
            lowest: operation.expectation.heights[0] - SLACK,
            above: subject.tools.get(operation.tool).map_or_else(Vec::new, |tool| colliders(tool, subject, level)),
        };
        judged.faults.extend(own.iter().filter_map(|segment| look.plunge(segment)));
        let mut unreached = BTreeMap::new();
        for piece in &chamfering.edges {
            watch.advance(0)?;
            judged.faults.extend(look.along(piece, (&feeds, last), &mut unreached));
        }
        judged.findings.extend(not_reached(&unreached));
    }
    Ok(judged)
}

struct Look<'a> {
    chamfering: &'a Chamfering,
    subject: &'a Subject<'a>,
    limits: &'a Limits,
    sweeps: &'a Sweeps,
    /// The tool at the part as it is to be made.
    prober: Prober<'a>,
    /// What may be left, mm.
    excess: f64,
    /// The lowest height of the tip, mm.
    lowest: f64,
    /// What is above the tool's profile, and what it must not come near.
    above: Vec<Collider<'a>>,
}

impl Look<'_> {
    /// That the tool comes straight down into the part as it was before.
    fn plunge(&self, segment: &Segment) -> Option<Fault> {
        if segment.kind != SegmentKind::Plunge {
            return None;
        }
        let level = gouge_level(self.subject, self.limits);
        let part = Prober { mesh: self.subject.mesh, bvh: self.subject.bvh, ..self.prober };
        let deepest = deepest_of(segment, level - SLACK, &part)?;
        Some(segment.fault(&faults::PLUNGE_ONTO_EDGE).measured(-deepest.touch.value, 0.0))
    }

    /// The worst that is left on a piece of an edge, where the tool can reach it; where it cannot, its length by its name.
    fn along<'p>(
        &self,
        piece: &'p ChamferedEdge,
        (feeds, last): (&[&Segment], &Segment),
        unreached: &mut BTreeMap<&'p str, (f64, Vector)>,
    ) -> Option<Fault> {
        let (edge, length) = (&piece.edge, piece.edge.length());
        let count = ((length / APART).ceil() as usize).clamp(2, MOST);
        let lines = edge.lines(self.chamfering.size);
        let limit = self.excess + SLACK;
        let mut worst: Option<Fault> = None;
        let mut hint = None;
        for i in 0..count {
            let share = (i as f64 + 0.5) / count as f64;
            let at = edge.ends[0] + (edge.ends[1] - edge.ends[0]) * share;
            let ends = lines.map(|line| at + line).into_iter().filter(|point| edge.is_between_miters(*point));
            let left = ends.map(|point| self.sweeps.left(point, &mut hint)).fold(f64::NEG_INFINITY, f64::max);
            let left = (left + self.subject.deviation_outward).min(self.chamfering.size.width);
            if left <= limit {
                continue;
            }
            if !self.is_free(edge, at) {
                let (sum, _) = unreached.entry(&piece.name).or_insert((0.0, at));
                *sum += length / count as f64;
                continue;
            }
            if worst.is_none_or(|worst| left > worst.weight) {
                let near = hint.as_ref().and_then(|(_, sweep)| feeds.get(sweep.segment)).copied().unwrap_or(last);
                let fault = near.fault(&faults::EDGE_LEFT).measured(left, self.excess);
                worst = Some(Fault { position: at.into(), weight: left, ..fault });
            }
        }
        worst
    }

    /// Whether a tool that makes the chamfer at a point of an edge stays out of all else.
    fn is_free(&self, edge: &ChamferEdge, at: Vector) -> bool {
        let Chamfering { size, tip_below, beside, .. } = *self.chamfering;
        // the triangles may lie inside of the part
        let beside = beside + self.subject.deviation_inward / libm::cos(size.half_angle);
        let tip = at - beside * edge.inward - tip_below * Vector::z();
        let keeps = |prober: &Prober<'_>, least: f64| {
            let touch = prober.at(prober.body.position(tip.into()), None);
            touch.is_none_or(|touch| touch.value > least - SLACK)
        };
        tip.z >= self.lowest
            && keeps(&self.prober, gouge_level(self.subject, self.limits))
            && self.above.iter().all(|collider| keeps(&collider.prober(), collider.least))
    }
}

/// What of the edges is not reached, by their names.
fn not_reached(unreached: &BTreeMap<&str, (f64, Vector)>) -> Option<Finding> {
    named_edges(unreached, "are not chamfered, for the tool would enter what is beside them")
}

/// Lengths of edges, each with a position on it, of which something is so.
pub(crate) fn named_edges(unreached: &BTreeMap<&str, (f64, Vector)>, what: &str) -> Option<Finding> {
    let all: Vec<_> = unreached.iter().filter(|(_, (length, _))| *length > NOTHING).collect();
    let (_, (_, first)) = all.first()?;
    let sum: f64 = all.iter().map(|(_, (length, _))| length).sum();
    let named: Vec<String> = all.iter().map(|(name, (length, _))| format!("{name} ({length:.2} mm)")).collect();
    let message = format!("{sum:.2} mm of the edges {what}: {}", named.join(", "));
    let finding = Finding::of_all(FindingKind::Unreached, Severity::Warning, message);
    Some(Finding { position: Some((*first).into()), length_mm: sum, value_mm: Some(sum), value: Some(sum), ..finding })
}
