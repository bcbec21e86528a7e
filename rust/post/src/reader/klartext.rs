//! Heidenhain's conversational blocks, line by line, as the blocks that the interpreter carries out.
//!
//! Sources: TNC 320 user's manual 7/2008 p. 155 (CC, C), TNC 426/430 user's manual p. 134 (TOOL CALL) and p. 180 (CP),
//! TNC 620 Klartext 10/2017 p. 154 (blocks), TNC 640 ISO p. 631 (ranges of numbers).

use styluscam_motion::{Plane, ToolRecord};

use super::block::Block;
use super::called::{number, Called, Parameters};
use super::codes::Codes;
use super::errors::{flaw_at, misfit_at, whole_line, whole_text};
use super::interpreter::Interpreter;
use super::lexer::{Flaw, Word};
use super::reading::Reading;
use crate::block::{cut_number, m_code, once, Code, Misfit, Motion, Number, Stop, Twice};
use crate::machine::{LengthUnit, Machine};
use crate::read_error::{ReadError, ReadFault};

/// Reads `text` as `machine` would.
pub(super) fn read(text: &str, machine: &Machine, tools: &[ToolRecord]) -> Result<Reading, ReadError> {
    let codes = Codes::new(machine).map_err(|e| whole_text(e.into()))?;
    let mut reader = Reader {
        machine,
        codes,
        interpreter: Interpreter::new(machine, tools, text.len()),
        units: None,
        centre: [None; 2],
        cycle: None,
        continues: false,
        ended: false,
        by_code: false,
    };
    let mut number = 0_u32;
    for line in text.lines() {
        number = number.checked_add(1).ok_or_else(|| whole_text(ReadFault::TooManyLines))?;
        reader.read_line(line, number)?;
    }
    if !reader.ended {
        return Err(whole_line(number, ReadFault::NoEnd));
    }
    reader.interpreter.finish(reader.by_code, number, Vec::new()).map_err(whole_text)
}

struct Reader<'m> {
    machine: &'m Machine,
    codes: Codes,
    interpreter: Interpreter<'m>,
    units: Option<LengthUnit>,
    /// X and Y of the last CC.
    centre: [Option<Word>; 2],
    /// The cycle that the lines belong to, and its parameters so far.
    cycle: Option<(u32, Parameters)>,
    /// Whether this line goes on from the last one.
    continues: bool,
    /// Whether END PGM was read.
    ended: bool,
    /// Whether M2 or M30 was.
    by_code: bool,
}

/// A word of a block, and where it stands in the line.
#[derive(Clone, Copy, Debug)]
struct Token<'t> {
    text: &'t str,
    start: usize,
}

impl Token<'_> {
    fn end(&self) -> usize {
        self.start + self.text.len()
    }

    fn misfit(&self, fault: ReadFault) -> Misfit {
        Misfit { fault, start: self.start, end: self.end() }
    }

    /// The word of a code that has no number of its own.
    fn code(&self, letter: u8) -> Word {
        Word { letter, number: Number::whole(0), start: self.start, end: self.end() }
    }

    /// The number behind an address of so many letters; `letter` is what the word becomes.
    fn word(&self, from: usize, letter: u8) -> Result<Word, Misfit> {
        let (number, end) = cut_number(self.text.as_bytes(), from).map_err(|m| self.misfit(m.fault))?;
        if end != self.text.len() {
            return Err(self.misfit(ReadFault::UnknownWord));
        }
        Ok(Word { letter, number, start: self.start, end: self.end() })
    }
}

