//! Slower feeds at sharp turns and on small arcs, as far as a machine's acceleration asks for them.
//!
//! At a corner the speed is that of a circle that touches both moves and leaves the corner by a deviation at most: with the angle
//! `t` between the direction back and the direction on, `v^2 = a d sin(t/2) / (1 - sin(t/2))` (S. K. Jeon, "Improving Grbl: Cornering
//! Algorithm", 2011). Arcs, and chords that stand for some, are as slow as `v^2 = a r`. Before a corner and behind it the feed
//! changes in steps, none faster than the acceleration allows at either of its ends. Derived in docs/concepts/linking.md.

use styluscam_motion::{Cornering, FeedMode, Move, MoveKind};

/// Seconds in a minute.
const MINUTE: f64 = 60.0;
/// Share of the speed allowed that is planned: what is within it is left as it is, and no feed changes by less.
const PLANNED: f64 = 0.95;
/// Feeds from step to step, at most.
const STEP: f64 = 2.0;
/// Steps are no shorter, mm, and no shorter than so many units of the last decimal.
const SHORTEST: f64 = 0.05;
const SHORTEST_UNITS: f64 = 20.0;
/// Moves that are shorter, in units of the last decimal, have no direction of their own.
const SHORTEST_HEADING: f64 = 2.0;
/// Turns by less are none, rad: rounding of coordinates.
const STRAIGHT: f64 = 1e-6;

/// The moves of an operation with slower feeds where a machine asks for them, lines divided where that is needed; and how many
/// corners and arcs that are.
///
/// The first feed behind a rapid keeps its own, and so do rapids and feeds that are not in mm/min.
#[must_use]
pub fn slowed(moves: &[Move], cornering: &Cornering) -> (Vec<Move>, usize) {
    let mut slowed = Vec::with_capacity(moves.len());
    let mut slow = 0;
    let mut number = 0;
    while let Some(step) = moves.get(number) {
        let start = number.checked_sub(1).map(|before| moves[before]);
        let Some(before) = start.filter(|before| is_fed(step) && before.kind == MoveKind::Feed) else {
            slowed.push(*step);
            number += 1;
            continue;
        };
        let rest = &moves[number..];
        let count = rest.iter().take_while(|step| is_fed(step)).count();
        let (run, corners) = Run::of(before.end.tip, &rest[..count], cornering);
        slow += corners;
        run.write(&rest[..count], SHORTEST.max(SHORTEST_UNITS * cornering.unit), &mut slowed);
        number += count;
    }
    (slowed, slow)
}

fn is_fed(step: &Move) -> bool {
    step.kind == MoveKind::Feed && step.feed_mode == FeedMode::PerMinute
}

/// Moves without a stop, and how fast they may be.
struct Run {
    acceleration: f64,
    /// Of each move: where it begins, its length, mm, and its highest speed, mm/s.
    starts: Vec<[f64; 3]>,
    lengths: Vec<f64>,
    tops: Vec<f64>,
    /// At each end of a move, mm/s.
    speeds: Vec<f64>,
}

impl Run {
    fn of(start: [f64; 3], moves: &[Move], cornering: &Cornering) -> (Self, usize) {
        let Cornering { acceleration, deviation, unit } = *cornering;
        let mut from = start;
        let (mut starts, mut lengths, mut tops, mut headings) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut slow = 0;
        for step in moves {
            let feed = step.feed / MINUTE;
            let path = step.path(from);
            let most = path.map_or(f64::INFINITY, |arc| PLANNED * (acceleration * arc.radius()).sqrt());
            slow += usize::from(most < PLANNED * feed);
            tops.push(if most < PLANNED * feed { most } else { feed });
            lengths.push(step.length(from));
            let heading =
                |a: f64, b: f64| path.map_or(direction(from, step.end.tip), |arc| direction(arc.at(a), arc.at(b)));
            headings.push([heading(0.0, 1e-4), heading(1.0 - 1e-4, 1.0)]);
            starts.push(from);
            from = step.end.tip;
        }
        // what the machine stops from within half of the deviation
        let least = (acceleration * deviation).sqrt();
        let mut speeds = vec![f64::INFINITY; moves.len() + 1];
        let mut last = headings.first().and_then(|ends| ends[1]);
        for number in 1..moves.len() {
            // what rounding makes of moves that are shorter than the last decimal is no direction
            let Some(after) = headings[number][0].filter(|_| lengths[number] >= SHORTEST_HEADING * unit) else {
                continue;
            };
            let before = std::mem::replace(&mut last, headings[number][1]);
            let Some(before) = before else { continue };
            let top = tops[number - 1].min(tops[number]);
            let turn = angle(before, after);
            if turn < STRAIGHT {
                continue;
            }
            let half = libm::cos(0.5 * turn);
            let around = (acceleration * deviation * half / (1.0 - half)).sqrt();
            let is_chords = moves[number - 1].arc.is_none() && moves[number].arc.is_none();
            let along = (acceleration * 0.5 * (lengths[number - 1] + lengths[number]) / turn).sqrt();
            let of_arcs = (number - 1..=number).filter(|i| tops[*i] < moves[*i].feed / MINUTE).map(|i| tops[i]);
            let allowed = PLANNED * if is_chords { around.min(along) } else { around }.max(least);
            speeds[number] = of_arcs.fold(f64::INFINITY, f64::min);
            if allowed < PLANNED * top {
                speeds[number] = speeds[number].min(allowed);
                slow += 1;
            }
        }
        let reach = |from: f64, length: f64| (from * from + 2.0 * acceleration * length).sqrt();
        for number in (0..moves.len()).rev() {
            speeds[number] = speeds[number].min(reach(speeds[number + 1].min(tops[number]), lengths[number]));
        }
        for number in 0..moves.len() {
            speeds[number + 1] = speeds[number + 1].min(reach(speeds[number].min(tops[number]), lengths[number]));
        }
        (Self { acceleration, starts, lengths, tops, speeds }, slow)
    }

