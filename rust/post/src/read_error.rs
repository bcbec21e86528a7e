//! What keeps text from being read.

use thiserror::Error;

use crate::faults::codes_and_hints;
use crate::machine::MachineError;

/// Text that could not be read, and where.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("line {line}, column {column}: {fault}{}", shown(.word))]
pub struct ReadError {
    /// The line, from 1; 0 when no line is at fault.
    pub line: u32,
    /// The character in it, from 1; 0 when the whole line is meant.
    pub column: u32,
    /// The word as written; empty when no word is at fault.
    pub word: String,
    /// What is wrong.
    pub fault: ReadFault,
}

fn shown(word: &str) -> String {
    if word.is_empty() {
        String::new()
    } else {
        format!(": {word:?}")
    }
}

/// What is wrong with a line.
///
/// Each variant states when it occurs and what to do about it.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ReadFault {
    /// The machine's own values are at fault. Correct the machine file.
    #[error(transparent)]
    Machine(#[from] MachineError),
    /// A character that starts no word. Remove it.
    #[error("this character starts no word")]
    Character,
    /// A letter without a number. Write the number.
    #[error("a number is expected after the letter")]
    NumberExpected,
    /// More than 15 digits. Shorten the number.
    #[error("the number has too many digits")]
    NumberTooLong,
    /// A space among a number's digits: some controllers read on, others stop there. Close it up.
    #[error("a space inside a number")]
    SpaceInNumber,
    /// A number without a decimal point where the controller may count it in its smallest increments. Write a point.
    #[error("a number without a decimal point: the controller may count it in its smallest increments")]
    NoPoint,
    /// A time in ms with a decimal point: controllers refuse it, or take it for seconds. Write whole ms.
    #[error("a decimal point in a time that counts in ms")]
    PointInTime,
    /// A `(` without its `)`. Close the comment on its line.
    #[error("the comment is not closed")]
    UnclosedComment,
    /// A `(` inside a comment. Replace it.
    #[error("a comment inside a comment")]
    NestedComment,
    /// The line is longer than the machine reads. Break or shorten it.
    #[error("the line has {length} characters, and the machine reads {max}")]
    LineTooLong {
        /// Its length, as the machine counts.
        length: usize,
        /// The machine's longest.
        max: u32,
    },
    /// More lines than a 32-bit number counts. Split the program.
    #[error("the text has too many lines")]
    TooManyLines,
    /// A `%` where the machine takes none: anywhere on some machines, elsewhere than alone on its line on the others. Remove it.
    #[error("a % is not taken here")]
    Percent,
    /// A `/` where the machine takes none. Remove the mark, or the block.
    #[error("the machine takes no / before a block")]
    BlockDelete,
    /// A letter that means nothing on three axes: A, B, C, U, V, W are further axes. Remove the word.
    #[error("no such word on a machine with three axes")]
    UnknownWord,
    /// A G or M code that this reader does not know. Remove it, or post the program again.
    #[error("this code is not known")]
    UnknownCode,
    /// Something that this release does not read: canned cycles, parameters. Post the program without it.
    #[error("{what} are not read yet")]
    NotRead {
        /// What it is, in the plural.
        what: &'static str,
    },
    /// A code that this controller refuses. Remove it, or take the machine file of the controller that it is for.
    #[error("{machine} refuses this code")]
    Refused {
        /// The machine.
        machine: String,
    },
    /// Two codes of one modal group in a block. Put them in two blocks.
    #[error("a second code of the same group in one block")]
    SameGroup,
    /// One letter twice in a block. Put them in two blocks.
    #[error("the same word twice in one block")]
    WordTwice,
    /// A P, Q or H that belongs to no code of its block. Remove it.
    #[error("no code of this block takes this word")]
    StrayWord,
    /// A code needs a word: P of G4, axes of G53. Write the word.
    #[error("{what} is missing")]
    MissingWord {
        /// The word.
        what: &'static str,
    },
    /// A number that must be whole and not negative. Correct it.
    #[error("a whole number of 0 or more is expected")]
    NotNatural,
    /// A number below zero where none may be: dwell, speed. Correct it.
    #[error("the number must not be negative")]
    Negative,
    /// A feed of zero or less. Write a feed above zero.
    #[error("the feed must be above zero")]
    ZeroFeed,
    /// Motion or a feed before G20 or G21, and the machine file names no unit to begin with. Write G21 (or G20) in a block before.
    #[error("the unit is not known: neither G20 nor G21 came before")]
    NoUnits,
    /// A block changes the unit and gives a feed: controllers differ in which comes first. Put G20 or G21 in a block before.
    #[error("the unit changes in the block of a feed")]
    FeedWithUnits,
    /// A feed move and no F before it. Write a feed.
    #[error("no feed came before this feed move")]
    NoFeed,
    /// Axis words and none of G0 to G3 before them, or G80 after. Write the motion code.
    #[error("axis words without G0, G1, G2 or G3")]
    NoMotionMode,
    /// M6 and no T before it. Write the tool's number.
    #[error("no T came before the tool change")]
    NoToolSelected,
    /// Motion before any tool change, and the job has several tools. Write the tool change.
    #[error("no tool is loaded, and the job has several")]
    NoToolLoaded,
    /// The job has no tool of this number. Correct the number, or the job.
    #[error("the job has no tool {number}")]
    UnknownTool {
        /// The number.
        number: u32,
    },
    /// H names another offset than the loaded tool's: the tip would be at another height than programmed. Correct one of them.
    #[error("length offset {found} is not that of the loaded tool, {expected}")]
    LengthOffset {
        /// What is written.
        found: u32,
        /// The tool's.
        expected: u32,
    },
    /// A move without the tool's length offset: the tip would be off by the tool's length. Write G43 with the tool's H.
    #[error("a move without the tool's length offset")]
    NoLengthOffset {
        /// The tool's H.
        expected: u32,
    },
    /// A move while the controller may round the path off by more than the machine's tolerance, or no tolerance is stated.
    #[error("a move with no path tolerance of {limit} mm or less in force")]
    PathTolerance {
        /// What the machine allows, mm.
        limit: f64,
    },
    /// An arc's I, J or K across the plane in force (G17, G18, G19). Write the plane's code, or the plane's letters.
    #[error("this offset lies across the plane in force")]
    ArcPlane,
    /// An arc with R and a centre, or with R and no other end than its start. Write the centre only.
    #[error("R with a centre, or for a full circle")]
    ArcForm,
    /// A radius of zero, or smaller than the machine takes. Write the centre's offset from the arc's start, or a line.
    #[error("the arc has no radius, or one that the machine does not take")]
    ArcOfNoRadius,
    /// R is less than half the distance of the ends. Correct R or the end.
    #[error("the arc's ends are farther apart than its diameter")]
    ArcOfShortRadius,
    /// The ends are not equally far from the centre, by more than the machine takes. Correct the end or the centre.
    #[error("the arc's ends differ by {mismatch:.4} mm in their distance from its centre")]
    ArcEnds {
        /// The difference, mm.
        mismatch: f64,
    },
    /// An arc that turns more often than is read. Split it.
    #[error("the arc turns more than {most} times")]
    ArcTurns {
        /// How often is read.
        most: u32,
    },
    /// An arc whose ends all but meet: controllers differ in whether it is a full circle. Write a line, or the start as the end.
    #[error("the arc's ends all but meet: some controllers make a full circle of it")]
    ArcOfNoAngle,
    /// A full circle without X, Y or Z, which the machine needs. Write the end.
    #[error("a full circle needs an axis word here")]
    ArcNeedsAxis,
    /// A work offset that the machine does not have. Take one that it has.
    #[error("the machine has no such work offset")]
    Wcs,
    /// The work offset changes between moves: one program has one zero point here. Split the program.
    #[error("the work offset changes between moves")]
    WcsChanged,
    /// G91 on an axis whose position is not known: at the start, after a tool change or G53. Move it with G90 first.
    #[error("an incremental move of an axis whose position is not known")]
    IncrementalFromUnknown,
    /// A feed move while the position of an axis is not known: at the start, after a tool change (Z) or G53. Move it with G0 first.
    #[error("a feed move while the position of {axis} is not known")]
    FeedFromUnknown {
        /// The axis.
        axis: char,
    },
    /// G53 without G0 or G1, or with G91. Write `G53 G0` with G90 active.
    #[error("G53 needs G0 or G1 and G90")]
    MachineCoordinates,
    /// The program moves and never gives a position of this axis. Move it with G0.
    #[error("the program never gives a position of {axis}")]
    NeverPlaced {
        /// The axis.
        axis: char,
    },
    /// The text ends and the machine asks for M2 or M30 (or a closing %): it may be cut off. Write the end, or get the whole file.
    #[error("the program has no end")]
    NoEnd,
    /// A cut after a stop that has stopped the spindle too. Start it again.
    #[error("the stop before has stopped the spindle, and this move is at feed")]
    Halted,
    /// A feed per revolution while the spindle stands. Turn it on before.
    #[error("a feed per revolution while the spindle stands")]
    NoRevolutions,
    /// A second G or M on a line, and the machine takes one. Put it on a line of its own.
    #[error("a second code on one line")]
    SecondCommand,
    /// G28 through another position than where the axis stands. Write `G91 G28 Z0`.
    #[error("G28 moves at rapid through the position that is written")]
    HomeByWay,
    /// A canned cycle whose bottom is above its retract plane. Correct Z or R.
    #[error("the cycle's bottom is above its retract plane")]
    CycleUpwards,
    /// More pecks than are read. Correct Q.
    #[error("the hole takes too many pecks")]
    TooManyPecks,
    /// Words that this reader does not know. Remove them, or post the program again.
    #[error("these words are not known")]
    UnknownWords,
    /// Text after M2 or M30, which the machine would run. Delete it, or delete the earlier end.
    #[error("text after M2 or M30, which the machine would run")]
    AfterEnd,
}

