//! The moves as the verifier sees them: what each is meant to do, with which tool, from where.

use styluscam_geometry::Vector;
use styluscam_motion::{ArcPath, EventKind, MoveKind, Program};

use crate::assignment::Assignment;
use crate::expectation::Contact;
use crate::faults::{Fault, FaultKind};
use crate::subject::{Limits, Subject};

/// Two coordinates this close are the same, mm: below what any machine resolves.
const SAME: f64 = 1e-6;

/// Largest coordinate that is checked, mm.
const FARTHEST: f64 = 1e7;

/// What a move is meant to do, known from its text and geometry alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SegmentKind {
    /// Positioning at the rapid rate.
    Rapid,
    /// Straight down at a feed.
    Plunge,
    /// Straight up at a feed.
    Retract,
    /// A feed move of length 0.
    Still,
    /// Any other feed move: it should touch the part.
    Lateral,
}

/// Largest turn of a piece, rad.
const TURN: f64 = std::f64::consts::PI / 12.0;

/// Longest piece of a move that should touch, as a share of the tool's radius: its contact is sampled at both ends and in
/// the middle.
const PIECE: f64 = 0.5;

/// A line that is longer than so many diagonals of the part ends far from it, where its ends show what is wrong.
const FAR: f64 = 4.0;

/// One move, or a piece of one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    /// Index of the move in the program.
    pub index: usize,
    /// Index of the move's operation in the program.
    pub operation: u32,
    /// The job's operation that this is, by its number.
    pub expected: Option<usize>,
    pub kind: SegmentKind,
    /// The tool's tip where the move starts, when it is known.
    pub start: Option<[f64; 3]>,
    /// The tool's tip where it ends.
    pub end: [f64; 3],
    /// How the tip gets there, when not straight; the start is known then.
    pub bend: Option<ArcPath>,
    /// Line of the text, 0 when there is none.
    pub line: u32,
    /// Index of the tool; none is loaded or known otherwise.
    pub tool: Option<usize>,
    /// Distance at which it still touches, when it is meant to, mm.
    pub excess: Option<f64>,
    /// Pieces in which it is looked at.
    pub(crate) pieces: u32,
}

impl Segment {
    /// Its length, mm; 0 when the start is not known.
    pub fn length(&self) -> f64 {
        let chord = self.start.map_or(0.0, |start| (Vector::from(self.end) - Vector::from(start)).norm());
        self.bend.map_or(chord, |bend| bend.length())
    }

    /// How many pieces there are.
    pub fn piece_count(&self) -> usize {
        self.pieces as usize
    }

    /// The pieces of an arc, or of a move that should touch and is long, one after the other; ends are kept to the bit.
    pub fn pieces(self) -> impl Iterator<Item = Self> {
        let share = move |i: u32| f64::from(i) / f64::from(self.pieces);
        let at = move |i: u32| self.at(share(i));
        (0..self.pieces).map(move |i| Self {
            start: if i == 0 { self.start } else { Some(at(i)) },
            end: if i + 1 == self.pieces { self.end } else { at(i + 1) },
            bend: self.bend.map(|bend| bend.part(share(i), share(i + 1))),
            pieces: 1,
            ..self
        })
    }

    /// Pieces that are no longer than `longest` and turn no more than is good; what is longer than `far` (mm) is not
    /// divided for its length.
    fn count(&self, longest: f64, far: f64) -> u32 {
        let turns = self.bend.map_or(0.0, |bend| bend.sweep().abs() / TURN);
        let length = if self.excess.is_some() { self.length() } else { 0.0 };
        let lengths = if length > far { 1.0 } else { length / longest };
        turns.max(lengths).ceil().clamp(1.0, f64::from(u32::MAX)) as u32
    }

    /// The tip at a share of its path.
    pub fn at(&self, share: f64) -> [f64; 3] {
        let (start, end) = (Vector::from(self.start.unwrap_or(self.end)), Vector::from(self.end));
        self.bend.map_or_else(|| (start + share * (end - start)).into(), |bend| bend.at(share))
    }

    /// The same this much higher, mm.
    pub fn raised(&self, by: f64) -> Self {
        let raised = |[x, y, z]: [f64; 3]| [x, y, z + by];
        let bend = self.bend.map(|bend| bend.shifted([0.0, 0.0, by]));
        Self { start: self.start.map(raised), end: raised(self.end), bend, ..*self }
    }

    /// Whether the tip moves sideways.
    pub fn travels(&self) -> bool {
        self.start.is_some_and(|s| !same_plan(s, self.end))
    }

