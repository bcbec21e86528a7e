//! Stock that is cleared: what the tool engages on its way, and what it leaves.
//!
//! An operation that clears works in layers: each lies between the heights of two of its level passes, the first between
//! the stock's top and the first of them. A layer is looked at in the plane just below its top, with the tool's radius there. The
//! stock is the subject's, of rest machining without what the operations before have swept; what no move of the layer has swept stands. What is measured there is the engagement angle
//! ([`crate::engagement`]); what is looked for is stock that a tool could have cleared (`rest`), by positions at which the tool is found
//! free of the part. Both know nothing of how the path was planned.

mod along;
mod before;
mod beside;
mod layer;
mod own;
mod rest;
mod to_leave;
mod work;

use styluscam_motion::{Cancelled, Program, Watch};

use crate::assignment::Assignment;
use crate::body::Body;
use crate::engaged::OperationEngagement;
use crate::expectation::{Clearing, ExpectedOperation};
use crate::faults::Fault;
use crate::findings::{Finding, FindingKind, Severity};
use crate::segments::Segment;
use crate::subject::{Limits, Subject};
use crate::tolerances::{ROUGH, SAME_LEVEL, SLACK, WIDE};

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
        let Some(work) = Work::of(operation, program, segments, assignment, subject) else { continue };
        let body = Body::new(work.tool, subject.sheet.as_ref());
        let mut along = Along::new(&work);
        work.by_layer(subject, limits, |layer| {
            let inside = layer.measured(&work.own, watch)?;
            along.add(layer, &inside, &work);
            let swept = layer.judged(&inside, watch, &mut faults)?;
            let grid = rest::Grid::new(layer);
            let free = grid.free(layer, &body, subject, watch)?;
            let reached = grid.reached(layer, &free, &swept, subject);
            findings.extend(rest::left(layer, &swept, (&grid, &reached)));
            findings.extend(beside::left(layer, &swept, (&grid, &free, &reached), &body, subject));
            if layer.clearing.left.iter().any(|left| *left > 0.0) {
                let solids = Solids { body: &body, subject, limits };
                faults.extend(to_leave::faults(layer, &work.own, (&grid, &free), &solids, watch)?);
            }
            Ok(())
        })?;
        engagement.push(along.finished());
        findings.extend(missing_levels(operation, work.clearing, &work.heights, subject));
    }
    faults.sort_by_key(|fault| fault.index);
    Ok(Judged { faults, findings, engagement })
}

/// Levels that lie farther apart than a step, and level floors of the selected faces on which there is none.
fn missing_levels(
    operation: &ExpectedOperation,
    clearing: &Clearing,
    heights: &[f64],
    subject: &Subject,
) -> Vec<Finding> {
    let id = &operation.id;
    let missing = |message: String| Finding::of_all(FindingKind::MissingLevel, Severity::Error, message);
    let all: Vec<f64> = std::iter::once(clearing.top).chain(heights.iter().copied()).collect();
    let wide = all.windows(2).filter_map(|pair| {
        let [above, below] = pair else { return None };
        let most = WIDE * clearing.pitch.at(*above) + ROUGH;
        (above - below > most).then(|| {
            missing(format!(
                "operation {id:?}: from Z{above:.3} to Z{below:.3} there is no level, and they are to be {most:.3} mm apart at \
                 most; post the job again"
            ))
        })
    });
    let [lowest, highest] = operation.expectation.heights;
    let mut floors: Vec<f64> = operation
        .expectation
        .triangles()
        .into_iter()
        .filter(|triangle| subject.mesh.normal(*triangle).z > 1.0 - SLACK)
        .map(|triangle| subject.mesh.corners(triangle)[0].z)
        .filter(|z| *z < clearing.top - ROUGH && (lowest..=highest).contains(z))
        .collect();
    floors.sort_by(f64::total_cmp);
    floors.dedup_by(|a, b| (*a - *b).abs() <= SAME_LEVEL);
    let left = clearing.left[1];
    let over = floors.into_iter().filter(|floor| floor + left < clearing.top - ROUGH).map(|floor| {
        let level = all.iter().position(|z| (-SAME_LEVEL..=ROUGH + clearing.tolerance).contains(&(z - floor - left)));
        let Some((level, above)) = level.and_then(|i| Some((all.get(i)?, all.get(i.checked_sub(1)?)?))) else {
            let on = if left > 0.0 { format!("{left:.3} mm over") } else { "on".to_owned() };
            let message = format!(
                "operation {id:?}: no level lies {on} the floor at Z{floor:.3}; post the job again, or take its face out of faces"
            );
            return Some(missing(message));
        };
        (above - level > clearing.last_layer + 3.0 * ROUGH).then(|| {
            missing(format!(
                "operation {id:?}: the last layer over the floor at Z{floor:.3} takes {:.3} mm, and is to take {:.3} mm at most; post \
                 the job again",
                above - level,
                clearing.last_layer
            ))
        })
    });
    let over: Vec<Finding> = over.flatten().collect();
    wide.chain(over).chain(above_lowest(id, clearing, heights)).collect()
}

/// That the last level lies higher than the height to which all stock is to be cleared.
fn above_lowest(id: &str, clearing: &Clearing, heights: &[f64]) -> Option<Finding> {
    let (lowest, last) = (clearing.lowest?, heights.last().copied().unwrap_or(clearing.top));
    (last > lowest + ROUGH + clearing.tolerance).then(|| {
        let message = format!(
            "operation {id:?}: the last level lies at Z{last:.3}, and stock is to be cleared down to Z{lowest:.3}; post the job again"
        );
        Finding::of_all(FindingKind::MissingLevel, Severity::Error, message)
    })
}
