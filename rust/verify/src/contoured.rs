//! Edges along which a tool goes: on each level its axis passes every position of them at the tool's radius, no nearer and no farther,
//! on the side that is asked for.
//!
//! Edges are followed every quarter of a millimetre, in plan, beside the straight pieces of the model's triangles. Where no pass touches a
//! position, a tool is put where it would: is that free, then a pass is missing or too far, else the edge is not reached there.
//! Whatever comes nearer than the radius takes stock that is to stay, or enters the wall. Ramps are measured by their slope.
//!
//! The method: `docs/concepts/contours.md`.

use std::collections::BTreeMap;

use rstar::primitives::{GeomWithData, Line};
use rstar::{PointDistance, RTree};
use styluscam_geometry::{Cutter, Vector};
use styluscam_motion::{Cancelled, Program, Role, SpindleDirection, Watch};

use crate::assignment::Assignment;
use crate::body::Body;
use crate::chamfered::named_edges;
use crate::clearance::Prober;
use crate::earlier::plan_chords;
use crate::expectation::{ContourLevel, ContourLine, ContourPiece, ContourSide, Contouring, ExpectedOperation};
use crate::faults::{self, Fault};
use crate::findings::Finding;
use crate::holding::{colliders, Collider};
use crate::measure::gouge_level;
use crate::segments::{Segment, SegmentKind};
use crate::subject::{Limits, Subject};
use crate::tabs::Tabs;
use crate::tolerances::{SAME_LEVEL, SLACK};

/// Positions of an edge that are looked at lie so far apart at most, mm.
const APART: f64 = 0.25;
/// Positions of a piece of an edge at most: of longer ones they lie farther apart.
const MOST: usize = 4000;
/// Largest distance of chords from arcs, mm.
const SAG: f64 = 1e-4;
/// A pass that is farther from where it should be than this is another, mm.
const ANOTHER: f64 = 0.1;
/// Cosines of angles between a pass and its edge that are less are of a pass beside another edge.
const ALONG: f64 = 0.9;
/// The tool comes down through what is cleared where it is no farther beside the path that cleared it, mm.
const BESIDE: f64 = 0.02;

/// What is found of operations that go along edges.
#[derive(Default)]
pub(crate) struct Judged {
    pub faults: Vec<Fault>,
    pub findings: Vec<Finding>,
}

/// Looks at the operations that go along edges, in the order of the job's.
///
/// # Errors
/// `Cancelled` when the watch is cancelled.
pub(crate) fn judged(
    program: &Program,
    segments: &[Segment],
    assignment: &Assignment,
    (subject, limits): (&Subject, &Limits),
    watch: &Watch,
) -> Result<Judged, Cancelled> {
    let mut judged = Judged::default();
    for (number, operation) in subject.expected.iter().enumerate() {
        let Some(contouring) = operation.expectation.contouring() else { continue };
        let own: Vec<Own<'_>> = segments
            .iter()
            .filter(|segment| segment.expected == Some(number))
            .map(|segment| Own { segment, role: program.moves.get(segment.index).and_then(|step| step.role) })
            .collect();
        let (Some(last), Some(tool)) = (own.last(), subject.tools.get(operation.tool)) else { continue };
        let level = gouge_level(subject, limits);
        let look = Look {
            contouring,
            subject,
            limits,
            own: &own,
            last: last.segment,
            cutter: tool.cutter(),
            body: Body::new(tool, subject.sheet.as_ref()),
            above: colliders(tool, subject, level),
            excess: limits.excess_of(last.segment.operation).unwrap_or(0.0),
            tabs: Tabs::of(program, segments, assignment, subject, operation),
        };
        judged.faults.extend(look.entries(operation));
        let mut unreached = BTreeMap::new();
        for line in &contouring.lines {
            watch.advance(0)?;
            judged.faults.extend(look.crossed(line));
            look.line((operation, line), (&mut judged.faults, &mut unreached), watch)?;
        }
        let what = "have no pass beside them on some level, for the tool would enter what is there";
        judged.findings.extend(named_edges(&unreached, what));
    }
    Ok(judged)
}