    /// Whether it starts at a position.
    pub fn starts_at(&self, position: [f64; 3]) -> bool {
        self.start.is_some_and(|s| same_plan(s, position) && (s[2] - position[2]).abs() <= SAME)
    }

    /// Whether it leaves its height.
    pub fn falls(&self) -> bool {
        let bent = self.bend.map(|bend| bend.bounds()).is_some_and(|(low, high)| high[2] - low[2] > SAME);
        bent || self.start.is_none_or(|s| (self.end[2] - s[2]).abs() > SAME)
    }

    /// The lowest height of the tip on its path, mm.
    pub fn lowest(&self) -> f64 {
        let straight = self.start.map_or(self.end[2], |start| start[2].min(self.end[2]));
        self.bend.map_or(straight, |bend| bend.bounds().0[2])
    }

    /// Whether the tip goes down.
    pub fn descends(&self) -> bool {
        self.start.is_some_and(|s| self.end[2] < s[2] - SAME)
    }

    /// Whether the tip goes straight up, or stays where it is.
    pub fn goes_straight_up(&self) -> bool {
        self.start.is_some_and(|start| !self.travels() && self.end[2] >= start[2])
    }

    /// An error at its end.
    pub fn fault(&self, kind: &'static FaultKind) -> Fault {
        Fault::new(kind, self.index, self.line, self.end)
    }
}

/// The last of the segments before a move.
pub(crate) fn last_before(segments: &[Segment], index: usize) -> Option<&Segment> {
    segments.get(segments.partition_point(|segment| segment.index < index).checked_sub(1)?)
}

/// The moves of upright tools whose position is known, in order.
pub(crate) fn placed(program: &Program, subject: &Subject, limits: &Limits) -> Vec<Segment> {
    let mut upcoming = program.upcoming();
    // until a tool is called the first one is taken to be loaded: the check for a missing change reports it
    let known_tool = |tool: usize| Some(tool).filter(|tool| *tool < subject.tools.len());
    let mut tool = known_tool(0);
    let mut segments = Vec::with_capacity(program.moves.len());
    let (low, high) = subject.mesh.bounds();
    let part = (high - low).norm();
    let assignment = Assignment::new(program, subject);
    let touches =
        |operation: u32| assignment.of(operation).is_none_or(|expected| expected.expectation.contact == Contact::Touch);
    let mut start = None;
    for (index, step) in program.moves.iter().enumerate() {
        for event in upcoming.before(index) {
            if let EventKind::ToolChange { tool: called } = event {
                tool = known_tool(*called as usize);
            }
        }
        let known = subject.is_known(index) && is_in_range(step.end.tip) && step.end.axis.is_up();
        // what tools that may lean do is checked by itself: `leaning`
        let known = known && !assignment.leans(step.operation);
        if known {
            let path = start.and_then(|start| step.path(start));
            let kind = if path.is_some() { SegmentKind::Lateral } else { kind(step.kind, start, step.end.tip) };
            let is_pass = kind == SegmentKind::Lateral && step.is_along_pass();
            let excess = limits.excess_of(step.operation).filter(|_| is_pass && touches(step.operation));
            let segment = Segment {
                index,
                operation: step.operation,
                expected: assignment.number_of(step.operation),
                kind,
                start,
                end: step.end.tip,
                bend: path,
                line: step.line,
                tool,
                excess,
                pieces: 1,
            };
            let radius = tool.and_then(|t| subject.tools.get(t)).map_or(f64::INFINITY, |t| 0.5 * t.diameter());
            segments.push(Segment { pieces: segment.count(PIECE * radius, FAR * (part + 2.0 * radius)), ..segment });
        }
        start = known.then_some(step.end.tip);
    }
    segments
}

fn kind(kind: MoveKind, start: Option<[f64; 3]>, end: [f64; 3]) -> SegmentKind {
    let Some(start) = start.filter(|_| kind != MoveKind::Rapid) else {
        return if kind == MoveKind::Rapid { SegmentKind::Rapid } else { SegmentKind::Lateral };
    };
    let rise = end[2] - start[2];
    match same_plan(start, end) {
        false => SegmentKind::Lateral,
        true if rise > SAME => SegmentKind::Retract,
        true if rise < -SAME => SegmentKind::Plunge,
        true => SegmentKind::Still,
    }
}

/// Whether a position's coordinates are numbers, and not too large: arithmetic holds up to there.
pub(crate) fn is_in_range(position: [f64; 3]) -> bool {
    position.iter().all(|x| x.abs() <= FARTHEST)
}

fn same_plan(a: [f64; 3], b: [f64; 3]) -> bool {
    (a[0] - b[0]).abs() <= SAME && (a[1] - b[1]).abs() <= SAME
}
