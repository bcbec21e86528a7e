//! The moves as the judge sees them: what each is meant to do, with which tool, from where.

use styluscam_motion::{ArcWay, EventKind, MoveKind, Program};

use crate::findings::Fault;
use crate::{FindingKind, Limits, Subject, Vector};

/// Two coordinates this close are the same, mm: below what any machine resolves.
const SAME: f64 = 1e-6;

/// Largest coordinate that is judged, mm.
const FARTHEST: f64 = 1e7;

/// What a move is meant to do, told from its text and geometry alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LegKind {
    /// Positioning at the rapid rate.
    Rapid,
    /// Straight down at a feed.
    Plunge,
    /// Straight up at a feed.
    Retract,
    /// A feed move that goes nowhere.
    Still,
    /// Any other feed move: it should touch the part.
    Contact,
}

/// Largest turn of a leg, rad: a longer arc becomes several legs, so that its contact is sampled all along it.
const TURN: f64 = std::f64::consts::PI / 12.0;

/// Longest piece of a straight move that should touch, as a share of the tool's radius: its contact is sampled at both
/// ends and in the middle.
const PIECE: f64 = 0.5;

/// Pieces of one move at most; a line that would have more runs far beyond any part and is looked at as a whole.
const PIECES: f64 = 1000.0;

/// One move, or a piece of one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leg {
    /// Index of the move in the program.
    pub index: usize,
    /// Index of the move's operation in the program.
    pub operation: u32,
    pub kind: LegKind,
    /// The tool's tip where the move starts, when it is known.
    pub start: Option<[f64; 3]>,
    /// The tool's tip where it ends.
    pub end: [f64; 3],
    /// How the tip gets there, when not straight; the start is known then.
    pub bend: Option<ArcWay>,
    /// Line of the text, 0 when there is none.
    pub line: u32,
    /// Index of the tool; none is loaded or known otherwise.
    pub tool: Option<usize>,
    /// Distance at which it still touches, when it is meant to, mm.
    pub excess: Option<f64>,
}

impl Leg {
    /// Distance between its ends, mm; 0 when the start is not known.
    pub fn chord(&self) -> f64 {
        self.start.map_or(0.0, |start| (Vector::from(self.end) - Vector::from(start)).norm())
    }

    /// Whether the tip moves sideways.
    pub fn travels(&self) -> bool {
        self.start.is_some_and(|s| !same_plan(s, self.end))
    }

    /// Whether it starts at a place.
    pub fn starts_at(&self, place: [f64; 3]) -> bool {
        self.start.is_some_and(|s| same_plan(s, place) && (s[2] - place[2]).abs() <= SAME)
    }

    /// Whether its ends lie at different heights.
    pub fn falls(&self) -> bool {
        self.start.is_none_or(|s| (self.end[2] - s[2]).abs() > SAME)
    }

    /// Whether the tip goes down.
    pub fn descends(&self) -> bool {
        self.start.is_some_and(|s| self.end[2] < s[2] - SAME)
    }

    /// An error at its end.
    pub fn fault(&self, kind: FindingKind) -> Fault {
        Fault::new(kind, self.index, self.line, self.end)
    }
}

/// The last of the legs before a move.
pub(crate) fn last_before(legs: &[Leg], index: usize) -> Option<&Leg> {
    legs.get(legs.partition_point(|leg| leg.index < index).checked_sub(1)?)
}

/// The moves that have a place in space, in order.
pub(crate) fn placed(program: &Program, subject: &Subject, limits: &Limits) -> Vec<Leg> {
    let mut upcoming = program.upcoming();
    // until a tool is called the first one is taken to be loaded: the check for a missing change says so
    let known_tool = |tool: usize| Some(tool).filter(|tool| *tool < subject.tools.len());
    let mut tool = known_tool(0);
    let mut legs = Vec::with_capacity(program.moves.len());
    let mut start = None;
    for (index, step) in program.moves.iter().enumerate() {
        for event in upcoming.before(index) {
            if let EventKind::ToolChange { tool: called } = event {
                tool = known_tool(*called as usize);
            }
        }
        let known = subject.places(index) && in_this_world(step.end);
        if known {
            let way = start.and_then(|start| step.way(start));
            let kind = if way.is_some() { LegKind::Contact } else { kind(step.kind, start, step.end) };
            let excess = limits.excess_of(step.operation).filter(|_| kind == LegKind::Contact);
            let leg = Leg {
                index,
                operation: step.operation,
                kind,
                start,
                end: step.end,
                bend: None,
                line: step.line,
                tool,
                excess,
            };
            let longest = PIECE * tool.and_then(|t| subject.tools.get(t)).map_or(f64::INFINITY, |t| 0.5 * t.diameter());
            legs.extend(pieces(&leg, way.as_ref(), longest));
        }
        start = known.then_some(step.end);
    }
    legs
}

/// The pieces of an arc, or of a line that should touch and is longer than `longest`, mm: ends are kept to the bit.
fn pieces<'a>(leg: &'a Leg, way: Option<&'a ArcWay>, longest: f64) -> impl Iterator<Item = Leg> + 'a {
    let turns = way.map_or(0.0, |way| way.sweep().abs() / TURN);
    let touches = leg.excess.is_some();
    let lengths = if touches && way.is_none() { leg.chord() / longest } else { 0.0 };
    let lengths = if lengths > PIECES { 1.0 } else { lengths };
    let count = turns.max(lengths).ceil().clamp(1.0, PIECES) as usize;
    let share = move |i: usize| i as f64 / count as f64;
    let at = move |i: usize| way.map_or_else(|| between(leg, share(i)), |way| way.at(share(i)));
    (0..count).map(move |i| Leg {
        start: if i == 0 { leg.start } else { Some(at(i)) },
        end: if i + 1 == count { leg.end } else { at(i + 1) },
        bend: way.map(|way| way.part(share(i), share(i + 1))),
        ..*leg
    })
}

fn between(leg: &Leg, share: f64) -> [f64; 3] {
    let (start, end) = (Vector::from(leg.start.unwrap_or(leg.end)), Vector::from(leg.end));
    (start + share * (end - start)).into()
}

fn kind(kind: MoveKind, start: Option<[f64; 3]>, end: [f64; 3]) -> LegKind {
    let Some(start) = start.filter(|_| kind != MoveKind::Rapid) else {
        return if kind == MoveKind::Rapid { LegKind::Rapid } else { LegKind::Contact };
    };
    let rise = end[2] - start[2];
    match same_plan(start, end) {
        false => LegKind::Contact,
        true if rise > SAME => LegKind::Retract,
        true if rise < -SAME => LegKind::Plunge,
        true => LegKind::Still,
    }
}

/// Whether a place's coordinates are numbers, and not absurd: arithmetic holds up to there.
pub(crate) fn in_this_world(place: [f64; 3]) -> bool {
    place.iter().all(|x| x.abs() <= FARTHEST)
}

fn same_plan(a: [f64; 3], b: [f64; 3]) -> bool {
    (a[0] - b[0]).abs() <= SAME && (a[1] - b[1]).abs() <= SAME
}
