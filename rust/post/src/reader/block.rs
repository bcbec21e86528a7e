//! One block of G-code: its words sorted into what they ask for, each modal group at most once.

use styluscam_motion::{Plane, SpindleDirection};

use super::codes::{Codes, Meaning};
use super::lexer::{Word, TURN};
use crate::block::{g_code, m_code, Code, Length, Motion, Number, Stop};
use crate::machine::{FeedMode, LengthUnit};
use crate::read_error::ReadFault;

/// The words of one block.
#[derive(Debug, Default)]
pub(crate) struct Block {
    pub(crate) axes: [Option<Word>; 3],
    /// I, J and K.
    pub(crate) offsets: [Option<Word>; 3],
    pub(crate) radius: Option<Word>,
    pub(crate) feed: Option<Word>,
    pub(crate) speed: Option<Word>,
    pub(crate) tool: Option<Word>,
    pub(crate) h: Option<Word>,
    pub(crate) p: Option<Word>,
    pub(crate) q: Option<Word>,
    /// The time of a dwell, where its letter is another word's as well.
    pub(crate) time: Option<Word>,
    pub(crate) motion: Option<(Motion, Word)>,
    pub(crate) units: Option<LengthUnit>,
    /// Whether G91, not G90.
    pub(crate) incremental: Option<bool>,
    /// Whether G43, not G49.
    pub(crate) length: Option<(bool, Word)>,
    /// Its number, and D where that is the letter.
    pub(crate) d: Option<Word>,
    pub(crate) feed_mode: Option<(FeedMode, Word)>,
    /// Whether G99, not G98.
    pub(crate) low_return: Option<bool>,
    pub(crate) probe: Option<(bool, Word)>,
    pub(crate) home: Option<Word>,
    /// A call of the cycle that was defined: M99 (Klartext).
    pub(crate) call: Option<Word>,
    pub(crate) turns: Option<Word>,
    /// An angle from the start about the centre, degrees, in place of an end.
    pub(crate) polar: Option<Word>,
    /// How far Z goes on the way, in place of its end.
    pub(crate) rise: Option<Word>,
    /// A code that the machine's file hands on.
    pub(crate) passed: Option<Word>,
    pub(crate) wcs: Option<Word>,
    pub(crate) dwell: Option<Word>,
    pub(crate) machine_coordinates: Option<Word>,
    pub(crate) smoothing: Option<Word>,
    pub(crate) change: Option<Word>,
    pub(crate) spindle: Option<(Option<SpindleDirection>, Word)>,
    pub(crate) mist: Option<Word>,
    pub(crate) flood: Option<Word>,
    pub(crate) coolant_off: Option<Word>,
    pub(crate) stop: Option<(Stop, Word)>,
    pub(crate) plane: Option<(Plane, Word)>,
    /// Whether G90.1, not G91.1.
    pub(crate) absolute_centre: Option<bool>,
    pub(super) line_number: Option<Word>,
    pub(super) compensation: Option<Word>,
}

impl Block {
    /// Sorts one word in, by a machine's codes and then by those that all share.
    pub(crate) fn take(&mut self, word: Word, codes: &Codes, radius_word: u8) -> Result<(), ReadFault> {
        match codes.meaning(word) {
            Some(Meaning::Code(code)) => return self.take_code(code, word, ReadFault::SameGroup),
            Some(Meaning::Passed) => return once(&mut self.passed, word, ReadFault::SameGroup),
            Some(Meaning::Refused) | None => {}
        }
        if word.letter == radius_word {
            return once(&mut self.radius, word, ReadFault::WordTwice);
        }
        let [x, y, z] = &mut self.axes;
        let [i, j, k] = &mut self.offsets;
        let slot = match word.letter {
            b'X' => x,
            b'Y' => y,
            b'Z' => z,
            b'F' => &mut self.feed,
            b'G' => return self.take_code(shared_g(word.number)?, word, ReadFault::SameGroup),
            b'M' => return self.take_m(word),
            b'S' => &mut self.speed,
            b'T' => &mut self.tool,
            b'H' => &mut self.h,
            b'D' => &mut self.d,
            TURN => &mut self.turns,
            b'P' => &mut self.p,
            b'Q' => &mut self.q,
            b'N' => &mut self.line_number,
            b'I' => i,
            b'J' => j,
            b'K' => k,
            b'O' => return Err(ReadFault::NotRead { what: "subroutines and program numbers" }),
            _ => return Err(ReadFault::UnknownWord),
        };
        once(slot, word, ReadFault::WordTwice)
    }

