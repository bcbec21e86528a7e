//! The program that a trace records: moves and events, consistent in space.

use styluscam_motion::{Arc, EventKind, Move, MoveKind, Plane, Program};

use super::codes;
use super::fault::TraceFault;
use super::offsets::{system_code, turned, Offsets};
use crate::block::Recorder;

/// mm: no machine reaches so far.
const FAR: f64 = 1e6;

/// mm: how far chords may be from an arc that is in none of the machine's planes.
pub(super) const SAG: f64 = 0.005;

/// mm: positions that differ less are one.
const SAME: f64 = 1e-6;

/// Moves in the coordinates that were in force at the first one.
pub(super) struct Path {
    record: Recorder,
    /// The offsets at the first move.
    anchor: Option<Offsets>,
    /// Of moves and events.
    limit: usize,
}

/// How a move is made.
#[derive(Clone, Copy)]
pub(super) struct Pace {
    pub(super) kind: MoveKind,
    /// mm/min; 0 for rapids.
    pub(super) feed: f64,
    /// The line, from 1.
    pub(super) line: u32,
}

impl Path {
    pub(super) fn new(limit: usize) -> Self {
        Self { record: Recorder::new(&[], 0), anchor: None, limit }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.record.program.moves.is_empty()
    }

    /// Whether it has come to a position in the program's coordinates.
    pub(super) fn stands_at(&mut self, offsets: &Offsets, position: [f64; 3]) -> bool {
        let Some(end) = self.record.program.moves.last().map(|last| last.end.tip) else { return false };
        let position = self.shown(offsets, position);
        end.iter().zip(position).all(|(a, b)| (a - b).abs() <= SAME)
    }

    /// The program, in the work coordinates of its first move.
    pub(super) fn finish(mut self) -> Program {
        let code = system_code(self.anchor.map_or(0, |anchor| anchor.index));
        self.record.program.setup.wcs = codes::name_g(code);
        self.record.program
    }

    fn require_room(&self) -> Result<(), TraceFault> {
        if self.record.program.moves.len() + self.record.program.events.len() < self.limit {
            Ok(())
        } else {
            Err(TraceFault::TooManyMoves { limit: self.limit })
        }
    }

    pub(super) fn event(&mut self, kind: EventKind) -> Result<(), TraceFault> {
        self.require_room()?;
        self.record.event(kind);
        Ok(())
    }

    /// A tool of this number is in the spindle from now on.
    pub(super) fn load(&mut self, number: u32) -> Result<(), TraceFault> {
        let tool = self.record.tool_of_number(number);
        self.record.load(tool);
        self.event(EventKind::ToolChange { tool })
    }

    /// A straight move to a position in the program's coordinates.
    pub(super) fn line(&mut self, offsets: &Offsets, end: [f64; 3], pace: Pace) -> Result<(), TraceFault> {
        let end = self.shown(offsets, end);
        self.push(end, None, pace)
    }

    /// An arc from one position in the program's coordinates to another.
    pub(super) fn arc(
        &mut self,
        offsets: &Offsets,
        [start, end]: [[f64; 3]; 2],
        arc: Arc,
        pace: Pace,
    ) -> Result<(), TraceFault> {
        let turn = offsets.system.turn_deg - self.anchor(offsets).system.turn_deg;
        if arc.plane == Plane::Xy || turn == 0.0 {
            let centre = self.shown(offsets, arc.centre);
            let end = self.shown(offsets, end);
            return self.push(end, Some(Arc { centre, ..arc }), pace);
        }
        let path = arc.path(start, end);
        let count = path.chords(SAG);
        (1..=count).try_for_each(|i| self.line(offsets, path.at(i as f64 / count as f64), pace))
    }

    fn anchor(&mut self, offsets: &Offsets) -> Offsets {
        *self.anchor.get_or_insert(*offsets)
    }

    /// A position as the path shows it: as called by the offsets of the first move.
    fn shown(&mut self, offsets: &Offsets, position: [f64; 3]) -> [f64; 3] {
        let anchor = self.anchor(offsets);
        if (anchor.system, anchor.local) == (offsets.system, offsets.local) {
            return position;
        }
        anchor.of_space(offsets.in_space(position))
    }

    fn push(&mut self, end: [f64; 3], arc: Option<Arc>, pace: Pace) -> Result<(), TraceFault> {
        self.require_room()?;
        let centre = arc.map_or(end, |arc| arc.centre);
        if !end.iter().chain(&centre).all(|coordinate| coordinate.abs() <= FAR) {
            return Err(TraceFault::TooFar);
        }
        let Pace { kind, feed, line } = pace;
        self.record.push(Move::new(kind, end, feed).arc(arc).on_line(line));
        Ok(())
    }
}

/// The distance of a position from zero and its angle, degrees.
pub(super) fn polar([x, y, _]: [f64; 3]) -> (f64, f64) {
    (libm::hypot(x, y), libm::atan2(y, x).to_degrees())
}

/// The position at a distance and an angle.
pub(super) fn cartesian(distance: f64, degrees: f64) -> [f64; 2] {
    turned([distance, 0.0], degrees)
}