/// A move of the operation.
#[derive(Clone, Copy)]
struct Own<'a> {
    segment: &'a Segment,
    role: Option<Role>,
}

impl Own<'_> {
    fn is_feed(&self) -> bool {
        matches!(self.segment.kind, SegmentKind::Lateral | SegmentKind::Plunge)
    }

    /// Whether it goes along a pass on a level.
    fn is_on(&self, tip: f64) -> bool {
        let is_level = |z: f64| (z - tip).abs() <= SAME_LEVEL;
        self.segment.kind == SegmentKind::Lateral
            && matches!(self.role, None | Some(Role::Cut))
            && is_level(self.segment.end[2])
            && self.segment.start.is_some_and(|start| is_level(start[2]))
            && is_level(self.segment.lowest())
    }

    /// Its path in plan in chords.
    fn chords(&self) -> impl Iterator<Item = Line<[f64; 2]>> {
        let Segment { start, end, bend, .. } = *self.segment;
        plan_chords([start.unwrap_or(end), end], bend, SAG)
    }
}

/// Paths of the axis in plan, with the number of their move among the operation's.
type Axes = RTree<GeomWithData<Line<[f64; 2]>, usize>>;

struct Look<'a> {
    contouring: &'a Contouring,
    subject: &'a Subject<'a>,
    limits: &'a Limits,
    own: &'a [Own<'a>],
    last: &'a Segment,
    cutter: Cutter,
    body: Body,
    /// What is above the tool's profile, and what it must not come near.
    above: Vec<Collider<'a>>,
    /// How far a pass may be beyond where it should be, mm.
    excess: f64,
    tabs: Option<Tabs<'a>>,
}

/// The worst of a line on a level: pass too far, and none at all.
#[derive(Default)]
struct Worst {
    far: Option<Fault>,
    missing: Option<Fault>,
    /// A pass in the wrong direction.
    turned: Option<Fault>,
    /// Positions that a pass touches.
    touched: usize,
}

/// A pass beside a position of an edge.
#[derive(Clone, Copy)]
struct Near {
    /// By how much its axis is farther from the edge than it should be, mm.
    beyond: f64,
    /// The number of its move among the operation's.
    number: usize,
    /// The cosine of the angle between its direction and the edge's.
    ahead: f64,
}

