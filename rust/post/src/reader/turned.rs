//! From what a text states for machines with rotary axes to the tool's path in the part.
//!
//! Between two positions all axes go evenly, and the tip leaves its straight line where it is not tracked: the path in the part is
//! made of as many straight moves as it takes.

use std::ops::Range;

use styluscam_motion::{ArcPath, Move, Program, UnitAxis};

use super::reading::Reading;
use crate::machine::Machine;
use crate::read_error::ReadFault;
use crate::rotary::{between, difference, larger_turn, norm, unit, RotaryAxes};

/// How far the tip may be from the straight moves in the part, mm.
const TIP: f64 = 1e-4;
/// How far the tool's axis may lean aside, rad: it moves a point 50 mm up by as much.
const LEAN: f64 = TIP / 50.0;
/// Shares of a part at which it is looked how far the tool leaves it.
const SHARES: [f64; 3] = [0.25, 0.5, 0.75];
/// A turn by more is halved before it is looked at, deg.
const LOOKED_AT_DEG: f64 = 30.0;
/// A move is halved so often at most.
const HALVINGS: u32 = 16;
/// Moves in the part at most; a few hundred bytes each.
const MOST: usize = 4_000_000;
const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// Where the tool is.
#[derive(Clone, Copy, Debug)]
struct At {
    /// The tip in the part, mm.
    tip: [f64; 3],
    /// The tool's axis in the part.
    direction: [f64; 3],
    /// Where the linear axes stand, mm: where the tip is with all angles 0.
    stand: [f64; 3],
}

/// The moves in the part, and where the linear axes stand at their ends.
#[derive(Default)]
struct Path {
    moves: Vec<Move>,
    stands: Vec<[f64; 3]>,
}

impl Path {
    fn push(&mut self, step: Move, at: At) {
        self.moves.push(step);
        self.stands.push(at.stand);
    }
}

/// What belongs to a move of the text beside its record.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    /// Of rotary axes at its end, deg.
    pub angles: [f64; 2],
    /// Whether coordinates are the tip's.
    pub is_tracked: bool,
    /// Height of the posted point above the tip, mm.
    pub height: f64,
    /// Whether X, Y and Z are known at its end, and both angles.
    pub known: [bool; 3],
    pub are_angles_known: bool,
    /// Whether it was known where it begins.
    pub is_start_known: bool,
    /// How long it takes, min, where its feed follows from that.
    pub minutes: Option<f64>,
}

impl Stretch {
    fn is_known(&self) -> bool {
        self.known == [true; 3] && self.are_angles_known
    }
}

/// A position as the text states it: coordinates that are the tip's while all angles are 0, mm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub stated: [f64; 3],
    pub angles: [f64; 2],
    pub is_tracked: bool,
    pub height: f64,
}

impl Place {
    fn of((step, stretch): (&Move, &Stretch)) -> Self {
        let Stretch { angles, is_tracked, height, .. } = *stretch;
        Self { stated: step.end.tip, angles, is_tracked, height }
    }

    fn is_at_zero(&self) -> bool {
        larger_turn(self.angles, [0.0; 2]) == 0.0
    }

    fn at(&self, axes: &RotaryAxes) -> At {
        let direction = axes.direction(self.angles);
        let tip = match self.is_tracked {
            _ if self.is_at_zero() => self.stated,
            true => [0, 1, 2].map(|i| self.stated[i] + self.height * (UP[i] - direction[i])),
            false => axes.tip(self.stated, self.angles),
        };
        let is_tip = self.is_tracked && !self.is_at_zero();
        let stand = if is_tip { axes.linear(tip, self.angles) } else { self.stated };
        At { tip, direction, stand }
    }

    /// The same position in coordinates that are the tip's, or not.
    pub fn in_frame(&self, axes: &RotaryAxes, is_tracked: bool) -> Self {
        let At { tip, direction, stand } = self.at(axes);
        let stated = match is_tracked {
            _ if is_tracked == self.is_tracked || self.is_at_zero() => self.stated,
            true => [0, 1, 2].map(|i| tip[i] - self.height * (UP[i] - direction[i])),
            false => stand,
        };
        Self { stated, is_tracked, ..*self }
    }
}

