//! Moves and events in the order in which the machine meets them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{OperationRecord, SetupRecord, ToolRecord};

/// What a move is for the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MoveKind {
    /// Positioning at the machine's rapid rate.
    Rapid,
    /// A straight line at a feed.
    Feed,
}

/// One straight move of the controlled point, from the end of the one before it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Move {
    /// Rapid or feed.
    pub kind: MoveKind,
    /// Where it ends, work coordinates, mm.
    pub end: [f64; 3],
    /// Feed in mm/min; 0 on rapids.
    pub feed: f64,
    /// Index into [`Program::operations`].
    pub operation: u32,
    /// Line of the text that it was read from, from 1; 0 when it was not read from text.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub line: u32,
}

#[allow(clippy::trivially_copy_pass_by_ref)] // serde hands a reference
fn is_zero(line: &u32) -> bool {
    *line == 0
}

/// Sense of the spindle's rotation, seen from above the tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SpindleDirection {
    /// M3.
    Clockwise,
    /// M4.
    Counterclockwise,
}

/// What happens between moves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", tag = "kind")]
pub enum EventKind {
    /// Load a tool and apply its length: index into [`Program::tools`].
    ToolChange {
        /// Index of the tool.
        tool: u32,
    },
    /// Turn the spindle.
    SpindleOn {
        /// Speed, rev/min.
        rpm: f64,
        /// Sense of rotation.
        direction: SpindleDirection,
    },
    /// Stop the spindle.
    SpindleOff,
    /// Flood coolant (or forming lubricant) on or off.
    Flood {
        /// On or off.
        on: bool,
    },
    /// A remark for the operator.
    Comment {
        /// One line of text.
        text: String,
    },
    /// Wait.
    Dwell {
        /// How long, s.
        seconds: f64,
    },
}

/// An event and its place: it happens before move `before`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Event {
    /// Index of the move that follows; the number of moves when none does.
    pub before: usize,
    /// What happens.
    #[serde(flatten)]
    pub kind: EventKind,
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
}

impl Program {
    /// The moves paired with the place where each starts; the first has none.
    pub fn segments(&self) -> impl Iterator<Item = (Option<[f64; 3]>, &Move)> {
        let starts = std::iter::once(None).chain(self.moves.iter().map(|m| Some(m.end)));
        starts.zip(&self.moves)
    }
}
