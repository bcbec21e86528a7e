//! Moves and events in the order in which the machine meets them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{Arc, ArcWay, Cycle, Event, EventKind, OperationRecord, SetupRecord, ToolRecord, Upcoming, PROGRAM_SCHEMA};

/// What a move is for the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MoveKind {
    /// Positioning at the machine's rapid rate.
    Rapid,
    /// A line or an arc at a feed.
    Feed,
}

/// One move of the controlled point, straight unless it has an arc, from the end of the one before it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Move {
    /// Rapid or feed.
    pub kind: MoveKind,
    /// Where it ends, work coordinates, mm.
    pub end: [f64; 3],
    /// How it turns on the way; straight when left out. Rapids are straight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arc: Option<Arc>,
    /// Feed in mm/min; 0 on rapids.
    pub feed: f64,
    /// Index into [`Program::operations`].
    pub operation: u32,
    /// Line of the text that it was read from, from 1; 0 when it was not read from text.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub line: u32,
}

impl Move {
    /// The way of an arc that starts at `start`; none when the move is straight.
    #[must_use]
    pub fn way(&self, start: [f64; 3]) -> Option<ArcWay> {
        self.arc.map(|arc| arc.way(start, self.end))
    }

    /// The box around it, lowest and highest coordinates, mm; of a straight move without its start.
    #[must_use]
    pub fn bounds(&self, start: Option<[f64; 3]>) -> ([f64; 3], [f64; 3]) {
        start.and_then(|start| self.way(start)).map_or((self.end, self.end), |way| way.bounds())
    }

    /// Its length from `start`, mm.
    #[must_use]
    pub fn length(&self, start: [f64; 3]) -> f64 {
        let [dx, dy, dz] = [0, 1, 2].map(|axis| self.end[axis] - start[axis]);
        self.way(start).map_or_else(|| (dx * dx + dy * dy + dz * dz).sqrt(), |way| way.length())
    }
}

#[allow(clippy::trivially_copy_pass_by_ref)] // serde hands a reference
fn is_zero(line: &u32) -> bool {
    *line == 0
}

/// A whole program of one channel.
///
/// The first move goes to a known place from wherever the machine stands: its posted form goes
/// up first, then across. Later moves start where the one before them ends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Program {
    /// Version of this document.
    pub schema: u32,
    /// Where the work's zero is and what surrounds it.
    pub setup: SetupRecord,
    /// Tools in the order of their first use.
    pub tools: Vec<ToolRecord>,
    /// Operations in order.
    pub operations: Vec<OperationRecord>,
    /// All moves in order.
    pub moves: Vec<Move>,
    /// Events in order of `before`.
    pub events: Vec<Event>,
    /// Moves and events that a controller's canned cycle makes, in their order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cycles: Vec<Cycle>,
    /// The tool's axis at the end of every move, a unit vector from the tip up; empty when it is +Z throughout.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub axes: Vec<[f64; 3]>,
}

/// A move in the machine's own coordinates (G53): where that is in the work is not known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MachineMove {
    /// Index of the move before which it comes.
    pub before: usize,
    /// Line of the text, from 1.
    pub line: u32,
    /// Where it goes, machine coordinates, mm; none for axes that stay.
    pub places: [Option<f64>; 3],
}

impl Program {
    /// A program without motion.
    #[must_use]
    pub fn empty(setup: SetupRecord, tools: Vec<ToolRecord>, operations: Vec<OperationRecord>) -> Self {
        let (moves, events, cycles, axes) = Default::default();
        Self { schema: PROGRAM_SCHEMA, setup, tools, operations, moves, events, cycles, axes }
    }

    /// The moves paired with the place where each starts; the first has none.
    pub fn segments(&self) -> impl Iterator<Item = (Option<[f64; 3]>, &Move)> {
        let starts = std::iter::once(None).chain(self.moves.iter().map(|m| Some(m.end)));
        starts.zip(&self.moves)
    }

    /// The events, to be taken in step with the moves.
    #[must_use]
    pub fn upcoming(&self) -> Upcoming<'_> {
        Upcoming::of(&self.events)
    }

    /// The boxes in which the posted points stay, the tools' references, move by move: lowest and highest coordinates, mm.
    ///
    /// Until a tool is called the first one is taken to be loaded.
    pub fn posted_boxes(&self) -> impl Iterator<Item = ([f64; 3], [f64; 3])> + '_ {
        let above = |tool: usize| self.tools.get(tool).map_or(0.0, |tool| tool.reference_height);
        let mut upcoming = self.upcoming();
        let mut height = above(0);
        self.segments().enumerate().map(move |(index, (start, step))| {
            for event in upcoming.before(index) {
                if let EventKind::ToolChange { tool } = event {
                    height = above(*tool as usize);
                }
            }
            let (low, high) = step.bounds(start);
            let lifted = |[x, y, z]: [f64; 3]| [x, y, z + height];
            (lifted(low), lifted(high))
        })
    }

    /// Places along the program and the move that each belongs to: the ends of all moves, and along arcs so many more that
    /// no chord is farther than `sag` mm from its arc.
    pub fn polyline(&self, sag: f64) -> impl Iterator<Item = ([f64; 3], usize)> + '_ {
        self.segments().enumerate().flat_map(move |(index, (start, step))| {
            let way = start.and_then(|start| step.way(start));
            let count = way.map_or(1, |way| way.chords(sag));
            (1..=count).map(move |i| match way {
                Some(way) if i < count => (way.at(i as f64 / count as f64), index),
                _ => (step.end, index),
            })
        })
    }
}