/// The way of one move, as all axes go.
struct Way<'a> {
    axes: &'a RotaryAxes,
    from: Place,
    to: Place,
    arc: Option<ArcPath>,
}

impl Way<'_> {
    fn at(&self, share: f64) -> At {
        let stated = self.arc.map_or_else(|| between(self.from.stated, self.to.stated, share), |arc| arc.at(share));
        let angles = between(self.from.angles, self.to.angles, share);
        Place { stated, angles, ..self.to }.at(self.axes)
    }

    /// Whether it is one move in the part: rotary axes stand, and so does what turns the path.
    fn is_one(&self) -> bool {
        let still = larger_turn(self.from.angles, self.to.angles) == 0.0;
        let keeps_arcs = self.to.is_at_zero() || self.to.is_tracked && self.to.height == 0.0;
        still && (self.arc.is_none() || keeps_arcs)
    }

    /// The moves that it makes in the part; `feed` is that of a path so long, mm, in which an axis turns so far, deg.
    fn append(&self, step: &Move, ends: [At; 2], feed: impl Fn(f64, f64) -> Option<f64>, out: &mut Path) {
        if self.is_one() {
            out.push(Move { arc: step.arc, ..at_end(step, ends[1]) }, ends[1]);
            return;
        }
        let mut poses = Vec::new();
        self.split([0.0, 1.0], ends, HALVINGS, &mut poses);
        let starts = std::iter::once(&ends[0]).chain(&poses);
        let length = starts.zip(&poses).map(|(from, to)| norm(difference(to.tip, from.tip))).sum();
        let feed = feed(length, larger_turn(self.from.angles, self.to.angles)).unwrap_or(step.feed);
        poses.into_iter().for_each(|at| out.push(Move { feed, ..at_end(step, at) }, at));
    }

    /// Poses from one share to another, behind the first.
    fn split(&self, [from, to]: [f64; 2], ends: [At; 2], halvings: u32, out: &mut Vec<At>) {
        let is_off = |share: &f64| {
            let At { tip, direction, .. } = self.at(from + share * (to - from));
            let wanted = between(ends[0].tip, ends[1].tip, *share);
            let lean = unit(between(ends[0].direction, ends[1].direction, *share));
            norm(difference(tip, wanted)) > TIP || norm(difference(direction, lean)) > LEAN
        };
        // whole turns are back where they began at every share that is looked at
        let turned = (to - from) * larger_turn(self.from.angles, self.to.angles);
        if halvings == 0 || turned <= LOOKED_AT_DEG && !SHARES.iter().any(is_off) {
            out.push(ends[1]);
            return;
        }
        let share = f64::midpoint(from, to);
        let middle = self.at(share);
        self.split([from, share], [ends[0], middle], halvings - 1, out);
        self.split([share, to], [middle, ends[1]], halvings - 1, out);
    }
}

/// What was read, as a program in the part.
pub(super) fn turned(
    mut reading: Reading,
    axes: &RotaryAxes,
    stretches: &[Stretch],
    machine: &Machine,
) -> Result<Reading, ReadFault> {
    let moves = std::mem::take(&mut reading.program.moves);
    let places: Vec<Place> = moves.iter().zip(stretches).map(Place::of).collect();
    let ends = ends(axes, &places, stretches);
    let (mut first, mut out) = (Vec::with_capacity(moves.len() + 1), Path::default());
    let mut last: Option<(Place, At)> = None;
    for (((step, stretch), place), end) in moves.iter().zip(stretches).zip(&places).zip(&ends) {
        first.push(out.moves.len());
        let before = last.replace((*place, *end)).filter(|_| stretch.is_start_known && stretch.is_known());
        match before {
            None => out.push(at_end(step, *end), *end),
            Some((from, start)) => {
                let from = from.in_frame(axes, place.is_tracked);
                let way = Way { axes, from, to: *place, arc: step.path(from.stated) };
                let feed = |length, turned| stretch.minutes.map(|minutes| machine.way(length, turned) / minutes);
                way.append(step, [start, *end], feed, &mut out);
            }
        }
        if out.moves.len() > MOST {
            return Err(ReadFault::PathTooLong { most: MOST });
        }
    }
    first.push(out.moves.len());
    reading.program.moves = out.moves;
    reading.unknown_positions = runs(stretches, |stretch| !stretch.is_known());
    reading.unknown_heights = runs(stretches, |stretch| !(stretch.known[2] && stretch.are_angles_known));
    renumber(&mut reading, &first, &places);
    if !places.iter().all(Place::is_at_zero) {
        reading.axes = Some(of_axes(&reading.program, &out.stands));
    }
    Ok(reading)
}

