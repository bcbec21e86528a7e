//! One block of G-code: its words sorted into what they ask for, each modal group at most once.

use styluscam_motion::Plane;

use super::codes::{Codes, Meaning};
use super::lexer::Word;
use crate::machine::{FeedMode, LengthUnit};
use crate::read_error::ReadFault;

/// What G0, G1, G2, G3 or G80 ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Motion {
    Rapid,
    Feed,
    /// Clockwise or not.
    Arc(bool),
    /// G73 to G89, by its number.
    Cycle(u16),
    Cancel,
}

/// What M3, M4 or M5 ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Spindle {
    Clockwise,
    Counterclockwise,
    Off,
}

/// What M0, M1, M2 or M30 ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stop {
    Pause,
    OptionalPause,
    End,
}

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
    pub(crate) spindle: Option<(Spindle, Word)>,
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
        let group = ReadFault::SameGroup;
        match codes.meaning(word) {
            Some(Meaning::Units(units)) => return once(&mut self.units, units, group),
            Some(Meaning::Feed(mode)) => return once(&mut self.feed_mode, (mode, word), group),
            Some(Meaning::Length(on)) => return once(&mut self.length, (on, word), group),
            Some(Meaning::Wcs) => return once(&mut self.wcs, word, group),
            Some(Meaning::Probe(must)) => return once(&mut self.probe, (must, word), group),
            Some(Meaning::Stop(optional)) => {
                let stop = if optional { Stop::OptionalPause } else { Stop::Pause };
                return once(&mut self.stop, (stop, word), group);
            }
            Some(Meaning::Home) => return once(&mut self.home, word, group),
            Some(Meaning::Passed) => return once(&mut self.passed, word, group),
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
            b'G' => return self.take_g(word),
            b'M' => return self.take_m(word),
            b'S' => &mut self.speed,
            b'T' => &mut self.tool,
            b'H' => &mut self.h,
            b'D' => &mut self.d,
            super::lexer::TURN => &mut self.turns,
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

    fn take_g(&mut self, word: Word) -> Result<(), ReadFault> {
        let group = ReadFault::SameGroup;
        match word.number.tenths().ok_or(ReadFault::UnknownCode)? {
            0 => once(&mut self.motion, (Motion::Rapid, word), group),
            10 => once(&mut self.motion, (Motion::Feed, word), group),
            800 => once(&mut self.motion, (Motion::Cancel, word), group),
            20 => once(&mut self.motion, (Motion::Arc(true), word), group),
            30 => once(&mut self.motion, (Motion::Arc(false), word), group),
            40 => once(&mut self.dwell, word, group),
            170 => once(&mut self.plane, (Plane::Xy, word), group),
            180 => once(&mut self.plane, (Plane::Zx, word), group),
            190 => once(&mut self.plane, (Plane::Yz, word), group),
            400 => once(&mut self.compensation, word, group),
            410 | 411 | 420 | 421 => Err(ReadFault::NotRead { what: "radius compensations" }),
            430 => once(&mut self.length, (true, word), group),
            490 => once(&mut self.length, (false, word), group),
            431 | 432 => Err(ReadFault::NotRead { what: "length offsets other than G43 H" }),
            530 => once(&mut self.machine_coordinates, word, group),
            540 | 550 | 560 | 570 | 580 | 590..=593 => Err(ReadFault::Wcs),
            980 => once(&mut self.low_return, false, group),
            990 => once(&mut self.low_return, true, group),
            610 | 611 | 640 => once(&mut self.smoothing, word, group),
            900 => once(&mut self.incremental, false, group),
            910 => once(&mut self.incremental, true, group),
            901 => once(&mut self.absolute_centre, true, group),
            911 => once(&mut self.absolute_centre, false, group),
            930 | 940 | 950 => Err(ReadFault::NotRead { what: "feeds other than those of the machine's file" }),
            380..=389 => Err(ReadFault::NotRead { what: "probing moves other than those of the machine's file" }),
            code @ (730 | 740 | 810 | 820 | 830 | 840 | 850 | 860 | 890) => {
                let number = u16::try_from(code / 10).unwrap_or_default();
                once(&mut self.motion, (Motion::Cycle(number), word), group)
            }
            760 | 870 | 880 => Err(ReadFault::NotRead { what: "cycles of this kind" }),
            280 | 300 => Err(ReadFault::NotRead { what: "returns to stored points" }),
            100 | 520 | 920..=923 => Err(ReadFault::NotRead { what: "shifts of the zero point" }),
            _ => Err(ReadFault::UnknownCode),
        }
    }

    fn take_m(&mut self, word: Word) -> Result<(), ReadFault> {
        let group = ReadFault::SameGroup;
        match word.number.natural().ok_or(ReadFault::UnknownCode)? {
            0 => once(&mut self.stop, (Stop::Pause, word), group),
            1 => once(&mut self.stop, (Stop::OptionalPause, word), group),
            2 | 30 => once(&mut self.stop, (Stop::End, word), group),
            3 => once(&mut self.spindle, (Spindle::Clockwise, word), group),
            4 => once(&mut self.spindle, (Spindle::Counterclockwise, word), group),
            5 => once(&mut self.spindle, (Spindle::Off, word), group),
            6 => once(&mut self.change, word, group),
            7 if self.coolant_off.is_none() => once(&mut self.mist, word, group),
            8 if self.coolant_off.is_none() => once(&mut self.flood, word, group),
            9 if self.mist.is_none() && self.flood.is_none() => once(&mut self.coolant_off, word, group),
            7..=9 => Err(group),
            98 | 99 => Err(ReadFault::NotRead { what: "subroutines" }),
            _ => Err(ReadFault::UnknownCode),
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
