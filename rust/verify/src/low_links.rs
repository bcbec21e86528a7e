//! Rapids below the clearance height, where the job allows them: they keep a margin above what stands.
//!
//! The part, with its sheet, is measured exactly along the move, the tool lowered by the margin. What is not formed yet is the
//! sheet as it stands ([`crate::blank`]), checked with the punches; what is not cut yet is stock.

use rayon::prelude::*;
use styluscam_motion::{Cancelled, Watch};

use crate::assignment::Assignment;
use crate::body::Body;
use crate::clearance::Prober;
use crate::faults::{self, Fault};
use crate::measure::{deepest_of, gouge_level};
use crate::segments::{Segment, SegmentKind};
use crate::subject::{Limits, Subject};
use crate::tolerances::{ROUGH, SLACK};

/// The margin, mm, that a rapid below clearance has to keep, less what rounding may cost; none of other moves, where the job does
/// not allow it, and where rapids may leave the line between their ends. Straight up a rapid leaves what it has formed.
pub(crate) fn margin(segment: &Segment, assignment: &Assignment, limits: &Limits) -> Option<f64> {
    let is_low =
        segment.kind == SegmentKind::Rapid && segment.start.is_some() && segment.lowest() < limits.clearance - SLACK;
    let margin = assignment.of(segment.operation)?.low_links.filter(|_| is_low && limits.straight_rapids)?;
    // either across or down, not both at once
    (segment.travels() != segment.descends()).then_some(margin - ROUGH)
}

/// Low rapids that come nearer to the part, or to uncut stock, than their margin.
///
/// # Errors
/// `Cancelled`.
pub(crate) fn faults(
    segments: &[Segment],
    assignment: &Assignment,
    subject: &Subject,
    limits: &Limits,
    watch: &Watch,
) -> Result<Vec<Fault>, Cancelled> {
    let bodies: Vec<Body> = subject.tools.iter().map(|tool| Body::new(tool, subject.sheet.as_ref())).collect();
    let stock = subject.stock.map(|stock| stock.top);
    let fault = |segment: &Segment| {
        watch.advance(0)?;
        let Some((margin, body)) = margin(segment, assignment, limits).zip(segment.tool.and_then(|t| bodies.get(t)))
        else {
            return Ok(None);
        };
        let lowest = segment.lowest();
        if let Some(stock) = stock.filter(|stock| lowest < stock + margin) {
            return Ok(Some(segment.fault(&faults::RAPID_NEAR_STOCK).measured(lowest, stock)));
        }
        let prober = Prober { body, mesh: subject.mesh, bvh: subject.bvh };
        let found = deepest_of(&segment.raised(-margin), gouge_level(subject, limits), &prober);
        Ok(found.map(|sample| {
            let [x, y, z] = sample.tip;
            let at = [x, y, z + margin];
            Fault { position: at, ..segment.fault(&faults::RAPID_NEAR_PART) }.measured(at[2], margin)
        }))
    };
    let found: Result<Vec<Option<Fault>>, Cancelled> = segments.par_iter().with_min_len(64).map(fault).collect();
    Ok(found?.into_iter().flatten().collect())
}
