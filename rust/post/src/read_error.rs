//! What keeps text from being read.

use thiserror::Error;

use crate::faults::faults;
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

faults! {
    /// What is wrong with a line.
    ///
    /// Each variant states when it occurs and what to do about it.
    pub enum ReadFault;
    @transparent
    /// The machine's own values are at fault. Correct the machine file.
    Machine(MachineError);
    /// A character that starts no word.
    Character = "read-character", ("this character starts no word"), "remove the character";
    /// A letter without a number.
    NumberExpected = "read-number-expected", ("a number is expected after the letter"), "write a number after the letter";
    /// More than 15 digits.
    NumberTooLong = "read-number-too-long", ("the number has too many digits"), "shorten the number to 15 digits";
    /// A space among a number's digits: some controllers read on, others stop there.
    SpaceInNumber = "read-space-in-number", ("a space inside a number"),
        "close the number up, or put a letter before the second one";
    /// A number without a decimal point where the controller may count it in its smallest increments.
    NoPoint = "read-no-point", ("a number without a decimal point: the controller may count it in its smallest increments"),
        "write a decimal point: 10. in place of 10";
    /// A time in ms with a decimal point: controllers refuse it, or take it for seconds.
    PointInTime = "read-point-in-time", ("a decimal point in a time that counts in ms"),
        "write whole milliseconds, without a point";
    /// A `(` without its `)`.
    UnclosedComment = "read-unclosed-comment", ("the comment is not closed"), "close the comment on its line";
    /// A `(` inside a comment.
    NestedComment = "read-nested-comment", ("a comment inside a comment"), "replace the inner parentheses";
    /// The line is longer than the machine reads.
    LineTooLong {
        /// Its length, as the machine counts.
        length: usize,
        /// The machine's longest.
        max: u32,
    } = "read-line-too-long", ("the line has {length} characters, and the machine reads {max}"),
        "break or shorten the line";
    /// More lines than a 32-bit number counts.
    TooManyLines = "read-too-many-lines", ("the text has too many lines"), "split the program";
    /// A `%` where the machine takes none: anywhere on some machines, elsewhere than alone on its line on the others.
    Percent = "read-percent", ("% is not allowed here"),
        "remove the %, or take the machine file of the controller that the program is for";
    /// A `/` where the machine takes none.
    BlockDelete = "read-block-delete", ("the machine takes no / before a block"), "remove the / or the block";
    /// A letter that means nothing on the machine: A, B, C, U, V, W are further axes.
    UnknownWord = "read-unknown-word", ("no such word on this machine"),
        "remove the word: repeats are not read, nor are axes beside X, Y, Z and those of the machine file's [rotary]";
    /// A G or M code that this reader does not know.
    UnknownCode = "read-unknown-code", ("this code is not known"),
        "remove the code, or post the program again for this machine";
    /// Something that this release does not read: canned cycles, parameters.
    NotRead {
        /// What it is, in the plural.
        what: &'static str,
    } = "read-not-read", ("{what} are not read yet"), "post the program with lines, arcs and plain numbers only";
    /// A code that this controller refuses.
    Refused {
        /// The machine.
        machine: String,
    } = "read-refused", ("{machine} refuses this code"),
        "remove the code, or take the machine file of the controller that the program is for";
    /// Two codes of one modal group in a block.
    SameGroup = "read-same-group", ("a second code of the same group in one block"), "put them in two blocks";
    /// One letter twice in a block.
    WordTwice = "read-word-twice", ("the same word twice in one block"), "put them in two blocks";
    /// A P, Q or H that belongs to no code of its block.
    StrayWord = "read-stray-word", ("no code of this block takes this word"),
        "remove the word, or write the code that it belongs to";
    /// A code needs a word: P of G4, axes of G53.
    MissingWord {
        /// The word.
        what: &'static str,
    } = "read-missing-word", ("{what} is missing"), "write the missing word";
    /// A number that must be whole and not negative.
    NotNatural = "read-not-natural", ("a whole number of 0 or more is expected"), "write a whole number of 0 or more";
    /// A number below zero where none may be: dwell, speed.
    Negative = "read-negative", ("the number must not be negative"), "write a number of 0 or more";
    /// A feed of zero or less.
    ZeroFeed = "read-zero-feed", ("the feed must be above zero"), "write a feed above zero";
    /// Motion or a feed before G20 or G21, and the machine file names no unit to begin with.
    NoUnits = "read-no-units", ("the unit is not known: neither G20 nor G21 came before"),
        "write G21 (mm) or G20 (inch) in a block before";
    /// A block changes the unit and gives a feed: controllers differ in which comes first.
    FeedWithUnits = "read-feed-with-units", ("the unit changes in the block of a feed"),
        "write G21 (mm) or G20 (inch) in a block before";
    /// A feed move and no F before it.
    NoFeed = "read-no-feed", ("no feed came before this feed move"), "write a feed (F) with the first feed move";
    /// Axis words and none of G0 to G3 before them, or G80 after.
    NoMotionMode = "read-no-motion-mode", ("axis words without G0, G1, G2 or G3"), "write G0, G1, G2 or G3";
    /// M6 and no T before it.
    NoToolSelected = "read-no-tool-selected", ("no T came before the tool change"), "write T and the tool's number";
    /// Motion before any tool change, and the job has several tools.
    NoToolLoaded = "read-no-tool-loaded", ("no tool is loaded, and the job has several"),
        "write the tool change before the first move";
    /// The job has no tool of this number.
    UnknownTool {
        /// The number.
        number: u32,
    } = "read-unknown-tool", ("the job has no tool {number}"), "correct the tool number, or add the tool to the job";
    /// H names another offset than the loaded tool's: the tip would be at another height than programmed.
    LengthOffset {
        /// What is written.
        found: u32,
        /// The tool's.
        expected: u32,
    } = "read-length-offset", ("length offset {found} is not that of the loaded tool, {expected}"),
        "correct H, or the tool's length_offset in the job";
    /// A move without the tool's length offset: the tip would be off by the tool's length.
    NoLengthOffset {
        /// The tool's H.
        expected: u32,
    } = "read-no-length-offset", ("a move without the tool's length offset"),
        "write G43 H{expected} after the tool change, or take a machine without length offsets";
    /// A move while the controller may round the path off by more than the machine's tolerance, or no tolerance is stated.
    PathTolerance {
        /// What the machine allows, mm.
        limit: f64,
    } = "read-path-tolerance", ("a move with no path tolerance of {limit} mm or less in force"),
        "write G64 P{limit} (or G61) before, or set the machine's option smoothing_tolerance";
    /// An arc's I, J or K across the plane in force (G17, G18, G19).
    ArcPlane = "read-arc-plane", ("this offset lies across the plane in force"),
        "write the plane's code (G17 for I and J), or its two letters";
    /// An arc with R and a centre, or with R and no other end than its start.
    ArcForm = "read-arc-form", ("R with a centre, or for a full circle"), "write the centre by I, J, K, without R";
    /// A radius of zero, or smaller than the machine takes.
    ArcOfNoRadius = "read-arc-of-no-radius", ("the arc has no radius, or one that the machine does not take"),
        "write the centre's offset from the arc's start";
    /// R is less than half the distance of the ends.
    ArcOfShortRadius = "read-arc-of-short-radius", ("the arc's ends are farther apart than its diameter"),
        "correct R, or the arc's end";
    /// The ends are not equally far from the centre, by more than the machine takes.
    ArcEnds {
        /// The difference, mm.
        mismatch: f64,
    } = "read-arc-ends", ("the arc's ends differ by {mismatch:.4} mm in their distance from its centre"),
        "correct the arc's end, or its centre";
    /// An arc that turns more often than is read.
    ArcTurns {
        /// How often is read.
        most: u32,
    } = "read-arc-turns", ("the arc turns more than {most} times"), "split the arc";
    /// An arc whose ends nearly coincide: controllers differ in whether it is a full circle.
    ArcOfNoAngle = "read-arc-of-no-angle", ("the arc's ends nearly coincide: some controllers make a full circle of it"),
        "write a line, or exactly the start as the end for a full circle";
    /// A full circle without X, Y or Z, which the machine needs.
    ArcNeedsAxis = "read-arc-needs-axis", ("a full circle needs an axis word here"), "write the end's X, Y or Z";
    /// A work offset that the machine does not have.
    Wcs = "read-wcs", ("the machine has no such work offset"), "take a work offset that the machine has";
    /// The work offset changes between moves: one program has one zero point here.
    WcsChanged = "read-wcs-changed", ("the work offset changes between moves"), "split the program: one zero point each";
    /// G91 on an axis whose position is not known: at the start, after a tool change or G53.
    IncrementalFromUnknown = "read-incremental-from-unknown", ("an incremental move of an axis whose position is not known"),
        "move the axis with G90 G0 first";
    /// A feed move while the position of an axis is not known: at the start, after a tool change (Z) or G53.
    FeedFromUnknown {
        /// The axis.
        axis: char,
    } = "read-feed-from-unknown", ("a feed move while the position of {axis} is not known"),
        "move the axis with G0 first";
    /// G53 without G0 or G1, or with G91.
    MachineCoordinates = "read-machine-coordinates", ("G53 needs G0 or G1 and G90"),
        "write G53 G0 and an axis, with G90 active";
    /// The program moves and never gives a position of this axis.
    NeverPlaced {
        /// The axis.
        axis: char,
    } = "read-never-placed", ("the program never gives a position of {axis}"), "move the axis with G0 first";
    /// The text ends and the machine asks for M2 or M30 (or a closing %): it may be cut off.
    NoEnd = "read-no-end", ("the program has no end"), "the file may be cut off: get the whole file, or write M2 at its end";
    /// A cut after a stop that has stopped the spindle too.
    Halted = "read-halted", ("a feed move while the spindle stands: the stop before it (M0, M1) stopped the spindle"),
        "write M3 or M4 after the stop";
    /// A feed per revolution while the spindle stands.
    NoRevolutions = "read-no-revolutions", ("a feed per revolution while the spindle stands"),
        "turn the spindle on before, or write feeds per minute (G94)";
    /// A second G or M on a line, and the machine takes one.
    SecondCommand = "read-second-command", ("a second code on one line"), "put each code on a line of its own";
    /// G28 through another position than where the axis stands.
    HomeByWay = "read-home-by-way", ("G28 moves at rapid through the position that is written"),
        "write G91 G28 Z0, or G53 G0 Z0";
    /// A canned cycle whose bottom is above its retract plane.
    CycleUpwards = "read-cycle-upwards", ("the cycle's bottom is above its retract plane"), "correct Z or R of the cycle";
    /// More pecks than are read.
    TooManyPecks = "read-too-many-pecks", ("the hole takes too many pecks"), "correct Q of the cycle";
    /// Words that this reader does not know.
    UnknownWords = "read-unknown-words", ("these words are not known"),
        "remove the words, or post the program again for this machine";
    /// Rotary axes turn so far that the tool's path in the part takes too many straight moves.
    PathTooLong {
        /// How many are made.
        most: usize,
    } = "read-path-too-long", ("the tool's path in the part takes more than {most} straight moves"),
        "split the program, or turn the rotary axes less far from line to line";
    /// Text after M2 or M30, which the machine would run.
    AfterEnd = "read-after-end", ("text after M2 or M30, which the machine would run"),
        "delete it, or delete the earlier M2 or M30";
}

impl ReadError {
    /// A stable name for scripts.
    #[must_use]
    pub fn code(&self) -> &'static str {
        self.fault.code()
    }

    /// Where: line and column.
    #[must_use]
    pub fn location(&self) -> String {
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
