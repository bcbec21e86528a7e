//! What keeps a program from being posted.

use styluscam_motion::SpindleDirection;

use crate::faults::faults;
use crate::machine::MachineError;
use crate::rotary::RotaryError;

faults! {
    /// A program that this machine cannot be given. Nothing is written then.
    ///
    /// Moves and events count from 0, as in the program. Each variant states when it occurs and what to do about it.
    pub enum PostError;
    @transparent
    /// The machine's own values or templates are at fault. Correct the machine file.
    Machine(MachineError);
    @transparent
    /// The machine's rotary axes cannot follow the program.
    Rotary(RotaryError);
    /// The program has no moves.
    Empty = "post-empty", ("the program has no moves"), "find out why planning found nothing to do";
    /// The machine has no such work offset.
    Wcs {
        /// What the set-up asks for.
        wcs: String,
        /// What the machine has, in words.
        allowed: String,
    } = "post-wcs", ("the machine has no work offset {wcs:?}; it has {allowed}"),
        "take a work offset that the machine has";
    /// A coordinate, feed, speed or time is NaN, infinite or beyond what numbers in a program can hold.
    Number {
        /// X, feed, ...
        what: &'static str,
        /// The move or event.
        place: String,
        /// The value.
        value: f64,
    } = "post-number", ("{what} of {place} cannot be written as a number: {value}"),
        "the program was built wrongly: report it";
    /// A feed is zero or negative, or rounds to zero at the machine's decimals.
    Feed {
        /// The move.
        index: usize,
        /// Its feed, mm/min.
        feed: f64,
    } = "post-feed", ("the feed of move {index} is {feed} mm/min, which posts as zero or less"),
        "give the operation a feed above zero";
    /// A feed is above what the machine can do.
    FeedTooHigh {
        /// The move.
        index: usize,
        /// Its feed, mm/min.
        feed: f64,
        /// The machine's largest, mm/min.
        max: f64,
    } = "post-feed-too-high", ("the feed of move {index} is {feed} mm/min; the machine's largest is {max} mm/min"),
        "lower the feed, or correct limits.max_feed of the machine";
    /// A move ends outside the machine's range.
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
    } = "post-axis-limit", ("move {index} goes to {axis}{value} mm; the machine reaches {min} to {max} mm"),
        "move the zero point or the part, or correct limits of the machine";
    /// The program is longer in one axis than the machine's travel.
    Travel {
        /// X, Y or Z.
        axis: char,
        /// What the program needs, mm.
        needed: f64,
        /// What the machine has, mm.
        travel: f64,
    } = "post-travel", ("the program needs {needed} mm of {axis}; the machine travels {travel} mm"),
        "turn the part, or take a larger machine";
    /// Events are not in the order of the moves, or one stands after the last move's end.
    EventOrder {
        /// The event.
        event: usize,
    } = "post-event-order", ("event {event} is out of order"), "the program was built wrongly: report it";
    /// A move or event names a tool or operation that the program does not have.
    NoSuchRecord {
        /// The move or event.
        place: String,
        /// Tool or operation.
        what: &'static str,
        /// The index named.
        index: u32,
    } = "post-no-such-record", ("{place} names {what} {index}, which the program does not have"),
        "the program was built wrongly: report it";
    /// A move comes before any tool change.
    NoTool {
        /// The move.
        index: usize,
    } = "post-no-tool", ("move {index} comes before any tool change"), "put a tool change before the first move";
    /// The first move, or the first after a tool change, is not a rapid: where it starts is not known.
    FeedFromUnknown {
        /// The move.
        index: usize,
    } = "post-feed-from-unknown", ("move {index} is a feed move from a position that is not known"),
        "begin with a rapid, and begin with one again after a tool change";
    /// A tool's number is larger than the machine takes, or 0.
    ToolNumber {
        /// The number.
        number: u32,
        /// The machine's largest.
        max: u32,
    } = "post-tool-number", ("tool number {number} is outside 1 to {max}"), "renumber the tool";
    /// Two tools that differ have one number: the text could not distinguish them.
    ToolNumberTwice {
        /// The number.
        number: u32,
        /// One tool.
        first: String,
        /// The other.
        second: String,
    } = "post-tool-number-twice", ("tools {first:?} and {second:?} both have number {number}"), "renumber the tool";
    /// The machine works with one tool, loaded before the start, and the program changes it.
    ToolChange {
        /// The event.
        event: usize,
    } = "post-tool-change", ("event {event} changes the tool; this machine takes one tool per program"),
        "post one program per tool; or, where all tools have the same length, take a machine file with tool.change = \"pause\"";
    /// The spindle's speed is below or above what the machine can do.
    SpindleSpeed {
        /// The speed, rev/min.
        rpm: f64,
        /// The machine's smallest, rev/min.
        min: f64,
        /// The machine's largest, rev/min; infinity when its file names none.
        max: f64,
    } = "post-spindle-speed", ("spindle speed {rpm} rev/min is outside {min} to {max}"),
        "take a speed that the machine has, or correct limits.min_rpm and limits.max_rpm";
    /// A tapping cycle whose moves and events are not those of its numbers, or that the machine does not have: plain moves
    /// cannot tap.
    TapMoves {
        /// The first move of the cycle.
        index: usize,
    } = "post-tap-moves",
        ("move {index} begins a tapping cycle that the machine does not have, or whose moves are not its own"),
        "create the hole again, without anything between the moves of its cycle";
    /// The machine's spindle does not turn in this direction.
    SpindleDirection {
        /// The direction asked for.
        direction: SpindleDirection,
    } = "post-spindle-direction", ("the machine's spindle does not turn {direction:?}"),
        "take the other direction, or correct [spindle] of the machine";
    /// The machine has no word for this.
    Unsupported {
        /// Flood coolant, dwell.
        what: &'static str,
    } = "post-unsupported", ("the machine has no word for {what}"),
        "leave it out of the job, or correct the machine file";
    /// A dwell is negative.
    Dwell {
        /// The event.
        event: usize,
        /// The time, s.
        seconds: f64,
    } = "post-dwell", ("event {event} waits for {seconds} s, which is less than 0"), "give a time of 0 s or more";
    /// A line is longer than the machine reads.
    LineTooLong {
        /// The line, from 1.
        line: u32,
        /// Its length, as the machine counts.
        length: usize,
        /// The machine's longest.
        max: u32,
    } = "post-line-too-long", ("line {line} has {length} characters; the machine reads {max}"),
        "shorten the line in the machine's template";
    /// A template writes a character that the machine does not take.
    Character {
        /// The line, from 1.
        line: u32,
        /// The character.
        character: char,
    } = "post-character", ("line {line} holds {character:?}, which the machine does not take"),
        "take the character out of the template, or put the text through comment()";
    /// A cycle's moves overlap another's, or go past the end.
    CycleOrder {
        /// The cycle.
        cycle: usize,
    } = "post-cycle-order", ("cycle {cycle} is out of order"), "the program was built wrongly: report it";
    /// A cycle's numbers are not those of its moves.
    CycleMoves {
        /// The cycle.
        cycle: usize,
    } = "post-cycle-moves", ("cycle {cycle} does not match its moves"),
        "the program was built wrongly: report it";
    /// The tool leans, and the machine has no rotary axes.
    ToolAxis {
        /// The move.
        index: usize,
    } = "post-tool-axis", ("the tool leans in move {index}: its axis is not +Z there, and the machine has no rotary axes"),
        "post it for a machine with rotary axes: a machine file states them in [rotary], as linuxcnc-trunnion does";
    /// A move's feed is per revolution or in inverse time; what the writer takes is mm/min, and the machine file decides how
    /// it is written.
    FeedMode {
        /// The move.
        index: usize,
    } = "post-feed-mode", ("the feed of move {index} is not in mm/min"),
        "give the feed in mm/min: the machine file's feed mode decides how it is written";
    /// A move leaves 0 along an axis that the machine does not have.
    NoSuchAxis {
        /// The move.
        index: usize,
        /// The axis.
        axis: char,
        /// Where it goes, mm.
        value: f64,
    } = "post-no-such-axis", ("move {index} goes to {axis}{value} mm; the machine has no {axis}"),
        "turn the part into the machine's plane, or take another machine";
    /// Feeds are posted per revolution and the spindle stands.
    NoRevolutions {
        /// The move.
        index: usize,
    } = "post-no-revolutions", ("move {index} is at a feed per revolution while the spindle stands"),
        "turn the spindle on first, or take feed_mode = \"per-minute\"";
    /// The text could not be written where it goes.
    Output {
        /// The system's message.
        message: String,
    } = "post-output", ("the text cannot be written: {message}"), "check the disk that it goes to";
}

impl PostError {
    /// Where: a move, event or record of the program, a key of the job or the machine, or a line of the text.
    #[must_use]
    pub fn location(&self) -> String {
        match self {
            Self::Machine(error) => error.location(),
            Self::Rotary(error) => format!("moves[{}]", error.index()),
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