/// The moves of the linear axes, straight where they are not those of the tip.
fn of_axes(program: &Program, stands: &[[f64; 3]]) -> Program {
    let stand = |(step, stand): (&Move, &[f64; 3])| {
        let arc = step.arc.filter(|_| norm(difference(*stand, step.end.tip)) == 0.0);
        step.to(*stand).with_axis(UnitAxis::UP).arc(arc)
    };
    Program { moves: program.moves.iter().zip(stands).map(stand).collect(), cycles: Vec::new(), ..program.clone() }
}

/// A straight move to a pose.
fn at_end(step: &Move, At { tip, direction, .. }: At) -> Move {
    // turned by rotations only, it is a unit vector
    step.arc(None).to(tip).with_axis(UnitAxis::new(direction).unwrap_or_default())
}

/// Where moves end. One whose height or angles are not known ends where the next one does that is known, or the last one.
fn ends(axes: &RotaryAxes, places: &[Place], stretches: &[Stretch]) -> Vec<At> {
    let known = |index: &usize| stretches.get(*index).is_some_and(Stretch::is_known);
    let last = (0..stretches.len()).rev().find(known);
    let mut next = None;
    let mut ends = Vec::with_capacity(places.len());
    for (index, (place, stretch)) in places.iter().zip(stretches).enumerate().rev() {
        if stretch.is_known() {
            next = Some(index);
        }
        let other = next.or(last).and_then(|other| places.get(other));
        // where X or Y are not known the next ones are taken, unless they are another frame's
        let is_sound = stretch.known[2]
            && stretch.are_angles_known
            && other.is_none_or(|other| other.is_tracked == place.is_tracked || place.is_at_zero());
        let own = stretch.is_known() || is_sound;
        ends.push(other.filter(|_| !own).unwrap_or(place).at(axes));
    }
    ends.reverse();
    ends
}

/// The runs of moves that are so.
fn runs(stretches: &[Stretch], is_so: impl Fn(&Stretch) -> bool) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for (index, _) in stretches.iter().enumerate().filter(|(_, stretch)| is_so(stretch)) {
        match runs.last_mut().filter(|run| run.end == index) {
            Some(run) => run.end = index + 1,
            None => runs.push(index..index + 1),
        }
    }
    runs
}

/// All that counts moves, by those in the part; `first` is the first of each move of the text, and behind the last one all.
fn renumber(reading: &mut Reading, first: &[usize], places: &[Place]) {
    let count = reading.program.moves.len();
    let at = |index: usize| first.get(index).copied().unwrap_or(count);
    let again = |run: &mut Range<usize>| *run = at(run.start)..at(run.end);
    reading.unknown_positions.iter_mut().for_each(again);
    reading.unknown_heights.iter_mut().for_each(again);
    reading.planes_not_needed.iter_mut().for_each(again);
    reading.machine_moves.iter_mut().for_each(|made| made.before = at(made.before));
    reading.stops.iter_mut().for_each(|before| *before = at(*before));
    reading.program.events.iter_mut().for_each(|event| event.before = at(event.before));
    let begins = reading.unknown_positions.first().filter(|run| run.start == 0);
    reading.first_known_move = begins.map_or(0, |run| run.end);
    let upright = |first: usize, count: usize| places.iter().skip(first).take(count).all(Place::is_at_zero);
    reading.program.cycles.retain(|cycle| upright(cycle.first, cycle.count));
    for cycle in &mut reading.program.cycles {
        let end = at(cycle.first + cycle.count);
        cycle.first = at(cycle.first);
        cycle.count = end - cycle.first;
    }
}
