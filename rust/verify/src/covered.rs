//! What passes in no known order leave of the faces that they are to cover: where the tool can touch, no more than a scallop.

use rayon::prelude::*;
use styluscam_motion::{Cancelled, Watch};

use crate::assignment::Assignment;
use crate::body::Body;
use crate::clearance::Prober;
use crate::coverage::{Sweep, Sweeps};
use crate::expectation::{ExpectedOperation, Passes};
use crate::faults::{self, Fault};
use crate::probes::{self, Probe};
use crate::segments::{Segment, SegmentKind};
use crate::subject::{Limits, Subject};
use crate::tolerances::{ROOM, VERTICAL};

/// Points that are looked at for an operation, as for passes in an order.
const POINTS: usize = 20_000;
/// Points in a piece of work. Fixed, so that the result does not depend on the number of threads.
const CHUNK: usize = 256;
/// What may be left more than asked for: a tenth of it, and mm, for what rounding does to passes.
const MORE: f64 = 1.1;
const ROUNDED: f64 = 0.0015;
/// So many times as much is none of the part's curvature: a pass is missing, which leaves four times as much.
const SURELY: f64 = 1.6;

/// Faults of the operations whose passes are to cover their faces, at the moves beside what they leave.
pub(crate) fn faults(
    segments: &[Segment],
    assignment: &Assignment,
    subject: &Subject,
    limits: &Limits,
    watch: &Watch,
) -> Result<Vec<Fault>, Cancelled> {
    let mut faults = Vec::new();
    for operation in subject.expected {
        let Passes::Covering { scallop } = operation.expectation.passes else { continue };
        let is_own =
            |segment: &&Segment| segment.kind == SegmentKind::Lateral && assignment.is(segment.operation, operation);
        let contacts: Vec<&Segment> = segments.iter().filter(is_own).collect();
        let sweeps = Sweeps::of(&contacts, subject, operation.expectation.to_leave);
        let Some(body) = sweeps.body(operation.tool).filter(|_| !contacts.is_empty()) else { continue };
        let cover = Cover { subject, limits, operation, body, sweeps: &sweeps, contacts: &contacts, scallop };
        faults.extend(cover.faults(watch)?);
    }
    Ok(faults)
}

/// One operation, looked at.
struct Cover<'a> {
    subject: &'a Subject<'a>,
    limits: &'a Limits,
    operation: &'a ExpectedOperation,
    body: &'a Body,
    sweeps: &'a Sweeps,
    /// The operation's moves that should touch, as the sweeps number them.
    contacts: &'a [&'a Segment],
    /// What is asked for, mm.
    scallop: f64,
}

impl Cover<'_> {
    fn faults(&self, watch: &Watch) -> Result<Vec<Fault>, Cancelled> {
        let mut triangles = self.operation.expectation.triangles();
        // passes that lie side by side in plan pass upright walls at one height
        triangles.retain(|triangle| self.subject.mesh.normal(*triangle).z > VERTICAL);
        let probes = probes::spread(self.subject.mesh, &triangles, POINTS);
        watch.begin("scallops", probes.len().div_ceil(CHUNK));
        let of_chunk = |chunk: &[Probe]| {
            watch.advance(1)?;
            let mut last = None;
            Ok(chunk.iter().filter_map(|probe| self.fault(probe, &mut last)).collect())
        };
        let found: Result<Vec<Vec<Fault>>, Cancelled> = probes.par_chunks(CHUNK).map(of_chunk).collect();
        Ok(found?.concat())
    }

    /// The fault of a point that the tool can touch and at which too much is left; it belongs to the move beside it.
    fn fault(&self, probe: &Probe, last: &mut Option<(usize, Sweep)>) -> Option<Fault> {
        let expectation = &self.operation.expectation;
        let up = self.subject.mesh.normal(probe.triangle);
        let position = probe.point - self.body.farthest(up).0;
        let tip = self.body.tip(position);
        if !expectation.reaches(tip[2]) || !expectation.region.takes(self.body, position, (probe.point, up)) {
            return None;
        }
        let left = self.sweeps.left_beyond(probe.point, self.allowed(MORE), position, last)?;
        let prober = Prober { body: self.body, mesh: self.subject.mesh, bvh: self.subject.bvh };
        if prober.at(position, None).is_some_and(|touch| touch.value < -ROOM) {
            return None; // bridged
        }
        let beside = self.contacts.get(last.as_ref()?.1.segment)?.fault(&faults::SCALLOP);
        let fault = Fault { position: tip, ..beside }.measured(left, self.scallop);
        Some(if left > self.allowed(SURELY) { fault } else { fault.warning() })
    }

    /// What may be left, mm, where the scallop is so many times the one asked for.
    fn allowed(&self, times: f64) -> f64 {
        let off = self.limits.excess.unwrap_or(0.0) + self.subject.deviation_outward;
        times * self.scallop + off + ROUNDED
    }
}
