//! Holes that are drilled: each is gone down by feeds along its axis, to its depth, no deeper at once than a peck, and nothing
//! is drilled beside them.
//!
//! A drill as wide as its hole touches the wall all around. Triangles of a hole's wall are chords of it and lie outside of the
//! material, so a tool on the axis is measured against the hole's own radius, and against triangles less what they are off.
//!
//! The method: `docs/concepts/drilling.md`.

use crate::bored;
use crate::expectation::{DrilledHole, Drilling};
use crate::faults::{self, Fault};
use crate::opened::{Opened, Opening};
use crate::segments::{Segment, SegmentKind};
use crate::subject::{Limits, Subject};
use crate::tolerances::SLACK;

/// The hole that a move is in, of those of its operation: on its axis straight up or down, or where the hole is bored on any path.
pub(crate) fn hole_of<'a>(segment: &Segment, subject: &Subject<'a>, limits: &Limits) -> Option<&'a DrilledHole> {
    drilled_at(segment, subject, limits).or_else(|| bored::hole_of(segment, subject, limits))
}

/// The hole whose axis a straight move up or down follows.
fn drilled_at<'a>(segment: &Segment, subject: &Subject<'a>, limits: &Limits) -> Option<&'a DrilledHole> {
    let (_, drilling) = drilling_of(segment, subject)?;
    let (hole, off) = nearest(drilling, segment.end)?;
    (!segment.travels() && off <= limits.unit + SLACK).then_some(hole)
}

/// Whether it waits at the end of a move, which stands at the bottom of a hole, as long as asked.
pub(crate) fn may_wait(segment: &Segment, seconds: f64, subject: &Subject, limits: &Limits) -> bool {
    let dwell = drilling_of(segment, subject).map_or(0.0, |(_, drilling)| drilling.dwell);
    let at_bottom = |hole: &DrilledHole| (segment.end[2] - hole.bottom).abs() <= limits.unit + SLACK;
    (seconds - dwell).abs() <= WAIT && drilled_at(segment, subject, limits).is_some_and(at_bottom)
}

/// Waits that differ by less are the same, s: texts state milliseconds.
const WAIT: f64 = 1e-3;

fn drilling_of<'a>(segment: &Segment, subject: &Subject<'a>) -> Option<(usize, &'a Drilling)> {
    let number = segment.expected?;
    Some((number, subject.expected.get(number)?.expectation.drilling()?))
}

/// The nearest hole, and how far its axis lies from a position, mm.
fn nearest(drilling: &Drilling, [x, y, _]: [f64; 3]) -> Option<(&DrilledHole, f64)> {
    let off = |hole: &DrilledHole| libm::hypot(hole.at[0] - x, hole.at[1] - y);
    let all = drilling.holes.iter().map(|hole| (hole, off(hole)));
    all.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// How far a hole is drilled.
#[derive(Clone, Copy)]
struct Drilled {
    /// The lowest tip at a feed, mm; infinite before the first.
    depth: f64,
    /// Where the feed began that is going on, mm.
    from: Option<f64>,
    /// The highest tip since the last feed down, mm.
    up: f64,
}

const UNTOUCHED: Drilled = Drilled { depth: f64::INFINITY, from: None, up: f64::INFINITY };

/// Faults of the operations that drill, in the order of the job's.
pub(crate) fn faults(segments: &[Segment], subject: &Subject, limits: &Limits) -> Vec<Fault> {
    let mut faults = Vec::new();
    for (number, operation) in subject.expected.iter().enumerate() {
        let Some(drilling) = operation.expectation.drilling() else { continue };
        let own: Vec<&Segment> = segments.iter().filter(|segment| segment.expected == Some(number)).collect();
        let Some(last) = own.last() else { continue }; // that the operation is missing is found by itself
        if drilling.rises_at_feed {
            faults.extend(without_core(&own, segments, drilling, subject, limits));
        }
        let [_, top] = operation.expectation.heights;
        let stock = if top.is_finite() { top } else { f64::NEG_INFINITY };
        let mut walk = Walk { drilling, subject, limits, stock, drilled: vec![UNTOUCHED; drilling.holes.len()] };
        for segment in &own {
            faults.extend(walk.take(segment));
        }
        for (hole, drilled) in drilling.holes.iter().zip(&walk.drilled) {
            if drilled.depth > hole.bottom + limits.unit + SLACK {
                let [x, y] = hole.at;
                let fault = last.fault(&faults::MISSING_HOLE).measured(drilled.depth, hole.bottom);
                let weight = hole.top - hole.bottom;
                faults.push(Fault { position: [x, y, hole.bottom], weight, ..fault });
            }
        }
    }
    faults
}

/// Share of its radius to which a hole has to be open before it is tapped or bored: core holes of threads are wider.
const CORE: f64 = 0.6;

/// The faults of holes that are tapped or bored, which cuts no hole into what is solid, and are not drilled before.
fn without_core(
    own: &[&Segment],
    segments: &[Segment],
    drilling: &Drilling,
    subject: &Subject,
    limits: &Limits,
) -> Vec<Fault> {
    let opened = own.first().and_then(|first| Opened::before(first.index, segments, subject));
    let Some(opened) = opened else { return Vec::new() };
    let fault = |hole: &DrilledHole| {
        // a drill's point leaves a cone over the bottom
        let bottom = (hole.bottom + hole.radius).min(0.5 * (hole.bottom + hole.top));
        let opening = Opening { at: hole.at, radius: CORE * hole.radius, top: hole.top, bottom };
        let is_in_hole = |segment: &&&Segment| {
            segment.kind == SegmentKind::Plunge
                && drilled_at(segment, subject, limits).is_some_and(|other| std::ptr::eq(other, hole))
        };
        let segment = own.iter().find(is_in_hole).filter(|_| !opened.has(&opening))?;
        Some(segment.fault(&faults::NO_CORE_HOLE).measured(2.0 * hole.radius, hole.bottom))
    };
    drilling.holes.iter().filter_map(fault).collect()
}

struct Walk<'a> {
    drilling: &'a Drilling,
    subject: &'a Subject<'a>,
    limits: &'a Limits,
    /// Height up to which stock stands over the holes, where the job states one, mm.
    stock: f64,
    /// In the order of the holes.
    drilled: Vec<Drilled>,
}

