//! Passes in an order, each from where it is entered to where it is left, and the air between them.

use styluscam_geometry::Vector;

use super::air::Air;
use super::nearest::begin_nearest;
use crate::Pass;

/// A pass in its place in the order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stop {
    /// Its number among the given passes.
    pub pass: usize,
    /// Whether it is followed from its end to its start.
    pub is_turned: bool,
}

/// An order of passes.
#[derive(Clone, Debug)]
pub struct Sequence<'a> {
    given: &'a [Pass],
    /// Whether loops begin where they are nearest.
    begins_free: bool,
    /// Whether open passes may be followed in both directions.
    turns: bool,
    /// The order.
    pub stops: Vec<Stop>,
    /// Of each stop: where the tool comes to it and where it leaves it.
    pub ends: Vec<[Vector; 2]>,
    /// Air between the stops, mm.
    pub length: f64,
}

impl Air {
    /// Between two tips, mm: straight if they are near, else up, across and down.
    pub fn from_to(&self, from: Vector, to: Vector) -> f64 {
        let across = (to - from).xy().norm();
        if across <= self.along {
            (to - from).norm()
        } else {
            across + (self.height - from.z).max(0.0) + (self.height - to.z).max(0.0)
        }
    }

    /// Between passes in their order, mm.
    pub fn between(&self, passes: &[Pass]) -> f64 {
        let ends = |pass: &Pass| Some([pass.points.first()?.tip, pass.points.last()?.tip]);
        let ends: Vec<[Vector; 2]> = passes.iter().filter_map(ends).collect();
        ends.windows(2).map(|pair| self.from_to(pair[0][1], pair[1][0])).sum()
    }

    /// Whether the tool goes up between any two of some passes in their order: where it does not, there is nothing to gain.
    pub fn is_crossed(&self, passes: &[Pass]) -> bool {
        let ends = |pass: &Pass| Some([pass.points.first()?.tip, pass.points.last()?.tip]);
        let ends: Vec<[Vector; 2]> = passes.iter().filter_map(ends).collect();
        ends.windows(2).any(|pair| (pair[1][0] - pair[0][1]).xy().norm() > self.along)
    }
}

impl<'a> Sequence<'a> {
    /// Passes as they are given.
    pub fn of(given: &'a [Pass], begins_free: bool) -> Self {
        let ends = |pass: &Pass| Some([pass.points.first()?.tip, pass.points.last()?.tip]);
        let ends: Vec<[Vector; 2]> = given.iter().filter_map(ends).collect();
        let stops = (0..given.len()).map(|pass| Stop { pass, is_turned: false }).collect();
        Self { given, begins_free, turns: false, stops, ends, length: f64::INFINITY }
    }

    /// With open passes in both directions, if that is so.
    pub fn turning(self, turns: bool) -> Self {
        Self { turns, ..self }
    }

    /// The passes.
    pub fn given(&self) -> &'a [Pass] {
        self.given
    }

    /// Whether a pass may be followed in its other direction.
    pub fn may_turn(&self, pass: usize) -> bool {
        self.turns && !self.given[pass].closed
    }

    /// Whether a pass begins anywhere on it.
    pub fn begins_anywhere(&self, pass: usize) -> bool {
        self.begins_free && self.given[pass].closed
    }

    /// The same passes in another order.
    pub fn reordered(&self, stops: Vec<Stop>, air: &Air) -> Self {
        let mut ends: Vec<[Vector; 2]> = Vec::with_capacity(stops.len());
        let mut length = 0.0;
        for stop in &stops {
            let last = ends.last().map(|[_, end]| *end);
            let next = self.ends_after(*stop, last);
            length += last.map_or(0.0, |last| air.from_to(last, next[0]));
            ends.push(next);
        }
        Self { stops, ends, length, ..*self }
    }

    /// Where the tool comes to a pass from a tip, and where it leaves it.
    fn ends_after(&self, stop: Stop, from: Option<Vector>) -> [Vector; 2] {
        let points = &self.given[stop.pass].points;
        if let (true, Some(from)) = (self.begins_anywhere(stop.pass), from) {
            let distance = |tip: &Vector| (tip - from).norm_squared();
            let tips = points.iter().map(|point| point.tip);
            let nearest = tips.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(from);
            return [nearest; 2];
        }
        let ends = [points.first(), points.last()].map(|point| point.map_or_else(Vector::zeros, |point| point.tip));
        if stop.is_turned && self.may_turn(stop.pass) {
            [ends[1], ends[0]]
        } else {
            ends
        }
    }

    /// How the passes are followed, in their order.
    pub fn order(&self) -> Order {
        let visit = |(stop, [start, _]): (&Stop, &[Vector; 2])| Visit {
            pass: stop.pass,
            is_turned: stop.is_turned && self.may_turn(stop.pass),
            begins_at: self.begins_anywhere(stop.pass).then_some(*start),
        };
        Order(self.stops.iter().zip(&self.ends).map(visit).collect())
    }
}

/// An order that no longer holds the passes.
pub struct Order(Vec<Visit>);

struct Visit {
    pass: usize,
    is_turned: bool,
    /// Where a loop begins, if it is free to.
    begins_at: Option<Vector>,
}

impl Order {
    /// The given passes as they are followed; none is copied.
    pub fn of(&self, mut given: Vec<Pass>) -> Vec<Pass> {
        let follow = |visit: &Visit| {
            let pass = &mut given[visit.pass];
            let mut pass = Pass { points: std::mem::take(&mut pass.points), ..*pass };
            if visit.is_turned {
                pass.points.reverse();
            }
            if let Some(start) = visit.begins_at {
                begin_nearest(&mut pass.points, start);
            }
            pass
        };
        self.0.iter().map(follow).collect()
    }
}
