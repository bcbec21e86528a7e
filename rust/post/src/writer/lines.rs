//! Lines of posted text: block numbers, spaces, lengths, characters, and where they go.

use std::io;

use crate::comment::CommentFormat;
use crate::machine::{CommentForm, Counted, LineEnd, Machine, Numbered, Separator};
use crate::number::{write_integer, NumberFormat};
use crate::post_error::PostError;

/// Text is handed on in pieces of about this many bytes.
const PIECE: usize = 1 << 16;

/// Where posted text goes.
pub(super) enum Outlet<'o> {
    /// It is kept whole.
    Memory,
    /// It is handed on piece by piece.
    Stream(&'o mut dyn io::Write),
}

/// The text so far, and the line that is being written.
pub(super) struct Lines<'a> {
    machine: &'a Machine,
    comments: CommentFormat,
    outlet: Outlet<'a>,
    text: String,
    line_start: usize,
    /// The line being written, from 1.
    pub line: u32,
    number: u32,
    /// Whether the next block is numbered where only some are.
    number_due: bool,
    /// Whether the last line goes on in the next one, as Klartext's cycles do.
    goes_on: bool,
}

impl<'a> Lines<'a> {
    pub fn new(machine: &'a Machine, outlet: Outlet<'a>, capacity: usize) -> Self {
        Self {
            machine,
            comments: CommentFormat::new(machine),
            outlet,
            text: String::with_capacity(capacity.max(PIECE)),
            line_start: 0,
            line: 1,
            number: machine.block_number.as_ref().map_or(0, |b| b.start),
            number_due: false,
            goes_on: false,
        }
    }

    /// The text that was kept; what is left of it when it was handed on.
    pub fn finish(mut self) -> Result<String, PostError> {
        self.hand_on(0)?;
        Ok(self.text)
    }

    /// The next block is one where an operator may start again.
    pub fn mark(&mut self) {
        self.number_due = true;
    }

    // Blocks

    /// Begins a block: its number.
    pub fn begin(&mut self) {
        let Some(rules) = &self.machine.block_number else { return };
        if rules.which == Numbered::ToolChanges && !std::mem::take(&mut self.number_due) {
            return;
        }
        let (prefix, digits, next) = (rules.prefix.as_str(), rules.digits, self.number.saturating_add(rules.step));
        self.text.push_str(prefix);
        let width = 1 + self.number.checked_ilog10().unwrap_or(0);
        (width..u32::from(digits)).for_each(|_| self.text.push('0'));
        write_integer(&mut self.text, u64::from(self.number));
        self.number = if next > rules.max { rules.start } else { next };
        if prefix.is_empty() || self.machine.words.separator == Separator::Space {
            self.text.push(' ');
        }
    }

    /// A word as it stands.
    pub fn word(&mut self, word: &str) {
        self.separate();
        self.text.push_str(word);
    }

    /// A letter, or an address, and a number in units of the last decimal.
    pub fn number(&mut self, address: &str, format: &NumberFormat, count: i64) {
        self.separate();
        self.text.push_str(address);
        format.write(&mut self.text, count);
    }

    /// A space between two words; none at a line's start or after a block's number.
    fn separate(&mut self) {
        let at_start = self.text.len() == self.line_start || self.text.ends_with(' ');
        if !at_start && self.machine.words.separator == Separator::Space {
            self.text.push(' ');
        }
    }

    /// Ends a block.
    pub fn end(&mut self) -> Result<(), PostError> {
        self.check_length()?;
        self.text.push_str(match self.machine.line.eol {
            LineEnd::Lf => "\n",
            LineEnd::Crlf => "\r\n",
        });
        self.line_start = self.text.len();
        self.line = self.line.saturating_add(1);
        if self.text.len() >= PIECE {
            self.hand_on(PIECE)?;
        }
        Ok(())
    }

    /// A block of one word or of words that stand as they are.
    pub fn block(&mut self, words: &str) -> Result<(), PostError> {
        self.begin();
        self.word(words);
        self.end()
    }

    // Whole lines

    /// A remark, on as many lines as it needs.
    pub fn comment(&mut self, text: &str) -> Result<(), PostError> {
        self.comments.lines(text).iter().try_for_each(|line| self.line(line))
    }

    /// Lines of a template, without the empty ones.
    pub fn text(&mut self, text: &str) -> Result<(), PostError> {
        text.lines().map(str::trim_end).filter(|l| !l.is_empty()).try_for_each(|line| self.line(line))
    }

    /// One line as it stands, numbered where blocks are.
    pub fn line(&mut self, line: &str) -> Result<(), PostError> {
        if let Some(character) = line.chars().find(|c| !self.takes(*c)) {
            return Err(PostError::Character { line: self.line, character });
        }
        if self.is_numbered(line) {
            self.begin();
        }
        self.text.push_str(line);
        self.goes_on = line.ends_with('~');
        self.end()
    }

    fn is_numbered(&self, line: &str) -> bool {
        let Some(rules) = &self.machine.block_number else { return false };
        let named =
            self.machine.program.name.is_some() && line.strip_prefix('O').is_some_and(|name| !name.contains(' '));
        let frame = line.starts_with('%') || program_number(line) || named;
        let remark = match self.machine.comment.form {
            CommentForm::Colon => line.starts_with(':'),
            _ => line.starts_with(['(', ';']),
        };
        match rules.which {
            Numbered::Lines => !self.goes_on,
            Numbered::Blocks | Numbered::ToolChanges => !frame && !remark,
        }
    }

    fn takes(&self, c: char) -> bool {
        // A line that is a program's mark holds nothing else, and the template's author wrote it.
        (' '..='~').contains(&c) && !self.machine.line.forbidden.contains(c)
    }

    fn check_length(&self) -> Result<(), PostError> {
        let max = self.machine.line.max_chars;
        if self.text.len() - self.line_start <= max as usize {
            return Ok(());
        }
        let line = self.text.get(self.line_start..).unwrap_or_default();
        let length = counted_length(line, self.machine.line.counted);
        if length <= max as usize {
            return Ok(());
        }
        Err(PostError::LineTooLong { line: self.line, length, max })
    }

    /// Hands all text on once there is more than `least` of it; text that is kept stays.
    fn hand_on(&mut self, least: usize) -> Result<(), PostError> {
        let Outlet::Stream(out) = &mut self.outlet else { return Ok(()) };
        if self.text.len() < least {
            return Ok(());
        }
        out.write_all(self.text.as_bytes()).map_err(|e| PostError::Output { message: e.to_string() })?;
        self.text.clear();
        self.line_start = 0;
        Ok(())
    }
}

/// Whether a line begins a program: `O0001`.
fn program_number(line: &str) -> bool {
    line.strip_prefix('O').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
}

/// A line's length as the controller counts it.
pub(crate) fn counted_length(line: &str, counted: Counted) -> usize {
    match counted {
        Counted::All => line.chars().count(),
        Counted::Code => code_length(line),
    }
}

/// Characters outside comments, without white space.
fn code_length(line: &str) -> usize {
    let mut inside = false;
    let mut length = 0;
    for c in line.chars() {
        match c {
            ';' if !inside => break,
            '(' => inside = true,
            ')' => inside = false,
            _ if inside || c.is_whitespace() => {}
            _ => length += 1,
        }
    }
    length
}
