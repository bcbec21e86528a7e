//! Holes that are bored by a tool narrower than they are: its axis turns about the hole's at the right distance, in the right sense, no
//! steeper than asked, and at the bottom nothing of the hole is left all around.
//!
//! What is swept is followed on rays from the hole's axis, some degrees apart: a round tool whose axis crosses a ray covers of it what lies
//! within its radius of the crossing. Walls are measured against the hole's own radius, and against triangles less what they are off.
//!
//! The method: `docs/concepts/drilling.md`.

use std::f64::consts::{PI, TAU};

use styluscam_motion::{Program, SpindleDirection};

use crate::expectation::{Boring, DrilledHole, ExpectedOperation};
use crate::faults::{self, Fault};
use crate::segments::{Segment, SegmentKind};
use crate::subject::{Limits, Subject};
use crate::tolerances::SLACK;

/// Rays from a hole's axis.
const RAYS: usize = 90;
/// Rounded ends of a move that are nearer along a circle state no sense, in units of the machine.
const TURNED: f64 = 4.0;

/// The hole inside of whose wall a move's tool is, of those of its operation.
pub(crate) fn hole_of<'a>(segment: &Segment, subject: &Subject<'a>, limits: &Limits) -> Option<&'a DrilledHole> {
    let operation = subject.expected.get(segment.expected?)?;
    let boring = operation.expectation.boring()?;
    let tool = subject.tools.get(segment.tool?)?;
    let is_inside = |hole: &&DrilledHole| {
        let [x, y] = about(hole, segment.end);
        let most = hole.radius + limits.gouge + SLACK - 0.5 * tool.diameter();
        libm::hypot(x, y) <= most && distances(segment, hole)[1] <= most
    };
    boring.holes.iter().filter(is_inside).min_by(|a, b| a.radius.total_cmp(&b.radius))
}

/// The hole that a run of moves is in, with its number: of those that hold all of its axis the one that ends nearest to where the run does,
/// else the one out of which it comes least.
fn hole_of_run(boring: &Boring, run: &[&Segment]) -> Option<usize> {
    let feeds = || run.iter().filter(|segment| segment.kind != SegmentKind::Rapid);
    let lowest = feeds().map(|segment| segment.lowest()).reduce(f64::min)?;
    let out = |hole: &DrilledHole| feeds().map(|segment| distances(segment, hole)[1]).fold(0.0, f64::max) - hole.radius;
    let all: Vec<(usize, f64, f64)> = boring
        .holes
        .iter()
        .enumerate()
        .map(|(i, hole)| (i, out(hole).max(0.0), (hole.bottom - lowest).abs()))
        .collect();
    let best = all.into_iter().min_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)));
    best.map(|(number, ..)| number)
}

/// Moves from one rapid to the next, each run with the rapids before it.
fn runs<'s, 'a>(segments: &'s [&'a Segment]) -> impl Iterator<Item = &'s [&'a Segment]> {
    segments.chunk_by(|a, b| a.kind == SegmentKind::Rapid || b.kind != SegmentKind::Rapid)
}

/// How near to a hole's axis, and how far from it, the tip is on a move or a piece of an arc, mm.
fn distances(segment: &Segment, hole: &DrilledHole) -> [f64; 2] {
    let mut found = [f64::INFINITY, 0.0_f64];
    for piece in segment.pieces() {
        let [start, end] = [piece.start.unwrap_or(piece.end), piece.end].map(|tip| about(hole, tip));
        let between = if piece.bend.is_some() { about(hole, piece.at(0.5)) } else { foot(start, end) };
        for [x, y] in [start, between, end] {
            let distance = libm::hypot(x, y);
            found = [found[0].min(distance), found[1].max(distance)];
        }
    }
    found
}

/// A position in plan as seen from a hole's axis, mm.
fn about(hole: &DrilledHole, [x, y, _]: [f64; 3]) -> [f64; 2] {
    [x - hole.at[0], y - hole.at[1]]
}

