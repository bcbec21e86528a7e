//! Levels that are missing: farther apart than a step, on level floors, and at the height to which all stock is to be cleared.
//!
//! Of rest machining, where all stock is cleared, and of stock that is a body or what a program left, only those on which there is stock left
//! that the tool reaches: others have nothing to clear.

use styluscam_motion::{Cancelled, Watch};

use super::layer::Layer;
use super::rest::{left, Grid};
use super::work::Work;
use crate::body::Body;
use crate::expectation::Clearing;
use crate::findings::{Finding, FindingKind, Severity};
use crate::subject::{Limits, Subject};
use crate::tolerances::{ROUGH, SAME_LEVEL, WIDE};

/// Of smaller floors, in squares of the tool's radius, only those are to have a level over which the tool's axis gets: among the triangles
/// of curved faces some are level.
const SMALL: f64 = 0.5;

/// Floors are level up to a slope of 1e-4, in the cosine of their normal: where curved faces turn over, triangles that slope by more lie
/// as well, and no level is theirs.
const LEVEL: f64 = 5e-9;

/// Stock over a floor, and over what stays on it, that is no thicker is no layer, mm.
const NO_LAYER: f64 = 0.02;

/// A level that is missing.
struct Missing {
    finding: Finding,
    /// The layers that the levels would have cleared, from the top down, mm.
    layers: Vec<[f64; 2]>,
    /// Triangles of the floor that it would have been for.
    floor: Vec<usize>,
}

/// The findings of levels that are missing.
pub(super) fn missing(
    work: &Work<'_>,
    body: &Body,
    subject: &Subject,
    limits: &Limits,
    watch: &Watch,
) -> Result<Vec<Finding>, Cancelled> {
    let mut findings = Vec::new();
    for Missing { finding, layers, floor } in
        wide(work).into_iter().chain(over_floors(work, subject)).chain(above_lowest(work))
    {
        let is_everywhere = work.is_even && !(work.clearing.rest || work.clearing.all);
        let mut is_owed = is_everywhere || layers.is_empty();
        for layer in layers {
            is_owed =
                is_owed || work.in_layer(layer, limits, |layer| has_stock(layer, &floor, body, subject, watch))?;
        }
        findings.extend(is_owed.then_some(finding));
    }
    Ok(findings)
}

/// Whether there is stock in a layer that the tool reaches; of a floor, over it.
fn has_stock(
    layer: &Layer<'_>,
    floor: &[usize],
    body: &Body,
    subject: &Subject,
    watch: &Watch,
) -> Result<bool, Cancelled> {
    let grid = Grid::new(layer);
    let free = grid.free(layer, body, subject, watch)?;
    let mut reached = grid.reached(layer, &free, &[], subject);
    if !floor.is_empty() {
        let area: f64 = floor.iter().map(|triangle| subject.mesh.area(*triangle)).sum();
        let beside = if area < SMALL * layer.radius * layer.radius { 0.0 } else { layer.radius };
        let over = grid.over(floor.iter().copied(), beside, subject);
        reached.iter_mut().zip(over).for_each(|(reached, over)| *reached &= over);
    }
    Ok(left(layer, &[], (&grid, &reached)).is_some())
}

fn finding(message: String) -> Finding {
    Finding::of_all(FindingKind::MissingLevel, Severity::Error, message)
}

/// The heights of the stock and of all levels.
fn all_heights(work: &Work<'_>) -> Vec<f64> {
    std::iter::once(work.clearing.top).chain(work.heights.iter().copied()).collect()
}

