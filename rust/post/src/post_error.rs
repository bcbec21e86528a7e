//! What keeps a program from being posted.

use styluscam_motion::SpindleDirection;
use thiserror::Error;

use crate::faults::codes_and_hints;
use crate::machine::MachineError;

/// A program that this machine cannot be given. Nothing is written then.
///
/// Moves and events count from 0, as in the program. Each variant states when it occurs and what to do about it.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PostError {
    /// The machine's own values or templates are at fault. Correct the machine file.
    #[error(transparent)]
    Machine(#[from] MachineError),
    /// The program has no moves. Find out why planning found nothing to do.
    #[error("the program has no moves")]
    Empty,
    /// The machine has no such work offset. Take one that it has.
    #[error("the machine has no work offset {wcs:?}; it has {allowed}")]
    Wcs {
        /// What the set-up asks for.
        wcs: String,
        /// What the machine has, in words.
        allowed: String,
    },
    /// A coordinate, feed, speed or time is NaN, infinite or beyond what numbers in a program can hold. Planning is at fault.
    #[error("{what} of {place} cannot be written as a number: {value}")]
    Number {
        /// X, feed, ...
        what: &'static str,
        /// The move or event.
        place: String,
        /// The value.
        value: f64,
    },
    /// A feed is zero or negative, or rounds to zero at the machine's decimals. Give the operation a feed.
    #[error("the feed of move {index} is {feed} mm/min, which posts as zero or less")]
    Feed {
        /// The move.
        index: usize,
        /// Its feed, mm/min.
        feed: f64,
    },
    /// A feed is above what the machine can do. Lower it, or correct `limits.max_feed`.
    #[error("the feed of move {index} is {feed} mm/min; the machine's largest is {max} mm/min")]
    FeedTooHigh {
        /// The move.
        index: usize,
        /// Its feed, mm/min.
        feed: f64,
        /// The machine's largest, mm/min.
        max: f64,
    },
    /// A move ends outside the machine's range. Move the zero point or the part, or correct `limits`.
    #[error("move {index} goes to {axis}{value} mm; the machine reaches {min} to {max} mm")]
    AxisLimit {
        /// The move.
        index: usize,
        /// X, Y or Z.
        axis: char,
        /// Where it goes, mm.
        value: f64,
        /// Lowest, mm.
        min: f64,
        /// Highest, mm.
        max: f64,
    },
    /// The program is longer in one axis than the machine's travel. It fits no zero point: turn the part, or take another machine.
    #[error("the program needs {needed} mm of {axis}; the machine travels {travel} mm")]
    Travel {
        /// X, Y or Z.
        axis: char,
        /// What the program needs, mm.
        needed: f64,
        /// What the machine has, mm.
        travel: f64,
    },
    /// Events are not in the order of the moves, or one stands after the last move's end. Whoever built the program is at fault.
    #[error("event {event} is out of order")]
    EventOrder {
        /// The event.
        event: usize,
    },
    /// A move or event names a tool or operation that the program does not have. Whoever built the program is at fault.
    #[error("{place} names {what} {index}, which the program does not have")]
    NoSuchRecord {
        /// The move or event.
        place: String,
        /// Tool or operation.
        what: &'static str,
        /// The index named.
        index: u32,
    },
    /// A move comes before any tool change. Put a tool change first.
    #[error("move {index} comes before any tool change")]
    NoTool {
        /// The move.
        index: usize,
    },
    /// The first move, or the first after a tool change, is not a rapid: where it starts is not known. Begin with a rapid.
    #[error("move {index} is at feed, from a position that is not known")]
    FeedFromUnknown {
        /// The move.
        index: usize,
    },
    /// A tool's number is larger than the machine takes, or 0. Renumber the tool.
    #[error("tool number {number} is outside 1 to {max}")]
    ToolNumber {
        /// The number.
        number: u32,
        /// The machine's largest.
        max: u32,
    },
    /// Two tools that differ have one number: the text could not distinguish them. Renumber one.
    #[error("tools {first:?} and {second:?} both have number {number}")]
    ToolNumberTwice {
        /// The number.
        number: u32,
        /// One tool.
        first: String,
        /// The other.
        second: String,
    },
    /// The machine works with one tool, loaded before the start, and the program changes it.
    /// Post one program per tool; or, where all tools have the same length, take `tool.change = "pause"`.
    #[error("event {event} changes the tool; this machine takes one tool per program")]
    ToolChange {
        /// The event.
        event: usize,
    },
    /// The spindle's speed is below or above what the machine can do.
    #[error("spindle speed {rpm} rev/min is outside {min} to {max}")]
    SpindleSpeed {
        /// The speed, rev/min.
        rpm: f64,
        /// The machine's smallest, rev/min.
        min: f64,
        /// The machine's largest, rev/min; infinity when its file names none.
        max: f64,
    },
    /// A tapping cycle whose moves and events are not those of its numbers, or that the machine does not have: plain moves
    /// cannot tap. Make the hole anew.
    #[error("move {index} begins a tapping cycle that the machine does not have, or whose moves are not its own")]
    TapMoves {
        /// The first move of the cycle.
        index: usize,
    },
    /// The machine's spindle does not turn in this direction. Take the other direction, or correct `[spindle]`.
    #[error("the machine's spindle does not turn {direction:?}")]
    SpindleDirection {
        /// The direction asked for.
        direction: SpindleDirection,
    },
    /// The machine has no word for this. Leave it out, or correct the machine file.
    #[error("the machine has no word for {what}")]
    Unsupported {
        /// Flood coolant, dwell.
        what: &'static str,
    },
    /// A dwell is negative. Give a time of 0 or more.
    #[error("event {event} waits for {seconds} s")]
    Dwell {
        /// The event.
        event: usize,
        /// The time, s.
        seconds: f64,
    },
    /// A line is longer than the machine reads. Shorten the template, or its comments by `comment()`.
    #[error("line {line} has {length} characters; the machine reads {max}")]
    LineTooLong {
        /// The line, from 1.
        line: u32,
        /// Its length, as the machine counts.
        length: usize,
        /// The machine's longest.
        max: u32,
    },
    /// A template writes a character that the machine does not take. Take it out, or put the text through `comment()`.
    #[error("line {line} holds {character:?}, which the machine does not take")]
    Character {
        /// The line, from 1.
        line: u32,
        /// The character.
        character: char,
    },
    /// A cycle's moves overlap another's, or go past the end. Whoever built the program is at fault.
    #[error("cycle {cycle} is out of order")]
    CycleOrder {
        /// The cycle.
        cycle: usize,
    },
    /// A cycle's numbers are not those of its moves. Whoever built the program is at fault.
    #[error("cycle {cycle} is another hole than its moves make")]
    CycleMoves {
        /// The cycle.
        cycle: usize,
    },
    /// The program turns the tool's axis; the machine has three axes. Post it for a machine that turns the tool.
    #[error("the tool axis of move {index} is not +Z; this machine has three axes and cannot turn it")]
    ToolAxis {
        /// The move.
        index: usize,
    },
    /// A move's feed is per revolution or in inverse time; what the writer takes is mm/min, and the machine file decides
    /// how it is written. Give the feed in mm/min.
    #[error("the feed of move {index} is not in mm/min")]
    FeedMode {
        /// The move.
        index: usize,
    },
    /// A move leaves 0 along an axis that the machine does not have. Turn the part into its plane, or take another machine.
    #[error("move {index} goes to {axis}{value} mm; the machine has no {axis}")]
    NoSuchAxis {
        /// The move.
        index: usize,
        /// The axis.
        axis: char,
        /// Where it goes, mm.
        value: f64,
    },
    /// Feeds are posted per revolution and the spindle stands. Turn it on before, or post feeds per minute.
    #[error("move {index} is at a feed per revolution while the spindle stands")]
    NoRevolutions {
        /// The move.
        index: usize,
    },
    /// The text could not be written where it goes. Check the disk.
    #[error("the text cannot be written: {message}")]
    Output {
        /// The system's message.
        message: String,
    },
}