impl Look<'_> {
    /// Paths of some of the moves.
    fn axes(&self, is_meant: impl Fn(&Own<'_>) -> bool) -> Axes {
        let meant = self.own.iter().enumerate().filter(|(_, own)| is_meant(own));
        let chords = meant.flat_map(|(number, own)| own.chords().map(move |chord| GeomWithData::new(chord, number)));
        RTree::bulk_load(chords.collect())
    }

    /// How far the axis of a tool whose tip is at a height is from a line that it touches, mm.
    fn radius(&self, line: &ContourLine, tip: f64) -> f64 {
        match self.contouring.side {
            ContourSide::On => 0.0,
            ContourSide::Left | ContourSide::Right => self.cutter.at_height((line.plane_top - tip).max(0.0)).0,
        }
    }

    /// From a position of a piece to the side of the tool, a unit vector.
    fn aside(&self, piece: &ContourPiece) -> [f64; 2] {
        let [a, b] = piece.ends;
        let length = apart(a, b).max(f64::MIN_POSITIVE);
        let left = [-(b[1] - a[1]) / length, (b[0] - a[0]) / length];
        match self.contouring.side {
            ContourSide::Right => left.map(|x| -x),
            ContourSide::Left | ContourSide::On => left,
        }
    }

    /// What is wrong with the passes along a line, level by level; and what of it is not reached.
    fn line<'l>(
        &self,
        (operation, line): (&ExpectedOperation, &'l ContourLine),
        (faults, unreached): (&mut Vec<Fault>, &mut BTreeMap<&'l str, (f64, Vector)>),
        watch: &Watch,
    ) -> Result<(), Cancelled> {
        let pieces =
            RTree::bulk_load(line.pieces.iter().map(|piece| Line::new(piece.ends[0], piece.ends[1])).collect());
        let mut shortest: BTreeMap<&'l str, (f64, Vector)> = BTreeMap::new();
        for level in &line.levels {
            let axes = self.axes(|own| own.is_on(level.tip));
            let mut worst = Worst::default();
            let mut missed: BTreeMap<&'l str, (f64, Vector)> = BTreeMap::new();
            for piece in &line.pieces {
                watch.advance(0)?;
                self.piece((operation, line, piece, *level), (&axes, &pieces), (&mut worst, &mut missed));
            }
            // the lowest level misses most: what is missed on several counts once
            for (name, (length, at)) in missed {
                let known = shortest.entry(name).or_insert((length, at));
                known.0 = known.0.max(length);
            }
            faults.extend(worst.turned);
            match (worst.touched, worst.missing) {
                (0, Some(missing)) if line.is_alone(*level) => {
                    faults.push(Fault { kind: &faults::CONTOUR_LEVEL, ..missing });
                }
                (_, missing) => faults.extend(missing.into_iter().chain(worst.far)),
            }
        }
        for (name, (length, at)) in shortest {
            unreached.entry(name).or_insert((0.0, at)).0 += length;
        }
        Ok(())
    }

    /// Looks at a piece of a line on a level.
    fn piece<'l>(
        &self,
        (operation, line, piece, level): (&ExpectedOperation, &ContourLine, &'l ContourPiece, ContourLevel),
        (axes, pieces): (&Axes, &RTree<Line<[f64; 2]>>),
        (worst, missed): (&mut Worst, &mut BTreeMap<&'l str, (f64, Vector)>),
    ) {
        let distance = self.radius(line, level.tip) + level.left;
        for (at, length) in positions(piece) {
            let least = if line.is_finished(level) { -self.limits.gouge - SLACK } else { -ANOTHER };
            let near = self.near(axes, (at, piece), (distance, least));
            let position = [at[0], at[1], level.tip];
            if let Some(touching) = near.filter(|near| near.beyond <= self.excess + SLACK) {
                worst.touched += 1; // what is too near is found by itself
                let turned = worst.turned.is_none().then(|| self.turned(operation, touching)).flatten();
                worst.turned = worst.turned.or(turned.map(|fault| Fault { position, ..fault }));
                continue;
            }
            let aside = self.aside(piece);
            let out = distance + self.subject.deviation_inward;
            let axis = [0, 1].map(|i| at[i] + out * aside[i]);
            let tip = [axis[0], axis[1], level.tip];
            if Tabs::excuse(&self.tabs, tip) {
                continue;
            }
            let is_near =
                pieces.nearest_neighbor(axis).is_some_and(|other| other.distance_2(&axis).sqrt() < distance - SLACK);
            if is_near || !self.is_free(tip) {
                let known = missed.entry(piece.name.as_str()).or_insert((0.0, [at[0], at[1], level.tip].into()));
                known.0 += length;
                continue;
            }
            match near {
                Some(Near { beyond, number, .. }) => {
                    let near = self.own.get(number).map_or(self.last, |own| own.segment);
                    let fault = near.fault(&faults::CONTOUR_LEFT).measured(beyond, self.excess);
                    if worst.far.is_none_or(|far| far.weight < fault.weight) {
                        worst.far = Some(Fault { position, ..fault });
                    }
                }
                None if worst.missing.is_none() => {
                    let above = self.own.iter().rev().find(|own| own.segment.lowest() > level.tip - SAME_LEVEL);
                    let near = above.map_or(self.last, |own| own.segment);
                    let fault = near.fault(&faults::CONTOUR_MISSING).measured(level.tip, level.tip);
                    worst.missing = Some(Fault { position, ..fault });
                }
                None => {}
            }
        }
    }

    /// The pass nearest to where one should be at a distance from a position of a piece, mm, on its right side. What is nearer by more
    /// than `least` (below 0) is another pass.
    fn near(&self, axes: &Axes, (at, piece): ([f64; 2], &ContourPiece), (distance, least): (f64, f64)) -> Option<Near> {
        let farthest = distance + ANOTHER;
        let aside = self.aside(piece);
        let [from, to] = piece.ends;
        let near = axes.locate_within_distance(at, farthest * farthest).filter_map(|chord| {
            let line = chord.geom();
            let axis = line.nearest_point(&at);
            let arm = [axis[0] - at[0], axis[1] - at[1]];
            let is_beside = self.contouring.side == ContourSide::On || arm[0] * aside[0] + arm[1] * aside[1] > 0.0;
            let beyond = libm::hypot(arm[0], arm[1]) - distance + self.subject.deviation_outward;
            let dot = (line.to[0] - line.from[0]) * (to[0] - from[0]) + (line.to[1] - line.from[1]) * (to[1] - from[1]);
            let ahead = dot / (apart(line.from, line.to) * apart(from, to)).max(f64::MIN_POSITIVE);
            (is_beside && beyond >= least).then_some(Near { beyond, number: chord.data, ahead })
        });
        near.min_by(|a, b| a.beyond.total_cmp(&b.beyond))
    }

    /// That a pass goes along its edge in the other sense than asked for.
    fn turned(&self, operation: &ExpectedOperation, near: Near) -> Option<Fault> {
        let is_climb = self.contouring.is_climb?;
        let edge_on_right = match self.contouring.side {
            ContourSide::Left => near.ahead > 0.0,
            ContourSide::Right => near.ahead < 0.0,
            ContourSide::On => return None,
        };
        let turns_back = operation.spindle.is_some_and(|(_, sense)| sense == SpindleDirection::Counterclockwise);
        let is_wrong = near.ahead.abs() > ALONG && edge_on_right != (is_climb != turns_back);
        let segment = self.own.get(near.number)?.segment;
        is_wrong.then(|| segment.fault(&faults::CUT_DIRECTION).measured(0.0, f64::from(u8::from(is_climb))))
    }

    /// Whether a tool stays out of the part, and of what stands around it.
    fn is_free(&self, tip: [f64; 3]) -> bool {
        let keeps = |prober: &Prober<'_>, least: f64| {
            let touch = prober.at(prober.body.position(tip), None);
            touch.is_none_or(|touch| touch.value > least - SLACK)
        };
        let part = Prober { body: &self.body, mesh: self.subject.mesh, bvh: self.subject.bvh };
        keeps(&part, gouge_level(self.subject, self.limits))
            && self.above.iter().all(|collider| keeps(&collider.prober(), collider.least))
    }

    /// The worst move that comes nearer to a line than it may.
    fn crossed(&self, line: &ContourLine) -> Option<Fault> {
        if self.contouring.side == ContourSide::On {
            return None;
        }
        let axes = self.axes(|own| own.is_feed() && own.segment.lowest() < line.plane_top - SLACK);
        // between levels a move takes no more than the one that takes most
        let least = line.levels.iter().map(|level| level.left).fold(f64::INFINITY, f64::min);
        let left = |own: &Own<'_>| {
            let on = line.levels.iter().filter(|level| own.is_on(level.tip)).map(|level| level.left);
            on.reduce(f64::min).unwrap_or(least)
        };
        // whatever the height of a move
        let widest = self.cutter.max_radius() + line.levels.iter().map(|level| level.left).fold(0.0, f64::max);
        let mut worst: Option<Fault> = None;
        for piece in &line.pieces {
            for (at, _) in positions(piece) {
                for chord in axes.locate_within_distance(at, widest * widest) {
                    let Some(own) = self.own.get(chord.data) else { continue };
                    let left = left(own);
                    let least = self.radius(line, own.segment.lowest()) + left;
                    let over = least - chord.geom().distance_2(&at).sqrt();
                    if over <= self.limits.gouge + SLACK || worst.is_some_and(|worst| worst.weight >= over) {
                        continue;
                    }
                    let kind = if left > 0.0 { &faults::STOCK_TO_LEAVE } else { &faults::CONTOUR_CROSSED };
                    let fault = own.segment.fault(kind).measured(over, 0.0);
                    worst = Some(Fault { position: [at[0], at[1], own.segment.end[2]], ..fault });
                }
            }
        }
        worst
    }

    /// Moves that go down into the material too steeply.
    fn entries(&self, operation: &ExpectedOperation) -> Vec<Fault> {
        let Some(slope) = self.contouring.entry_slope else { return Vec::new() };
        let of_tabs = operation.expectation.tabs.map_or(slope, |tabs| tabs.slope.max(slope));
        let begins = self.contouring.lines.iter().map(|line| line.begins).fold(f64::NEG_INFINITY, f64::max);
        let unit = self.limits.unit;
        let steep = |(number, own): (usize, &Own<'_>)| {
            let Segment { start, end, kind, .. } = *own.segment;
            let start = start.filter(|_| own.is_feed())?;
            let most = if Tabs::excuse(&self.tabs, start) { of_tabs } else { slope };
            let fall = start[2].min(begins) - end[2];
            let whole =
                own.segment.bend.map_or_else(|| apart([start[0], start[1]], [end[0], end[1]]), |bend| bend.length());
            // of moves that begin in the air what is below counts
            let share = if fall > 0.0 { fall / (start[2] - end[2]) } else { 1.0 };
            let run = share * whole;
            let is_steep = fall - 2.0 * unit > most * (run + 2.0 * unit);
            let is_down = kind == SegmentKind::Plunge;
            if !is_steep || self.is_beside_stock(own) || (is_down && self.is_cleared(number, end)) {
                return None;
            }
            let degrees = |rise: f64, run: f64| libm::atan2(rise, run).to_degrees();
            Some(own.segment.fault(&faults::STEEP_ENTRY).measured(degrees(fall, run), degrees(slope, 1.0)))
        };
        self.own.iter().enumerate().filter_map(steep).collect()
    }

    /// Whether a move is beside the stock all along.
    fn is_beside_stock(&self, own: &Own<'_>) -> bool {
        let Some((low, high)) = self.subject.stock.map(styluscam_geometry::Stock::bounds) else { return true };
        let radius = self.cutter.max_radius() - 2.0 * self.limits.unit;
        let is_out = |[x, y]: [f64; 2]| {
            libm::hypot((low.x - x).max(x - high.x).max(0.0), (low.y - y).max(y - high.y).max(0.0)) >= radius
        };
        let along = |chord: &Line<[f64; 2]>| {
            let count = (2.0 * apart(chord.from, chord.to) / self.cutter.max_radius()).ceil().clamp(1.0, MOST as f64);
            let at = |i: usize| [0, 1].map(|k| chord.from[k] + (chord.to[k] - chord.from[k]) * i as f64 / count);
            (0..=count as usize).all(|i| is_out(at(i)))
        };
        own.chords().all(|chord| along(&chord))
    }

    /// Whether moves before one went as low, or lower, where it ends.
    fn is_cleared(&self, number: usize, [x, y, z]: [f64; 3]) -> bool {
        let before = self.own.iter().take(number).filter(|own| own.is_feed() && own.segment.lowest() <= z + SLACK);
        let is_near = |own: &Own<'_>| own.chords().any(|chord| chord.distance_2(&[x, y]) <= BESIDE * BESIDE);
        before.filter(|own| !own.segment.falls()).any(is_near)
    }
}

impl ContourLine {
    /// Whether no other level is at the height of one.
    fn is_alone(&self, level: ContourLevel) -> bool {
        self.levels.iter().filter(|other| (other.tip - level.tip).abs() <= SAME_LEVEL).count() == 1
    }

    /// Whether another level at the same height takes what one leaves.
    fn is_finished(&self, level: ContourLevel) -> bool {
        self.levels.iter().any(|other| (other.tip - level.tip).abs() <= SAME_LEVEL && other.left < level.left)
    }
}

/// Positions of a piece that are looked at, with the length for which each stands, mm.
fn positions(piece: &ContourPiece) -> impl Iterator<Item = ([f64; 2], f64)> {
    let [a, b] = piece.ends;
    let length = apart(a, b);
    let count = ((length / APART).ceil() as usize).clamp(1, MOST);
    (0..count).map(move |i| {
        let share = (i as f64 + 0.5) / count as f64;
        ([0, 1].map(|axis| a[axis] + share * (b[axis] - a[axis])), length / count as f64)
    })
}

fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    libm::hypot(b[0] - a[0], b[1] - a[1])
}
