//! The moves of an operation that clears, layer by layer.

use rayon::prelude::*;
use styluscam_geometry::{Stock, Tool};
use styluscam_motion::{Cancelled, Program};

use super::before::Took;
use super::layer::Layer;
use super::own::{moves_of, Own};
use crate::assignment::Assignment;
use crate::engagement::{Area, Sweeps, CHIP};
use crate::expectation::{Clearing, ExpectedOperation};
use crate::segments::{Segment, SegmentKind};
use crate::subject::{Limits, Subject};
use crate::tolerances::{SAME_LEVEL, SLACK};

/// Cells in which the outlines of the stock are listed, and radii by which what is swept is, are as large as this at least, mm.
const LEAST_CELL: f64 = 1.0;

/// An operation that clears stock, with the moves that do it.
pub(super) struct Work<'a> {
    pub operation: &'a ExpectedOperation,
    pub clearing: &'a Clearing,
    pub tool: &'a Tool,
    stock: &'a Stock,
    pub own: Vec<Own<'a>>,
    /// What took of its stock before them.
    before: Took<'a>,
    /// Whether the stock is equally wide at all heights.
    pub is_even: bool,
    /// Of its levels, from the top down, mm.
    pub heights: Vec<f64>,
}

impl<'a> Work<'a> {
    /// None of an operation that clears nothing, or has no moves, and where there is no stock.
    pub fn of(
        operation: &'a ExpectedOperation,
        program: &Program,
        segments: &'a [Segment],
        assignment: &Assignment,
        subject: &'a Subject,
        limits: &Limits,
    ) -> Option<Self> {
        let clearing = operation.expectation.clearing()?;
        let stock = subject.stock?;
        let tool = subject.tools.get(operation.tool)?;
        let segments_of = segments.iter().filter(|segment| assignment.is(segment.operation, operation));
        let own = moves_of(program, segments_of, limits.unit, 0.5 * tool.diameter());
        if own.is_empty() {
            return None;
        }
        let before = Took::of(subject.before, (segments, subject.tools), &own, clearing);
        let is_even = stock.solid().is_none() && subject.before.is_none();
        let heights = heights(&own, clearing.top);
        Some(Self { operation, clearing, tool, stock, own, before, is_even, heights })
    }

    /// What is found in each layer, by its number, from the top down.
    pub fn by_layer<T: Send>(
        &self,
        limits: &Limits,
        look: impl Fn(usize, &Layer<'_>) -> Result<T, Cancelled> + Sync,
    ) -> Result<Vec<T>, Cancelled> {
        let tops = std::iter::once(self.clearing.top).chain(self.heights.iter().copied());
        let layers: Vec<[f64; 2]> = tops.zip(&self.heights).map(|(top, floor)| [top, *floor]).collect();
        layers
            .into_par_iter()
            .enumerate()
            .map(|(number, layer)| self.in_layer(layer, limits, |layer| look(number, layer)))
            .collect()
    }

    /// Looks at what lies between two heights.
    pub fn in_layer<T>(&self, [top, floor]: [f64; 2], limits: &Limits, look: impl FnOnce(&Layer<'_>) -> T) -> T {
        let cleared = self.before.cleared([top, floor]);
        let radius = self.tool.cutter().at_height(top - floor).0;
        // heights are rounded: what is no thicker than that is none
        let outlines = self.stock.outlines_between([top - limits.unit, floor + limits.unit]);
        look(&Layer {
            stock: &outlines,
            bounds: self.stock.bounds(),
            area: &Area::new(&outlines, radius.max(LEAST_CELL)),
            cleared: &cleared,
            gone: &Sweeps::along(&cleared, 0.0, radius.max(LEAST_CELL)),
            before: &self.before,
            top,
            floor,
            radius,
            unit: limits.unit,
            chip: CHIP + 2.0 * limits.unit,
            gap: limits.rapid_gap,
            clearing: self.clearing,
            operation: self.operation,
        })
    }
}

/// The heights of the tip on level feeds, from the top down.
fn heights(own: &[Own], top: f64) -> Vec<f64> {
    let level = own.iter().filter(|own| !own.is_link && !own.descends).map(|own| own.segment);
    let level = level.filter(|segment| segment.kind == SegmentKind::Lateral && !segment.falls());
    let mut heights: Vec<f64> = level.map(|segment| segment.end[2]).filter(|z| *z < top - SLACK).collect();
    heights.sort_by(|a, b| b.total_cmp(a));
    heights.dedup_by(|a, b| (*a - *b).abs() <= SAME_LEVEL);
    heights
}