/// The point of a line that is nearest to the axis.
fn foot([ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> [f64; 2] {
    let (dx, dy) = (bx - ax, by - ay);
    let square = dx * dx + dy * dy;
    let share = if square > 0.0 { (-(ax * dx + ay * dy) / square).clamp(0.0, 1.0) } else { 0.0 };
    [ax + share * dx, ay + share * dy]
}

/// What is done along one ray.
#[derive(Clone)]
struct Ray {
    /// The tip at the last crossing of the descent that is going on, mm; infinite before the first.
    passed: f64,
    /// The lowest crossing, mm.
    lowest: f64,
    /// Down to where the wall is cut in steps, mm; infinite before the first.
    wall: f64,
    /// Of the ray, what is covered at the bottom, mm from the axis.
    covered: Vec<[f64; 2]>,
}

const UNTOUCHED: Ray = Ray { passed: f64::INFINITY, lowest: f64::INFINITY, wall: f64::INFINITY, covered: Vec::new() };

/// Faults of the operations that bore, in the order of the job's.
pub(crate) fn faults(program: &Program, segments: &[Segment], subject: &Subject, limits: &Limits) -> Vec<Fault> {
    let mut faults = Vec::new();
    for (number, operation) in subject.expected.iter().enumerate() {
        let Some(boring) = operation.expectation.boring() else { continue };
        let own: Vec<&Segment> = segments.iter().filter(|segment| segment.expected == Some(number)).collect();
        let Some(last) = own.last() else { continue }; // that the operation is missing is found by itself
        let mut walk = Walk::new(operation, boring, (subject, limits), limits.excess_of(last.operation));
        for run in runs(&own) {
            let Some(number) = hole_of_run(boring, run) else { continue }; // rapids behind the last hole
            for segment in run {
                let feed = program.moves.get(segment.index).map_or(0.0, |step| step.feed);
                walk.take(segment, feed, number, &mut faults);
            }
        }
        faults.extend(boring.holes.iter().zip(&walk.rays).filter_map(|(hole, rays)| walk.left(hole, rays, last)));
    }
    faults
}

struct Walk<'a> {
    operation: &'a ExpectedOperation,
    boring: &'a Boring,
    subject: &'a Subject<'a>,
    limits: &'a Limits,
    /// Height up to which stock stands over the holes, where the job states one, mm.
    stock: f64,
    /// What may be left on walls beyond the stock that is to stay, mm.
    excess: f64,
    /// Of each hole.
    rays: Vec<Vec<Ray>>,
    /// The height from which the tip goes down since it last crossed a ray, mm; none before a descent.
    since: Option<f64>,
}

impl<'a> Walk<'a> {
    fn new(
        operation: &'a ExpectedOperation,
        boring: &'a Boring,
        (subject, limits): (&'a Subject<'a>, &'a Limits),
        excess: Option<f64>,
    ) -> Self {
        let [_, top] = operation.expectation.heights;
        Self {
            operation,
            boring,
            subject,
            limits,
            stock: if top.is_finite() { top } else { f64::NEG_INFINITY },
            excess: excess.unwrap_or(0.0),
            rays: vec![vec![UNTOUCHED; RAYS]; boring.holes.len()],
            since: None,
        }
    }

    /// What rounding may cost a position, mm.
    fn unit(&self) -> f64 {
        self.limits.unit + SLACK
    }

    fn radius(&self, segment: &Segment) -> f64 {
        segment.tool.and_then(|tool| self.subject.tools.get(tool)).map_or(0.0, |tool| 0.5 * tool.diameter())
    }

    /// Where material may begin over a hole, mm.
    fn begins(&self, hole: &DrilledHole) -> f64 {
        let [x, y] = hole.at;
        // a wider hole above it on its axis, of which some stands
        let above = self.boring.holes.iter().zip(&self.rays).filter(|(other, rays)| {
            let apart = libm::hypot(other.at[0] - x, other.at[1] - y);
            apart < other.radius && rays.iter().any(|ray| ray.lowest > other.bottom + self.unit())
        });
        above.map(|(other, _)| other.top).fold(hole.top.max(self.stock), f64::max)
    }

    fn take(&mut self, segment: &Segment, feed: f64, number: usize, faults: &mut Vec<Fault>) {
        let Some(hole) = self.boring.holes.get(number) else { return };
        let [near, far] = distances(segment, hole);
        if segment.kind == SegmentKind::Rapid {
            self.since = None;
            self.rays.iter_mut().flatten().for_each(|ray| ray.passed = f64::INFINITY);
            let least = self.begins(hole) + self.limits.rapid_gap - self.unit();
            let is_low = far <= hole.radius && segment.descends() && segment.end[2] < least;
            let fault = || segment.fault(&faults::RAPID_IN_HOLE).measured(segment.end[2], self.begins(hole));
            faults.extend(is_low.then(fault));
            return;
        }
        if near > hole.radius {
            faults.push(segment.fault(&faults::NO_HOLE_HERE).measured(near, 0.0));
            return;
        }
        faults.extend(self.of_place(segment, hole, far));
        faults.extend(self.of_feed(segment, feed, far));
        for piece in segment.pieces() {
            let found = self.along(&piece, (number, hole));
            faults.extend(found);
        }
    }

    /// Faults of where a move is: in the wall, or below the bottom.
    fn of_place(&self, segment: &Segment, hole: &DrilledHole, far: f64) -> Vec<Fault> {
        let limit = self.limits.gouge;
        let entered = far + self.radius(segment) - hole.radius;
        let taken = entered + self.boring.left;
        let gouge = (entered > limit + SLACK).then(|| segment.fault(&faults::GOUGE).measured(entered, limit));
        let takes = gouge.is_none() && taken > limit + SLACK;
        let stock = takes.then(|| segment.fault(&faults::STOCK_TO_LEAVE).measured(taken, limit));
        let lowest = segment.lowest();
        let deep = lowest < hole.bottom - self.unit();
        let deep = deep.then(|| segment.fault(&faults::TOO_DEEP).measured(lowest, hole.bottom));
        gouge.into_iter().chain(stock).chain(deep).collect()
    }

    /// That a move's feed is not the one that its circle asks for.
    fn of_feed(&self, segment: &Segment, feed: f64, far: f64) -> Option<Fault> {
        let (cut, radius) = (self.operation.cut, self.radius(segment));
        let posted = |path: f64| if self.boring.feed_at_rim { cut * path / (path + radius) } else { cut };
        let slack = self.limits.feed_slack(feed, segment.length());
        let [low, high] = [far - 2.0 * self.unit(), far + 2.0 * self.unit()].map(|path| posted(path.max(0.0)));
        let same = (low - slack..=high + slack).contains(&feed);
        let is_pass = matches!(segment.kind, SegmentKind::Lateral | SegmentKind::Plunge);
        (is_pass && feed > 0.0 && !same).then(|| segment.fault(&faults::FEED).measured(feed, posted(far)))
    }

    /// Faults of a piece of a move: its sense, and how steeply it goes down.
    fn along(&mut self, piece: &Segment, (number, hole): (usize, &DrilledHole)) -> Vec<Fault> {
        let Some(start) = piece.start else { return Vec::new() };
        let [from, to] = [start, piece.end].map(|tip| about(hole, tip));
        let turned = libm::atan2(from[0] * to[1] - from[1] * to[0], from[0] * to[0] + from[1] * to[1]);
        let [near, far] = distances(piece, hole);
        let mut faults = Vec::new();
        let is_turn = turned.abs() * near > TURNED * self.limits.unit;
        if is_turn && (turned > 0.0) != self.is_counterclockwise() {
            faults.push(piece.fault(&faults::CUT_DIRECTION).measured(0.0, f64::from(u8::from(self.boring.is_climb))));
        }
        let (unit, top) = (self.unit(), self.begins(hole));
        let inside = |z: f64| z.min(top);
        let mut since = self.since.unwrap_or(start[2]);
        let first = libm::atan2(from[1], from[0]);
        let crossings = crossed(first, turned);
        for (ray, share) in crossings {
            let z = start[2] + share * (piece.end[2] - start[2]);
            let cut = Cut { z, covers: [near - self.radius(piece), near + self.radius(piece)] };
            faults.extend(self.cross(piece, (number, hole), ray, &cut));
            let fall = inside(since) - z;
            faults.extend(self.steep(piece, fall, far));
            since = z;
        }
        let fall = inside(since) - piece.end[2];
        if self.steep(piece, fall, far).is_some() && fall > unit {
            faults.extend(self.steep(piece, fall, far));
            since = piece.end[2];
        }
        self.since = Some(since);
        faults
    }

    /// That the tip falls by more than a pitch allows from one ray to the next.
    fn steep(&self, piece: &Segment, fall: f64, far: f64) -> Option<Fault> {
        let around = TAU * far / RAYS as f64;
        let limit = self.boring.pitch / RAYS as f64 + 2.0 * self.unit();
        let degrees = |fall: f64| libm::atan2(fall, around).to_degrees();
        (fall > limit).then(|| piece.fault(&faults::STEEP_ENTRY).measured(degrees(fall), degrees(limit)))
    }

    /// Takes down that the tool's axis crosses a ray.
    fn cross(
        &mut self,
        piece: &Segment,
        (number, hole): (usize, &DrilledHole),
        ray: usize,
        cut: &Cut,
    ) -> Option<Fault> {
        let (unit, top, pitch) = (self.unit(), self.begins(hole), self.boring.pitch);
        let wall = hole.radius - self.boring.left - self.excess - SLACK;
        let ray = self.rays.get_mut(number)?.get_mut(ray)?;
        let turn = ray.passed.min(top) - cut.z;
        ray.passed = cut.z;
        ray.lowest = ray.lowest.min(cut.z);
        let [_, outer] = cut.covers;
        let mut skipped = None;
        if outer >= wall {
            skipped = Some(ray.wall.min(top) - cut.z).filter(|step| *step > pitch + 2.0 * unit);
            ray.wall = ray.wall.min(cut.z);
        }
        if cut.z <= hole.bottom + unit {
            ray.covered.push(cut.covers);
        }
        let around = TAU * (outer - self.radius(piece));
        let degrees = |fall: f64| libm::atan2(fall, around).to_degrees();
        let steep = (turn > pitch + 2.0 * unit)
            .then(|| piece.fault(&faults::STEEP_ENTRY).measured(degrees(turn), degrees(pitch)));
        steep.or_else(|| skipped.map(|step| piece.fault(&faults::WALL_SKIPPED).measured(step, pitch)))
    }

    fn is_counterclockwise(&self) -> bool {
        let turns_back = self.operation.spindle.is_some_and(|(_, way)| way == SpindleDirection::Counterclockwise);
        self.boring.is_climb != turns_back
    }

    /// What is left of a hole at the bottom: the worst of it.
    fn left(&self, hole: &DrilledHole, rays: &[Ray], last: &Segment) -> Option<Fault> {
        let [x, y] = hole.at;
        let at = |fault: Fault| Fault { position: [x, y, hole.bottom], ..fault };
        let depth = rays.iter().map(|ray| ray.lowest).fold(f64::NEG_INFINITY, f64::max);
        if depth > hole.bottom + self.unit() {
            let fault = last.fault(&faults::MISSING_HOLE).measured(depth, hole.bottom);
            return Some(at(Fault { weight: hole.top - hole.bottom, ..fault }));
        }
        let wall = hole.radius - self.boring.left;
        let reach = |ray: &Ray| wall - ray.covered.iter().map(|[_, outer]| *outer).fold(0.0, f64::max);
        let left = rays.iter().map(reach).fold(0.0, f64::max);
        if left > self.excess + SLACK {
            return Some(at(last.fault(&faults::EXCESS).measured(left, self.excess)));
        }
        let gap = rays.iter().map(|ray| gap(&ray.covered)).fold(0.0, f64::max);
        (gap > self.unit()).then(|| at(last.fault(&faults::CORE_LEFT).measured(gap, 0.0)))
    }
}

/// A crossing of a ray.
struct Cut {
    /// The tip's height, mm.
    z: f64,
    /// Of the ray, what the tool covers there, mm from the axis.
    covers: [f64; 2],
}

/// The widest part of a ray up to the farthest cover that none covers, mm.
fn gap(covered: &[[f64; 2]]) -> f64 {
    let mut covered = covered.to_vec();
    covered.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut widest: f64 = 0.0;
    covered.iter().fold(0.0_f64, |reached, [inner, outer]| {
        widest = widest.max(inner - reached);
        reached.max(*outer)
    });
    widest
}

/// The rays that a turn from an angle by another (rad) crosses, in their order, each with the share of the turn.
fn crossed(from: f64, turned: f64) -> impl Iterator<Item = (usize, f64)> {
    let step = TAU / RAYS as f64;
    // rays lie half a step off the axes, where turns begin
    let number = |angle: f64| (angle + PI) / step - 0.5;
    let [low, high] = [from.min(from + turned), from.max(from + turned)].map(number);
    let all = (low.floor() as i64 + 1)..=(high.floor() as i64);
    let count = all.clone().count();
    let first = *all.start();
    (0..count).map(move |index| {
        let place = if turned < 0.0 { count - 1 - index } else { index };
        let ray = first + place as i64;
        let angle = (ray as f64 + 0.5) * step - PI;
        (ray.rem_euclid(RAYS as i64) as usize, ((angle - from) / turned).clamp(0.0, 1.0))
    })
}