impl PostError {
    /// Where: a move, event or record of the program, a key of the job or the machine, or a line of the text.
    #[must_use]
    pub fn place(&self) -> String {
        match self {
            Self::Machine(error) => error.place(),
            Self::Empty => "moves".into(),
            Self::Wcs { .. } => "setup.wcs".into(),
            Self::Number { place, .. } | Self::NoSuchRecord { place, .. } => place.clone(),
            Self::Feed { index, .. }
            | Self::FeedTooHigh { index, .. }
            | Self::AxisLimit { index, .. }
            | Self::NoTool { index }
            | Self::ToolAxis { index }
            | Self::FeedMode { index }
            | Self::NoSuchAxis { index, .. }
            | Self::NoRevolutions { index }
            | Self::FeedFromUnknown { index } => format!("moves[{index}]"),
            Self::Travel { .. } => "limits.travel".into(),
            Self::EventOrder { event } | Self::ToolChange { event } | Self::Dwell { event, .. } => {
                format!("events[{event}]")
            }
            Self::CycleOrder { cycle } | Self::CycleMoves { cycle } => format!("cycles[{cycle}]"),
            Self::Output { .. } => "output".into(),
            Self::ToolNumber { .. } | Self::ToolNumberTwice { .. } => "tools".into(),
            Self::SpindleSpeed { .. } | Self::SpindleDirection { .. } => "spindle".into(),
            Self::TapMoves { index } => format!("moves[{index}]"),
            Self::Unsupported { .. } => "machine".into(),
            Self::LineTooLong { line, .. } | Self::Character { line, .. } => format!("line {line}"),
        }
    }
}