impl Reader<'_> {
    fn read_line(&mut self, text: &str, number: u32) -> Result<(), ReadError> {
        let length = text.trim_end().chars().count();
        let max = self.machine.line.max_chars;
        if length > max as usize {
            return Err(whole_line(number, ReadFault::LineTooLong { length, max }));
        }
        let (code, remark) = split_remark(text);
        let tokens = tokens(code);
        let goes_on = std::mem::replace(&mut self.continues, text.trim_end().ends_with('~'));
        let tokens = if goes_on { &tokens[..] } else { without_number(&tokens) };
        if let Some(remark) = remark.filter(|_| !goes_on) {
            self.interpreter.remark(remark.trim().trim_end_matches('~').trim_end());
        }
        if tokens.is_empty() {
            return Ok(());
        }
        let closes = tokens.iter().map(|t| t.text).take(2).eq(["END", "PGM"]);
        if self.ended || self.by_code && !closes {
            return Err(whole_line(number, ReadFault::AfterEnd));
        }
        if !goes_on && self.cycle.take().is_some() {
            return Err(whole_line(number, ReadFault::MissingWord { what: "a parameter of the cycle" }));
        }
        if goes_on {
            return self.read_parameter(tokens).map_err(|m| misfit_at(text, number, m));
        }
        let block = self.block(tokens, text, number)?;
        let Some(block) = block else { return Ok(()) };
        let ends = self.interpreter.run(&block, &self.codes, number);
        self.by_code |= ends.map_err(|(fault, word): Flaw| flaw_at(text, number, fault, word))?;
        Ok(())
    }

    /// What a block asks for; none when it asks for nothing.
    fn block(&mut self, tokens: &[Token], text: &str, number: u32) -> Result<Option<Block>, ReadError> {
        let head: Vec<&str> = tokens.iter().map(|t| t.text).collect();
        let misfit = |m: Misfit| misfit_at(text, number, m);
        match head.as_slice() {
            ["BEGIN", "PGM", _, unit] => self.begin(unit, tokens).map(Some).map_err(misfit),
            ["END", "PGM", ..] => {
                self.ended = true;
                Ok(None)
            }
            ["BLK", "FORM", ..] | ["TOOL", "DEF", ..] => Ok(None),
            ["*", ..] => {
                let heading = text.split_once('*').map_or("", |(_, rest)| rest.trim_start_matches([' ', '-']));
                self.interpreter.remark(heading.trim());
                Ok(None)
            }
            ["TOOL", "CALL", ..] => tool_call(&tokens[2..]).map(Some).map_err(misfit),
            ["CYCL", "DEF", ..] => self.cycle(&tokens[2..]).map_err(misfit),
            ["CYCL", "CALL"] => {
                let word = Word { end: tokens[1].end(), ..tokens[0].code(b'M') };
                Ok(Some(Block { call: Some(word), ..Block::default() }))
            }
            ["CC"] => Err(misfit(tokens[0].misfit(ReadFault::MissingWord { what: "the centre (X and Y)" }))),
            ["CC", ..] => self.set_centre(&tokens[1..]).map(|()| None).map_err(misfit),
            ["L", ..] => self.line(&tokens[1..]).map(Some).map_err(misfit),
            ["C" | "CR" | "CP", ..] => self.circle(&tokens[1..], &tokens[0]).map(Some).map_err(misfit),
            ["STOP", ..] => functions(tokens, 1).map(Some).map_err(misfit),
            [first, ..] if first.starts_with('M') => functions(tokens, 0).map(Some).map_err(misfit),
            _ => Err(misfit(tokens[0].misfit(ReadFault::UnknownWords))),
        }
    }

    fn begin(&mut self, unit: &str, tokens: &[Token]) -> Result<Block, Misfit> {
        let units = match unit {
            "MM" => LengthUnit::Mm,
            "INCH" => LengthUnit::Inch,
            _ => return Err(tokens[3].misfit(ReadFault::NoUnits)),
        };
        if self.units.is_some() {
            return Err(tokens[0].misfit(ReadFault::SameGroup));
        }
        self.units = Some(units);
        let word = tokens[0].code(b'U');
        Ok(Block::of(&[Code::Unit(units), Code::Incremental(false), Code::AbsoluteCentre(true)], word))
    }

    /// X, Y and Z of a block, and what else may stand in it: R0, F, M.
    fn line(&self, tokens: &[Token]) -> Result<Block, Misfit> {
        let mut block = Block::default();
        let mut rapid = None;
        if tokens.iter().map(|token| token.text).eq(["M140", "MB", "MAX"]) {
            return Ok(away(&tokens[0]));
        }
        for (index, token) in tokens.iter().enumerate() {
            match token.text {
                "FMAX" => rapid = Some(*token),
                "F" if tokens.get(index + 1).is_some_and(|next| next.text == "MAX") => rapid = Some(*token),
                "MAX" if rapid.is_some() => {}
                text if text.starts_with('F') => take_word(&mut block, token, b'F')?,
                _ => take_common(&mut block, token)?,
            }
        }
        let nothing = Word { letter: b'L', number: Number::whole(0), start: 0, end: 0 };
        let code = tokens.first().map_or(nothing, |token| token.code(b'L'));
        let motion = if rapid.is_some() { Motion::Rapid } else { Motion::Feed };
        block.set_code(Code::Motion(motion), code);
        Ok(block)
    }

    fn set_centre(&mut self, tokens: &[Token]) -> Result<(), Misfit> {
        for token in tokens {
            match token.text.as_bytes().first() {
                Some(b'X') => self.centre[0] = Some(token.word(1, b'I')?),
                Some(b'Y') => self.centre[1] = Some(token.word(1, b'J')?),
                _ => return Err(token.misfit(ReadFault::NotRead { what: "centres other than by X and Y" })),
            }
        }
        Ok(())
    }

    /// C about the last CC, CR with a radius, CP with an angle about the last CC.
    fn circle(&self, tokens: &[Token], head: &Token) -> Result<Block, Misfit> {
        let mut block = Block::default();
        let mut clockwise = None;
        for token in tokens {
            match token.text {
                "DR+" => clockwise = Some(false),
                "DR-" => clockwise = Some(true),
                text if text.starts_with("IPA") && head.text == "CP" => {
                    put(&mut block.polar, token.word(3, b'P')?, token)?;
                }
                text if text.starts_with("IZ") && head.text == "CP" => {
                    put(&mut block.rise, token.word(2, b'Z')?, token)?;
                }
                text if text.starts_with("R") && head.text == "CR" => {
                    take_word(&mut block, token, b'R')?;
                }
                text if text.starts_with('F') => take_word(&mut block, token, b'F')?,
                _ => take_common(&mut block, token)?,
            }
        }
        let missing = |what| head.misfit(ReadFault::MissingWord { what });
        let clockwise = clockwise.ok_or(missing("the sense of the arc (DR+ or DR-)"))?;
        if head.text == "CP" {
            let angle = block.polar.ok_or(missing("the angle of the arc (IPA)"))?;
            if angle.number.value() == 0.0 {
                return Err(head.misfit(ReadFault::ArcOfNoAngle));
            }
            if (angle.number.value() < 0.0) != clockwise {
                return Err(head.misfit(ReadFault::ArcForm));
            }
        }
        if head.text == "CR" {
            block.words.get(b'R').ok_or(missing("the radius of the arc (R)"))?;
        } else {
            let [Some(x), Some(y)] = self.centre else { return Err(missing("the arc's centre (CC)")) };
            block.words.set(b'I', x);
            block.words.set(b'J', y);
        }
        block.set_code(Code::Motion(Motion::Arc(clockwise)), head.code(b'C'));
        block.set_code(Code::Plane(Plane::Xy), head.code(b'C'));
        Ok(block)
    }

    /// CYCL DEF: 9 waits, 32 states how far the path may be left, 247 chooses a datum, 200, 203 and 207 drill where they are called.
    fn cycle(&mut self, tokens: &[Token]) -> Result<Option<Block>, Misfit> {
        let Some(first) = tokens.first() else { return Ok(None) };
        let value = |address: &str, letter| {
            tokens
                .get(1..)
                .unwrap_or_default()
                .iter()
                .rev()
                .find(|t| t.text.starts_with(address))
                .map(|t| t.word(address.len(), letter))
        };
        match first.text {
            "9.0" | "32.0" | "32.2" => Ok(None),
            "9.1" => {
                let last = tokens
                    .get(2)
                    .ok_or_else(|| first.misfit(ReadFault::MissingWord { what: "the time of cycle 9" }))?;
                let time = last.word(0, b'P')?;
                Ok(Some(Block { time: Some(time), ..Block::of(&[Code::Dwell], time) }))
            }
            "32.1" => {
                let mut block = Block::of(&[Code::PathMode], Word { number: Number::whole(64), ..first.code(b'G') });
                if let Some(tolerance) = value("T", b'P') {
                    block.words.set(b'P', tolerance?);
                }
                Ok(Some(block))
            }
            "200" | "203" | "207" | "247" if self.continues => {
                self.cycle = first.text.parse().ok().map(|number| (number, Parameters::default()));
                Ok(None)
            }
            "200" | "203" | "207" | "247" => {
                Err(first.misfit(ReadFault::MissingWord { what: "a parameter of the cycle" }))
            }
            _ => Err(first.misfit(ReadFault::NotRead { what: "cycles of this kind" })),
        }
    }

    /// A line of a cycle's parameters: `Q339=+1`. The last one does not go on.
    fn read_parameter(&mut self, tokens: &[Token]) -> Result<(), Misfit> {
        let (Some((cycle, mut parameters)), [first]) = (self.cycle.take(), tokens) else {
            return Err(tokens[0].misfit(ReadFault::UnknownWords));
        };
        let stated = first.text.strip_prefix('Q').and_then(|stated| stated.split_once('='));
        let (q, value) = stated.ok_or_else(|| first.misfit(ReadFault::UnknownWord))?;
        let q = q.parse().map_err(|_| first.misfit(ReadFault::UnknownWord))?;
        let value = if value == "MAX" { None } else { Some(number(value).map_err(|fault| first.misfit(fault))?) };
        parameters.push(q, value).map_err(|fault| first.misfit(fault))?;
        if self.continues {
            self.cycle = Some((cycle, parameters));
            return Ok(());
        }
        self.define(cycle, &parameters).map_err(|fault| first.misfit(fault))
    }

    /// A cycle with all its parameters: 247 chooses a datum, the others wait for a call.
    fn define(&mut self, cycle: u32, parameters: &Parameters) -> Result<(), ReadFault> {
        if cycle == 247 {
            let number = parameters.natural(339).ok_or(ReadFault::Wcs)?;
            let index = number.checked_sub(1).and_then(|index| usize::try_from(index).ok()).ok_or(ReadFault::Wcs)?;
            return self.interpreter.choose_wcs(index);
        }
        let unit = self.interpreter.unit_mm().ok_or(ReadFault::NoUnits)?;
        self.interpreter.define(Some(Called::heidenhain(cycle, parameters, unit)?));
        Ok(())
    }
}