    /// Writes the moves with their feeds.
    fn write(&self, moves: &[Move], shortest: f64, into: &mut Vec<Move>) {
        let mut last = f64::INFINITY;
        for (number, step) in moves.iter().enumerate() {
            let start = self.starts[number];
            let is_whole = step.arc.is_some_and(|arc| arc.turns > 0);
            for (share, allowed) in self.pieces(number, is_whole, shortest) {
                let is_near = last <= allowed && last >= PLANNED * allowed && allowed < self.tops[number];
                last = if is_near { last } else { allowed };
                let at = || step.path(start).map_or_else(|| between(start, step.end.tip, share), |arc| arc.at(share));
                let piece = if share < 1.0 { step.to(at()) } else { *step };
                let feed = if last < (1.0 - 1e-9) * step.feed / MINUTE { last * MINUTE } else { step.feed };
                into.push(piece.with_feed(feed, step.feed_mode));
            }
        }
    }

    /// The pieces of a move: up to which share of it, and how fast, mm/s. An arc of several turns is one.
    fn pieces(&self, number: usize, is_whole: bool, shortest: f64) -> Vec<(f64, f64)> {
        let (length, top) = (self.lengths[number], self.tops[number]);
        let [first, last] = [self.speeds[number].min(top), self.speeds[number + 1].min(top)];
        if is_whole || length < 2.0 * shortest || (first >= top && last >= top) {
            return vec![(1.0, first.min(last))];
        }
        let reach = |from: f64, way: f64| (from * from + 2.0 * self.acceleration * way).sqrt();
        let allowed = |at: f64| reach(first, at).min(reach(last, length - at)).min(top);
        // where both meet
        let middle = 0.5 * length + (last * last - first * first) / (4.0 * self.acceleration);
        let middle = middle.clamp(0.0, length);
        let steps = |from: f64, within: f64| {
            let mut steps = vec![0.0];
            let mut speed = from;
            while speed < top {
                speed = (STEP * speed).min(top);
                let at = (speed * speed - from * from) / (2.0 * self.acceleration);
                if at >= within {
                    break;
                }
                if at - steps[steps.len() - 1] >= shortest {
                    steps.push(at);
                }
            }
            steps
        };
        let mut ends = steps(first, middle);
        let back = steps(last, length - middle);
        ends.extend(back[1..].iter().rev().map(|at| length - at).filter(|at| *at > middle));
        ends.push(length);
        // no piece between both that is too short
        while let Some(short) = (1..ends.len() - 1).find(|i| ends[i + 1] - ends[*i] < shortest) {
            ends.remove(short);
        }
        let pieces = ends.windows(2).map(|ends| (ends[1] / length, allowed(ends[0]).min(allowed(ends[1]))));
        let mut pieces: Vec<(f64, f64)> = pieces.collect();
        if let Some(last) = pieces.last_mut() {
            last.0 = 1.0;
        }
        pieces
    }
}

fn direction(a: [f64; 3], b: [f64; 3]) -> Option<[f64; 3]> {
    let along = [0, 1, 2].map(|axis| b[axis] - a[axis]);
    let length = along.iter().map(|x| x * x).sum::<f64>().sqrt();
    (length > 0.0).then(|| along.map(|x| x / length))
}

/// Between two unit vectors, rad: exact for small ones too.
fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    let norm = |of: [f64; 3]| of.iter().map(|x| x * x).sum::<f64>().sqrt();
    2.0 * libm::atan2(norm([0, 1, 2].map(|i| a[i] - b[i])), norm([0, 1, 2].map(|i| a[i] + b[i])))
}

