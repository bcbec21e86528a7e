//! One block of G-code: its words sorted into what they ask for, each modal group at most once.

use std::mem::discriminant;

use styluscam_motion::{Plane, SpindleDirection};

use super::codes::{Codes, Meaning};
use super::lexer::{Word, TURN};
use crate::block::{g_code, m_code, once, Code, Length, Motion, Number, Stop, Twice, Words};
use crate::machine::LengthUnit;
use crate::read_error::ReadFault;

/// The words of one block.
#[derive(Debug, Default)]
pub(crate) struct Block {
    /// By letter; an arc's or a cycle's radius is R, whatever its letter.
    pub(crate) words: Words<Word>,
    /// Codes with the words that they were written by, one of each modal group.
    pub(super) codes: Vec<(Code, Word)>,
    /// The time of a dwell, whatever its letter.
    pub(crate) time: Option<Word>,
    /// A call of the cycle that was defined: M99 (Klartext).
    pub(crate) call: Option<Word>,
    /// Full turns of an arc (Sinumerik).
    pub(crate) turns: Option<Word>,
    /// An angle from the start about the centre, degrees, in place of an end.
    pub(crate) polar: Option<Word>,
    /// How far Z goes on the path, in place of its end.
    pub(crate) rise: Option<Word>,
    /// A code that the machine's file hands on.
    pub(super) passed: Option<Word>,
}

/// What a block asks for of each modal group and the word that does so, or the word alone.
macro_rules! modal_groups {
    ($($name:ident: $code:pat => $value:expr, $type:ty;)* $(; $plain:ident: $only:path;)*) => {
        impl Block {
            $(pub(crate) fn $name(&self) -> Option<($type, Word)> {
                self.codes.iter().find_map(|(code, word)| match *code {
                    $code => Some(($value, *word)),
                    _ => None,
                })
            })*
            $(pub(crate) fn $plain(&self) -> Option<Word> {
                self.codes.iter().find(|(code, _)| *code == $only).map(|(_, word)| *word)
            })*
        }
    };
}

modal_groups! {
    motion: Code::Motion(motion) => motion, Motion;
    probe: Code::Probe(must_touch) => must_touch, bool;
    plane: Code::Plane(plane) => plane, Plane;
    unit: Code::Unit(unit) => unit, LengthUnit;
    incremental: Code::Incremental(on) => on, bool;
    length: Code::Length(length) => matches!(length, Length::Table | Length::Tip), bool;
    length_kind: Code::Length(length) => length, Length;
    tracking: Code::TipControl(on) => on, bool;
    stop: Code::Stop(stop) => stop, Stop;
    spindle: Code::Spindle(direction) => direction, Option<SpindleDirection>;
    ; dwell: Code::Dwell;
    ; machine_coordinates: Code::MachineCoordinates;
    ; wcs: Code::WorkOffset;
    ; smoothing: Code::PathMode;
    ; home: Code::Home;
    ; change: Code::ToolChange;
    ; mist: Code::Mist;
    ; flood: Code::Flood;
    ; coolant_off: Code::CoolantOff;
}

impl Block {
    /// A block that holds codes only, by one word.
    pub(crate) fn of(codes: &[Code], word: Word) -> Self {
        Self { codes: codes.iter().map(|code| (*code, word)).collect(), ..Self::default() }
    }

    /// Puts in a code, in place of another one of its modal group.
    pub(crate) fn set_code(&mut self, code: Code, word: Word) {
        self.codes.retain(|(known, _)| discriminant(known) != discriminant(&code));
        self.codes.push((code, word));
    }