/// The path along the tool to the end of its axis, which is at or over the machine's zero.
fn away(token: &Token) -> Block {
    let word = token.code(b'M');
    let mut block = Block::of(&[Code::MachineCoordinates, Code::Motion(Motion::Rapid)], word);
    block.words.set(b'Z', word);
    block
}

/// X, Y, Z, R0 and M words of any block.
fn take_common(block: &mut Block, token: &Token) -> Result<(), Misfit> {
    match token.text.as_bytes() {
        [letter @ (b'X' | b'Y' | b'Z'), ..] => take_word(block, token, *letter),
        b"R0" => Ok(()),
        [b'R', b'L' | b'R', ..] => Err(token.misfit(ReadFault::NotRead { what: "radius compensations" })),
        [b'M', ..] => take_function(block, token),
        [b'I', ..] => Err(token.misfit(ReadFault::NotRead { what: "incremental words" })),
        _ => Err(token.misfit(ReadFault::UnknownWord)),
    }
}

fn take_function(block: &mut Block, token: &Token) -> Result<(), Misfit> {
    let word = token.word(1, b'M')?;
    let number = word.number.natural().ok_or_else(|| token.misfit(ReadFault::UnknownCode))?;
    let mut take = |number| match m_code(number) {
        None | Some(Code::ToolChange) => Err(token.misfit(ReadFault::UnknownCode)),
        Some(code) => take_code(block, code, word, token),
    };
    match number {
        13 | 14 => {
            take(number - 10)?;
            take(8)
        }
        91 => take_code(block, Code::MachineCoordinates, word, token),
        99 => put(&mut block.call, word, token),
        _ => take(number),
    }
}

