//! Stock that is cleared: what the tool engages on its way, and what it leaves.
//!
//! An operation that clears works in layers: each lies between the heights of two of its level passes, the first between
//! the stock's top and the first of them. A layer is looked at in the plane just below its top, with the tool's radius there. The
//! stock is the subject's, without what earlier programs, and of rest machining the operations before, have swept; what no move of the layer has swept stands. What is measured there is the engagement angle
//! ([`crate::engagement`]); what is looked for is stock that a tool could have cleared (`rest`), by positions at which the tool is found
//! free of the part. Both know nothing of how the path was planned.

mod along;
mod before;
mod below;
mod beside;
mod entry_hole;
mod layer;
mod levels;
mod own;
mod rest;
mod to_leave;
mod work;

use styluscam_motion::{Cancelled, Program, Watch};

use crate::assignment::Assignment;
use crate::body::Body;
use crate::engaged::OperationEngagement;
use crate::faults::Fault;
use crate::findings::Finding;
use crate::segments::Segment;
use crate::subject::{Limits, Subject};

use along::Along;
use to_leave::Solids;
use work::Work;

/// What comes of looking at the operations that clear.
#[derive(Default)]
pub(crate) struct Judged {
    /// Of the moves that clear stock.
    pub faults: Vec<Fault>,
    /// Of what they leave.
    pub findings: Vec<Finding>,
    /// What they engage.
    pub engagement: Vec<OperationEngagement>,
}

/// Steps of a layer that are counted as done.
const STEPS: usize = 4;

/// Faults of the moves that clear stock, findings of what they leave, and what they engage.
///
/// # Errors
/// `Cancelled`.
pub(crate) fn judged(
    program: &Program,
    segments: &[Segment],
    assignment: &Assignment,
    subject: &Subject,
    limits: &Limits,
    watch: &Watch,
) -> Result<Judged, Cancelled> {
    let Judged { mut faults, mut findings, mut engagement } = Judged::default();
    for operation in subject.expected {
        let Some(work) = Work::of(operation, program, segments, assignment, subject, limits) else { continue };
        let body = Body::new(work.tool, subject.sheet.as_ref());
        let mut along = Along::new(&work);
        watch.begin("measuring the engagement", STEPS * work.heights.len());
        let layers = work.by_layer(limits, |number, layer| {
            let (inner, mut faults) = (watch.beside(), Vec::new());
            let inside = layer.measured(&work.own, &inner)?;
            watch.advance(1)?;
            let engaged = along.of_layer(number, layer, &inside, &work);
            let swept = layer.judged(&inside, &inner, &mut faults)?;
            watch.advance(1)?;
            let grid = rest::Grid::new(layer);
            let free = grid.free(layer, &body, subject, &inner)?;
            watch.advance(1)?;
            let reached = grid.reached(layer, &free, &swept, subject);
            let mut findings: Vec<Finding> = rest::left(layer, &swept, (&grid, &reached)).into_iter().collect();
            findings.extend(beside::left(layer, &swept, (&grid, &free, &reached), &body, subject));
            if layer.clearing.left.iter().any(|left| *left > 0.0) {
                let solids = Solids { body: &body, subject, limits };
                faults.extend(to_leave::faults(layer, &work.own, (&grid, &free), &solids, &inner)?);
            }
            watch.advance(1)?;
            Ok((engaged, faults, findings))
        })?;
        for (engaged, found, left) in layers {
            along.add(engaged);
            faults.extend(found);
            findings.extend(left);
        }
        engagement.push(along.finished());
        faults.extend(below::faults(&work, limits));
        findings.extend(entry_hole::missing(&work, segments, subject));
        findings.extend(levels::missing(&work, &body, subject, limits, watch)?);
    }
    faults.sort_by_key(|fault| fault.index);
    Ok(Judged { faults, findings, engagement })
}