fn between(a: [f64; 3], b: [f64; 3], share: f64) -> [f64; 3] {
    [0, 1, 2].map(|axis| a[axis] + share * (b[axis] - a[axis]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use styluscam_motion::{Arc, Plane};

    const MACHINE: Cornering = Cornering { acceleration: 500.0, deviation: 0.01, unit: 0.001 };
    const FEED: f64 = 1500.0;

    fn path(points: &[[f64; 3]]) -> Vec<Move> {
        let down = [Move::rapid(points[0]), Move::feed(points[0], 300.0)];
        down.into_iter().chain(points[1..].iter().map(|tip| Move::feed(*tip, FEED))).collect()
    }

    #[test]
    fn a_right_angle_is_taken_as_fast_as_its_circle() {
        let moves = path(&[[0.0; 3], [10.0, 0.0, 0.0], [10.0, 10.0, 0.0]]);
        let (slow, count) = slowed(&moves, &MACHINE);
        assert_eq!(count, 1);
        let corner = slow
            .iter()
            .position(|step| step.end.tip.map(f64::to_bits) == [10.0_f64, 0.0, 0.0].map(f64::to_bits))
            .unwrap();
        // v^2 = a d sin 45 / (1 - sin 45): 3.474 mm/s, of which 95 % are planned
        let expected = 0.95 * MINUTE * (500.0 * 0.01 * 0.5_f64.sqrt() / (1.0 - 0.5_f64.sqrt())).sqrt();
        assert!((slow[corner].feed - expected).abs() < 1e-9 && (slow[corner + 1].feed - expected).abs() < 1e-9);
        // the step to twice the feed would be 0.033 mm long: to four times after 0.163 mm; all of the feed at both ends
        assert!(slow[2..].windows(2).all(|pair| pair[1].feed <= 4.0001 * pair[0].feed));
        assert_eq!((slow[2].feed, slow[slow.len() - 1].feed), (FEED, FEED));
        let lengths: f64 = slow[2..].windows(2).map(|pair| pair[1].length(pair[0].end.tip)).sum();
        assert!((lengths + slow[2].length([0.0; 3]) - 20.0).abs() < 1e-9);
        // no faster at the end of a step than the acceleration allows from the corner
        let mut distance = 0.0;
        for pair in slow[corner..].windows(2) {
            let allowed = (expected.powi(2) + 2.0 * 500.0 * 3600.0 * distance).sqrt();
            assert!(pair[1].feed <= allowed + 1e-6, "{} {allowed}", pair[1].feed);
            distance += pair[1].length(pair[0].end.tip);
        }
    }

    #[test]
    fn straight_on_nothing_changes_and_back_is_slowest() {
        let straight = path(&[[0.0; 3], [5.0, 0.0, 0.0], [5.1, 0.0, 0.0], [20.0, 0.0, 0.0]]);
        assert_eq!(slowed(&straight, &MACHINE), (straight, 0));
        let back = path(&[[0.0; 3], [5.0, 0.0, 0.0], [0.0, 0.0, 0.0]]);
        let (slow, _) = slowed(&back, &MACHINE);
        let least = slow[2..].iter().map(|step| step.feed).fold(f64::INFINITY, f64::min);
        assert!((least - 0.95 * MINUTE * 5.0_f64.sqrt()).abs() < 1e-9, "{least}");
    }

    #[test]
    fn circles_of_arcs_and_of_chords_are_as_slow() {
        let radius = 0.3;
        let at = |i: usize| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * i as f64 / 90.0);
            [radius * cos, radius * sin, -1.0]
        };
        let top = 0.95 * MINUTE * (500.0 * radius).sqrt();
        let chords = path(&(0..=90).map(at).collect::<Vec<_>>());
        let (slow, _) = slowed(&chords, &MACHINE);
        let least = slow[2..].iter().map(|step| step.feed).fold(f64::INFINITY, f64::min);
        assert!((least / top - 1.0).abs() < 0.01, "{least} {top}");
        // one feed for all of it, but for where it begins and ends
        let feeds = slow[35..60].windows(2).filter(|pair| (pair[0].feed - pair[1].feed).abs() > 0.0).count();
        assert_eq!(feeds, 0);
        let mut arc = path(&[at(0), [-radius, 0.0, -1.0], [-20.0, 0.0, -1.0]]);
        arc[2].arc = Some(Arc { centre: [0.0, 0.0, -1.0], plane: Plane::Xy, clockwise: false, turns: 0 });
        let (slow, count) = slowed(&arc, &MACHINE);
        assert!(count == 2 && slow[2].feed <= top + 1e-9, "{count} {:?}", slow[2]);
    }

    #[test]
    fn what_is_not_along_a_path_keeps_its_feed() {
        let moves = path(&[[0.0; 3], [1.0, 0.0, 0.0]]);
        assert_eq!(slowed(&moves, &MACHINE), (moves.clone(), 0));
        let per_revolution: Vec<Move> = path(&[[0.0; 3], [9.0, 0.0, 0.0], [9.0, 9.0, 0.0]])
            .iter()
            .map(|step| step.with_feed(0.1, FeedMode::PerRevolution))
            .collect();
        assert_eq!(slowed(&per_revolution, &MACHINE).1, 0);
    }
}