    fn take_m(&mut self, word: Word) -> Result<(), ReadFault> {
        let code = word.number.natural().and_then(m_code).ok_or(ReadFault::UnknownCode)?;
        let both = match code {
            Code::Mist | Code::Flood => self.coolant_off.is_some(),
            Code::CoolantOff => self.mist.is_some() || self.flood.is_some(),
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
            Code::Motion(motion) => once(&mut self.motion, (motion, word), twice),
            Code::Probe(must_touch) => once(&mut self.probe, (must_touch, word), twice),
            Code::Dwell => once(&mut self.dwell, word, twice),
            Code::Plane(plane) => once(&mut self.plane, (plane, word), twice),
            Code::Unit(unit) => once(&mut self.units, unit, twice),
            Code::Incremental(on) => once(&mut self.incremental, on, twice),
            Code::AbsoluteCentre(on) => once(&mut self.absolute_centre, on, twice),
            Code::FeedMode(mode) => once(&mut self.feed_mode, (mode, word), twice),
            Code::LowReturn(on) => once(&mut self.low_return, on, twice),
            Code::Compensation(_) => once(&mut self.compensation, word, twice),
            Code::Length(length) => once(&mut self.length, (length == Length::Table, word), twice),
            Code::MachineCoordinates => once(&mut self.machine_coordinates, word, twice),
            Code::WorkOffset => once(&mut self.wcs, word, twice),
            Code::PathMode => once(&mut self.smoothing, word, twice),
            Code::Home => once(&mut self.home, word, twice),
            Code::Stop(stop) => once(&mut self.stop, (stop, word), twice),
            Code::Spindle(direction) => once(&mut self.spindle, (direction, word), twice),
            Code::ToolChange => once(&mut self.change, word, twice),
            Code::Mist => once(&mut self.mist, word, twice),
            Code::Flood => once(&mut self.flood, word, twice),
            Code::CoolantOff => once(&mut self.coolant_off, word, twice),
            Code::OtherMotion | Code::BackBore | Code::SetHome | Code::Shift | Code::ShiftOff => {
                Err(ReadFault::UnknownCode)
            }
            Code::Subroutine | Code::Other => Err(ReadFault::UnknownCode),
        }
    }

    /// Leaves out an arc's offsets of 0 where there are others: FreeCAD says all three.
    pub(crate) fn drop_idle_offsets(&mut self) {
        let count = self.offsets.iter().flatten().count();
        for slot in self.offsets.iter_mut().filter(|_| count > 2) {
            if slot.is_some_and(|word| word.number.value() == 0.0) {
                *slot = None;
            }
        }
    }

    /// The first axis word, if any.
    pub(crate) fn any_axis(&self) -> Option<Word> {
        self.axes.iter().flatten().next().copied()
    }

    /// The words that shape an arc, as far as they are there.
    pub(crate) fn arc_words(&self) -> impl Iterator<Item = Word> + '_ {
        self.offsets.iter().chain([&self.radius]).flatten().copied()
    }

    /// Checks that P, Q, H, R and an arc's words belong to a code; gives X of `G4 X` to the dwell on machines that write it so.
    pub(crate) fn settle(&mut self, force: &Force) -> Result<(), (ReadFault, Word)> {
        if self.dwell.is_some() {
            let [x, ..] = &mut self.axes;
            let [.., k] = &mut self.offsets;
            self.time = match force.dwell_word {
                'X' => x.take(),
                'K' => k.take(),
                'F' => self.feed.take(),
                'S' => self.speed.take(),
                _ => self.p,
            };
        }
        let wcs = |letter| self.wcs.is_some_and(|word| force.codes.wcs_takes(word, letter));
        let p_of_dwell = self.dwell.is_some() && force.dwell_word == 'P';
        let p_of_arc = force.turns && self.dwell.is_none() && self.moves(force.arc);
        let owners = [p_of_dwell, self.smoothing.is_some(), p_of_arc, force.cycle, wcs(b'P')];
        let p_owners = owners.into_iter().filter(|o| *o).count();
        let on = matches!(self.length, Some((true, _)));
        let owned = [
            (self.p, p_owners == 1),
            (self.q, self.smoothing.is_some() || force.cycle),
            (self.h, on && force.length_word == b'H' || wcs(b'H')),
            (self.d, on && force.length_word == b'D' || force.edges),
            (self.turns, force.arc),
            (self.radius, force.arc || force.cycle),
        ];
        for (word, owned) in owned {
            match word {
                Some(word) if !owned => return Err((ReadFault::StrayWord, word)),
                _ => {}
            }
        }
        match self.offsets.iter().flatten().next().filter(|_| !force.arc) {
            Some(word) => Err((ReadFault::StrayWord, *word)),
            None => Ok(()),
        }
    }

    /// The number of the length offset that a block names.
    pub(crate) fn length_number(&self, letter: u8) -> Option<Word> {
        if letter == b'D' {
            self.d
        } else {
            self.h
        }
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

fn once<T>(slot: &mut Option<T>, value: T, fault: ReadFault) -> Result<(), ReadFault> {
    if slot.is_some() {
        return Err(fault);
    }
    *slot = Some(value);
    Ok(())
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
