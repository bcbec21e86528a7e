//! What a machine's file states about codes that differ from controller to controller.

use std::collections::BTreeMap;

use super::lexer::Word;
use crate::block::{code, Code, Length, Stop};
use crate::machine::{FeedMode, LengthUnit, Machine, MachineError, TipControl};
use crate::template::Templater;

/// What a code means on one machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    Refused,
    /// It moves nothing; its block is handed on as it stands.
    Passed,
    Code(Code),
}

/// A work offset's words: the code, the number's letter and ten times the number.
type WcsWords = ((u8, i64), Option<(u8, i64)>);

/// The codes of one machine.
pub(super) struct Codes {
    meanings: BTreeMap<(u8, i64), Meaning>,
    wcs: Vec<WcsWords>,
    /// The smoothing's blocks without spaces, and the tolerance that each sets, mm.
    smoothing: Vec<(String, f64)>,
    /// Letters of rotary axes.
    turns: Vec<u8>,
}

impl Codes {
    pub fn new(machine: &Machine) -> Result<Self, MachineError> {
        let words: Vec<WcsWords> = machine.wcs.iter().filter_map(|wcs| wcs_words(machine.wcs_words_of(wcs)?)).collect();
        let mut meanings = BTreeMap::new();
        let Machine { units, feed, tool, probe, reader, stop, .. } = machine;
        let mut mean = |word: Option<&str>, meaning| {
            if let Some(code) = word.and_then(code) {
                meanings.insert(code, meaning);
            }
        };
        let length = tool.length.as_ref();
        for (word, code) in [
            (units.mm.as_deref(), Code::Unit(LengthUnit::Mm)),
            (units.inch.as_deref(), Code::Unit(LengthUnit::Inch)),
            (feed.per_minute.as_deref(), Code::FeedMode(FeedMode::PerMinute)),
            (feed.per_revolution.as_deref(), Code::FeedMode(FeedMode::PerRevolution)),
            (feed.inverse_time.as_deref(), Code::FeedMode(FeedMode::InverseTime)),
            (length.map(|length| length.code.as_str()), Code::Length(Length::Table)),
            (length.and_then(|length| length.cancel.as_deref()), Code::Length(Length::Off)),
            (probe.as_ref().map(|probe| probe.must_touch.as_str()), Code::Probe(true)),
            (probe.as_ref().and_then(|probe| probe.may_touch.as_deref()), Code::Probe(false)),
            (reader.home.map(|_| "G28"), Code::Home),
        ] {
            mean(word, Meaning::Code(code));
        }
        reader.passed.iter().for_each(|word| mean(Some(word), Meaning::Passed));
        mean(stop.always.as_deref(), Meaning::Code(Code::Stop(Stop::Pause)));
        mean(stop.optional.as_deref(), Meaning::Code(Code::Stop(Stop::OptionalPause)));
        if let Some(control) = machine.rotary.as_ref().and_then(|rules| rules.tip_control.as_ref()) {
            tip_codes(machine, control).into_iter().for_each(|(code, meaning)| _ = meanings.insert(code, meaning));
        }
        words.iter().for_each(|(code, _)| _ = meanings.insert(*code, Meaning::Code(Code::WorkOffset)));
        let refused = reader.refused.iter().filter_map(|word| code(word));
        refused.for_each(|code| _ = meanings.insert(code, Meaning::Refused));
        let letters = machine.rotary.iter().flat_map(|rules| rules.axes);
        let turns = letters.filter_map(|axis| u8::try_from(axis.letter).ok()).collect();
        Ok(Self { meanings, wcs: words, smoothing: smoothing(machine)?, turns })
    }

    /// Whether the control tracks the tip by a code that names the tool's length too: then all length offsets decide it.
    pub fn tracks_by_length(machine: &Machine) -> bool {
        let control = machine.rotary.as_ref().and_then(|rules| rules.tip_control.as_ref());
        let length = machine.tool.length.as_ref();
        control.zip(length).is_some_and(|(control, length)| control.names_length(length.word))
    }

