//! A text for a part that turns, as a path about the part: spinning and other work on a turning spindle.
//!
//! The axes move the tool in a plane through the axis of the spindle, which turns the part about Z of the work offset. In the part's
//! own frame the tool turns about Z instead, the other way round: a move of length s at f mm per revolution is a spiral of s / f
//! turns. It is laid out here in chords, so that everything that looks at a path about a part looks at these too. The feeds stay
//! those of the text, which are what is compared with the job; lengths and times are not those of the machine.

use std::f64::consts::TAU;
use std::ops::Range;

use styluscam_motion::{Event, EventKind, Move, MoveKind, Program, SpindleDirection};

use crate::subject::TextFacts;

/// What a chord deviates from its spiral by, mm, three quarters of it towards the axis at most: a quarter of what is still no gouge.
const SAG: f64 = 3e-4;
/// A chord turns by no more than this, rad.
const LARGEST: f64 = TAU / 24.0;
/// Two coordinates this close are the same, mm: below what any machine resolves.
const SAME: f64 = 1e-6;
/// Chords that are laid out at most: some minutes of verification.
const MOST: f64 = 4e6;

/// A program in the part's frame.
#[derive(Clone, Debug)]
pub struct Turned {
    /// The moves in chords; events and operations are the text's.
    pub program: Program,
    /// Index of the first chord of each move of the text, and behind the last one the number of all.
    first: Vec<usize>,
}

/// A text whose spirals are too long to be looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TooLong {
    /// Line of the move at which that shows, from 1.
    pub line: u32,
    /// Chords that the program would take up to there.
    pub chords: f64,
    /// Chords that are laid out at most.
    pub most: f64,
}

/// Turns a program's feeds into spirals about the part, with the spindle's speeds of its events; a wait with the tool down becomes
/// rings.
///
/// A rapid, and a feed straight down from a rapid or straight up, are on one side of the part: it is the same all round, and they
/// are no passes. So is every move while the spindle stands.
///
/// # Errors
/// [`TooLong`].
pub fn turned(program: &Program) -> Result<Turned, TooLong> {
    let mut upcoming = program.upcoming();
    let mut lathe = Lathe::default();
    let (mut first, mut events) = (Vec::with_capacity(program.moves.len() + 1), Vec::new());
    for (index, (start, step)) in program.segments().enumerate() {
        let before = lathe.moves.len();
        first.push(before);
        for kind in upcoming.before(index) {
            if !lathe.take(kind)? {
                events.push(Event { before, kind: kind.clone() });
            }
        }
        lathe.go(start, step)?;
    }
    let before = lathe.moves.len();
    first.push(before);
    events.extend(upcoming.before(usize::MAX).map(|kind| Event { before, kind: kind.clone() }));
    let program = Program { events, cycles: Vec::new(), moves: lathe.moves, ..program.clone() };
    Ok(Turned { program, first })
}

/// The part as it turns, and the moves as it sees them.
#[derive(Default)]
struct Lathe {
    /// rev/min, positive where the tool goes counterclockwise about the part.
    rpm: f64,
    /// Of the tool about the part, rad.
    angle: f64,
    /// The last move of the text.
    last: Option<Move>,
    moves: Vec<Move>,
}

impl Lathe {
    /// Whether an event has become moves.
    fn take(&mut self, event: &EventKind) -> Result<bool, TooLong> {
        match *event {
            EventKind::SpindleOn { rpm, direction: SpindleDirection::Clockwise } => self.rpm = rpm,
            EventKind::SpindleOn { rpm, direction: SpindleDirection::Counterclockwise } => self.rpm = -rpm,
            EventKind::SpindleOff => self.rpm = 0.0,
            EventKind::Dwell { seconds } => return self.wait(seconds),
            // none of these turns the part
            EventKind::ToolChange { .. }
            | EventKind::Mist { .. }
            | EventKind::Flood { .. }
            | EventKind::Stop { .. }
            | EventKind::WorkOffset { .. }
            | EventKind::Probe { .. }
            | EventKind::Raw { .. }
            | EventKind::Sync { .. }
            | EventKind::Comment { .. } => {}
        }
        Ok(false)
    }

