//! Text to motion: the reader of G-code.

mod block;
mod called;
mod circle;
mod codes;
mod drilling;
mod errors;
mod in_force;
mod interpreter;
mod klartext;
mod lexer;
mod reading;
mod rotary;
mod siemens;
mod turned;

use std::collections::BTreeMap;

use styluscam_motion::{EventKind, ToolRecord, UnitAxis};

use crate::block::{Comments, Misfit, Number};
use crate::machine::{AfterEnd, BlockDelete, Family, Machine, Turns};
use crate::read_error::{ReadError, ReadFault};
use crate::writer::counted_length;
use block::{Block, Force};
use called::{Arguments, Called};
use codes::{Codes, Meaning};
use errors::{flaw_at, misfit_at, whole_line, whole_text};
use interpreter::Interpreter;
use lexer::{Call, Flaw, Line, Word};
pub use reading::Reading;

/// In place of a radius's letter, where the machine reads none.
const NO_RADIUS: u8 = 0;

/// Reads `text` as `machine` would, strictly: what is not understood is an error, never skipped.
///
/// `tools` are the job's: positions are those of the active tool's tip, `reference_height` below the coordinates. Without
/// any, tools are made up from their numbers and coordinates are taken for the tip's. A job's only tool need not be
/// called. An axis that has not been commanded takes the first position commanded for it; feed moves are refused until all
/// three have a position. After a tool change that holds for Z, after G53 for its axes: its move is a remark only.
/// M0 and M1 become remarks too. On machines without M6 a T word is the tool change.
///
/// # Errors
/// [`ReadError`] for the first thing that cannot be read.
pub fn read(text: &str, machine: &Machine, tools: &[ToolRecord]) -> Result<Reading, ReadError> {
    machine.check().map_err(|e| whole_text(e.into()))?;
    if machine.family == Family::Klartext {
        return klartext::read(text, machine, tools);
    }
    let mut reader = Reader::new(text.len(), machine, tools).map_err(|e| whole_text(e.into()))?;
    let mut line_number = 0_u32;
    for line in text.lines() {
        line_number = line_number.checked_add(1).ok_or_else(|| whole_text(ReadFault::TooManyLines))?;
        if reader.read_line(line, line_number)? == Progress::Done {
            break;
        }
    }
    reader.finish(line_number)
}

/// A part of a program that is put together from several.
pub(crate) struct Section<'t> {
    /// Id and kind of the operation that it is, if any.
    pub operation: Option<(&'t str, &'t str)>,
    /// Coolant that is on around it.
    pub coolant: Option<&'t EventKind>,
    pub text: &'t str,
    /// Axes of tools that lean at the ends of the moves of lines; those of others stand upright.
    pub axes: &'t BTreeMap<u32, UnitAxis>,
}

/// Reads sections of commands one after the other, loosely: the work offset may change, codes that are not known are
/// handed on, an arc's offset across its plane may be 0. An error comes with its section's index.
pub(crate) fn read_sections(
    sections: &[Section],
    machine: &Machine,
    tools: &[ToolRecord],
) -> Result<Reading, (usize, ReadError)> {
    let length = sections.iter().map(|section| section.text.len()).sum();
    let mut reader = Reader::new(length, machine, tools).map_err(|e| (0, whole_text(e.into())))?;
    reader.loose = true;
    reader.interpreter.loosen();
    for (index, section) in sections.iter().enumerate() {
        if let Some((id, kind)) = section.operation {
            reader.interpreter.start_operation(id, kind);
        }
        reader.interpreter.hand_on(section.coolant);
        let first = reader.interpreter.moves();
        for (line, number) in section.text.lines().zip(1..) {
            reader.read_line(line, number).map_err(|error| (index, error))?;
        }
        reader.interpreter.lean(first, section.axes);
        reader.interpreter.hand_on(section.coolant.and_then(switched_off).as_ref());
    }
    reader.finish(0).map_err(|error| (sections.len(), error))
}

fn switched_off(kind: &EventKind) -> Option<EventKind> {
    match kind {
        EventKind::Flood { .. } => Some(EventKind::Flood { on: false }),
        EventKind::Mist { .. } => Some(EventKind::Mist { on: false }),
        _ => None,
    }
}

#[derive(PartialEq, Eq)]
enum Progress {
    Going,
    Done,
}

/// Where the reader is in the file.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    /// Before the first line that is not empty.
    Start,
    /// In the program.
    Inside,
    /// After M2 or M30.
    Ended,
}

struct Reader<'t> {
    machine: &'t Machine,
    codes: Codes,
    comments: Comments,
    radius_word: u8,
    dwell_word: char,
    line: Line<'t>,
    interpreter: Interpreter<'t>,
    stage: Stage,
    /// Whether the first line was `%`.
    framed: bool,
    /// Whether M2 or M30 has ended it.
    by_code: bool,
    optional_lines: Vec<u32>,
    /// Whether codes that are not known are handed on.
    loose: bool,
}

