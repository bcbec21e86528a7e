//! Lines of G-code cut into words and comments.

use crate::block::{cut_number, CommentFault, Comments, Misfit, Number};
use crate::read_error::ReadFault;

/// In place of a letter: Sinumerik's `TURN=`.
pub(crate) const TURN: u8 = 1;

/// A letter and its number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Word {
    /// A capital letter.
    pub(crate) letter: u8,
    pub(crate) number: Number,
    /// Where it stands in the line, bytes from 0.
    pub(crate) start: usize,
    pub(crate) end: usize,
}

/// A fault and the word that has it.
pub(crate) type Flaw = (ReadFault, Option<Word>);

/// What one line holds; used again for the next one.
#[derive(Debug, Default)]
pub(crate) struct Line<'t> {
    pub(crate) words: Vec<Word>,
    pub(crate) comments: Vec<&'t str>,
    /// Whether it began with `/`.
    pub(crate) deleted: bool,
    /// `MCALL`, and what it calls from here on: name, what stands in the brackets. Nothing ends the calls.
    pub(crate) call: Option<Call<'t>>,
}

/// A block that calls a cycle, and where it stands in the line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Call<'t> {
    pub(crate) cycle: Option<(&'t str, &'t str)>,
    pub(crate) start: usize,
    pub(crate) end: usize,
}

/// Cuts what begins with a letter; gives where it ends.
pub(super) type CutAddress<'t> = fn(&mut Line<'t>, &'t str, usize) -> Result<usize, Misfit>;

impl<'t> Line<'t> {
    /// Cuts `text`, one line without its end mark: words of one letter and a number.
    pub(crate) fn cut(&mut self, text: &'t str, taken: Comments) -> Result<(), Misfit> {
        self.cut_by(text, taken, Self::cut_word)
    }

    /// The same for words that are cut otherwise.
    pub(super) fn cut_by(&mut self, text: &'t str, taken: Comments, cut_address: CutAddress<'t>) -> Result<(), Misfit> {
        self.words.clear();
        self.comments.clear();
        self.deleted = false;
        self.call = None;
        let bytes = text.as_bytes();
        let mut at = 0;
        while let Some(byte) = bytes.get(at) {
            at = match byte {
                b' ' | b'\t' | b'\r' => at + 1,
                b'a'..=b'z' | b'A'..=b'Z' => cut_address(self, text, at)?,
                b'/' if self.words.is_empty() && !self.deleted => {
                    self.deleted = true;
                    at + 1
                }
                _ => self.cut_comment(text, at, taken)?,
            };
        }
        Ok(())
    }

    fn cut_comment(&mut self, text: &'t str, start: usize, taken: Comments) -> Result<usize, Misfit> {
        let misfit = |fault| match fault {
            CommentFault::Unclosed => Misfit { fault: ReadFault::UnclosedComment, start, end: text.len() },
            CommentFault::Nested(end) => Misfit { fault: ReadFault::NestedComment, start, end },
        };
        let comment = taken.at(text, start, self.words.is_empty()).map_err(misfit)?;
        let (comment, end) = comment.ok_or_else(|| unexpected(text, start))?;
        self.comments.push(comment);
        Ok(end)
    }

    fn cut_word(&mut self, text: &'t str, start: usize) -> Result<usize, Misfit> {
        let bytes = text.as_bytes();
        let letter = bytes.get(start).map_or(b'?', u8::to_ascii_uppercase);
        let (number, end) = cut_number(bytes, start + 1).map_err(|m| Misfit { start, ..m })?;
        self.words.push(Word { letter, number, start, end });
        Ok(end)
    }
}

fn unexpected(text: &str, start: usize) -> Misfit {
    let character = text.get(start..).and_then(|t| t.chars().next()).unwrap_or('?');
    let fault = match character {
        '#' | '[' | '=' | '<' => ReadFault::NotRead { what: "parameters and expressions" },
        '%' => ReadFault::Percent,
        _ => ReadFault::Character,
    };
    Misfit { fault, start, end: start + character.len_utf8() }
}
