//! One block of G-code: its words sorted into what they ask for, each modal group at most once.

use styluscam_motion::Plane;

use crate::lexer::Word;
use crate::machine::LengthUnit;
use crate::read_error::ReadFault;

/// What G0, G1, G2, G3 or G80 ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Motion {
    Rapid,
    Feed,
    /// Clockwise or not.
    Arc(bool),
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
    pub(crate) x_of_dwell: Option<Word>,
    pub(crate) motion: Option<(Motion, Word)>,
    pub(crate) units: Option<LengthUnit>,
    /// Whether G91, not G90.
    pub(crate) incremental: Option<bool>,
    /// Whether G43, not G49.
    pub(crate) length: Option<(bool, Word)>,
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
    line_number: Option<Word>,
    feed_mode: Option<Word>,
    compensation: Option<Word>,
}

impl Block {
    /// Sorts one word in.
    pub(crate) fn take(&mut self, word: Word) -> Result<(), ReadFault> {
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
            b'P' => &mut self.p,
            b'Q' => &mut self.q,
            b'N' => &mut self.line_number,
            b'I' => i,
            b'J' => j,
            b'K' => k,
            b'R' => &mut self.radius,
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
            200 => once(&mut self.units, LengthUnit::Inch, group),
            210 => once(&mut self.units, LengthUnit::Mm, group),
            400 => once(&mut self.compensation, word, group),
            410 | 411 | 420 | 421 => Err(ReadFault::NotRead { what: "radius compensations" }),
            430 => once(&mut self.length, (true, word), group),
            490 => once(&mut self.length, (false, word), group),
            431 | 432 => Err(ReadFault::NotRead { what: "length offsets other than G43 H" }),
            530 => once(&mut self.machine_coordinates, word, group),
            540 | 550 | 560 | 570 | 580 | 590..=593 => once(&mut self.wcs, word, group),
            610 | 611 | 640 => once(&mut self.smoothing, word, group),
            900 => once(&mut self.incremental, false, group),
            910 => once(&mut self.incremental, true, group),
            901 => once(&mut self.absolute_centre, true, group),
            911 => once(&mut self.absolute_centre, false, group),
            940 => once(&mut self.feed_mode, word, group),
            930 | 950 => Err(ReadFault::NotRead { what: "feeds other than G94" }),
            380..=389 => Err(ReadFault::NotRead { what: "probing moves" }),
            730 | 740 | 760 | 810 | 820 | 830 | 840 | 850 | 860 | 870 | 880 | 890 => {
                Err(ReadFault::NotRead { what: "canned cycles" })
            }
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

    /// The first axis word, if any.
    pub(crate) fn any_axis(&self) -> Option<Word> {
        self.axes.iter().flatten().next().copied()
    }

    /// The words that shape an arc, as far as they are there.
    pub(crate) fn arc_words(&self) -> impl Iterator<Item = Word> + '_ {
        self.offsets.iter().chain([&self.radius]).flatten().copied()
    }

    /// Checks that P, Q, H and an arc's words belong to a code; gives X of `G4 X` to the dwell on machines that write it so.
    ///
    /// `turns` says whether an arc is in force that takes P.
    pub(crate) fn settle(&mut self, dwell_word: char, arc: bool, turns: bool) -> Result<(), (ReadFault, Word)> {
        if self.dwell.is_some() && dwell_word == 'X' {
            let [x, ..] = &mut self.axes;
            self.x_of_dwell = x.take();
        }
        let p_of_dwell = self.dwell.is_some() && dwell_word == 'P';
        let owners = [p_of_dwell, self.smoothing.is_some(), turns && self.dwell.is_none() && self.moves(arc)];
        let p_owners = owners.into_iter().filter(|o| *o).count();
        let q_owned = self.smoothing.is_some();
        let h_owned = matches!(self.length, Some((true, _)));
        for (word, owned) in [(self.p, p_owners == 1), (self.q, q_owned), (self.h, h_owned)] {
            match word {
                Some(word) if !owned => return Err((ReadFault::StrayWord, word)),
                _ => {}
            }
        }
        match self.arc_words().next().filter(|_| !arc) {
            Some(word) => Err((ReadFault::StrayWord, word)),
            None => Ok(()),
        }
    }

    /// Whether it holds what makes a move, with an arc in force or without.
    fn moves(&self, arc: bool) -> bool {
        self.any_axis().is_some() || arc && self.arc_words().next().is_some()
    }
}

fn once<T>(slot: &mut Option<T>, value: T, fault: ReadFault) -> Result<(), ReadFault> {
    if slot.is_some() {
        return Err(fault);
    }
    *slot = Some(value);
    Ok(())
}