    /// Whether this is the letter of a rotary axis.
    pub fn turns(&self, letter: u8) -> bool {
        self.turns.contains(&letter)
    }

    pub fn meaning(&self, word: Word) -> Option<Meaning> {
        if !word.letter.is_ascii_alphabetic() {
            return None;
        }
        self.meanings.get(&(word.letter, word.number.tenths()?)).copied()
    }

    /// Which work offset a code and the number that goes with it name; `p` and `h` are the block's.
    pub fn wcs(&self, word: Word, p: Option<Word>, h: Option<Word>) -> Option<usize> {
        let found = (word.letter, word.number.tenths()?);
        self.wcs.iter().position(|(code, number)| {
            let stated = match number {
                Some((b'P', tenths)) => p.is_some_and(|w| w.number.tenths() == Some(*tenths)),
                Some((b'H', tenths)) => h.is_some_and(|w| w.number.tenths() == Some(*tenths)),
                Some(_) => false,
                None => true,
            };
            *code == found && stated
        })
    }

    /// Whether a work offset's code takes a number with this letter.
    pub fn wcs_takes(&self, word: Word, letter: u8) -> bool {
        let tenths = word.number.tenths();
        self.wcs.iter().any(|(code, number)| {
            Some(code.1) == tenths && code.0 == word.letter && number.is_some_and(|(l, _)| l == letter)
        })
    }

    /// How far the path may be left after a block with this code, mm, where the machine's file has that very block.
    pub fn tolerance_after(&self, text: &str) -> Option<f64> {
        let squeezed = squeeze(text);
        self.smoothing.iter().find(|(block, _)| *block == squeezed).map(|(_, tolerance)| *tolerance)
    }
}

/// The codes that switch the tip's control on and off, but for one that takes the length offset back.
fn tip_codes(machine: &Machine, control: &TipControl) -> Vec<((u8, i64), Meaning)> {
    let by_length = Codes::tracks_by_length(machine);
    let cancel = machine.tool.length.as_ref().and_then(|length| length.cancel.as_deref()).and_then(code);
    let [on, off] = control.codes();
    let on_meaning = if by_length { Code::Length(Length::Tip) } else { Code::TipControl(true) };
    let on = on.map(|on| (on, Meaning::Code(on_meaning)));
    let off = off.filter(|off| !(by_length && cancel == Some(*off)));
    on.into_iter().chain(off.map(|off| (off, Meaning::Code(Code::TipControl(false))))).collect()
}

/// `G54`, or `G54.1 P1`.
fn wcs_words(text: &str) -> Option<WcsWords> {
    let mut words = text.split(' ').map(code);
    let first = words.next()??;
    match words.next() {
        None => Some((first, None)),
        Some(number) => Some((first, Some(number?))),
    }
}

fn smoothing(machine: &Machine) -> Result<Vec<(String, f64)>, MachineError> {
    let on = if machine.smoothing.on.is_some() { Templater::new(machine).smoothing()? } else { String::new() };
    let blocks = [(on, machine.smoothing.tolerance), (machine.smoothing.off.clone().unwrap_or_default(), 0.0)];
    let lines = blocks.iter().flat_map(|(text, tolerance)| text.lines().map(move |line| (squeeze(line), *tolerance)));
    Ok(lines.filter(|(line, _)| !line.is_empty()).collect())
}

/// Code without spaces, its number and its remarks.
fn squeeze(text: &str) -> String {
    let code = text.split([';', '(']).next().unwrap_or_default();
    let plain: String = code.chars().filter(|c| !c.is_whitespace()).map(|c| c.to_ascii_uppercase()).collect();
    let numbered = plain.strip_prefix('N').map(|rest| rest.trim_start_matches(|c: char| c.is_ascii_digit()));
    numbered.map_or(plain.clone(), str::to_owned)
}