impl<'t> Reader<'t> {
    fn new(length: usize, machine: &'t Machine, tools: &[ToolRecord]) -> Result<Self, crate::machine::MachineError> {
        let radius_word = machine.arc.as_ref().map_or("R", |rules| rules.radius_word.as_str());
        Ok(Self {
            machine,
            codes: Codes::new(machine)?,
            comments: Comments::of(machine),
            radius_word: radius_word.bytes().next().unwrap_or(NO_RADIUS),
            dwell_word: machine.dwell.as_ref().map_or('P', |d| d.word),
            line: Line::default(),
            interpreter: Interpreter::new(machine, tools, length),
            stage: Stage::Start,
            framed: false,
            by_code: false,
            optional_lines: Vec::new(),
            loose: false,
        })
    }

    fn read_line(&mut self, text: &'t str, number: u32) -> Result<Progress, ReadError> {
        if text.trim() == "%" {
            return self.read_percent(text, number);
        }
        self.check_length(text).map_err(|fault| whole_line(number, fault))?;
        self.check_characters(text).map_err(|misfit| misfit_at(text, number, misfit))?;
        if self.stage == Stage::Start && self.names_program(text) {
            return Ok(Progress::Going);
        }
        self.cut(text).map_err(|misfit| misfit_at(text, number, misfit))?;
        if !self.runs().map_err(|fault| whole_line(number, fault))? {
            self.optional_lines.push(number);
            return Ok(Progress::Going);
        }
        for comment in &self.line.comments {
            self.interpreter.remark(comment);
        }
        let empty = self.line.words.is_empty() && self.line.call.is_none();
        if empty && self.line.comments.is_empty() {
            return Ok(Progress::Going);
        }
        if self.stage == Stage::Ended && !empty {
            return Err(whole_line(number, ReadFault::AfterEnd));
        }
        if self.stage == Stage::Start {
            self.stage = Stage::Inside;
        }
        if empty || !self.run_block(text, number).map_err(|(fault, word)| flaw_at(text, number, fault, word))? {
            return Ok(Progress::Going);
        }
        self.stage = Stage::Ended;
        self.by_code = true;
        Ok(if self.machine.reader.after_end == AfterEnd::Ignore { Progress::Done } else { Progress::Going })
    }

    /// Whether a line is the program's number or name and a remark: `O0001 (CUP)`, `OCUP`, `%_N_CUP_MPF` (Sinumerik).
    fn names_program(&self, text: &str) -> bool {
        let head = &self.machine.reader.head;
        if !head.is_empty() && text.starts_with(head.as_str()) {
            return true;
        }
        let code = text.split('(').next().unwrap_or_default().trim();
        let Some(rest) = code.strip_prefix('O').filter(|rest| !rest.is_empty()) else { return false };
        let rules = &self.machine.program;
        let number =
            rules.number.is_some_and(|rules| rest.parse().is_ok_and(|n| (rules.least..=rules.most).contains(&n)));
        number || rules.name.as_ref().is_some_and(|rules| rules.takes(rest))
    }

    /// The first `%` opens the program when nothing comes before it, the second ends the text.
    fn read_percent(&mut self, text: &str, number: u32) -> Result<Progress, ReadError> {
        let opens = self.stage == Stage::Start && !self.framed;
        if !self.machine.reader.percent || !(opens || self.framed) {
            let start = text.find('%').unwrap_or_default();
            return Err(misfit_at(text, number, Misfit { fault: ReadFault::Percent, start, end: start + 1 }));
        }
        if opens {
            self.framed = true;
            return Ok(Progress::Going);
        }
        self.stage = Stage::Ended;
        Ok(Progress::Done)
    }

    fn check_length(&self, text: &str) -> Result<(), ReadFault> {
        let max = self.machine.line.max_chars;
        if text.len() <= max as usize {
            return Ok(());
        }
        let length = counted_length(text.trim_end_matches('\r'), self.machine.line.counted);
        if length <= max as usize {
            return Ok(());
        }
        Err(ReadFault::LineTooLong { length, max })
    }

    /// Some characters the machine acts on wherever they stand.
    fn check_characters(&self, text: &str) -> Result<(), Misfit> {
        let forbidden = &self.machine.line.forbidden;
        if forbidden.is_empty() {
            return Ok(());
        }
        match text.char_indices().find(|(_, char)| forbidden.contains(*char)) {
            Some((start, char)) => Err(Misfit { fault: ReadFault::Character, start, end: start + char.len_utf8() }),
            None => Ok(()),
        }
    }

    /// Whether the machine runs this line.
    fn runs(&self) -> Result<bool, ReadFault> {
        match self.machine.reader.block_delete {
            _ if !self.line.deleted => Ok(true),
            BlockDelete::Run => Ok(true),
            BlockDelete::Skip => Ok(false),
            BlockDelete::Error => Err(ReadFault::BlockDelete),
        }
    }

