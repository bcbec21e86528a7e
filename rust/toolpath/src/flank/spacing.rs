//! Which positions of a movement are posted: so many, or as few as straight moves between them need to follow it.
//!
//! A controller moves the tip along a line and turns the axis with it. What that leaves is measured at the surface: a point where
//! the flank touches the surface that the continuous movement sweeps, from the flank on its straight move. To go elsewhere along
//! the movement itself does not count.

use styluscam_geometry::Vector;

use super::cutter::Flank;
use super::movement::Movement;
use super::stand::Stand;
use super::{FlankError, Method, RuledStrip};

/// The least tolerance, mm.
const LEAST: f64 = 1e-6;
/// So many positions as are never posted: the movement that straight moves are compared with is the continuous one.
const CONTINUOUS: usize = 1001;
/// Places between two positions at which their move is looked at, at least, and of the whole strip; heights of the flank.
const BETWEEN: usize = 7;
const OVERALL: usize = 64;
const HEIGHTS: usize = 5;
/// The place of the straight move that is nearest lies no farther off, as a share of it, and is found by so many sections.
const ASIDE: f64 = 0.25;
const SECTIONS: usize = 22;
const RATIO: f64 = 0.618_033_988_749_894_9;
/// A move is long enough when it leaves this share of the tolerance, or when longer ones have been tried so often.
const FULL: f64 = 0.96;
const TRIALS: usize = 40;
/// Positions at most.
const MOST: usize = 100_000;
/// The shortest move, as a share of the strip.
const SHORTEST: f64 = 1e-6;
/// How often all moves are made more alike.
const EVENINGS: usize = 4;

/// `count` positions of a flank, evenly spread over the rails' parameters, the first and the last at their ends.
///
/// # Errors
/// The tool does not fit, or no position touches both rails.
pub fn positions(strip: &RuledStrip, flank: &Flank, count: usize, method: Method) -> Result<Vec<Stand>, FlankError> {
    if !(2..=MOST).contains(&count) {
        return Err(FlankError::Count(count));
    }
    let movement = Movement::of(strip, flank, count, method)?;
    (0..count).map(|i| movement.at(i as f64 / (count - 1) as f64)).collect()
}

/// Positions of a flank, as few as are needed that straight moves between them leave the continuous movement of the method by no
/// more than the tolerance, mm, anywhere along the flank's height: the denser the more the movement bends.
///
/// # Errors
/// [`FlankError::Tolerance`]; the tool does not fit, or no position touches both rails.
pub fn positions_within(
    strip: &RuledStrip,
    flank: &Flank,
    tolerance: f64,
    method: Method,
) -> Result<Vec<Stand>, FlankError> {
    if !(tolerance >= LEAST && tolerance.is_finite()) {
        return Err(FlankError::Tolerance(tolerance));
    }
    let spacing = Spacing { strip, flank, movement: Movement::of(strip, flank, CONTINUOUS, method)? };
    let mut places = spacing.places(tolerance)?;
    // the last move is what is left over: with a smaller tolerance as many moves are alike
    let (mut within, mut beyond) = (tolerance, 0.0);
    let mut tried = tolerance * spacing.evened(&places, tolerance)?;
    for _ in 0..EVENINGS {
        let evener = spacing.places(tried.max(LEAST))?;
        if evener.len() > places.len() {
            beyond = tried;
        } else {
            (places, within) = (evener, tried);
        }
        tried = 0.5 * (within + beyond);
    }
    places.into_iter().map(|u| spacing.movement.at(u)).collect()
}

/// A movement that straight moves are to follow.
struct Spacing<'a> {
    strip: &'a RuledStrip,
    flank: &'a Flank,
    movement: Movement<'a>,
}

