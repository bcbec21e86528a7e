//! What a family of controllers must be able to write; who walks through the program decides when.

use styluscam_motion::CycleKind;

use super::lines::Lines;
use crate::post_error::PostError;
use crate::rounded::RoundedArc;

/// Where the posted point stands, in units of the last decimal; none where that is not known.
pub(super) type Position = [Option<i64>; 3];

/// A feed as it is posted: in units of the last decimal of the mode that is in force.
pub(super) type Feed = i64;

/// A hole in units of the last decimal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hole {
    pub kind: CycleKind,
    pub at: [i64; 2],
    pub retract: i64,
    pub bottom: i64,
    pub peck: i64,
    /// Wait at the bottom, s.
    pub dwell: f64,
    pub feed: Feed,
    /// Where it ends: `retract`, or higher.
    pub leave: i64,
    /// What a tap needs to know.
    pub thread: Option<Thread>,
}

/// A thread to be tapped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Thread {
    /// Output units in a revolution.
    pub pitch: f64,
    /// The spindle's speed, in units of the last decimal.
    pub speed: i64,
}

impl Hole {
    /// Whether it ends higher than where it began to drill.
    pub fn lifts(&self) -> bool {
        self.leave > self.retract
    }

    /// Whether nothing but the position differs.
    pub fn is_like(&self, other: &Self) -> bool {
        Self { at: other.at, ..*self } == *other
    }
}

/// The blocks of one family.
pub(super) trait Dialect {
    /// Text of templates may have changed modes: write them again.
    fn forget(&mut self);

    /// Another tool is in the spindle; its length offset has this number.
    fn tool_changed(&mut self, length_offset: u32);

    /// What was begun and must end before anything else is written: a canned cycle.
    fn close(&mut self, lines: &mut Lines) -> Result<(), PostError>;

    /// The angles of rotary axes that the next block goes to, in units of the last decimal.
    fn turn(&mut self, _angles: [Option<i64>; 2]) {}

    /// A rapid; axes at `from` already are left out unless every axis is repeated.
    fn rapid(&mut self, lines: &mut Lines, from: Position, to: Position) -> Result<(), PostError>;

    /// A line at feed.
    fn feed(&mut self, lines: &mut Lines, from: Position, to: Position, feed: Feed) -> Result<(), PostError>;

    /// An arc that the machine takes.
    fn arc(&mut self, lines: &mut Lines, arc: &RoundedArc, feed: Feed) -> Result<(), PostError>;

    /// A hole of a kind that the machine has a cycle for.
    fn hole(&mut self, lines: &mut Lines, hole: &Hole) -> Result<(), PostError>;

    /// The spindle's speed, in units of the last decimal, and the word that turns it.
    fn spindle(&mut self, lines: &mut Lines, speed: i64, word: &str) -> Result<(), PostError>;

    /// A wait, s; false when it cannot be written as a number.
    fn dwell(&mut self, lines: &mut Lines, seconds: f64) -> Result<bool, PostError>;

    /// A path to a position until the probe touches, by this word.
    fn probe(&mut self, lines: &mut Lines, word: &str, to: Position, feed: Feed) -> Result<(), PostError>;
}
