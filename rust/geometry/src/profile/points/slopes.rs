//! The slope at each corner of the hull: how the turn there is shared by the two segments that meet.

use std::f64::consts::FRAC_PI_2;

use super::hull::Chord;
use super::leg::corner_at_start;

/// A leg takes at most this many times the turn at its other end: more would bend it at one end only.
const MOST_UNEVEN: f64 = 8.0;
/// Neither of two segments takes less than this share of their turn for its length alone.
const LEAST_SHARE: f64 = 1.0 / 64.0;
/// The least turn of a leg's end, rad, some bits above rounding of a slope.
const LEAST_TURN: f64 = 1e-14;
/// Points on a chord mean a line if they would be off an arc by more than this share of the tolerance.
const STRAIGHT: f64 = 0.5;
/// A larger turn (rad) between two segments that may not bend is a corner: the round that the tolerance leaves for it is less
/// than sixteen times the tolerance.
const SHARP: f64 = 0.35;
/// What the bend may take of the tolerance that a leg's points leave.
const BEND: f64 = 0.9;

/// The slope at the start of the first chord, at each corner and at the end of the last chord, rad.
///
/// 0 at a rounded tip. Straight chords keep their own slope at both ends.
pub fn at_corners(chords: &[Chord], tolerance: f64, size: f64) -> Vec<f64> {
    let mut legs = Legs::new(chords, tolerance);
    let most = legs.most.clone();
    legs.share_turns();
    // some segments must bend sharply at their end: again, with less at their start
    if let Some(less) = legs.bent_late(most) {
        legs.most = less;
        legs.share_turns();
    }
    legs.slopes(size)
}

struct Legs<'a> {
    chords: &'a [Chord],
    /// Which are lines.
    straight: Vec<bool>,
    /// The most that each may turn at its start and its end, rad, so that its bend stays with the points that it passes.
    most: Vec<[f64; 2]>,
    /// What each turns at its start, rad.
    starts: Vec<f64>,
}

impl<'a> Legs<'a> {
    fn new(chords: &'a [Chord], tolerance: f64) -> Self {
        let count = chords.len();
        let mut legs = Self { chords, straight: vec![false; count], most: Vec::new(), starts: vec![0.0; count] };
        let lines: Vec<bool> = (0..count).map(|i| legs.is_line(i, tolerance)).collect();
        // between two lines there is a corner, which both must help to round; a flat end or side cannot
        let bends = |i: usize| lines[i] && !chords[i].axial;
        let beside_line = |i: usize| (i > 0 && lines[i - 1]) || lines.get(i + 1) == Some(&true);
        legs.straight = (0..count).map(|i| lines[i] && !(bends(i) && beside_line(i))).collect();
        legs.most = (0..count).map(|i| [legs.most_turn(i, tolerance); 2]).collect();
        legs
    }

    /// Shares the turn at each corner between the segments that meet there.
    fn share_turns(&mut self) {
        for joint in 1..self.chords.len() {
            let turn = self.turn(joint);
            let (before, after) = (self.most[joint - 1][1], self.most[joint][0]);
            self.starts[joint] = if before + after < turn && turn <= SHARP && after > 0.0 {
                // all that the leg before does not take; the bend is small still where the other end turns little
                self.most[joint][1] = self.most[joint][1].min(0.5 * after);
                turn - before
            } else {
                self.taken_by_the_next(joint, turn)
            };
        }
    }

    /// What segments may turn, less at the start of those that turn more at their end than they may at both; if there are any.
    fn bent_late(&self, mut most: Vec<[f64; 2]>) -> Option<Vec<[f64; 2]>> {
        let mut any = false;
        for joint in 1..self.chords.len() {
            let (turn, allowed) = (self.turn(joint), most[joint - 1][1]);
            if turn - self.starts[joint] > 1.01 * allowed && allowed > 0.0 && turn <= SHARP {
                most[joint - 1] = [0.5 * allowed, f64::INFINITY];
                any = true;
            }
        }
        any.then_some(most)
    }

    fn slopes(&mut self, size: f64) -> Vec<f64> {
        let (chords, end) = (self.chords, self.chords.len());
        let mut slopes = vec![0.0; end + 1];
        for joint in 1..end {
            slopes[joint] = if self.straight[joint] {
                chords[joint].slope
            } else if self.straight[joint - 1] {
                chords[joint - 1].slope
            } else {
                chords[joint].slope - self.starts[joint]
            };
        }
        let (Some(first), Some(last)) = (chords.first(), chords.last()) else { return slopes };
        let mut start = first.slope.min(self.most[0][0]);
        self.starts[0] = start;
        slopes[end] = (last.slope + self.turn_at_the_end(self.starts[end - 1])).min(FRAC_PI_2);
        let after = slopes[1] - first.slope;
        if start > 0.0 && corner_at_start(first.length, start, after, size) {
            // as much on either side: pointed
            start = after;
        }
        // no difference to itself where the tip is rounded
        slopes[0] = if start < first.slope { first.slope - start } else { 0.0 };
        slopes
    }