    /// A ring, or several, where the tool is down and beside the axis.
    fn wait(&mut self, seconds: f64) -> Result<bool, TooLong> {
        let turns = self.rpm * seconds / 60.0;
        let Some(step) = self.last.filter(|last| last.kind == MoveKind::Feed && turns.abs() > 0.0) else {
            return Ok(false);
        };
        let ring = Spiral { step: step.arc(None), start: step.end.tip, from: self.angle, turns };
        if ring.radius() > SAME {
            self.spiral(&ring)?;
        }
        Ok(true)
    }

    fn go(&mut self, start: Option<[f64; 3]>, step: &Move) -> Result<(), TooLong> {
        let after_rapid = self.last.replace(*step).is_none_or(|last| last.kind == MoveKind::Rapid);
        let turns = start.map_or(0.0, |start| turns(step, start, self.rpm, after_rapid));
        if let Some(start) = start.filter(|_| turns.abs() > 0.0) {
            return self.spiral(&Spiral { step: *step, start, from: self.angle, turns });
        }
        self.moves.push(step.arc(None).to(rotated(step.end.tip, self.angle)));
        Ok(())
    }

    fn spiral(&mut self, spiral: &Spiral) -> Result<(), TooLong> {
        let chords = self.moves.len() as f64 + spiral.count();
        if chords > MOST {
            return Err(TooLong { line: spiral.step.line, chords, most: MOST });
        }
        spiral.append(&mut self.moves);
        self.angle += TAU * spiral.turns;
        Ok(())
    }
}

/// How many turns the part makes during a move that starts at `start`.
fn turns(step: &Move, start: [f64; 3], rpm: f64, after_rapid: bool) -> f64 {
    let length = step.length(start);
    let [x, y, z] = [0, 1, 2].map(|axis| step.end.tip[axis] - start[axis]);
    let upright = step.arc.is_none() && x.abs() <= SAME && y.abs() <= SAME;
    if upright && (after_rapid || z > -SAME) {
        return 0.0;
    }
    let turns = step.mm_per_min(length, Some(rpm.abs())).filter(|feed| *feed > 0.0).map(|feed| length / feed * rpm);
    turns.filter(|turns| turns.is_finite()).unwrap_or(0.0)
}

/// A move while the part turns.
struct Spiral {
    step: Move,
    start: [f64; 3],
    /// Where it begins about the axis, rad.
    from: f64,
    turns: f64,
}

impl Spiral {
    /// How far from the axis the tip gets, mm.
    fn radius(&self) -> f64 {
        let (low, high) = self.step.bounds(Some(self.start));
        let corners = [low, high, self.start].map(|[x, y, _]| libm::hypot(x, y));
        corners.into_iter().fold(0.0, f64::max)
    }

    /// Chords of one turn and all, at least one.
    fn count(&self) -> f64 {
        let lean = 1.0 - (SAG / self.radius().max(SAG)).min(1.0);
        let largest = (2.0 * libm::acos(lean)).min(LARGEST);
        (TAU * self.turns.abs() / largest).ceil().max(1.0)
    }

    fn append(&self, moves: &mut Vec<Move>) {
        let count = self.count();
        // corners this much outside the spiral put the chords' middles as far inside it
        let out = 2.0 / (1.0 + libm::cos(0.5 * TAU * self.turns.abs() / count));
        let path = self.step.path(self.start);
        let last = count as u64;
        for corner in 1..=last {
            let share = corner as f64 / count;
            let at = match path {
                _ if corner == last => self.step.end.tip,
                Some(path) => path.at(share),
                None => [0, 1, 2].map(|axis| self.start[axis] + share * (self.step.end.tip[axis] - self.start[axis])),
            };
            let scale = if corner == last { 1.0 } else { out };
            let [x, y, z] = rotated(at, self.from + TAU * share * self.turns);
            moves.push(self.step.arc(None).to([scale * x, scale * y, z]));
        }
    }
}

