//! Where in the text a fault is.

use super::lexer::Word;
use crate::block::Misfit;
use crate::read_error::{ReadError, ReadFault};

pub(super) fn whole_text(fault: ReadFault) -> ReadError {
    ReadError { line: 0, column: 0, word: String::new(), fault }
}

pub(super) fn whole_line(line: u32, fault: ReadFault) -> ReadError {
    ReadError { line, column: 0, word: String::new(), fault }
}

pub(super) fn misfit_at(text: &str, line: u32, misfit: Misfit) -> ReadError {
    let before = text.get(..misfit.start).unwrap_or_default().chars().count() + 1;
    let column = u32::try_from(before).unwrap_or(u32::MAX);
    let word = text.get(misfit.start..misfit.end).unwrap_or_default().chars().take(40).collect();
    ReadError { line, column, word, fault: misfit.fault }
}

pub(super) fn flaw_at(text: &str, line: u32, fault: ReadFault, word: Option<Word>) -> ReadError {
    match word {
        Some(Word { start, end, .. }) => misfit_at(text, line, Misfit { fault, start, end }),
        None => whole_line(line, fault),
    }
}