impl Spacing<'_> {
    /// Where positions are, from the first on each as far as the tolerance allows.
    fn places(&self, tolerance: f64) -> Result<Vec<f64>, FlankError> {
        let mut places = vec![0.0];
        let (mut from, mut length) = (0.0, 1.0);
        while from < 1.0 {
            length = self.reach(from, length, tolerance)?;
            from += length;
            places.push(from.min(1.0));
            if places.len() > MOST {
                return Err(FlankError::TooFine { tolerance, most: MOST });
            }
        }
        Ok(places)
    }

    /// The share of the tolerance with which the last move might be as long as the others: what is left grows by the square of a
    /// move's length.
    fn evened(&self, places: &[f64], tolerance: f64) -> Result<f64, FlankError> {
        let [.., before, last] = places else { return Ok(1.0) };
        let full = (self.off(*before, last - before)? / tolerance).sqrt().min(1.0);
        let moves = (places.len() - 1) as f64;
        let share = (moves - 1.0 + full) / moves;
        Ok(share * share)
    }

    /// How long a move from there may be; `length` is a guess.
    fn reach(&self, from: f64, length: f64, tolerance: f64) -> Result<f64, FlankError> {
        let rest = 1.0 - from;
        let (mut within, mut beyond) = (0.0, f64::INFINITY);
        let mut tried = length.min(rest);
        for _ in 0..TRIALS {
            let off = self.off(from, tried)?;
            if off <= tolerance {
                within = tried;
                if off >= FULL * tolerance || within >= rest {
                    break;
                }
            } else {
                beyond = tried;
            }
            if beyond - within <= SHORTEST {
                break;
            }
            // by the square of the length; else by halves
            let guess = tried * (0.5 * (1.0 + FULL) * tolerance / off).sqrt().clamp(0.1, 4.0);
            let most = beyond.min(rest);
            tried = if guess > within && guess < beyond { guess.min(rest) } else { 0.5 * (within + most) };
        }
        Ok(within.max(SHORTEST.min(rest)))
    }

    /// How far a straight move leaves the movement, mm.
    fn off(&self, from: f64, length: f64) -> Result<f64, FlankError> {
        let parts = 1 + BETWEEN.max((length * OVERALL as f64).ceil() as usize);
        let place = |i: usize| from + length * i as f64 / parts as f64;
        let stands = (0..=parts).map(|i| self.movement.at(place(i))).collect::<Result<Vec<_>, _>>()?;
        let (Some(first), Some(last)) = (stands.first(), stands.last()) else { return Ok(0.0) };
        let moved = StraightMove::between(first, last);
        let mut most = 0.0_f64;
        for (i, around) in (1..).zip(stands.windows(3)) {
            let normals = [0.0, 1.0].map(|v| self.strip.normal([place(i), v]));
            for j in 0..HEIGHTS {
                let v = j as f64 / (HEIGHTS - 1) as f64;
                let [before, here, after] = around else { continue };
                let Some(point) = touched([before, here, after], v, normals, self.flank) else { continue };
                most = most.max(moved.off(point, i as f64 / parts as f64, self.flank).abs());
            }
        }
        Ok(most)
    }
}

/// The point of the swept surface that the flank touches at a height: of the ball there that which all others miss, on the side
/// of the strip. None where that height of the flank only moves along the axis.
fn touched([before, here, after]: [&Stand; 3], v: f64, normals: [Vector; 2], flank: &Flank) -> Option<Vector> {
    let between = |[a, b]: [Vector; 2]| a + (b - a) * v;
    let length = |stand: &Stand| (stand.axis[1] - stand.axis[0]).norm();
    let along = here.direction();
    let moved = between(after.axis) - between(before.axis);
    let aside = moved - along * moved.dot(&along);
    let speed = aside.norm();
    if speed <= 1e-9 * length(here) {
        return None;
    }
    let aside = aside / speed;
    let grown = v * (length(after) - length(before));
    // the flank's normal leans down, and forwards where it moves along its axis
    let forwards = (flank.growth_along_line() * (grown - moved.dot(&along)) / speed).clamp(-1.0, 1.0);
    let across = along.cross(&aside);
    let across = if across.dot(&between(normals)) < 0.0 { -across } else { across };
    let level = aside * forwards + across * (1.0 - forwards * forwards).max(0.0).sqrt();
    let growth = flank.growth();
    let towards = along * growth + level * (1.0 - growth * growth).sqrt();
    Some(between(here.axis) - towards * flank.radius_at(length(here), v))
}

/// A move: the tip, and with it the point beside the first rail, along a line, the axis turning with it.
struct StraightMove {
    from: Vector,
    moved: Vector,
    along: Vector,
    turned: Vector,
}

impl StraightMove {
    fn between(first: &Stand, last: &Stand) -> Self {
        let along = first.direction();
        let [from, to] = [first, last].map(|stand| stand.axis[0]);
        Self { from, moved: to - from, along, turned: last.direction() - along }
    }

    /// Distance of a point from the flank at a share of the move, mm.
    fn distance(&self, point: Vector, share: f64, flank: &Flank) -> f64 {
        let axis = (self.along + self.turned * share).normalize();
        let way = point - self.from - self.moved * share;
        let height = way.dot(&axis);
        flank.distance(height, (way - axis * height).norm())
    }

    /// Distance of a point from the surface that the move sweeps, mm; below 0 inside. It is touched about at that share.
    fn off(&self, point: Vector, about: f64, flank: &Flank) -> f64 {
        let (mut low, mut high) = (about - ASIDE, about + ASIDE);
        let inner = |low: f64, high: f64| [high - RATIO * (high - low), low + RATIO * (high - low)];
        let at = |share: f64| self.distance(point, share, flank);
        let [mut p, mut q] = inner(low, high);
        let (mut at_p, mut at_q) = (at(p), at(q));
        for _ in 0..SECTIONS {
            if at_p < at_q {
                high = q;
                (q, at_q) = (p, at_p);
                p = inner(low, high)[0];
                at_p = at(p);
            } else {
                low = p;
                (p, at_p) = (q, at_q);
                q = inner(low, high)[1];
                at_q = at(q);
            }
        }
        at_p.min(at_q)
    }
}
