//! Lines of G-code cut into words and remarks.

use crate::machine::{CommentForm, Machine};
use crate::read_error::ReadFault;

/// In place of a letter: Sinumerik's `TURN=`.
pub(crate) const TURN: u8 = 1;

/// Most decimal places of a number, and the smallest number of as many digits: fifteen digits are exact in an f64.
const MAX_PLACES: u8 = 15;
const FIFTEEN_DIGITS: i64 = 100_000_000_000_000;

const POWERS_OF_TEN: [f64; 16] = [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];

/// A decimal number as written: `mantissa / 10^places`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Number {
    mantissa: i64,
    places: u8,
    /// Whether it has a decimal point.
    pointed: bool,
}

impl Number {
    /// A whole number.
    pub(crate) fn whole(value: i64) -> Self {
        Self { mantissa: value, places: 0, pointed: false }
    }

    /// The nearest f64.
    #[allow(clippy::cast_precision_loss)] // below 2^53
    pub(crate) fn value(self) -> f64 {
        let divisor = POWERS_OF_TEN.get(usize::from(self.places)).copied().unwrap_or(1.0);
        self.mantissa as f64 / divisor
    }

    /// Whether it has a decimal point.
    pub(crate) fn is_pointed(self) -> bool {
        self.pointed
    }

    /// Ten times the number, when that is whole: 591 for 59.1.
    pub(crate) fn tenths(self) -> Option<i64> {
        let Some(excess) = self.places.checked_sub(1) else { return Some(self.mantissa * 10) };
        let divisor = 10_i64.pow(u32::from(excess));
        (self.mantissa % divisor == 0).then_some(self.mantissa / divisor)
    }

    /// The number, when it is whole and not negative.
    pub(crate) fn natural(self) -> Option<u32> {
        let tenths = self.tenths().filter(|t| t % 10 == 0)?;
        u32::try_from(tenths / 10).ok()
    }
}

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

/// Something in a line that cannot be read, and the bytes where it stands.
#[derive(Debug)]
pub(crate) struct Misfit {
    pub(crate) fault: ReadFault,
    pub(crate) start: usize,
    pub(crate) end: usize,
}

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

/// The forms of remarks that a machine takes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Remarks {
    pub(crate) paren: bool,
    pub(crate) semicolon: bool,
    pub(crate) colon: bool,
}

impl Remarks {
    pub(crate) fn of(machine: &Machine) -> Self {
        let takes = |form| machine.comment.form == form || machine.reader.comments.contains(&form);
        Self {
            paren: takes(CommentForm::Paren),
            semicolon: takes(CommentForm::Semicolon),
            colon: takes(CommentForm::Colon),
        }
    }
}

/// Cuts what begins with a letter; gives where it ends.
pub(super) type CutAddress<'t> = fn(&mut Line<'t>, &'t str, usize) -> Result<usize, Misfit>;

impl<'t> Line<'t> {
    /// Cuts `text`, one line without its end mark: words of one letter and a number.
    pub(crate) fn cut(&mut self, text: &'t str, remarks: Remarks) -> Result<(), Misfit> {
        self.cut_by(text, remarks, Self::cut_word)
    }

    /// The same for words that are cut in another way.
    pub(super) fn cut_by(
        &mut self,
        text: &'t str,
        remarks: Remarks,
        cut_address: CutAddress<'t>,
    ) -> Result<(), Misfit> {
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
                b'(' if remarks.paren => self.cut_comment(text, at)?,
                b';' if remarks.semicolon => self.cut_tail(text, at),
                b':' if remarks.colon && self.words.is_empty() => self.cut_tail(text, at),
                b'/' if self.words.is_empty() && !self.deleted => {
                    self.deleted = true;
                    at + 1
                }
                _ => return Err(stranger(text, at)),
            };
        }
        Ok(())
    }

    fn cut_word(&mut self, text: &'t str, start: usize) -> Result<usize, Misfit> {
        let bytes = text.as_bytes();
        let letter = bytes.get(start).map_or(b'?', u8::to_ascii_uppercase);
        let (number, end) = cut_number(bytes, start + 1).map_err(|m| Misfit { start, ..m })?;
        self.words.push(Word { letter, number, start, end });
        Ok(end)
    }

    fn cut_comment(&mut self, text: &'t str, start: usize) -> Result<usize, Misfit> {
        let inside = text.get(start + 1..).unwrap_or_default();
        let Some(length) = inside.find(')') else {
            return Err(Misfit { fault: ReadFault::UnclosedComment, start, end: text.len() });
        };
        let comment = inside.get(..length).unwrap_or_default();
        if comment.contains('(') {
            return Err(Misfit { fault: ReadFault::NestedComment, start, end: start + length + 2 });
        }
        self.comments.push(comment.trim());
        Ok(start + length + 2)
    }

    fn cut_tail(&mut self, text: &'t str, start: usize) -> usize {
        self.comments.push(text.get(start + 1..).unwrap_or_default().trim());
        text.len()
    }
}

fn stranger(text: &str, start: usize) -> Misfit {
    let character = text.get(start..).and_then(|t| t.chars().next()).unwrap_or('?');
    let fault = match character {
        '#' | '[' | '=' | '<' => ReadFault::NotRead { what: "parameters and expressions" },
        '%' => ReadFault::Percent,
        _ => ReadFault::Character,
    };
    Misfit { fault, start, end: start + character.len_utf8() }
}

/// A number from `start` on, and where it ends. White space may stand before it; inside, some controllers end there.
pub(super) fn cut_number(bytes: &[u8], start: usize) -> Result<(Number, usize), Misfit> {
    let (mut at, mut end) = (start, start);
    let (mut mantissa, mut places) = (0_i64, 0_u8);
    let (mut negative, mut signed, mut digits, mut point) = (false, false, false, false);
    while let Some(byte) = bytes.get(at) {
        match byte {
            b'0'..=b'9' => {
                if mantissa >= FIFTEEN_DIGITS || places == MAX_PLACES {
                    return Err(Misfit { fault: ReadFault::NumberTooLong, start, end: at + 1 });
                }
                mantissa = mantissa * 10 + i64::from(byte - b'0');
                places += u8::from(point);
                digits = true;
            }
            b'.' if !point => point = true,
            b'-' | b'+' if !signed && !digits && !point => {
                negative = *byte == b'-';
                signed = true;
            }
            b' ' | b'\t' if !digits && !signed && !point => {}
            _ => break,
        }
        at += 1;
        end = at;
    }
    let next = bytes.get(at..).unwrap_or_default().iter().position(|b| !b.is_ascii_whitespace());
    if let Some(more) = next.filter(|gap| *gap > 0).and_then(|gap| bytes.get(at + gap)) {
        if more.is_ascii_digit() || *more == b'.' {
            return Err(Misfit { fault: ReadFault::SpaceInNumber, start, end });
        }
    }
    if !digits {
        let end = bytes.get(at).map_or(bytes.len(), |_| at);
        return Err(Misfit { fault: ReadFault::NumberExpected, start, end });
    }
    Ok((Number { mantissa: if negative { -mantissa } else { mantissa }, places, pointed: point }, end))
}

/// A word of a machine file, `G59.1`: its letter and ten times its number.
pub(crate) fn code(word: &str) -> Option<(u8, i64)> {
    let letter = *word.as_bytes().first().filter(|b| b.is_ascii_uppercase())?;
    let (number, end) = cut_number(word.as_bytes(), 1).ok()?;
    let plain = end == word.len() && !word.contains([' ', '\t', '+', '-']);
    plain.then_some((letter, number.tenths()?))
}
