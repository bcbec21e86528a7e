//! The poses along a program: those at the ends of its moves, and so many between that the tool keeps to its moves where all axes go
//! evenly from pose to pose.

use styluscam_motion::{EventKind, Move, MoveKind, Program};

use super::error::RotaryError;
use super::kinematics::{between, difference, dot, norm, unit, RotaryAxes};

/// The tool's axis may lean aside by so much as moves what is this far up from the tip by the tolerance, mm.
const REACH: f64 = 50.0;
/// Shares of a move at which it is looked how far the tool leaves it.
const SHARES: [f64; 3] = [0.25, 0.5, 0.75];
/// By so much the rise of an upright axis may differ from 1.
const UPRIGHT: f64 = 1e-15;
/// A move is halved so often at most.
const HALVINGS: usize = 10;
/// Directions whose cosine is less lie opposite: no turn leads from one to the other.
const OPPOSITE: f64 = -0.9999;

/// Where the tool is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pose {
    /// The move that leads there.
    pub index: usize,
    /// mm, in the part.
    pub tip: [f64; 3],
    /// A unit vector in the part.
    pub direction: [f64; 3],
    /// Of both axes, deg.
    pub angles: [f64; 2],
    /// What an angle is where the direction leaves it free, once that is chosen, deg.
    pub held: [Option<f64>; 2],
    /// Whether it is gone to from wherever the machine stands: the first one, and those after a tool change.
    pub is_fresh: bool,
}

/// What the tool may leave its moves by.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// Of the tip, mm; none where the control tracks it.
    pub tip: Option<f64>,
    /// Of the axis, rad.
    pub lean: f64,
    /// Of chords from arcs, mm.
    pub sag: f64,
}

impl Limits {
    pub fn new(tolerance: f64, is_tracked: bool, sag: f64) -> Self {
        Self { tip: (!is_tracked).then_some(tolerance), lean: tolerance / REACH, sag }
    }
}

/// The poses of a program, in order.
///
/// # Errors
/// As [`RotaryAxes::angles`]; [`RotaryError::Turn`] where no number of poses holds the tool: it passes the direction of an axis.
pub(crate) fn poses(program: &Program, axes: &RotaryAxes, limits: Limits) -> Result<Vec<Pose>, RotaryError> {
    let mut poses = corners(program, limits.sag);
    if let Some(pair) = poses.windows(2).find(|pair| dot(pair[0].direction, pair[1].direction) < OPPOSITE) {
        let letter = axes.axes()[0].letter;
        return Err(RotaryError::Turn { index: pair[1].index, letter, degrees: 180.0 });
    }
    for _ in 0..=HALVINGS {
        axes.turn_to(&mut poses)?;
        let refined = refined(axes, &poses, limits);
        if refined.len() == poses.len() {
            return Ok(poses);
        }
        poses = refined;
    }
    axes.turn_to(&mut poses)?;
    let is_off = |pair: &&[Pose]| is_off(axes, [&pair[0], &pair[1]], limits);
    match poses.windows(2).find(is_off) {
        None => Ok(poses),
        Some(pair) => Err(RotaryError::Turn {
            index: pair[1].index,
            letter: axes.axes()[turned_most(pair)].letter,
            degrees: (0..2).map(|i| (pair[1].angles[i] - pair[0].angles[i]).abs()).fold(0.0, f64::max),
        }),
    }
}

/// The poses at the ends of moves, and along arcs.
fn corners(program: &Program, sag: f64) -> Vec<Pose> {
    let mut poses: Vec<Pose> = Vec::with_capacity(program.moves.len());
    let mut upcoming = program.upcoming();
    for (index, step) in program.moves.iter().enumerate() {
        let changed = upcoming.before(index).filter(|event| matches!(event, EventKind::ToolChange { .. })).count() > 0;
        let end = Pose {
            index,
            tip: step.end.tip,
            direction: unit(step.end.axis.vector()),
            angles: [0.0; 2],
            held: [None; 2],
            is_fresh: changed || index == 0,
        };
        if let Some(from) = poses.last().copied().filter(|_| !end.is_fresh) {
            poses.extend(along_arc(step, &from, &end, sag));
            // where a rapid sets the tool upright, a table that is free may turn on the spot
            if step.kind == MoveKind::Rapid && is_upright(&end) && !is_upright(&from) {
                poses.push(end);
            }
        }
        poses.push(end);
    }
    poses
}

fn is_upright(pose: &Pose) -> bool {
    pose.direction[2] >= 1.0 - UPRIGHT
}

/// The poses along a move's arc, without its ends.
fn along_arc(step: &Move, from: &Pose, end: &Pose, sag: f64) -> Vec<Pose> {
    let Some(path) = step.path(from.tip) else { return Vec::new() };
    let count = path.chords(sag);
    let corner = |number: usize| {
        let share = number as f64 / count as f64;
        let direction = unit(between(from.direction, end.direction, share));
        Pose { tip: path.at(share), direction, ..*end }
    };
    (1..count).map(corner).collect()
}

/// The poses with one between any two from one to the next of which the tool would leave its move.
fn refined(axes: &RotaryAxes, poses: &[Pose], limits: Limits) -> Vec<Pose> {
    let mut refined = Vec::with_capacity(poses.len());
    refined.extend(poses.first());
    for pair in poses.windows(2) {
        if is_off(axes, [&pair[0], &pair[1]], limits) {
            let direction = unit(between(pair[0].direction, pair[1].direction, 0.5));
            // a free axis turns evenly over the move
            let middle = |i: usize| Some(f64::midpoint(pair[0].held[i]?, pair[1].held[i]?));
            let held = [middle(0), middle(1)];
            refined.push(Pose { tip: between(pair[0].tip, pair[1].tip, 0.5), direction, held, ..pair[1] });
        }
        refined.push(pair[1]);
    }
    refined
}

/// Whether the tool leaves its straight move, or leans aside, where all axes go evenly from one pose to another.
fn is_off(axes: &RotaryAxes, [from, to]: [&Pose; 2], limits: Limits) -> bool {
    if to.is_fresh {
        return false;
    }
    let [first, last] = [from, to].map(|pose| axes.linear(pose.tip, pose.angles));
    SHARES.into_iter().any(|share| {
        let angles = between(from.angles, to.angles, share);
        let is_aside = limits.tip.is_some_and(|most| {
            let reached = axes.tip(between(first, last, share), angles);
            norm(difference(reached, between(from.tip, to.tip, share))) > most
        });
        // a turn in one plane goes on evenly, but for its angle's third power
        let wanted = unit(between(from.direction, to.direction, share));
        is_aside || norm(difference(axes.direction(angles), wanted)) > limits.lean
    })
}

fn turned_most(pair: &[Pose]) -> usize {
    let [first, second] = [0, 1].map(|i| (pair[1].angles[i] - pair[0].angles[i]).abs());
    usize::from(second > first)
}
