//! What keeps a program from being traced.

use thiserror::Error;

use crate::faults::codes_and_hints;

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
    pub fn place(&self) -> String {
        heading(&self.file, self.line).trim_end_matches(": ").into()
    }

    /// What to do, in a sentence.
    #[must_use]
    pub fn hint(&self) -> &'static str {
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

/// What is wrong with a line, or with the whole program.
///
/// Each variant states when it occurs and what to do about it.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TraceFault {
    /// A character that starts no word. Remove it.
    #[error("{character:?} starts no word")]
    Character {
        /// The character.
        character: char,
    },
    /// A number, a parameter or an expression is due. Write it.
    #[error("a number is expected")]
    NumberExpected,
    /// A character is due in an expression, an assignment or a name. Write it.
    #[error("{expected:?} is expected")]
    Expected {
        /// The character.
        expected: char,
    },
    /// A function that the language does not have. Correct it.
    #[error("there is no function {name:?}")]
    Function {
        /// Its name as written.
        name: String,
    },
    /// A `(` without its `)`. Close the comment on its line.
    #[error("the comment is not closed")]
    UnclosedComment,
    /// Expressions in expressions, or signs in a row, too many to make sense. Split the expression.
    #[error("the expression is nested too deep")]
    TooDeep,
    /// A division by zero. Guard it.
    #[error("a division by zero")]
    DivisionByZero,
    /// A value that a function or a power is not made for: a root of a negative number. Guard it.
    #[error("{function} has no value there")]
    Domain {
        /// The function.
        function: &'static str,
    },
    /// A number past what a computer holds, or too many to make sense: turns of an arc, a wait. Correct it.
    #[error("the number is too large")]
    TooLarge,
    /// A parameter of a number that there is not. The language has #1 to #5602.
    #[error("there is no such parameter number")]
    ParameterNumber,
    /// A whole number of 0 or more is due. Correct it.
    #[error("{what}: a whole number is expected")]
    NotNatural {
        /// What it is for.
        what: &'static str,
    },
    /// One letter twice in a block. Put them in two blocks.
    #[error("{letter} stands twice in one block")]
    WordTwice {
        /// The letter.
        letter: char,
    },
    /// Two codes that both move, or both need the axes. Put them in two blocks.
    #[error("two codes of one block both use its axes")]
    SameGroup,
    /// A code lacks a word. Write it.
    #[error("{what} is missing")]
    WordMissing {
        /// The word.
        what: &'static str,
    },
    /// Axis words and no motion code before them, or G80 after it. Write the motion code.
    #[error("axis words, and no motion code before them")]
    NoMotionMode,
    /// An angle or a distance together with X or Y. Write one or the other.
    #[error("polar words (@, ^) with X or Y")]
    PolarWithCartesian,
    /// An arc with neither R nor a centre, or with both, or R for a full circle. Write the centre.
    #[error("an arc needs either its centre or R, and a full circle its centre")]
    ArcForm,
    /// An arc around its start, or with an R of less than half the chord. Correct it.
    #[error("there is no such arc: its radius is too small")]
    ArcRadius,
    /// A drilling cycle whose bottom is above its retract plane, or a peck of no depth. Correct R, Z or Q.
    #[error("the cycle's depths do not fit: from R down to Z, by Q above 0")]
    CycleDepths,
    /// A threading cycle whose numbers make no thread. Correct P, J, K, R.
    #[error("the thread's numbers do not fit: P, J, K above 0, R of 1 or more")]
    Thread,
    /// An O-word with no keyword that the language knows. Correct it.
    #[error("this O-word is not known")]
    FlowWord,
    /// A loop, a branch or a subroutine that is not closed, or an end with no begin. Write the other half.
    #[error("o{label} has no {other} that belongs to it")]
    Unmatched {
        /// The label.
        label: String,
        /// The keyword that is missing.
        other: &'static str,
    },
    /// Subroutines that call one another more than 100 deep. Correct the end of the recursion.
    #[error("subroutines call one another too deep")]
    CallDepth,
    /// More blocks than a program runs in practice: an endless loop. Correct its condition.
    #[error("{limit} blocks were run and the program has not ended: an endless loop?")]
    TooManyBlocks {
        /// The limit.
        limit: u64,
    },
    /// More moves and events than fit into memory. Split the program.
    #[error("more than {limit} moves and events")]
    TooManyMoves {
        /// The limit.
        limit: usize,
    },
    /// A coordinate that no machine reaches: a kilometre and more. Correct it, or the unit.
    #[error("a coordinate beyond 1e6 mm")]
    TooFar,
    /// The program defines subroutines and calls none: a library. Look at a program that calls them.
    #[error("it only defines subroutines ({names}): nothing moves until a program calls them")]
    OnlySubroutines {
        /// Their labels.
        names: String,
    },
    /// The program ends and nothing has moved. Check the file, or give the folder of its subroutines.
    #[error("no move in it: there is nothing to see{}", without(.left_out))]
    NoMoves {
        /// Codes and subroutines that are not known here, in words.
        left_out: String,
    },
    /// Stopped from outside.
    #[error("cancelled")]
    Cancelled,
}

codes_and_hints! {
    TraceFault, &'static str;
    Self::Character { .. } => "trace-character", "remove the character";
    Self::NumberExpected => "trace-number-expected", "write a number, a parameter or an expression in brackets";
    Self::Expected { .. } => "trace-expected", "write it";
    Self::Function { .. } => "trace-function", "correct its name";
    Self::UnclosedComment => "trace-unclosed-comment", "close the comment on its line";
    Self::TooDeep => "trace-too-deep", "split the expression";
    Self::DivisionByZero => "trace-division-by-zero", "check before that the divisor is not 0";
    Self::Domain { .. } => "trace-domain", "check before that the value is in its range";
    Self::TooLarge => "trace-too-large", "correct the number";
    Self::ParameterNumber => "trace-parameter-number", "take #1 to #5602";
    Self::NotNatural { .. } => "trace-not-natural", "write a whole number of 0 or more";
    Self::WordTwice { .. } => "trace-word-twice", "put them in two blocks";
    Self::SameGroup => "trace-same-group", "put them in two blocks";
    Self::WordMissing { .. } => "trace-word-missing", "write the missing word";
    Self::NoMotionMode => "trace-no-motion-mode", "write the motion code: G0, G1, G2, G3 or a cycle";
    Self::PolarWithCartesian => "trace-polar-with-cartesian", "write either @ and ^, or X and Y";
    Self::ArcForm => "trace-arc-form", "write I, J, K of the plane, or R";
    Self::ArcRadius => "trace-arc-radius", "correct R, the centre, or the end";
    Self::CycleDepths => "trace-cycle-depths", "correct R, Z or Q";
    Self::Thread => "trace-thread", "correct P, J, K, R";
    Self::FlowWord => "trace-flow-word",
        "write sub, endsub, return, call, if, elseif, else, endif, while, endwhile, do, repeat, endrepeat, break or continue";
    Self::Unmatched { .. } => "trace-unmatched", "write its other half, with the same number or name";
    Self::CallDepth => "trace-call-depth", "let the recursion end";
    Self::TooManyBlocks { .. } => "trace-too-many-blocks", "correct the loop's condition";
    Self::TooManyMoves { .. } => "trace-too-many-moves", "split the program";
    Self::TooFar => "trace-too-far", "correct the coordinate, or the unit (G20, G21)";
    Self::OnlySubroutines { .. } => "trace-only-subroutines", "look at a program that calls them";
    Self::NoMoves { .. } => "trace-no-moves", "check the file; the folders of its subroutines can be named";
    Self::Cancelled => "cancelled", "";
}