fn rotated([x, y, z]: [f64; 3], angle: f64) -> [f64; 3] {
    let (sin, cos) = libm::sincos(angle);
    [cos * x - sin * y, sin * x + cos * y, z]
}

impl Turned {
    /// The runs of moves in chords.
    #[must_use]
    pub fn runs(&self, runs: &[Range<usize>]) -> Vec<Range<usize>> {
        runs.iter().map(|run| self.before(run.start)..self.before(run.end)).collect()
    }

    /// What the text states, by the chords' numbers.
    #[must_use]
    pub fn facts(&self, facts: TextFacts) -> TextFacts {
        let TextFacts { unknown_heights, mut machine_moves, planes_not_needed, mut frame_levels, stops, .. } = facts;
        machine_moves.iter_mut().for_each(|made| made.before = self.before(made.before));
        frame_levels.iter_mut().for_each(|level| level.before = self.before(level.before));
        TextFacts {
            unknown_heights: self.runs(&unknown_heights),
            planes_not_needed: self.runs(&planes_not_needed),
            stops: stops.into_iter().map(|before| self.before(before)).collect(),
            machine_moves,
            frame_levels,
            ..facts
        }
    }

    fn before(&self, index: usize) -> usize {
        self.first.get(index).copied().unwrap_or(self.program.moves.len())
    }
}

#[cfg(test)]
mod tests {
    use styluscam_motion::SetupRecord;

    use super::*;

    fn program(moves: Vec<Move>, rpm: f64) -> Program {
        let on = EventKind::SpindleOn { rpm, direction: SpindleDirection::Clockwise };
        let events = vec![Event { before: 1, kind: on }];
        Program { moves, events, ..Program::empty(SetupRecord::default(), Vec::new(), Vec::new()) }
    }

    /// Down at the centre, 10 mm outwards and 4 mm down at 1.25 mm per turn, up.
    fn cone() -> Program {
        let length = 116.0_f64.sqrt();
        let moves = vec![
            Move::rapid([0.0, 0.0, 5.0]),
            Move::feed([0.0, 0.0, 0.0], 60.0),
            Move::feed([10.0, 0.0, -4.0], 1.25 * 120.0).on_line(7),
            Move::rapid([10.0, 0.0, 5.0]),
        ];
        assert!(length > 10.0);
        program(moves, 120.0)
    }

    #[test]
    fn a_feed_becomes_a_spiral_whose_chords_keep_to_it() {
        let turned = turned(&cone()).unwrap();
        let moves = &turned.program.moves;
        assert_eq!(moves[..2], cone().moves[..2]);
        let chords = &moves[2..moves.len() - 1];
        let turns = 116.0_f64.sqrt() / 1.25;
        let mut angle = 0.0;
        for pair in chords.windows(2) {
            let [a, b] = [&pair[0], &pair[1]].map(|step| step.end.tip);
            angle += libm::atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
            for share in [0.0, 0.5, 1.0] {
                let [x, y, z] = [0, 1, 2].map(|axis| a[axis] + share * (b[axis] - a[axis]));
                assert!((libm::hypot(x, y) + 2.5 * z).abs() <= SAG, "{x} {y} {z}");
            }
            assert_eq!((b[2] < a[2], pair[1].line), (true, 7));
        }
        assert!((angle / TAU - turns).abs() < 0.05, "{angle}");
        let [last, up] = [chords[chords.len() - 1], moves[moves.len() - 1]].map(|step| step.end.tip);
        assert!(last[..2] == up[..2] && (libm::hypot(last[0], last[1]) - 10.0).abs() < 1e-12);
        assert_eq!(turned.runs(&[2..3, 3..4]), [2..moves.len() - 1, moves.len() - 1..moves.len()]);
    }

    #[test]
    fn what_takes_forever_is_refused() {
        let mut slow = cone();
        slow.moves[2].feed = 1e-3;
        let error = turned(&slow).unwrap_err();
        assert!(error.line == 7 && error.chords > error.most);
    }

    #[test]
    fn nothing_turns_while_the_spindle_stands() {
        let mut still = cone();
        still.events.clear();
        assert_eq!(turned(&still).unwrap().program.moves, still.moves);
    }
}