impl ReadError {
    /// A stable name for scripts.
    #[must_use]
    pub fn code(&self) -> &'static str {
        self.fault.code()
    }

    /// Where: line and column.
    #[must_use]
    pub fn place(&self) -> String {
        match (self.line, self.column) {
            (0, _) => "text".into(),
            (line, 0) => format!("line {line}"),
            (line, column) => format!("line {line}, column {column}"),
        }
    }

    /// What to do, in a sentence.
    #[must_use]
    pub fn hint(&self) -> String {
        self.fault.hint()
    }
}

codes_and_hints! {
    ReadFault, String;
    Self::Machine(error) => error.code(), error.hint();
    Self::Character => "read-character", "remove the character";
    Self::NumberExpected => "read-number-expected", "write a number after the letter";
    Self::NumberTooLong => "read-number-too-long", "shorten the number to 15 digits";
    Self::SpaceInNumber => "read-space-in-number", "close the number up, or put a letter before the second one";
    Self::NoPoint => "read-no-point", "write a decimal point: 10. in place of 10";
    Self::PointInTime => "read-point-in-time", "write whole milliseconds, without a point";
    Self::UnclosedComment => "read-unclosed-comment", "close the comment on its line";
    Self::NestedComment => "read-nested-comment", "replace the inner parentheses";
    Self::LineTooLong { .. } => "read-line-too-long", "break or shorten the line";
    Self::TooManyLines => "read-too-many-lines", "split the program";
    Self::Percent => "read-percent", "remove the %, or take the machine file of the controller that the program is for";
    Self::BlockDelete => "read-block-delete", "remove the / or the block";
    Self::UnknownWord => "read-unknown-word", "remove the word: repeats, and axes other than X, Y and Z, are not read";
    Self::UnknownCode => "read-unknown-code", "remove the code, or post the program again for this machine";
    Self::NotRead { .. } => "read-not-read", "post the program with lines, arcs and plain numbers only";
    Self::Refused { .. } => "read-refused", "remove the code, or take the machine file of the controller that the program is for";
    Self::SameGroup => "read-same-group", "put them in two blocks";
    Self::WordTwice => "read-word-twice", "put them in two blocks";
    Self::StrayWord => "read-stray-word", "remove the word, or write the code that it belongs to";
    Self::MissingWord { .. } => "read-missing-word", "write the missing word";
    Self::NotNatural => "read-not-natural", "write a whole number of 0 or more";
    Self::Negative => "read-negative", "write a number of 0 or more";
    Self::ZeroFeed => "read-zero-feed", "write a feed above zero";
    Self::NoUnits => "read-no-units", "write G21 (mm) or G20 (inch) in a block before";
    Self::FeedWithUnits => "read-feed-with-units", "write G21 (mm) or G20 (inch) in a block before";
    Self::NoFeed => "read-no-feed", "write a feed (F) with the first feed move";
    Self::NoMotionMode => "read-no-motion-mode", "write G0, G1, G2 or G3";
    Self::NoToolSelected => "read-no-tool-selected", "write T and the tool's number";
    Self::NoToolLoaded => "read-no-tool-loaded", "write the tool change before the first move";
    Self::UnknownTool { .. } => "read-unknown-tool", "correct the tool number, or add the tool to the job";
    Self::LengthOffset { .. } => "read-length-offset", "correct H, or the tool's length_offset in the job";
    Self::NoLengthOffset { expected } => "read-no-length-offset", format!("write G43 H{expected} after the tool change, or take a machine without length offsets");
    Self::PathTolerance { limit } => "read-path-tolerance", format!("write G64 P{limit} (or G61) before, or set the machine's option smoothing_tolerance");
    Self::ArcPlane => "read-arc-plane", "write the plane's code (G17 for I and J), or its two letters";
    Self::ArcForm => "read-arc-form", "write the centre by I, J, K, without R";
    Self::ArcOfNoRadius => "read-arc-of-no-radius", "write the centre's offset from the arc's start";
    Self::ArcOfShortRadius => "read-arc-of-short-radius", "correct R, or the arc's end";
    Self::ArcEnds { .. } => "read-arc-ends", "correct the arc's end, or its centre";
    Self::ArcTurns { .. } => "read-arc-turns", "split the arc";
    Self::ArcOfNoAngle => "read-arc-of-no-angle", "write a line, or exactly the start as the end for a full circle";
    Self::ArcNeedsAxis => "read-arc-needs-axis", "write the end's X, Y or Z";
    Self::Wcs => "read-wcs", "take a work offset that the machine has";
    Self::WcsChanged => "read-wcs-changed", "split the program: one zero point each";
    Self::IncrementalFromUnknown => "read-incremental-from-unknown", "move the axis with G90 G0 first";
    Self::FeedFromUnknown { .. } => "read-feed-from-unknown", "move the axis with G0 first";
    Self::MachineCoordinates => "read-machine-coordinates", "write G53 G0 and an axis, with G90 active";
    Self::NeverPlaced { .. } => "read-never-placed", "move the axis with G0 first";
    Self::Halted => "read-halted", "write M3 or M4 after the stop";
    Self::NoRevolutions => "read-no-revolutions", "turn the spindle on before, or write feeds per minute (G94)";
    Self::SecondCommand => "read-second-command", "put each code on a line of its own";
    Self::HomeByWay => "read-home-by-way", "write G91 G28 Z0, or G53 G0 Z0";
    Self::CycleUpwards => "read-cycle-upwards", "correct Z or R of the cycle";
    Self::TooManyPecks => "read-too-many-pecks", "correct Q of the cycle";
    Self::UnknownWords => "read-unknown-words", "remove the words, or post the program again for this machine";
    Self::NoEnd => "read-no-end", "the file may be cut off: get the whole file, or write M2 at its end";
    Self::AfterEnd => "read-after-end", "delete it, or delete the earlier M2 or M30";
}