    fn cut(&mut self, text: &'t str) -> Result<(), Misfit> {
        match self.machine.family {
            Family::Siemens => self.line.cut_siemens(text, self.comments),
            _ => self.line.cut(text, self.comments),
        }
    }

    fn run_block(&mut self, text: &str, number: u32) -> Result<bool, Flaw> {
        self.check_words()?;
        if let Some(call) = self.line.call {
            let word = Word { letter: b'M', number: Number::whole(0), start: call.start, end: call.end };
            return self.call(call).map(|()| false).map_err(|fault| (fault, Some(word)));
        }
        if self.is_passed()? || self.loose && self.is_foreign() {
            self.interpreter.pass(text, self.codes.tolerance_after(text));
            return Ok(false);
        }
        let mut block = Block::default();
        for word in &self.line.words {
            block.take(*word, &self.codes, self.radius_word).map_err(|fault| (fault, Some(*word)))?;
        }
        if self.loose {
            block.drop_idle_offsets();
        }
        let arc = self.interpreter.arc_after(&block);
        let arrivals = self.machine.arc.as_ref().is_some_and(|rules| rules.turns == Turns::Arrivals);
        let force = Force {
            codes: &self.codes,
            dwell_word: self.dwell_word,
            length_word: self.interpreter.length_word(),
            edges: self.machine.family == Family::Siemens,
            arc,
            turns: arc && arrivals,
            cycle: self.interpreter.cycle_after(&block),
        };
        block.settle(&force).map_err(|(fault, word)| (fault, Some(word)))?;
        if let (Some(word), None, false) = (block.any_axis(), block.motion(), self.machine.reader.modal_motion) {
            return Err((ReadFault::NoMotionMode, Some(word)));
        }
        self.interpreter.run(&block, &self.codes, number)
    }

    /// Sinumerik's cycles are called at every position from here on, or at none.
    fn call(&mut self, call: Call) -> Result<(), ReadFault> {
        let Some((name, arguments)) = call.cycle else {
            self.interpreter.define(None);
            return Ok(());
        };
        let name = name.to_ascii_uppercase();
        let number = name.strip_prefix("CYCLE").and_then(|number| number.parse().ok());
        let number = number.ok_or(ReadFault::NotRead { what: "calls of these" })?;
        let unit = self.interpreter.unit_mm().ok_or(ReadFault::NoUnits)?;
        self.interpreter.define(Some(Called::sinumerik(number, &Arguments::cut(arguments)?, unit)?));
        Ok(())
    }

    /// Codes that this controller refuses, and how many it takes in a line.
    fn check_words(&self) -> Result<(), Flaw> {
        let mut commands = 0;
        for word in self.line.words.iter().filter(|word| matches!(word.letter, b'G' | b'M')) {
            commands += 1;
            if self.codes.meaning(*word) == Some(Meaning::Refused) {
                return Err((ReadFault::Refused { machine: self.machine.name.clone() }, Some(*word)));
            }
            if commands > 1 && self.machine.words.one_command {
                return Err((ReadFault::SecondCommand, Some(*word)));
            }
        }
        Ok(())
    }

    /// Whether a block is to be handed on as it stands. Nothing in it may move an axis or mean something to the reader.
    fn is_passed(&self) -> Result<bool, Flaw> {
        let passed = |word: &Word| self.codes.meaning(*word) == Some(Meaning::Passed);
        if !self.line.words.iter().any(passed) {
            return Ok(false);
        }
        let foreign = |word: &&Word| b"GMXYZIJKRABCUVWFST".contains(&word.letter) && !passed(word);
        match self.line.words.iter().find(foreign) {
            Some(word) => Err((ReadFault::StrayWord, Some(*word))),
            None => Ok(true),
        }
    }

    /// Whether a block holds a code that is not known, and nothing that moves an axis or that is known.
    fn is_foreign(&self) -> bool {
        let unknown = |word: &Word| {
            let mut block = Block::default();
            matches!(word.letter, b'G' | b'M')
                && matches!(block.take(*word, &self.codes, self.radius_word), Err(ReadFault::UnknownCode))
        };
        let quiet = |word: &Word| !b"GMXYZIJKRABCUVWTFS".contains(&word.letter) || unknown(word);
        self.line.words.iter().any(unknown) && self.line.words.iter().all(quiet)
    }

    fn finish(self, lines: u32) -> Result<Reading, ReadError> {
        if self.machine.reader.end_required && self.stage != Stage::Ended {
            return Err(whole_line(lines, ReadFault::NoEnd));
        }
        let (program, ended) = (self.interpreter, self.by_code);
        program.finish(ended, lines, self.optional_lines).map_err(whole_text)
    }
}
