//! The moves along a pocket's path: down by a helix, along the cuts, over or through to the next.

use std::f64::consts::TAU;

use styluscam_geometry::{PlanePiece, Vector};
use styluscam_motion::{Arc, Role};

use super::request::{PocketPath, PocketRun, PocketRunKind};
use crate::{Curve, Heights, Rates, Segment};

/// The layer that a path clears, and how the tool moves in it.
pub struct Layer<'a> {
    /// Height of the material's top, mm.
    pub top: f64,
    /// Height of the tip on the path, mm.
    pub floor: f64,
    /// Heights of rapids, mm.
    pub heights: Heights,
    /// Feeds: down helices at that of plunges.
    pub rates: Rates,
    /// Height over length of a helix into the material.
    pub entry_slope: f64,
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
                self.come_down(start);
                self.along(&run.points, Role::Cut);
            }
            PocketRunKind::Link => {
                self.come_down(start);
                self.along(&run.points, Role::Link);
            }
        }
    }

    /// Straight up.
    fn leave(&mut self) {
        if let Some(at) = self.at.take() {
            self.segments.push(Segment::rapid(Vector::new(at.x, at.y, self.layer.heights.clearance)));
        }
    }

    /// To a position where nothing is left to cut, unless the tool is there.
    fn come_down(&mut self, to: Vector) {
        if self.at.is_some() {
            return;
        }
        let Heights { clearance, retract } = self.layer.heights;
        self.segments.push(Segment::rapid(Vector::new(to.x, to.y, clearance)));
        if retract < clearance {
            self.segments.push(Segment::rapid(Vector::new(to.x, to.y, retract)));
        }
        self.segments.push(Segment::line(to, self.layer.rates.plunge));
        self.at = Some(to);
    }

    /// Down a helix from the material's top, and once around at its end.
    fn enter(&mut self, run: &PocketRun) {
        let Layer { top, floor, rates, entry_slope, .. } = *self.layer;
        let Some([x, y, _]) = run.points.first() else { return };
        let start = Vector::new(*x, *y, top);
        self.come_down(start);
        let around: f64 = PlanePiece::path(&run.points).iter().map(PlanePiece::length).sum();
        let turns = libm::ceil((top - floor) / (around * entry_slope)).max(1.0);
        let fall = (top - floor) / turns;
        for turn in 0..turns as usize {
            let from = top - turn as f64 * fall;
            let to = if turn as f64 + 1.5 > turns { floor } else { from - fall };
            self.turn(&run.points, [from, to], rates.plunge, Role::Ramp);
        }
        self.along(&run.points, Role::Ramp);
    }

    /// Along points with bulges at the floor.
    fn along(&mut self, points: &[[f64; 3]], role: Role) {
        let Layer { floor, rates, .. } = *self.layer;
        self.turn(points, [floor, floor], rates.cut, role);
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
