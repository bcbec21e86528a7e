//! What keeps a program from being traced.

use thiserror::Error;

use crate::faults::faults;

/// A program that could not be traced, and where.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{}{fault}", heading(.file, *.line))]
pub struct TraceError {
    /// The file that holds the line: a subroutine's name, empty for the program itself.
    pub file: String,
    /// The line, from 1; 0 when no line is at fault.
    pub line: u32,
    /// What is wrong.
    pub fault: TraceFault,
}

/// The file and the line, before a message.
pub(super) fn heading(file: &str, line: u32) -> String {
    match (file, line) {
        (_, 0) => String::new(),
        ("", line) => format!("line {line}: "),
        (file, line) => format!("line {line} of {file}: "),
    }
}

impl TraceError {
    /// A stable name for scripts.
    #[must_use]
    pub fn code(&self) -> &'static str {
        self.fault.code()
    }

    /// Where: the line, and its file where it is not the program's own; nothing when the whole program is meant.
    #[must_use]
    pub fn location(&self) -> String {
        heading(&self.file, self.line).trim_end_matches(": ").into()
    }

    /// What to do, in a sentence.
    #[must_use]
    pub fn hint(&self) -> String {
        self.fault.hint()
    }
}

fn without(left_out: &str) -> String {
    if left_out.is_empty() {
        String::new()
    } else {
        format!("; not known here: {left_out}")
    }
}

faults! {
    /// What is wrong with a line, or with the whole program.
    ///
    /// Each variant states when it occurs and what to do about it.
    pub enum TraceFault;
    /// A character that starts no word.
    Character {
        /// The character.
        character: char,
    } = "trace-character", ("{character:?} starts no word"), "remove the character";
    /// A number, a parameter or an expression is due.
    NumberExpected = "trace-number-expected", ("a number is expected"),
        "write a number, a parameter or an expression in brackets";
    /// A character is due in an expression, an assignment or a name.
    Expected {
        /// The character.
        expected: char,
    } = "trace-expected", ("{expected:?} is expected"), "write it";
    /// A function that the language does not have.
    Function {
        /// Its name as written.
        name: String,
    } = "trace-function", ("there is no function {name:?}"), "correct its name";
    /// A `(` without its `)`.
    UnclosedComment = "trace-unclosed-comment", ("the comment is not closed"), "close the comment on its line";
    /// Expressions in expressions, or signs in a row, too many to make sense.
    TooDeep = "trace-too-deep", ("the expression is nested too deep"), "split the expression";
    /// A division by zero.
    DivisionByZero = "trace-division-by-zero", ("a division by zero"), "check before that the divisor is not 0";
    /// A value that a function or a power is not made for: a root of a negative number.
    Domain {
        /// The function.
        function: &'static str,
    } = "trace-domain", ("{function} has no value there"), "check before that the value is in its range";
    /// A number past what a computer holds, or too many to make sense: turns of an arc, a wait.
    TooLarge = "trace-too-large", ("the number is too large"), "correct the number";
    /// A parameter of a number that there is not.
    ParameterNumber = "trace-parameter-number", ("there is no such parameter number"), "take #1 to #5602";
    /// A whole number of 0 or more is due.
    NotNatural {
        /// What it is for.
        what: &'static str,
    } = "trace-not-natural", ("{what}: a whole number is expected"), "write a whole number of 0 or more";
    /// One letter twice in a block.
    WordTwice {
        /// The letter.
        letter: char,
    } = "trace-word-twice", ("{letter} occurs twice in one block"), "put them in two blocks";
    /// Two codes that both move, or both need the axes.
    SameGroup = "trace-same-group", ("two codes of one block both use its axes"), "put them in two blocks";
    /// A code lacks a word.
    WordMissing {
        /// The word.
        what: &'static str,
    } = "trace-word-missing", ("{what} is missing"), "write the missing word";
    /// Axis words and no motion code before them, or G80 after it.
    NoMotionMode = "trace-no-motion-mode", ("axis words, and no motion code before them"),
        "write the motion code: G0, G1, G2, G3 or a cycle";
    /// An angle or a distance together with X or Y.
    PolarWithCartesian = "trace-polar-with-cartesian", ("polar words (@, ^) with X or Y"),
        "write either @ and ^, or X and Y";
    /// An arc with neither R nor a centre, or with both, or R for a full circle.
    ArcForm = "trace-arc-form", ("an arc needs either its centre or R, and a full circle its centre"),
        "write I, J, K of the plane, or R";
    /// An arc around its start, or with an R of less than half the chord.
    ArcRadius = "trace-arc-radius", ("there is no such arc: its radius is too small"), "correct R, the centre, or the end";
    /// A drilling cycle whose bottom is above its retract plane, or a peck of no depth.
    CycleDepths = "trace-cycle-depths", ("the cycle's depths do not fit: from R down to Z, by Q above 0"),
        "correct R, Z or Q";
    /// A threading cycle whose numbers make no thread.
    Thread = "trace-thread", ("the thread's numbers do not fit: P, J, K above 0, R of 1 or more"), "correct P, J, K, R";
    /// An O-word with no keyword that the language knows.
    FlowWord = "trace-flow-word", ("this O-word is not known"),
        "write sub, endsub, return, call, if, elseif, else, endif, while, endwhile, do, repeat, endrepeat, break or continue";
    /// A loop, a branch or a subroutine that is not closed, or an end with no begin.
    Unmatched {
        /// The label.
        label: String,
        /// The keyword that is missing.
        other: &'static str,
    } = "trace-unmatched", ("o{label} has no {other} that belongs to it"),
        "write its other half, with the same number or name";
    /// Subroutines that call one another more than 100 deep.
    CallDepth = "trace-call-depth", ("subroutines call one another too deep"), "let the recursion end";
    /// More blocks than a program runs in practice: an endless loop.
    TooManyBlocks {
        /// The limit.
        limit: u64,
    } = "trace-too-many-blocks", ("{limit} blocks were run and the program has not ended: an endless loop?"),
        "correct the loop's condition";
    /// More moves and events than fit into memory.
    TooManyMoves {
        /// The limit.
        limit: usize,
    } = "trace-too-many-moves", ("more than {limit} moves and events"), "split the program";
    /// A coordinate that no machine reaches: a kilometre and more.
    TooFar = "trace-too-far", ("a coordinate beyond 1e6 mm"), "correct the coordinate, or the unit (G20, G21)";
    /// The program defines subroutines and calls none: a library.
    OnlySubroutines {
        /// Their labels.
        names: String,
    } = "trace-only-subroutines",
        ("the program only defines subroutines ({names}): nothing moves until a program calls them"),
        "open a program that calls them";
    /// The program ends and nothing has moved.
    NoMoves {
        /// Codes and subroutines that are not known here, in words.
        left_out: String,
    } = "trace-no-moves", ("no move in it: there is nothing to see{}", without(.left_out)),
        "check the file, or name the folders of its subroutines";
    /// Stopped from outside.
    Cancelled = "cancelled", ("cancelled"), "";
}
