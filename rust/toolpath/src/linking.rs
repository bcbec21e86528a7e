//! From passes to moves: their order, their direction, and how the tool gets from one to the next.
//!
//! Between neighbouring passes the tool rides on the envelope; where that would leave the selected faces or is long,
//! it goes up, across at clearance height, and down again at plunge feed.

use rayon::prelude::*;
use styluscam_geometry::Vector;
use styluscam_motion::{Cancelled, Move, MoveKind, Watch};

use crate::{fitting, fitting::Course, nearest, Pass, PathPoint, Surface};

/// Heights of the ways between passes, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heights {
    /// Rapids cross the part here.
    pub clearance: f64,
    /// Rapids come down to here; from here on at plunge feed.
    pub retract: f64,
}

/// Feeds, mm/min.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates {
    /// Along passes and links that touch.
    pub cut: f64,
    /// Straight down.
    pub plunge: f64,
}

/// How passes follow each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Links {
    /// Turn round every other level or row.
    pub alternate: bool,
    /// Longest way in plan that is ridden instead of flown, mm.
    pub ride: f64,
    /// How far ridden chords may stray, mm.
    pub deviation: f64,
    /// What is narrower may be ridden over unseen, mm.
    pub narrow: f64,
    /// Heights of the ways that are flown.
    pub heights: Heights,
    /// Feeds.
    pub rates: Rates,
    /// Index of the operation.
    pub operation: u32,
}

/// The moves along all passes. Within a group the nearest pass comes next; a loop begins where it is nearest.
///
/// # Errors
/// `Cancelled`.
pub fn link(surface: &Surface<'_>, passes: &[Pass], links: &Links, watch: &Watch) -> Result<Vec<Move>, Cancelled> {
    // ordered, then ridden to
    watch.begin("linking", 2 * passes.len());
    let passes = nearest::ordered(passes, links.alternate, watch)?;
    let mut route = Route { links, surface, moves: Vec::new() };
    let ways: Result<Vec<Option<Vec<PathPoint>>>, Cancelled> = (0..passes.len())
        .into_par_iter()
        .map(|number| {
            watch.advance(1)?;
            let before = number.checked_sub(1).and_then(|before| passes.get(before)?.points.last());
            let first = passes[number].points.first();
            Ok(before.zip(first).and_then(|(from, to)| route.ridden(from, to)))
        })
        .collect();
    let mut last = None;
    for (pass, way) in passes.iter().zip(ways?) {
        let Some((first, rest)) = pass.points.split_first() else { continue };
        match way {
            Some(way) => route.cut(&way),
            None => {
                route.leave(last);
                route.arrive(first);
            }
        }
        route.cut(rest);
        last = pass.points.last();
    }
    route.leave(last);
    Ok(route.moves)
}

/// A way over selected faces.
struct Way<'a> {
    surface: &'a Surface<'a>,
    hint: Option<u32>,
    /// Whether it has led over nothing else so far.
    is_sound: bool,
}

impl Course for Way<'_> {
    fn between(&mut self, a: &PathPoint, b: &PathPoint) -> Option<PathPoint> {
        let middle = self.surface.between(a, b, &mut self.hint);
        self.is_sound &= middle.is_some_and(|m| m.selected);
        middle.filter(|_| self.is_sound)
    }

    fn keeps_to(&self, a: &PathPoint, b: &PathPoint, most: f64) -> bool {
        self.surface.keeps_to_selected(a, b, most)
    }

    fn may_rise(&self, a: &PathPoint, b: &PathPoint, most: f64) -> bool {
        self.surface.may_rise(a, b, most)
    }
}

struct Route<'a> {
    links: &'a Links,
    surface: &'a Surface<'a>,
    moves: Vec<Move>,
}

impl Route<'_> {
    /// The way over the envelope from one point to another, without its first point; none when it should be flown.
    fn ridden(&self, from: &PathPoint, to: &PathPoint) -> Option<Vec<PathPoint>> {
        if (to.tip - from.tip).xy().norm() > self.links.ride {
            return None;
        }
        let mut way = Way { surface: self.surface, hint: None, is_sound: true };
        let runs = fitting::densified(&[*from, *to], self.links.deviation, self.links.narrow, &mut way);
        let way = runs.first().filter(|_| way.is_sound)?;
        Some(fitting::thinned(way, self.links.deviation)[1..].to_vec())
    }

    /// Straight up to clearance, if the tool is down.
    fn leave(&mut self, last: Option<&PathPoint>) {
        if let Some(last) = last {
            self.go(MoveKind::Rapid, at_height(last.tip, self.links.heights.clearance), 0.0);
        }
    }

    fn arrive(&mut self, first: &PathPoint) {
        let Heights { clearance, retract } = self.links.heights;
        self.go(MoveKind::Rapid, at_height(first.tip, clearance), 0.0);
        self.go(MoveKind::Rapid, at_height(first.tip, retract), 0.0);
        self.go(MoveKind::Feed, first.tip, self.links.rates.plunge);
    }

    fn cut(&mut self, points: &[PathPoint]) {
        for point in points {
            self.go(MoveKind::Feed, point.tip, self.links.rates.cut);
        }
    }

    fn go(&mut self, kind: MoveKind, end: Vector, feed: f64) {
        self.moves.push(Move::new(kind, end.into(), feed).of_operation(self.links.operation));
    }
}

fn at_height(p: Vector, z: f64) -> Vector {
    Vector::new(p.x, p.y, z)
}
