//! Paths that go down evenly from a loop to the one below it: turns of spirals, and ramps.
//!
//! Between two loops, one a level below the other, the path has the height that its length so far gives it, and lies where the
//! envelope has that height on the straight line in plan between two points of the loops that belong together
//! ([`super::stitch`]). So each of its points is exact, for loops of any shape; between them it is fitted like every pass.
//!
//! Derived in docs/concepts/spirals.md.

use super::{level_curve::LevelCurve, stitch, stitch::Beside};
use crate::fitting::{self, Bending};
use crate::{ordering, Pass, PathPoint, Surface};

/// The line between two points is looked at this far beyond both, mm: on upright walls they lie over each other.
const BEYOND: f64 = 0.02;
/// Points of two levels are this many times farther apart than the slope gives, at most: in a corner of 30 degrees, 3.9 times.
const FAR: f64 = 4.0;
/// Walls that are steeper count as this steep, a cotangent: corners and rounding.
const LEAST: f64 = 0.3;
/// Shifts of the path against the loops that it runs between, at least, mm: shorter lines have no direction of their own.
const DIRECTED: f64 = 1e-6;

/// How a path goes down between two loops.
#[derive(Clone, Copy)]
pub(super) struct Descent<'a> {
    pub surface: &'a Surface<'a>,
    pub deviation: f64,
    pub longest: f64,
    /// Whether the path runs against the direction in which loops are traced.
    pub is_turned: bool,
}

/// A closed loop, and how far round each of its points is, from 0 to 1.
pub(super) struct Level {
    pub points: Vec<PathPoint>,
    round: Vec<f64>,
}

impl Level {
    /// By the length in plan.
    pub fn new(points: Vec<PathPoint>) -> Self {
        let round = stitch::by_length(&points);
        Self { points, round }
    }
}

impl Descent<'_> {
    /// One turn from a loop, from its first point on, down to the next one, with that loop as it begins there.
    pub(super) fn turn(&self, above: &Level, below: &Pass) -> Option<(Vec<PathPoint>, Level)> {
        let (below, pairs) = facing(above, below)?;
        let turn = self.fitted(above, &below, &pairs, 1.0)?;
        Some((turn, below))
    }

    /// A ramp from a loop's first point, this share of a turn long or up to the next point of the loop below, at which it arrives.
    pub(super) fn ramp(&self, above: Vec<PathPoint>, below: &Pass, share: f64) -> Option<Vec<PathPoint>> {
        let above = Level::new(above);
        let (below, pairs) = facing(&above, below)?;
        let (end, round) = arrival(&below.round, share)?;
        let ramp = self.fitted(&above, &below, &until(pairs, end), round)?;
        let arrives = ramp.last()?.tip == below.points.get(end)?.tip;
        arrives.then_some(ramp)
    }

    /// The path between points that belong together, which falls evenly and is at the lower loop when it is `whole` round.
    fn fitted(&self, above: &Level, below: &Level, pairs: &[[usize; 2]], whole: f64) -> Option<Vec<PathPoint>> {
        let mut curve = LevelCurve::new(self.surface, 0.0);
        let down = if self.surface.keeps_witnesses() { evenly_down } else { half_down };
        let exact = exact(&mut curve, above, below, (pairs, whole), down)?;
        let between = |a: &PathPoint, b: &PathPoint| {
            let level = curve.at_height(0.5 * (a.tip.z + b.tip.z));
            if self.is_turned {
                level.between(b, a)
            } else {
                level.between(a, b)
            }
        };
        let mut course = Bending { between, bend: self.surface.bend() };
        let runs = fitting::densified(&exact, self.deviation, self.longest, &mut course);
        let [run] = &runs[..] else { return None };
        let is_whole = run.iter().all(|point| point.selected)
            && self.surface.goes_on_along(run)
            && run.windows(2).all(|pair| pair[1].tip.z < pair[0].tip.z);
        is_whole.then(|| self.surface.thinned(run, self.deviation))
    }
}

/// The next loop as it begins beside the first point of the one above, and the pairs of their points; none where they are too
/// far apart.
fn facing(above: &Level, below: &Pass) -> Option<(Level, Vec<[usize; 2]>)> {
    let mut points = below.points.clone();
    ordering::begin_nearest(&mut points, above.points.first()?.tip);
    let pairs = stitch::pairs(&above.points, &points);
    let beside = stitch::beside(&pairs, [&above.points, &points]);
    let turned: Vec<[usize; 2]> = pairs.iter().map(|[i, j]| [*j, *i]).collect();
    let of_above = stitch::beside(&turned, [&points, &above.points]);
    let is_far = is_far(&beside, [&above.points, &points]) || is_far(&of_above, [&points, &above.points]);
    if is_far || beside.len() != points.len() {
        return None;
    }
    let round = stitch::carried(&beside, &above.round, &points);
    Some((Level { points, round }, pairs))
}