impl Walk<'_> {
    fn take(&mut self, segment: &Segment) -> Vec<Fault> {
        let Some((hole, off)) = nearest(self.drilling, segment.end) else { return Vec::new() };
        let number = self.drilling.holes.iter().position(|other| std::ptr::eq(other, hole));
        let on_axis = !segment.travels() && off <= self.limits.unit + SLACK;
        let Some(drilled) = number.and_then(|number| self.drilled.get_mut(number)) else { return Vec::new() };
        match segment.kind {
            // beside the holes it is a rapid as any other
            SegmentKind::Rapid if !on_axis => {
                drilled.from = None;
                Vec::new()
            }
            SegmentKind::Rapid => {
                let start = segment.start.map_or(segment.end[2], |start| start[2]);
                drilled.from = None;
                drilled.up = drilled.up.max(segment.end[2]);
                let open = if drilled.depth.is_finite() { drilled.depth } else { hole.top.max(self.stock) };
                let least = open + self.limits.rapid_gap;
                let (unit, is_up) = (self.limits.unit + SLACK, segment.end[2] > start);
                let falls = segment.descends() && segment.end[2] < least - unit;
                let tears = self.drilling.rises_at_feed && is_up && start < hole.top - unit;
                let fall = || segment.fault(&faults::RAPID_IN_HOLE).measured(segment.end[2], open);
                let tear = || segment.fault(&faults::RAPID_OUT_OF_HOLE).measured(start, hole.top);
                falls.then(fall).into_iter().chain(tears.then(tear)).collect()
            }
            SegmentKind::Plunge if on_axis => {
                let start = segment.start.map_or(segment.end[2], |start| start[2]);
                let goes_on = drilled.from.is_none() && drilled.depth.is_finite() && segment.end[2] < drilled.depth;
                let is_full = self.drilling.clears && goes_on && drilled.up < hole.top - self.limits.unit - SLACK;
                let full = || segment.fault(&faults::PECK_NOT_CLEARED).measured(drilled.up, hole.top);
                let full = is_full.then(full);
                let from = *drilled.from.get_or_insert(start.min(drilled.depth));
                drilled.depth = drilled.depth.min(segment.end[2]);
                drilled.up = segment.end[2];
                full.into_iter().chain(self.down(segment, hole, from, off)).collect()
            }
            SegmentKind::Retract | SegmentKind::Still if on_axis => {
                drilled.from = None;
                drilled.up = drilled.up.max(segment.end[2]);
                Vec::new()
            }
            _ => vec![segment.fault(&faults::NO_HOLE_HERE).measured(off, 0.0)],
        }
    }

    /// Faults of a feed down a hole's axis, from where it was drilled or began.
    fn down(&self, segment: &Segment, hole: &DrilledHole, from: f64, off: f64) -> Vec<Fault> {
        let (end, unit) = (segment.end[2], self.limits.unit + SLACK);
        let mut faults = Vec::new();
        if end < hole.bottom - unit {
            faults.push(segment.fault(&faults::TOO_DEEP).measured(end, hole.bottom));
        }
        if from - end > self.drilling.peck + 2.0 * unit {
            faults.push(segment.fault(&faults::DEEP_PECK).measured(from - end, self.drilling.peck));
        }
        let radius = segment.tool.and_then(|tool| self.subject.tools.get(tool)).map_or(0.0, |t| 0.5 * t.diameter());
        let entered = off + radius - hole.radius;
        if entered > self.limits.gouge + SLACK {
            faults.push(segment.fault(&faults::GOUGE).measured(entered, self.limits.gouge));
        }
        faults
    }
}

/// The clearance at and below which a tool on a hole's axis is in the part, mm.
pub(crate) fn gouge_level(hole: &DrilledHole, subject: &Subject, limits: &Limits) -> f64 {
    -limits.gouge - subject.deviation_outward.max(hole.chord)
}
