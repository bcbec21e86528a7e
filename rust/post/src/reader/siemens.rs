//! Sinumerik's lines cut into words: addresses of several letters become the words that mean the same elsewhere.

use super::lexer::{Call, Line, Word, TURN};
use crate::block::{cut_number, Comments, Misfit, Number};
use crate::read_error::ReadFault;

impl<'t> Line<'t> {
    /// Cuts `text`, one line without its end mark (programming manual Fundamentals, "Structure of an NC program").
    pub(super) fn cut_siemens(&mut self, text: &'t str, taken: Comments) -> Result<(), Misfit> {
        self.cut_by(text, taken, Self::cut_address)
    }

    fn cut_address(&mut self, text: &'t str, start: usize) -> Result<usize, Misfit> {
        let rest = text.get(start..).unwrap_or_default();
        let length = rest.find(|c: char| !c.is_ascii_alphabetic() && c != '_').unwrap_or(rest.len());
        let name = rest.get(..length).unwrap_or_default().to_ascii_uppercase();
        let after = start + length;
        let next = text.as_bytes().get(after).copied();
        match (name.as_str(), next) {
            ("MCALL", _) => self.cut_call(text, start, after),
            ("SUPA", _) => Ok(self.word(b'G', Number::whole(53), start, after)),
            ("CYCLE", Some(b'8')) if rest.to_ascii_uppercase().starts_with("CYCLE832(") => {
                self.cut_tolerance(text, start)
            }
            ("CR", Some(b'=')) => self.cut_assigned(text, b'R', start, after + 1),
            ("TURN", Some(b'=')) => self.cut_assigned(text, TURN, start, after + 1),
            (_, Some(b'=')) if length == 1 => {
                let letter = name.bytes().next().unwrap_or(b'?');
                self.cut_assigned(text, letter, start, after + 1)
            }
            _ if length == 1 => {
                let letter = name.bytes().next().unwrap_or(b'?');
                self.cut_assigned(text, letter, start, after)
            }
            _ => Err(Misfit { fault: ReadFault::UnknownWords, start, end: after }),
        }
    }

    fn word(&mut self, letter: u8, number: Number, start: usize, end: usize) -> usize {
        self.words.push(Word { letter, number, start, end });
        end
    }

    fn cut_assigned(&mut self, text: &str, letter: u8, start: usize, from: usize) -> Result<usize, Misfit> {
        if text.as_bytes().get(from).is_some_and(|b| b.is_ascii_alphabetic() || *b == b'"') {
            let fault = ReadFault::NotRead { what: "names, AC() and IC()" };
            return Err(Misfit { fault, start, end: text.len() });
        }
        let (number, end) = cut_number(text.as_bytes(), from).map_err(|m| Misfit { start, ..m })?;
        Ok(self.word(letter, number, start, end))
    }

    /// `MCALL CYCLE81(10,2,0,-6)`, or `MCALL` alone.
    fn cut_call(&mut self, text: &'t str, start: usize, after: usize) -> Result<usize, Misfit> {
        let rest = text.get(after..).unwrap_or_default();
        let code = rest.split(';').next().unwrap_or_default().trim_end();
        let end = after + code.len();
        let misfit = |fault| Misfit { fault, start, end };
        if self.call.is_some() || self.words.iter().any(|word| word.letter != b'N') {
            return Err(misfit(ReadFault::StrayWord));
        }
        let cycle = match (code.trim().split_once('('), code.trim()) {
            (None, "") => None,
            (Some((name, rest)), _) => {
                let arguments = rest.strip_suffix(')').ok_or_else(|| misfit(ReadFault::UnclosedComment))?;
                Some((name.trim(), arguments))
            }
            _ => return Err(misfit(ReadFault::NotRead { what: "calls of these" })),
        };
        self.call = Some(Call { cycle, start, end });
        Ok(end)
    }

    /// `CYCLE832(0.01,1,1)` states how far the path may be left, in the program's units; without numbers, or with a second
    /// one of 0, that nothing states it (NC programming 12/2019 p. 1108).
    fn cut_tolerance(&mut self, text: &'t str, start: usize) -> Result<usize, Misfit> {
        let open = start + "CYCLE832(".len();
        let rest = text.get(open..).unwrap_or_default();
        let Some(length) = rest.find(')') else {
            return Err(Misfit { fault: ReadFault::UnclosedComment, start, end: text.len() });
        };
        let end = open + length + 1;
        self.word(b'G', Number::whole(64), start, end);
        let mut arguments = rest.get(..length).unwrap_or_default().split(',').map(str::trim);
        let (first, mode) = (arguments.next().unwrap_or_default(), arguments.next().unwrap_or_default());
        // the last digit of the second one is the kind of machining, 0 switches the cycle off
        let on = mode.ends_with(|digit: char| ('1'..='9').contains(&digit)) || mode.starts_with('_') && mode != "_OFF";
        if on && !first.is_empty() {
            let (number, _) = cut_number(first.as_bytes(), 0).map_err(|m| Misfit { start, end, ..m })?;
            self.word(b'P', number, start, end);
        }
        Ok(end)
    }
}