    /// Whether a chord's points show that it is a line: an arc would pass them at a distance.
    fn is_line(&self, i: usize, tolerance: f64) -> bool {
        let chord = &self.chords[i];
        let turn = match i {
            0 => chord.slope,
            i if i + 1 < self.chords.len() => self.turn(i).min(self.turn(i + 1)),
            i => self.turn(i),
        };
        chord.axial || (chord.on_line && 0.125 * turn * chord.length > STRAIGHT * tolerance)
    }

    fn most_turn(&self, i: usize, tolerance: f64) -> f64 {
        match (self.straight[i], self.chords[i].depth) {
            (true, _) => 0.0,
            (_, None) => f64::INFINITY,
            // an arc over a chord L that turns by t on either side rises by L tan(t/2) / 2
            (_, Some(depth)) => {
                let rise = BEND * (tolerance - depth).max(0.0);
                (2.0 * libm::atan(2.0 * rise / self.chords[i].length)).max(LEAST_TURN)
            }
        }
    }

    /// The turn from one chord to the next, at the start of chord `joint`; at the tip, from its mirror image.
    fn turn(&self, joint: usize) -> f64 {
        match joint {
            0 => 2.0 * self.chords[0].slope,
            joint => self.chords[joint].slope - self.chords[joint - 1].slope,
        }
    }

    /// What the leg after a joint takes of the turn there, rad.
    fn taken_by_the_next(&self, joint: usize, turn: f64) -> f64 {
        let share = self.share_of_the_next(joint).clamp(LEAST_SHARE, 1.0 - LEAST_SHARE);
        let next =
            if joint + 1 < self.chords.len() { self.turn(joint + 1) } else { FRAC_PI_2 - self.chords[joint].slope };
        let before = self.most[joint - 1][1].min(MOST_UNEVEN * self.turn(joint - 1));
        let after = self.most[joint][0].min(MOST_UNEVEN * next);
        if before + after <= turn {
            // more than either should take
            return if before + after > 0.0 { turn * after / (before + after) } else { turn * share };
        }
        (turn * share).clamp(turn - before.min(turn), after.min(turn))
    }

    /// The share of a joint's turn that belongs to the leg after it, as on a smooth curve through the points.
    ///
    /// The circle through three points shares the turn by length. Where the curvature changes evenly, the segments' own
    /// curvatures, taken from their other ends, add a part that makes it exact to the third order; where it jumps, only
    /// they count.
    fn share_of_the_next(&self, joint: usize) -> f64 {
        let length = |i: usize| self.chords[i].length;
        let (before, after) = (length(joint - 1), length(joint));
        let by_length = after / (before + after);
        let (beyond_before, bend_before) = self.far_end(joint - 1, joint - 1, joint.checked_sub(2));
        let (beyond_after, bend_after) = if joint + 1 < self.chords.len() {
            self.far_end(joint, joint + 1, Some(joint + 1))
        } else {
            // no point beyond: as the curvature has changed so far
            let here = 2.0 * self.turn(joint) / (before + after);
            (after, (2.0 * here - bend_before).max(0.5 * here))
        };
        let sum = before * bend_before + after * bend_after;
        if sum <= 0.0 {
            return by_length;
        }
        let by_bend = after * bend_after / sum;
        let weight = (before + after) / (beyond_before + 2.0 * (before + after) + beyond_after);
        let apart = (bend_before - bend_after).abs() / (bend_before + bend_after);
        let weight = weight + (1.0 - weight) * (3.0 * apart - 1.0).clamp(0.0, 1.0);
        by_length + weight * (by_bend - by_length)
    }

    /// Length of the leg beyond a leg's other end, and the curvature there.
    fn far_end(&self, leg: usize, joint: usize, beyond: Option<usize>) -> (f64, f64) {
        let own = self.chords[leg].length;
        let beyond_length = beyond.map_or(own, |i| self.chords[i].length);
        let shared = if beyond.is_some_and(|i| self.straight[i]) { own } else { own + beyond_length };
        (beyond_length, 2.0 * self.turn(joint) / shared)
    }

    /// What the last leg turns beyond its chord, rad: as at its start, and a little more or less as the curvature goes.
    fn turn_at_the_end(&self, start: f64) -> f64 {
        let end = self.chords.len();
        let last = &self.chords[end - 1];
        if self.straight[end - 1] {
            return 0.0;
        }
        if end < 3 || self.straight[end - 2] {
            return if start > 0.0 { start } else { last.slope }.min(self.most[end - 1][1]);
        }
        let lengths = [end - 3, end - 2].map(|i| self.chords[i].length);
        let bend = |joint: usize| 2.0 * self.turn(joint) / (self.chords[joint - 1].length + self.chords[joint].length);
        let change = 3.0 * (bend(end - 1) - bend(end - 2)) / (lengths[0] + lengths[1] + last.length);
        let turned = start + last.length * last.length * change / 6.0;
        turned.clamp(0.5 * start, 2.0 * start).min(self.most[end - 1][1])
    }
}
