//! What the programs and the operations before one do, and what of a layer of stock they have cleared.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use styluscam_geometry::{Cutter, Tool};
use styluscam_motion::{Move, MoveKind};
use styluscam_toolpath::pocket::Cleared;

use crate::earlier::Earlier;

/// The largest angle of one piece of an arc, rad.
const TURN: f64 = 0.5 * PI;
/// Heights that differ by less are one, mm.
const SAME_LEVEL: f64 = 1e-6;

/// What runs before an operation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Before<'a> {
    /// What earlier programs cut.
    pub earlier: Option<&'a Earlier>,
    /// The moves of the operations before it in its own program, in their order.
    pub moves: &'a [Move],
    /// The tool of each of these operations.
    pub tools: &'a [&'a Tool],
}

impl Before<'_> {
    /// Whether nothing does.
    pub fn is_empty(&self) -> bool {
        self.tools.is_empty() && self.earlier.is_none()
    }

    /// What is cleared of a layer from `top` to `floor` (mm), as it looks under its top: by earlier programs, and by the operations before it
    /// where those count too.
    pub fn cleared(&self, layer: [f64; 2], do_operations_count: bool) -> Vec<Cleared> {
        let by_programs = self
            .earlier
            .map_or_else(Vec::new, |earlier| cleared(&earlier.moves, |tool| earlier.tools.get(tool as usize), layer));
        let own = do_operations_count
            .then(|| cleared(self.moves, |operation| self.tools.get(operation as usize).copied(), layer));
        by_programs.into_iter().chain(own.into_iter().flatten()).collect()
    }
}

/// The feed moves on which the tip is no higher than the floor of a layer, joined, with the tool's radius under the layer's top.
fn cleared<'a>(moves: &[Move], tool_of: impl Fn(u32) -> Option<&'a Tool>, [top, floor]: [f64; 2]) -> Vec<Cleared> {
    let mut cleared: Vec<Cleared> = Vec::new();
    let mut end = None;
    let mut cutters: BTreeMap<u32, Option<Cutter>> = BTreeMap::new();
    for pair in moves.windows(2) {
        let [before, step] = pair else { continue };
        if !(before.end.axis.is_up() && step.end.axis.is_up()) {
            continue; // what a leaning tool sweeps is no area in plan
        }
        let Some((points, highest)) = low(before.end.tip, step, floor) else { continue };
        let cutter = cutters.entry(step.operation).or_insert_with(|| tool_of(step.operation).map(Tool::cutter));
        let Some(cutter) = cutter else { continue };
        let radius = cutter.at_height(top - highest).0;
        match cleared.last_mut().filter(|_| end == Some((before.end.tip, radius))) {
            Some(path) => {
                path.points.pop();
                path.points.extend(points);
            }
            None => cleared.push(Cleared { points, radius }),
        }
        end = Some((step.end.tip, radius));
    }
    cleared
}

/// The points with bulges of a feed move no higher than a floor, as seen from above, and its greatest height, mm.
fn low(start: [f64; 3], step: &Move, floor: f64) -> Option<(Vec<[f64; 3]>, f64)> {
    let end = step.end.tip;
    let is_low = |z: f64| z <= floor + SAME_LEVEL;
    if step.kind != MoveKind::Feed || !is_low(start[2]) || !is_low(end[2]) {
        return None;
    }
    let Some(path) = step.arc.map(|arc| arc.path(start, end)) else {
        return Some((vec![[start[0], start[1], 0.0], [end[0], end[1], 0.0]], start[2].max(end[2])));
    };
    let highest = path.bounds().1[2];
    let count = libm::ceil(path.sweep().abs() / TURN).max(1.0) as usize;
    let share = |i: usize| i as f64 / count as f64;
    let mut points: Vec<[f64; 3]> = (0..count)
        .map(|i| {
            let [x, y, _] = path.at(share(i));
            [x, y, path.part(share(i), share(i + 1)).bulge()]
        })
        .collect();
    points.push([end[0], end[1], 0.0]);
    is_low(highest).then_some((points, highest))
}
