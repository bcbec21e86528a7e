//! From passes to moves: their order, their direction, and how the tool gets from one to the next.
//!
//! Between neighbouring passes the tool rides on the envelope; where that would leave the selected faces or is long,
//! it goes up, across at clearance height, and down again at plunge feed.

use styluscam_geometry::Vector;
use styluscam_motion::{Move, MoveKind};

use crate::{fitting, Pass, PathPoint, Surface};

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
#[must_use]
pub fn link(surface: &Surface<'_>, passes: Vec<Pass>, links: &Links) -> Vec<Move> {
    let mut route = Route { links, surface, moves: Vec::new(), last: None };
    let mut groups: Vec<Vec<Pass>> = Vec::new();
    for pass in passes {
        match groups.last_mut() {
            Some(group) if group[0].group == pass.group => group.push(pass),
            _ => groups.push(vec![pass]),
        }
    }
    for (number, mut group) in groups.into_iter().enumerate() {
        let turned = links.alternate && number % 2 == 1;
        while !group.is_empty() {
            let nearest = route.nearest(&group, turned);
            route.follow(&directed(group.remove(nearest), turned, route.last.as_ref()));
        }
    }
    route.leave();
    route.moves
}

/// A pass in its direction; a loop begins at its point nearest to `from`.
fn directed(mut pass: Pass, turned: bool, from: Option<&PathPoint>) -> Pass {
    if turned {
        pass.points.reverse();
    }
    if let (true, Some(from)) = (pass.closed, from) {
        pass.points.pop();
        let nearest = index_of_least(&pass.points, |p| (p.tip - from.tip).norm_squared());
        pass.points.rotate_left(nearest);
        pass.points.extend(pass.points.first().copied());
    }
    pass
}

fn index_of_least<T>(items: &[T], mut measure: impl FnMut(&T) -> f64) -> usize {
    let least = items.iter().enumerate().map(|(i, item)| (measure(item), i));
    least.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0, |(_, i)| i)
}

struct Route<'a> {
    links: &'a Links,
    surface: &'a Surface<'a>,
    moves: Vec<Move>,
    last: Option<PathPoint>,
}

impl Route<'_> {
    fn nearest(&self, group: &[Pass], turned: bool) -> usize {
        let Some(last) = self.last else { return 0 };
        index_of_least(group, |pass| {
            let entry = if turned { pass.points.last() } else { pass.points.first() };
            let entries = if pass.closed { &pass.points[..] } else { entry.map_or(&[][..], std::slice::from_ref) };
            entries.iter().map(|p| (p.tip - last.tip).norm_squared()).fold(f64::INFINITY, f64::min)
        })
    }

    fn follow(&mut self, pass: &Pass) {
        let Some(first) = pass.points.first() else { return };
        match self.last.and_then(|last| self.ridden(&last, first)) {
            Some(way) => self.cut(&way),
            None => {
                self.leave();
                self.arrive(first);
            }
        }
        self.cut(&pass.points[1..]);
        self.last = pass.points.last().copied();
    }

    /// The way over the envelope from one point to another, without its first point; none when it should be flown.
    fn ridden(&self, from: &PathPoint, to: &PathPoint) -> Option<Vec<PathPoint>> {
        if (to.tip - from.tip).xy().norm() > self.links.ride {
            return None;
        }
        let mut hint = None;
        let mut sound = true;
        let runs = fitting::densified(&[*from, *to], self.links.deviation, self.links.narrow, |a, b| {
            let middle = self.surface.between(a, b, &mut hint);
            sound &= middle.is_some_and(|m| m.selected);
            middle
        });
        let way = runs.first().filter(|_| sound)?;
        Some(fitting::thinned(way, self.links.deviation)[1..].to_vec())
    }

    /// Straight up to clearance, if the tool is down.
    fn leave(&mut self) {
        if let Some(last) = self.last.take() {
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
        self.moves.push(Move { kind, end: end.into(), arc: None, feed, operation: self.links.operation, line: 0 });
    }
}

fn at_height(p: Vector, z: f64) -> Vector {
    Vector::new(p.x, p.y, z)
}