/// Blocks of M words only; the first `skip` tokens are no M words. STOP alone stops until the operator goes on.
fn functions(tokens: &[Token], skip: usize) -> Result<Block, Misfit> {
    let mut block = Block::default();
    for token in tokens.get(skip..).unwrap_or_default() {
        take_function(&mut block, token)?;
    }
    if skip > 0 && block.stop().is_none() {
        block.set_code(Code::Stop(Stop::Pause), tokens[0].code(b'M'));
    }
    Ok(block)
}

/// `TOOL CALL 1 Z S1000`; without a number only the speed changes.
fn tool_call(tokens: &[Token]) -> Result<Block, Misfit> {
    let mut block = Block::default();
    for token in tokens {
        match token.text.as_bytes() {
            [b'0'..=b'9', ..] => {
                let word = token.word(0, b'T')?;
                block.words.set(b'T', word);
                block.set_code(Code::ToolChange, word);
            }
            b"Z" => {}
            [b'S', ..] => take_word(&mut block, token, b'S')?,
            [b'F', ..] => take_word(&mut block, token, b'F')?,
            [b'D', b'L' | b'R', ..] => {
                return Err(token.misfit(ReadFault::NotRead { what: "oversizes of tools" }));
            }
            _ => return Err(token.misfit(ReadFault::NotRead { what: "tools by name, and tool axes other than Z" })),
        }
    }
    Ok(block)
}

fn take_word(block: &mut Block, token: &Token, letter: u8) -> Result<(), Misfit> {
    block.take_word(letter, token.word(1, letter)?).map_err(|fault| token.misfit(fault))
}

fn take_code(block: &mut Block, code: Code, word: Word, token: &Token) -> Result<(), Misfit> {
    block.take_code(code, word, ReadFault::WordTwice).map_err(|fault| token.misfit(fault))
}

fn put(slot: &mut Option<Word>, word: Word, token: &Token) -> Result<(), Misfit> {
    once(slot, word).map_err(|Twice| token.misfit(ReadFault::WordTwice))
}

/// Code and remark of a line.
fn split_remark(text: &str) -> (&str, Option<&str>) {
    text.split_once(';').map_or((text, None), |(code, remark)| (code, Some(remark)))
}

fn tokens(text: &str) -> Vec<Token<'_>> {
    let base = text.as_ptr() as usize;
    text.split_whitespace()
        .filter(|t| *t != "~")
        .map(|t| Token { text: t, start: t.as_ptr() as usize - base })
        .collect()
}

/// A block's number comes first.
fn without_number<'s, 't>(tokens: &'s [Token<'t>]) -> &'s [Token<'t>] {
    match tokens {
        [first, rest @ ..] if first.text.bytes().all(|b| b.is_ascii_digit()) => rest,
        _ => tokens,
    }
}