codes_and_hints! {
    PostError, String;
    Self::Machine(error) => error.code(), error.hint();
    Self::Empty => "post-empty", "find out why planning found nothing to do";
    Self::Wcs { .. } => "post-wcs", "take a work offset that the machine has";
    Self::Number { .. } => "post-number", "whoever built the program is at fault: report it";
    Self::Feed { .. } => "post-feed", "give the operation a feed above zero";
    Self::FeedTooHigh { .. } => "post-feed-too-high", "lower the feed, or correct limits.max_feed of the machine";
    Self::AxisLimit { .. } => "post-axis-limit", "move the zero point or the part, or correct limits of the machine";
    Self::Travel { .. } => "post-travel", "turn the part, or take a larger machine";
    Self::EventOrder { .. } => "post-event-order", "whoever built the program is at fault: report it";
    Self::NoSuchRecord { .. } => "post-no-such-record", "whoever built the program is at fault: report it";
    Self::NoTool { .. } => "post-no-tool", "put a tool change before the first move";
    Self::FeedFromUnknown { .. } => "post-feed-from-unknown", "begin with a rapid, and begin with one again after a tool change";
    Self::ToolNumber { .. } => "post-tool-number", "renumber the tool";
    Self::ToolNumberTwice { .. } => "post-tool-number-twice", "renumber the tool";
    Self::ToolChange { .. } => "post-tool-change", "post one program per tool; or, where all tools have the same length, take a machine file with tool.change = \"pause\"";
    Self::SpindleSpeed { .. } => "post-spindle-speed", "take a speed that the machine has, or correct limits.min_rpm and limits.max_rpm";
    Self::TapMoves { .. } => "post-tap-moves", "make the hole anew, without anything between the moves of its cycle";
    Self::SpindleDirection { .. } => "post-spindle-direction", "take the other direction, or correct [spindle] of the machine";
    Self::Unsupported { .. } => "post-unsupported", "leave it out of the job, or correct the machine file";
    Self::Dwell { .. } => "post-dwell", "give a time of 0 s or more";
    Self::LineTooLong { .. } => "post-line-too-long", "shorten the line in the machine's template";
    Self::Character { .. } => "post-character", "take the character out of the template, or put the text through comment()";
    Self::CycleOrder { .. } => "post-cycle-order", "whoever built the program is at fault: report it";
    Self::CycleMoves { .. } => "post-cycle-moves", "whoever built the program is at fault: report it";
    Self::ToolAxis { .. } => "post-tool-axis", "post it for a machine that turns the tool";
    Self::FeedMode { .. } => "post-feed-mode", "give the feed in mm/min: the machine file's feed mode decides how it is written";
    Self::NoSuchAxis { .. } => "post-no-such-axis", "turn the part into the machine's plane, or take another machine";
    Self::NoRevolutions { .. } => "post-no-revolutions", "turn the spindle on first, or take feed_mode = \"per-minute\"";
    Self::Output { .. } => "post-output", "check the disk that it goes to";
}
