//! What a machine's file says about codes that differ from controller to controller.

use std::collections::BTreeMap;

use super::lexer::{code, Word};
use crate::machine::{FeedMode, LengthUnit, Machine, MachineError};
use crate::template::Templater;

/// What a code means on one machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    Refused,
    /// It moves nothing; its block is handed on as it stands.
    Passed,
    Units(LengthUnit),
    Feed(FeedMode),
    /// A tool's length is applied, or taken back.
    Length(bool),
    Wcs,
    /// Whether the probe must touch.
    Probe(bool),
    /// The machine's own stored place.
    Home,
    /// Whether the operator's switch decides.
    Stop(bool),
}

/// A work offset's words: the code, the number's letter and ten times the number.
type WcsWords = ((u8, i64), Option<(u8, i64)>);

/// The codes of one machine.
pub(super) struct Codes {
    meanings: BTreeMap<(u8, i64), Meaning>,
    wcs: Vec<WcsWords>,
    /// The smoothing's blocks without spaces, and the tolerance that each sets, mm.
    smoothing: Vec<(String, f64)>,
}

impl Codes {
    pub fn new(machine: &Machine) -> Result<Self, MachineError> {
        let words: Vec<WcsWords> = machine.wcs.iter().filter_map(|wcs| wcs_words(machine.wcs_words_of(wcs)?)).collect();
        let mut meanings = BTreeMap::new();
        let mut say = |word: Option<&str>, meaning| {
            if let Some(code) = word.and_then(code) {
                meanings.insert(code, meaning);
            }
        };
        let Machine { units, feed, tool, probe, reader, .. } = machine;
        say(units.mm.as_deref(), Meaning::Units(LengthUnit::Mm));
        say(units.inch.as_deref(), Meaning::Units(LengthUnit::Inch));
        say(feed.per_minute.as_deref(), Meaning::Feed(FeedMode::PerMinute));
        say(feed.per_revolution.as_deref(), Meaning::Feed(FeedMode::PerRevolution));
        say(feed.inverse_time.as_deref(), Meaning::Feed(FeedMode::InverseTime));
        if let Some(length) = &tool.length {
            say(Some(&length.code), Meaning::Length(true));
            say(length.cancel.as_deref(), Meaning::Length(false));
        }
        if let Some(probe) = probe {
            say(Some(&probe.must_touch), Meaning::Probe(true));
            say(probe.may_touch.as_deref(), Meaning::Probe(false));
        }
        if reader.home.is_some() {
            say(Some("G28"), Meaning::Home);
        }
        reader.passed.iter().for_each(|word| say(Some(word), Meaning::Passed));
        say(machine.stop.always.as_deref(), Meaning::Stop(false));
        say(machine.stop.optional.as_deref(), Meaning::Stop(true));
        words.iter().for_each(|(code, _)| _ = meanings.insert(*code, Meaning::Wcs));
        reader
            .refused
            .iter()
            .filter_map(|word| code(word))
            .for_each(|code| _ = meanings.insert(code, Meaning::Refused));
        Ok(Self { meanings, wcs: words, smoothing: smoothing(machine)? })
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
            let said = match number {
                Some((b'P', tenths)) => p.is_some_and(|w| w.number.tenths() == Some(*tenths)),
                Some((b'H', tenths)) => h.is_some_and(|w| w.number.tenths() == Some(*tenths)),
                Some(_) => false,
                None => true,
            };
            *code == found && said
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
