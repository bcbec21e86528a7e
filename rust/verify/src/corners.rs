//! Feeds at sharp turns and on small arcs, compared with what the machine's acceleration allows, where the job asks for that.
//!
//! A circle of the radius `R` that touches both lines of a corner turned by `t` leaves the corner by `d = R (1/cos(t/2) - 1)`: with
//! `v^2 = a R` that is the highest speed for a deviation `d` (S. K. Jeon, "Improving Grbl: Cornering Algorithm", 2011). Positions
//! of a text are rounded: of each turn so much is taken off as that may make.

use styluscam_motion::{Cornering, FeedMode, Move, MoveKind, Program};

use crate::assignment::Assignment;
use crate::faults::{self, Fault};
use crate::subject::Limits;

/// Feeds above the limit by this share are within it: rounding of feeds, and of arcs' radii.
const WITHIN: f64 = 0.02;
/// How far rounding may turn a move, in units of a coordinate's last decimal over its length: both ends, in space.
const ROUNDED: f64 = 1.75;

/// Faults in the order of the moves.
pub(crate) fn faults(program: &Program, assignment: &Assignment, limits: &Limits) -> Vec<Fault> {
    let Some(cornering) = limits.reach.cornering else { return Vec::new() };
    let is_slow = |step: &Move| assignment.of(step.operation).is_some_and(|operation| operation.slows_at_corners);
    let mut faults = Vec::new();
    let mut run: Vec<Stretch> = Vec::new();
    let mut comes_down = true;
    for (index, (start, step)) in program.segments().enumerate() {
        let is_feed = step.kind == MoveKind::Feed && step.feed_mode == FeedMode::PerMinute;
        let Some(start) = start.filter(|_| is_feed && !comes_down && is_slow(step)) else {
            check(&run, program, &cornering, limits, &mut faults);
            run.clear();
            comes_down = step.kind == MoveKind::Rapid;
            continue;
        };
        run.extend(Stretch::of(index, start, step));
    }
    check(&run, program, &cornering, limits, &mut faults);
    faults
}

/// A move that has a length.
struct Stretch {
    index: usize,
    length: f64,
    /// Of an arc, mm.
    radius: Option<f64>,
    /// Directions at both ends.
    from: [f64; 3],
    to: [f64; 3],
}

impl Stretch {
    fn of(index: usize, start: [f64; 3], step: &Move) -> Option<Self> {
        let path = step.path(start);
        let tips = |a: f64, b: f64| path.map_or([start, step.end.tip], |arc| [arc.at(a), arc.at(b)]);
        let heading = |[a, b]: [[f64; 3]; 2]| {
            let along = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
            let length = dot(along, along).sqrt();
            (length > 0.0).then(|| along.map(|x| x / length))
        };
        let (from, to) = (heading(tips(0.0, 1e-4))?, heading(tips(1.0 - 1e-4, 1.0))?);
        Some(Self { index, length: step.length(start), radius: path.map(|arc| arc.radius()), from, to })
    }
}

fn check(run: &[Stretch], program: &Program, cornering: &Cornering, limits: &Limits, faults: &mut Vec<Fault>) {
    let Cornering { acceleration, .. } = *cornering;
    let mut find = |stretch: &Stretch, speed: f64, turn: Option<f64>| {
        let step = &program.moves[stretch.index];
        let most = 60.0 * speed;
        let slack = limits.feed_slack(most, stretch.length) + WITHIN * most;
        if step.feed > most + slack {
            let kind = if turn.is_some() { &faults::CORNER_FEED } else { &faults::ARC_FEED };
            faults.push(Fault::of(kind, stretch.index, step).measured(step.feed, most));
        }
    };
    let turns = turns(run, cornering.unit);
    let straight = straight(run, &turns);
    for (number, stretch) in run.iter().enumerate() {
        if let Some(radius) = stretch.radius {
            find(stretch, (acceleration * radius).sqrt(), None);
        }
        let ends = [number.checked_sub(1), Some(number).filter(|number| *number < turns.len())];
        let allowed = |corner: usize| allowed(turns[corner], [straight[corner][0], straight[corner + 1][1]], cornering);
        let slowest = ends.into_iter().flatten().filter(|corner| turns[*corner] > 0.0).map(|corner| {
            let is_chords = run[corner].radius.is_none() && run[corner + 1].radius.is_none();
            (allowed(corner)[usize::from(is_chords)], turns[corner])
        });
        if let Some((speed, turn)) = slowest.min_by(|a, b| a.0.total_cmp(&b.0)) {
            find(stretch, speed, Some(turn));
        }
    }
}

/// Between neighbouring moves, rad: by how much the path turns at least; 0 where rounding alone may have made it.
fn turns(run: &[Stretch], unit: f64) -> Vec<f64> {
    let turn = |pair: &[Stretch]| {
        let turn = libm::acos(dot(pair[0].to, pair[1].from).clamp(-1.0, 1.0));
        (turn - ROUNDED * unit * (pair[0].length.recip() + pair[1].length.recip())).max(0.0)
    };
    run.windows(2).map(turn).collect()
}

/// Of each move: how far the path goes straight up to its end, and from its start on, mm.
fn straight(run: &[Stretch], turns: &[f64]) -> Vec<[f64; 2]> {
    let mut straight: Vec<[f64; 2]> = run.iter().map(|stretch| [stretch.length; 2]).collect();
    for number in 1..run.len() {
        if turns[number - 1] == 0.0 {
            straight[number][0] += straight[number - 1][0];
        }
    }
    for number in (1..run.len()).rev() {
        if turns[number - 1] == 0.0 {
            straight[number - 1][1] += straight[number][1];
        }
    }
    straight
}

/// The highest speed at a turn between two straight stretches, mm/s: of a corner, and of one that may be a chord's end.
fn allowed(turn: f64, lengths: [f64; 2], cornering: &Cornering) -> [f64; 2] {
    let Cornering { acceleration, deviation, .. } = *cornering;
    let radius = deviation / (libm::cos(0.5 * turn).recip() - 1.0);
    let of_chords = 0.5 * (lengths[0] + lengths[1]) / turn;
    // turned back the machine stops from it within half of the deviation
    let speed = |radius: f64| (acceleration * radius.max(deviation)).sqrt();
    [speed(radius), speed(radius.min(of_chords))]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
