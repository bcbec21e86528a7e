//! The moves along a pocket's path: down by a helix or a ramp, along the cuts, over or through to the next.

use std::f64::consts::TAU;

use styluscam_geometry::{PlaneCircle, PlanePiece, Vector};
use styluscam_motion::{Arc, Role};

use super::feeds::{FeedLaw, Stretch};
use super::request::{PocketPath, PocketRun, PocketRunKind};
use crate::{Curve, Heights, Segment};

/// A change of the feed is no nearer to the end of a line or an arc, in tool radii.
const SHORTEST: f64 = 0.05;
/// Links are lifted where they are so many times as long as high.
const LONG: f64 = 4.0;
/// Lengths that differ by less are the same, mm.
const SAME: f64 = 1e-9;
/// Rapids come down to so far over what is cleared, mm; from there on the tool is fed.
const GAP: f64 = 0.25;
/// They do where walls are so far, mm.
const ROOM: f64 = 0.1;

/// The layer that a path clears, and how the tool moves in it.
pub struct Layer<'a> {
    /// Height of the material's top, mm.
    pub top: f64,
    /// Height of the tip on the path, mm.
    pub floor: f64,
    /// Heights of rapids, mm.
    pub heights: Heights,
    /// Straight down, mm/min.
    pub plunge: f64,
    /// Down into the material, mm/min.
    pub entry_feed: f64,
    /// Height over length of a way into the material.
    pub entry_slope: f64,
    /// Along cuts.
    pub feeds: FeedLaw,
    /// Along links at depth, mm/min.
    pub link_feed: f64,
    /// Of rapids, mm/min.
    pub rapid_rate: f64,
    /// How far the tool is kept from walls everywhere, mm.
    pub kept: f64,
    /// How much higher than cuts links are, mm.
    pub link_lift: f64,
    /// How far chords may be off arcs that are not taken, mm.
    pub deviation: f64,
    /// Whether the machine takes an arc between two tips.
    pub takes: &'a dyn Fn([[f64; 3]; 2], &Arc) -> bool,
}

/// The moves along a path, from clearance height to clearance height.
#[must_use]
pub fn segments(path: &PocketPath, layer: &Layer<'_>) -> Vec<Segment> {
    let mut moves = Moves { layer, segments: Vec::new(), at: None };
    for run in &path.runs {
        moves.run(run);
    }
    moves.leave();
    moves.segments
}

struct Moves<'a> {
    layer: &'a Layer<'a>,
    segments: Vec<Segment>,
    /// The tip, while it is down.
    at: Option<Vector>,
}