/// Whether a point of the second loop is farther in plan from the first than their slopes explain: the wall ends between them.
fn is_far(beside: &[Beside], [first, second]: [&[PathPoint]; 2]) -> bool {
    let flat = |point: &PathPoint| point.normal.z.max(0.0) / point.normal.xy().norm().max(f64::MIN_POSITIVE);
    let is_far = |(near, point): (&Beside, &PathPoint)| {
        let Some(other) = first.get(near.side) else { return true };
        let expected = (other.tip.z - point.tip.z).abs() * flat(other).max(flat(point)).max(LEAST);
        near.square.sqrt() > FAR * expected
    };
    beside.iter().zip(second).any(is_far)
}

/// Exact points between those above and below that belong together, as far down as they are round, of a `whole`.
fn exact(
    curve: &mut LevelCurve<'_>,
    above: &Level,
    below: &Level,
    (pairs, whole): (&[[usize; 2]], f64),
    down: fn([f64; 2], f64) -> f64,
) -> Option<Vec<PathPoint>> {
    let mut points: Vec<PathPoint> = Vec::with_capacity(pairs.len());
    for (number, [i, j]) in pairs.iter().enumerate() {
        let share = down([*above.round.get(*i)?, *below.round.get(*j)?], whole);
        let (above, below) = (above.points.get(*i)?, below.points.get(*j)?);
        // ends are the loops' own points
        let point = match share {
            _ if number + 1 == pairs.len() => *below,
            share if share <= 0.0 => *above,
            share if share >= 1.0 => continue,
            share => between(curve, above, below, share)?,
        };
        // pairs that lie over each other in plan are one position of the path
        if points.last().is_none_or(|last| (last.tip - point.tip).xy().norm() > DIRECTED) {
            points.push(point);
        }
    }
    (points.len() > 1).then_some(points)
}

/// How far down the path is between points of which the upper and the lower one are so far round, of a `whole`: as their middle is.
///
/// Where one of both has neighbours that are far apart, the path falls in waves about an even slope; chords pass over them.
fn half_down([above, below]: [f64; 2], whole: f64) -> f64 {
    0.5 * (above + below) / whole
}

/// The same, evenly: so far down as it is round itself, which is nearer to the upper point's the higher it is. Arcs are as long as
/// the path is even.
fn evenly_down([above, below]: [f64; 2], whole: f64) -> f64 {
    above / (whole + above - below).max(f64::MIN_POSITIVE)
}

/// The point of the envelope between a higher and a lower one in plan, this share of the height down.
fn between(curve: &mut LevelCurve<'_>, above: &PathPoint, below: &PathPoint, share: f64) -> Option<PathPoint> {
    let z = above.tip.z + share * (below.tip.z - above.tip.z);
    let span = (below.tip - above.tip).xy();
    let free = if span.norm() > BEYOND { span } else { above.normal.xy() };
    let along = free.try_normalize(DIRECTED)? * BEYOND;
    let (from, to) = (above.tip.xy() - along, below.tip.xy() + along);
    let guess = (BEYOND + share * span.norm()) / (to - from).norm();
    curve.at_height(z).crossing(from.into(), to.into(), guess)
}

/// The number of the first point of a loop that is at least this share round, and how far it is: the last one at most.
fn arrival(round: &[f64], share: f64) -> Option<(usize, f64)> {
    let number = (1..round.len()).find(|number| round[*number] >= share).or(round.len().checked_sub(1))?;
    round.get(number).filter(|round| **round > 0.0).map(|round| (number, *round))
}

/// Pairs of points up to the first that belongs to the lower loop's `arrival`.
fn until(pairs: Vec<[usize; 2]>, arrival: usize) -> Vec<[usize; 2]> {
    let end = pairs.iter().position(|[_, below]| *below == arrival).map_or(pairs.len(), |end| end + 1);
    pairs.into_iter().take(end).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_arrives_at_a_point_of_the_loop_and_no_sooner_than_asked() {
        let round = [0.0, 0.2, 0.5, 0.8, 1.0];
        assert_eq!(arrival(&round, 0.3), Some((2, 0.5)));
        assert_eq!(arrival(&round, 0.0), Some((1, 0.2)));
        assert_eq!(arrival(&round, 7.0), Some((4, 1.0)));
        assert_eq!(arrival(&[0.0], 0.1), None);
        assert_eq!(until(vec![[0, 0], [1, 0], [1, 1], [2, 1], [2, 2]], 1), [[0, 0], [1, 0], [1, 1]]);
    }
}
