//! Comments in a line of code.

use crate::machine::{CommentForm, Machine};

/// The forms of comments that are taken.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Comments {
    /// `(...)`.
    pub paren: bool,
    /// Whether a `(` may stand inside of one.
    pub nested: bool,
    /// `; ...`.
    pub semicolon: bool,
    /// `: ...` on a line of its own.
    pub colon: bool,
}

/// What is wrong with a comment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CommentFault {
    Unclosed,
    /// A `(` inside; the byte where the comment ends.
    Nested(usize),
}

impl Comments {
    /// Those of RS-274NGC.
    pub const NGC: Self = Self { paren: true, nested: true, semicolon: true, colon: false };

    /// Those of a machine's file. Some controllers end at the first `)`, others count: nested ones are refused.
    pub fn of(machine: &Machine) -> Self {
        let takes = |form| machine.comment.form == form || machine.reader.comments.contains(&form);
        Self {
            paren: takes(CommentForm::Paren),
            nested: false,
            semicolon: takes(CommentForm::Semicolon),
            colon: takes(CommentForm::Colon),
        }
    }

    /// The comment that begins at a byte, and where the code goes on; none where no comment begins. `alone` is set when no
    /// word stands before it.
    pub fn at(self, text: &str, start: usize, alone: bool) -> Result<Option<(&str, usize)>, CommentFault> {
        let inside = || text.get(start + 1..).unwrap_or_default();
        match text.as_bytes().get(start) {
            Some(b'(') if self.paren => {
                let (comment, _) = inside().split_once(')').ok_or(CommentFault::Unclosed)?;
                let end = start + comment.len() + 2;
                if comment.contains('(') && !self.nested {
                    return Err(CommentFault::Nested(end));
                }
                Ok(Some((comment.trim(), end)))
            }
            Some(b';') if self.semicolon => Ok(Some((inside().trim(), text.len()))),
            Some(b':') if self.colon && alone => Ok(Some((inside().trim(), text.len()))),
            _ => Ok(None),
        }
    }
}