    /// Sorts one word in, by a machine's codes and then by those that all share.
    pub(crate) fn take(&mut self, word: Word, codes: &Codes, radius_word: u8) -> Result<(), ReadFault> {
        match codes.meaning(word) {
            Some(Meaning::Code(code)) => return self.take_code(code, word, ReadFault::SameGroup),
            Some(Meaning::Passed) => return once(&mut self.passed, word).map_err(|Twice| ReadFault::SameGroup),
            Some(Meaning::Refused) | None => {}
        }
        match word.letter {
            letter if letter == radius_word => self.take_word(b'R', word),
            b'X' | b'Y' | b'Z' | b'F' | b'S' | b'T' | b'H' | b'D' | b'P' | b'Q' | b'N' | b'I' | b'J' | b'K' => {
                self.take_word(word.letter, word)
            }
            b'A' | b'B' | b'C' if codes.turns(word.letter) => self.take_word(word.letter, word),
            TURN => once(&mut self.turns, word).map_err(|Twice| ReadFault::WordTwice),
            b'G' => self.take_code(shared_g(word.number)?, word, ReadFault::SameGroup),
            b'M' => self.take_m(word),
            b'O' => Err(ReadFault::NotRead { what: "subroutines and program numbers" }),
            _ => Err(ReadFault::UnknownWord),
        }
    }

    pub(crate) fn take_word(&mut self, letter: u8, word: Word) -> Result<(), ReadFault> {
        self.words.put(letter, word).map_err(|Twice| ReadFault::WordTwice)
    }

    fn take_m(&mut self, word: Word) -> Result<(), ReadFault> {
        let code = word.number.natural().and_then(m_code).ok_or(ReadFault::UnknownCode)?;
        let both = match code {
            Code::Mist | Code::Flood => self.coolant_off().is_some(),
            Code::CoolantOff => self.mist().or(self.flood()).is_some(),
            Code::Subroutine => return Err(ReadFault::NotRead { what: "subroutines" }),
            _ => false,
        };
        if both {
            return Err(ReadFault::SameGroup);
        }
        self.take_code(code, word, ReadFault::SameGroup)
    }

    /// Sorts in what a code asks for; `twice` is the fault of a second one of its modal group.
    pub(crate) fn take_code(&mut self, code: Code, word: Word, twice: ReadFault) -> Result<(), ReadFault> {
        match code {
            Code::OtherMotion | Code::BackBore | Code::SetHome | Code::Shift | Code::ShiftOff => {
                Err(ReadFault::UnknownCode)
            }
            Code::Subroutine | Code::Other => Err(ReadFault::UnknownCode),
            _ if self.codes.iter().any(|(known, _)| discriminant(known) == discriminant(&code)) => Err(twice),
            _ => {
                self.codes.push((code, word));
                Ok(())
            }
        }
    }