/// Layers a step thick from one height down to another.
fn stepped(clearing: &Clearing, [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
    let below = |top: f64| Some([top, (top - clearing.pitch.at(top)).max(to)]).filter(|_| top > to + SAME_LEVEL);
    std::iter::successors(below(from), |[_, floor]| below(*floor)).collect()
}

/// Levels that lie farther apart than a step.
fn wide(work: &Work<'_>) -> Vec<Missing> {
    let (id, clearing) = (&work.operation.id, work.clearing);
    all_heights(work)
        .windows(2)
        .filter_map(|pair| {
            let [above, below] = pair else { return None };
            let most = WIDE * clearing.pitch.at(*above) + ROUGH;
            let mut layers = stepped(clearing, [*above, *below]);
            layers.pop(); // the level below clears it
            (above - below > most).then(|| {
                let message = format!(
                    "operation {id:?}: from Z{above:.3} to Z{below:.3} there is no level, and they are to be {most:.3} mm apart at \
                     most; post the job again"
                );
                Missing { finding: finding(message), layers, floor: Vec::new() }
            })
        })
        .collect()
}

/// Level floors of the selected faces on which there is none, or over which the last layer is too thick.
fn over_floors(work: &Work<'_>, subject: &Subject) -> Vec<Missing> {
    let Work { operation, clearing, .. } = work;
    let (id, all) = (&operation.id, all_heights(work));
    let [lowest, highest] = operation.expectation.heights;
    let height = |triangle: usize| subject.mesh.corners(triangle)[0].z;
    let mut level: Vec<usize> = operation
        .expectation
        .triangles()
        .into_iter()
        .filter(|triangle| subject.mesh.normal(*triangle).z >= 1.0 - LEVEL)
        .filter(|triangle| height(*triangle) < clearing.top - ROUGH && (lowest..=highest).contains(&height(*triangle)))
        .collect();
    level.sort_by(|a, b| height(*a).total_cmp(&height(*b)));
    let floors = level.chunk_by(|a, b| height(*b) - height(*a) <= SAME_LEVEL);
    let floors = floors.map(|floor| (floor.first().map_or(clearing.top, |triangle| height(*triangle)), floor));
    let left = clearing.left[1];
    let allowed = ROUGH + clearing.tolerance;
    let over = floors.filter(|(floor, _)| floor + left < clearing.top - NO_LAYER).map(|(floor, triangles)| {
        let level = all.iter().position(|z| (-SAME_LEVEL..=allowed).contains(&(z - floor - left)));
        let Some((level, above)) = level.and_then(|i| Some((all.get(i)?, all.get(i.checked_sub(1)?)?))) else {
            let on = if left > 0.0 { format!("{left:.3} mm over") } else { "on".to_owned() };
            let message = format!(
                "operation {id:?}: no level lies {on} the floor at Z{floor:.3}; post the job again, or take its face out of faces"
            );
            let height = floor + left + clearing.tolerance;
            let top = (height + clearing.pitch.at(height)).min(clearing.top);
            return Some(Missing {
                finding: finding(message),
                layers: vec![[top, height]],
                floor: triangles.to_vec(),
            });
        };
        (above - level > clearing.last_layer + 3.0 * ROUGH).then(|| {
            let message = format!(
                "operation {id:?}: the last layer over the floor at Z{floor:.3} takes {:.3} mm, and is to take {:.3} mm at most; post \
                 the job again",
                above - level,
                clearing.last_layer
            );
            Missing { finding: finding(message), layers: Vec::new(), floor: Vec::new() }
        })
    });
    over.flatten().collect()
}

/// That the last level lies higher than the height to which all stock is to be cleared.
fn above_lowest(work: &Work<'_>) -> Option<Missing> {
    let (id, clearing) = (&work.operation.id, work.clearing);
    let (lowest, last) = (clearing.lowest?, work.heights.last().copied().unwrap_or(clearing.top));
    (last > lowest + ROUGH + clearing.tolerance).then(|| {
        let message = format!(
            "operation {id:?}: the last level lies at Z{last:.3}, and stock is to be cleared down to Z{lowest:.3}; post the job again"
        );
        Missing { finding: finding(message), layers: stepped(clearing, [last, lowest]), floor: Vec::new() }
    })
}