impl Moves<'_> {
    fn run(&mut self, run: &PocketRun) {
        let Some([x, y, _]) = run.points.first() else { return };
        let start = Vector::new(*x, *y, self.layer.floor);
        match run.kind {
            PocketRunKind::Rapid => self.leave(),
            PocketRunKind::Entry => {
                self.leave();
                self.enter(run);
            }
            PocketRunKind::Cut => {
                self.come_down(start, run);
                self.cut(run);
            }
            PocketRunKind::Link if self.has_room(run) && self.is_faster_over(&run.points) => self.leave(),
            PocketRunKind::Link => {
                self.come_down(start, run);
                self.link(&run.points);
            }
        }
    }

    /// Straight up.
    fn leave(&mut self) {
        if let Some(at) = self.at.take() {
            self.segments.push(Segment::rapid(Vector::new(at.x, at.y, self.layer.heights.clearance)));
        }
    }

    /// Whether no wall is near where the tool comes down for a run.
    fn has_room(&self, run: &PocketRun) -> bool {
        run.room + self.layer.kept >= ROOM
    }

    /// To a position down to which all is cleared, unless the tool is there.
    fn come_down(&mut self, to: Vector, run: &PocketRun) {
        if self.at.is_some() {
            return;
        }
        let Heights { clearance, retract } = self.layer.heights;
        let low = if self.has_room(run) { retract.min(to.z + GAP) } else { retract };
        self.segments.push(Segment::rapid(Vector::new(to.x, to.y, clearance)));
        if low < clearance {
            self.segments.push(Segment::rapid(Vector::new(to.x, to.y, low)));
        }
        self.segments.push(Segment::line(to, self.layer.plunge));
        self.at = Some(to);
    }

    /// Down along a loop from the material's top, and once around at its end.
    fn enter(&mut self, run: &PocketRun) {
        let Layer { top, floor, entry_slope, .. } = *self.layer;
        let Some([x, y, _]) = run.points.first() else { return };
        let start = Vector::new(*x, *y, top);
        self.come_down(start, run);
        let around: f64 = PlanePiece::path(&run.points).iter().map(PlanePiece::length).sum();
        let turns = libm::ceil((top - floor) / (around * entry_slope)).max(1.0);
        let fall = (top - floor) / turns;
        let feed = self.entry_feed(fall);
        for turn in 0..turns as usize {
            let from = top - turn as f64 * fall;
            let to = if turn as f64 + 1.5 > turns { floor } else { from - fall };
            self.turn(&run.points, [from, to], feed, Role::Ramp);
        }
        self.turn(&run.points, [floor, floor], feed, Role::Ramp);
    }

    /// The feed along a loop that falls by so much in a turn, mm/min: the tool is as wide as it can be in what the turn before left, and takes no
    /// more than at the reference.
    fn entry_feed(&self, fall: f64) -> f64 {
        let Layer { top, floor, feeds, entry_feed, .. } = *self.layer;
        let section = 2.0 * feeds.radius * fall;
        entry_feed.min(feeds.reference() * (top - floor) / section)
    }

    /// Along a cut, as fast as what is cut allows.
    fn cut(&mut self, run: &PocketRun) {
        let floor = self.layer.floor;
        let stretches = self.layer.feeds.stretches(run);
        let shortest = SHORTEST * self.layer.feeds.radius;
        let mut travelled = 0.0;
        for piece in PlanePiece::path(&run.points).iter().filter(|piece| piece.length() > 0.0) {
            let [from, to] = [travelled, travelled + piece.length()];
            travelled = to;
            let ends = stretches.iter().map(|stretch| stretch.end);
            let inside = ends.filter(|end| *end > from + shortest && *end < to - shortest);
            let mut start = from;
            for end in inside.chain([to]).collect::<Vec<_>>() {
                let shares = [start, end].map(|length| (length - from) / (to - from));
                self.piece(&part(piece, shares), [floor, floor], slowest(&stretches, [start, end]), Role::Cut);
                start = end;
            }
        }
    }

    /// Whether a way over the stock, straight up, across and down again, takes less time than a link at depth.
    fn is_faster_over(&self, points: &[[f64; 3]]) -> bool {
        let Layer { floor, heights, plunge, rapid_rate, link_feed, .. } = *self.layer;
        let ([Some([x, y, _]), Some([u, v, _])], true) = ([points.first(), points.last()], self.at.is_some()) else {
            return false;
        };
        let seconds = |length: f64, feed: f64| self.layer.feeds.seconds(length, feed);
        let [height, across] = [heights.clearance - floor, libm::hypot(u - x, v - y)];
        let over = seconds(height, rapid_rate)
            + seconds(across, rapid_rate)
            + seconds((height - GAP).max(0.0), rapid_rate)
            + seconds(GAP, plunge);
        let through: f64 = PlanePiece::path(points).iter().map(PlanePiece::length).sum();
        over < seconds(through, link_feed)
    }

    /// Along straight lines through what is cleared: up along its beginning and down again along its end.
    fn link(&mut self, points: &[[f64; 3]]) {
        let Layer { floor, link_lift, link_feed, .. } = *self.layer;
        let pieces = PlanePiece::path(points);
        let whole: f64 = pieces.iter().map(PlanePiece::length).sum();
        let lift = if whole >= LONG * link_lift { link_lift } else { 0.0 };
        let mut travelled = 0.0;
        for piece in pieces.iter().filter(|piece| piece.length() > 0.0) {
            let [from, to] = [travelled, travelled + piece.length()];
            travelled = to;
            let inside = [lift, whole - lift].into_iter().filter(|at| lift > 0.0 && *at > from && *at < to);
            let mut start = from;
            for end in inside.chain([to]) {
                let shares = [start, end].map(|length| (length - from) / (to - from));
                let heights = [start, end].map(|length| floor + lift.min(length).min((whole - length).max(0.0)));
                self.piece(&part(piece, shares), heights, link_feed, Role::Link);
                start = end;
            }
        }
    }

    /// Along points with bulges from a height evenly to another.
    fn turn(&mut self, points: &[[f64; 3]], [from, to]: [f64; 2], feed: f64, role: Role) {
        let pieces = PlanePiece::path(points);
        let whole: f64 = pieces.iter().map(PlanePiece::length).sum();
        let mut travelled = 0.0;
        for (number, piece) in pieces.iter().enumerate() {
            if piece.length() <= 0.0 {
                continue;
            }
            let height = |length: f64| from + (to - from) * length / whole;
            let before = height(travelled);
            travelled += piece.length();
            let after = if number + 1 == pieces.len() { to } else { height(travelled) };
            self.piece(piece, [before, after], feed, role);
        }
    }

    /// Along an arc, or as few chords as stay near to it.
    fn piece(&mut self, piece: &PlanePiece, [before, after]: [f64; 2], feed: f64, role: Role) {
        let [start, end] = [(piece.start, before), (piece.end, after)].map(|([x, y], z)| Vector::new(x, y, z));
        let mut add = |end: Vector, curve: Curve| {
            self.segments.push(Segment { curve, ..Segment::line(end, feed).in_role(role) });
        };
        self.at = Some(end);
        let Some(circle) = piece.circle else { return add(end, Curve::Line) };
        let plane = styluscam_motion::Plane::Xy;
        let clockwise = circle.turn < 0.0;
        let arc = Arc { centre: [circle.centre[0], circle.centre[1], end.z], plane, clockwise, turns: 0 };
        if (self.layer.takes)([start.into(), end.into()], &arc) {
            return add(end, Curve::Arc { plane, centre: circle.centre, clockwise });
        }
        let step = 2.0 * libm::acos((1.0 - self.layer.deviation / circle.radius).max(0.0)).min(TAU / 12.0);
        let count = libm::ceil(circle.turn.abs() / step).max(1.0) as usize;
        for i in 1..=count {
            let share = i as f64 / count as f64;
            let [x, y] = if i == count { piece.end } else { piece.at(share) };
            add(Vector::new(x, y, before + (after - before) * share), Curve::Line);
        }
    }
}

/// The part of a piece between two shares of its length.
fn part(piece: &PlanePiece, [from, to]: [f64; 2]) -> PlanePiece {
    let circle = piece.circle.map(|circle| PlaneCircle {
        from: circle.from + from * circle.turn,
        turn: (to - from) * circle.turn,
        ..circle
    });
    let end = if to < 1.0 { piece.at(to) } else { piece.end };
    PlanePiece { start: if from > 0.0 { piece.at(from) } else { piece.start }, end, circle }
}

/// The lowest feed on a length of a run, mm/min.
fn slowest(stretches: &[Stretch], [from, to]: [f64; 2]) -> f64 {
    let mut begin = f64::NEG_INFINITY;
    let mut lowest = f64::INFINITY;
    for stretch in stretches {
        let start = std::mem::replace(&mut begin, stretch.end);
        if start < to - SAME && stretch.end > from + SAME {
            lowest = lowest.min(stretch.feed);
        }
    }
    match stretches.last() {
        Some(last) if !lowest.is_finite() => last.feed,
        _ => lowest,
    }
}