    /// All that it asks for.
    pub(crate) fn codes(&self) -> impl Iterator<Item = Code> + '_ {
        self.codes.iter().map(|(code, _)| *code)
    }

    /// X, Y and Z.
    pub(crate) fn axes(&self) -> [Option<Word>; 3] {
        self.words.axes()
    }

    /// I, J and K.
    pub(crate) fn offsets(&self) -> [Option<Word>; 3] {
        self.words.offsets()
    }

    /// Leaves out an arc's offsets of 0 where there are others: FreeCAD writes all three.
    pub(crate) fn drop_idle_offsets(&mut self) {
        let offsets = self.offsets().into_iter().flatten();
        for word in offsets.clone().filter(|word| offsets.clone().count() > 2 && word.number.value() == 0.0) {
            self.words.take(word.letter);
        }
    }

    /// The first axis word, if any.
    pub(crate) fn any_axis(&self) -> Option<Word> {
        self.axes().into_iter().flatten().next().or(self.turn_word())
    }

    /// The first word of a rotary axis, if any.
    pub(crate) fn turn_word(&self) -> Option<Word> {
        [b'A', b'B', b'C'].into_iter().find_map(|letter| self.words.get(letter))
    }

    /// The words that shape an arc, as far as they are there.
    pub(crate) fn arc_words(&self) -> impl Iterator<Item = Word> {
        self.offsets().into_iter().chain([self.words.get(b'R')]).flatten()
    }

    /// Checks that P, Q, H, R and an arc's words belong to a code; gives X of `G4 X` to the dwell on machines that write it so.
    pub(crate) fn settle(&mut self, force: &Force) -> Result<(), (ReadFault, Word)> {
        if self.dwell().is_some() {
            self.time = match force.dwell_word {
                letter @ ('X' | 'K' | 'F' | 'S') => self.words.take(letter as u8),
                _ => self.words.get(b'P'),
            };
        }
        let wcs = |letter| self.wcs().is_some_and(|word| force.codes.wcs_takes(word, letter));
        let p_of_dwell = self.dwell().is_some() && force.dwell_word == 'P';
        let p_of_arc = force.turns && self.dwell().is_none() && self.moves(force.arc);
        let owners = [p_of_dwell, self.smoothing().is_some(), p_of_arc, force.cycle, wcs(b'P')];
        let p_owners = owners.into_iter().filter(|o| *o).count();
        let on = matches!(self.length(), Some((true, _)));
        let owned = [
            (self.words.get(b'P'), p_owners == 1),
            (self.words.get(b'Q'), self.smoothing().is_some() || force.cycle),
            (self.words.get(b'H'), on && force.length_word == b'H' || wcs(b'H')),
            (self.words.get(b'D'), on && force.length_word == b'D' || force.edges),
            (self.turns, force.arc),
            (self.words.get(b'R'), force.arc || force.cycle),
        ];
        for (word, owned) in owned {
            match word {
                Some(word) if !owned => return Err((ReadFault::StrayWord, word)),
                _ => {}
            }
        }
        match self.offsets().into_iter().flatten().next().filter(|_| !force.arc) {
            Some(word) => Err((ReadFault::StrayWord, word)),
            None => Ok(()),
        }
    }

    /// The number of the length offset that a block names.
    pub(crate) fn length_number(&self, letter: u8) -> Option<Word> {
        self.words.get(letter).filter(|_| matches!(letter, b'D' | b'H'))
    }

    /// Whether it holds what makes a move, with an arc in force or without.
    fn moves(&self, arc: bool) -> bool {
        self.any_axis().is_some() || arc && self.arc_words().next().is_some()
    }
}

/// What is in force when a block's words are sorted out.
pub(crate) struct Force<'c> {
    pub(crate) codes: &'c Codes,
    /// The letter of a dwell's time.
    pub(crate) dwell_word: char,
    /// The letter of a length offset's number.
    pub(crate) length_word: u8,
    /// Whether D names a tool's edge by itself.
    pub(crate) edges: bool,
    /// An arc.
    pub(crate) arc: bool,
    /// Whether it takes P for its turns.
    pub(crate) turns: bool,
    /// A canned cycle.
    pub(crate) cycle: bool,
}

/// A G code as all machines have it. Units, feeds, work offsets, probing and stored points are those of the machine's file.
fn shared_g(number: Number) -> Result<Code, ReadFault> {
    let not_read = |what| Err(ReadFault::NotRead { what });
    let tenths = number.tenths().and_then(|tenths| u32::try_from(tenths).ok()).ok_or(ReadFault::UnknownCode)?;
    match g_code(tenths) {
        _ if (380..=389).contains(&tenths) => not_read("probing moves other than those of the machine's file"),
        Some(Code::Compensation(true)) => not_read("radius compensations"),
        Some(Code::Length(Length::Words | Length::Added)) => not_read("length offsets other than G43 H"),
        Some(Code::FeedMode(_)) => not_read("feeds other than those of the machine's file"),
        Some(Code::Motion(Motion::Cycle(76 | 88)) | Code::BackBore) => not_read("cycles of this kind"),
        Some(Code::Home) => not_read("returns to stored points"),
        Some(Code::Shift | Code::ShiftOff) => not_read("shifts of the zero point"),
        Some(Code::WorkOffset) => Err(ReadFault::Wcs),
        Some(Code::Unit(_)) | None => Err(ReadFault::UnknownCode),
        Some(code) => Ok(code),
    }
}
