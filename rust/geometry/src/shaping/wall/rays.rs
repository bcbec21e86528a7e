//! The lines of steepest ascent of a wall: straight in plan, from the edge to the plane, or to where another part of the wall begins.

use std::f64::consts::PI;

use rayon::prelude::*;

use super::bend::Bend;
use super::corner::Corner;
use super::field::Walls;
use crate::Vector;

/// Rays start no farther apart than this along the edge, mm: what they enclose is checked and divided afterwards.
const PITCH: f64 = 2.0;
/// Halvings that find where a ray ends: 1e-12 of its length.
const HALVINGS: u32 = 40;
/// A wall is overtaken by another one where that is lower by more than this, mm.
const OVERTAKEN: f64 = 1e-9;
/// With arcs at the edge they bend in plan where it rises or falls; straight ones serve while they deviate by less than this share
/// of the tolerance.
const BENT: f64 = 0.25;
/// Corners of arcs at the edge lie no nearer to each other than this, mm: none on the edge itself.
const APART: f64 = 0.02;

/// A slope from which there is an ascent.
const LEAST: f64 = 1e-6;

/// A ray: corners of the wall above it.
#[derive(Clone, Debug)]
pub struct Ray {
    /// The corner of the edge at which it starts, by its number in the line; none between corners.
    pub corner: Option<usize>,
    /// Positions in plan where it crosses the section's levels, in their order, as far as it reaches.
    pub crossings: Vec<[f64; 2]>,
    /// Where another part of the wall ends it before it has crossed them all.
    pub end: Option<[f64; 2]>,
}

/// Where a ray begins and what it follows.
struct Start {
    corner: Option<usize>,
    foot: Vector,
    /// Unit vector in plan.
    direction: [f64; 2],
    /// The sides, by their numbers, whose walls the ray is a part of.
    own: [usize; 2],
    /// How the wall leaves the edge there.
    bend: Bend,
}

/// The rays of one closed line, counter-clockwise, whose sides have numbers from `first` on; `longest` bounds their lengths, mm.
pub fn rays(line: &[Vector], first: usize, walls: &Walls, corner: &Corner, levels: &[f64], tolerance: f64) -> Vec<Ray> {
    let low = line.iter().map(|point| point.z).fold(f64::INFINITY, f64::min);
    let longest = (levels.last().copied().unwrap_or(low) - low).max(tolerance) / corner.slope();
    // a turn that a chord over it cuts off by no more than the tolerance, along the wall's normal
    let most = (8.0 * tolerance / longest).sqrt();
    let starts = starts(line, first, walls, most);
    let chords = walls.chords(tolerance);
    let overtaken = if chords > 0 { BENT * tolerance } else { OVERTAKEN };
    starts.par_iter().map(|start| start.ray(walls, levels, chords, overtaken)).collect()
}

/// The direction of steepest ascent from a side with the rise `m` per length in plan, along the unit vector (x, y).
fn ascent([a, b]: [Vector; 2], slope: f64) -> [f64; 2] {
    let (dx, dy) = (b.x - a.x, b.y - a.y);
    let length = libm::hypot(dx, dy);
    let (x, y, m) = (dx / length, dy / length, (b.z - a.z) / length);
    let across = (slope * slope - m * m).max(0.0).sqrt();
    [(m * x + across * y) / slope, (m * y - across * x) / slope]
}

fn starts(line: &[Vector], first: usize, walls: &Walls, most: f64) -> Vec<Start> {
    let count = line.len();
    let side = |i: usize| [line[i % count], line[(i + 1) % count]];
    let mut starts = Vec::new();
    for (i, corner) in line.iter().enumerate() {
        let before = (i + count - 1) % count;
        let bends = [walls.bend(first + before, 1.0), walls.bend(first + i, 0.0)];
        let [from, to] = [(before, bends[0]), (i, bends[1])].map(|(side_of, bend)| {
            let along = side(side_of)[1] - side(side_of)[0];
            ascent(side(side_of), bend.rise(0.0).max(along.z.abs() / along.xy().norm()).max(LEAST))
        });
        let turn = libm::atan2(from[0] * to[1] - from[1] * to[0], from[0] * to[0] + from[1] * to[1]);
        // a fan about a corner that juts out; where the edge turns inwards, one ray along the crease of both walls
        let fan = if turn > most { (turn / most).ceil() as u32 } else { 0 };
        let begin = libm::atan2(from[1], from[0]);
        for k in 0..=fan {
            let share = if fan == 0 { 0.5 } else { f64::from(k) / f64::from(fan) };
            let (sin, cos) = libm::sincos(begin + share * turn);
            let own = [first + before, first + i];
            let bend = Bend { from: bends[0].from + share * (bends[1].from - bends[0].from), ..bends[0] };
            starts.push(Start { corner: Some(i), foot: *corner, direction: [cos, sin], own, bend });
        }
        let [a, b] = side(i);
        let parts = ((b - a).xy().norm() / PITCH).ceil().max(1.0) as u32;
        for k in 1..parts {
            let share = f64::from(k) / f64::from(parts);
            let (foot, bend) = (a + (b - a) * share, walls.bend(first + i, share));
            starts.push(Start { corner: None, foot, direction: to, own: [first + i; 2], bend });
        }
        debug_assert!(turn.abs() <= PI);
    }
    starts
}

impl Start {
    fn at(&self, length: f64) -> [f64; 2] {
        [self.foot.x + length * self.direction[0], self.foot.y + length * self.direction[1]]
    }

    fn ray(&self, walls: &Walls, levels: &[f64], chords: u32, overtaken: f64) -> Ray {
        let slope = walls.slope();
        let own = |length: f64| {
            self.own.map(|side| walls.of_side(side, self.at(length))).into_iter().fold(f64::INFINITY, f64::min)
        };
        let is_own = |length: f64| walls.at(self.at(length)).height >= own(length) - overtaken;
        let top = levels.last().copied().unwrap_or(self.foot.z);
        // along the crease of two walls it rises less steeply than they do
        let mut far = ((top - self.foot.z) / slope).max(0.0);
        for _ in 0..HALVINGS {
            if own(far) >= top - OVERTAKEN {
                break;
            }
            far *= 1.25;
        }
        let end = if is_own(far) { None } else { Some(bisected(0.0, far, is_own)) };
        let reach = end.unwrap_or(far);
        let reached = levels.iter().take_while(|level| end.is_none() || own(reach) > **level);
        let crossed = reached.map(|level| self.at(bisected(0.0, reach, |length| own(length) < *level)));
        let bent = self.bend.corners(chords, APART).take_while(|length| *length < reach).map(|length| self.at(length));
        let crossings = bent.chain(crossed).collect();
        Ray { corner: self.corner, crossings, end: end.map(|length| self.at(length)) }
    }
}

/// The largest length of a range up to which something holds that holds at its beginning only.
fn bisected(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
