//! Cycles that are defined once and called at places: Sinumerik's MCALL, Heidenhain's CYCL DEF.

use styluscam_motion::CycleKind;

use super::lexer::{cut_number, Number};
use crate::read_error::ReadFault;

/// A cycle that was defined. Heights are those of the point that the text moves, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Called {
    pub kind: CycleKind,
    pub retract: f64,
    pub bottom: f64,
    pub leave: f64,
    pub peck: f64,
    /// s.
    pub dwell: f64,
    pub pace: Pace,
    /// Whether every move calls it.
    pub modal: bool,
}

/// How fast a cycle goes down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Pace {
    /// By the feed in force.
    Standing,
    /// As the words of a block would say it.
    Feed(Number),
    /// mm in a revolution, and the speed where the cycle says it, rev/min.
    Pitch(f64, Option<f64>),
}

const MISSING: ReadFault = ReadFault::MissingWord { what: "a height, a depth or a pitch of the cycle" };
const OTHER: ReadFault = ReadFault::NotRead { what: "cycles with these parameters" };

/// What stands between the brackets of a call: `CYCLE81(10,2,0,-6)`; an argument may be left out, its comma not.
pub(super) struct Arguments(Vec<Option<f64>>);

impl Arguments {
    pub fn cut(text: &str) -> Result<Self, ReadFault> {
        let value = |argument: &str| match argument.trim() {
            "" => Ok(None),
            argument => number(argument).map(|number| Some(number.value())),
        };
        text.split(',').map(value).collect::<Result<_, _>>().map(Self)
    }

    /// One of them, counted from 0.
    fn get(&self, index: usize) -> Option<f64> {
        self.0.get(index).copied().flatten()
    }

    /// Whether those from an index on say nothing.
    fn end_at(&self, index: usize) -> bool {
        self.0.iter().skip(index).flatten().all(|value| *value == 0.0)
    }
}

/// A number and nothing else.
pub(super) fn number(text: &str) -> Result<Number, ReadFault> {
    let (number, end) = cut_number(text.as_bytes(), 0).map_err(|misfit| misfit.fault)?;
    if end == text.len() {
        Ok(number)
    } else {
        Err(ReadFault::NumberExpected)
    }
}

impl Called {
    /// CYCLE81 to 84 (programming guide Cycles 11.02, Autodesk siemens-840d.cps); `unit` is that of the program, mm.
    #[allow(clippy::float_cmp)] // numbers as written
    pub fn sinumerik(cycle: u32, arguments: &Arguments, unit: f64) -> Result<Self, ReadFault> {
        let length = |index: usize| arguments.get(index).map(|value| value * unit);
        let said = |index: usize| arguments.get(index).unwrap_or(0.0);
        let retract = length(1).ok_or(MISSING)? + length(2).unwrap_or(0.0).abs();
        let depth = |absolute: usize, relative: usize| match (length(absolute), length(relative)) {
            (Some(height), None) => Ok(height),
            (None, Some(deep)) => length(1).map(|reference| reference - deep.abs()).ok_or(MISSING),
            (None, None) => Err(MISSING),
            _ => Err(OTHER),
        };
        let bottom = depth(3, 4)?;
        let base = Self {
            kind: CycleKind::Drill,
            retract,
            bottom,
            leave: length(0).ok_or(MISSING)?,
            peck: 0.0,
            dwell: 0.0,
            pace: Pace::Standing,
            modal: true,
        };
        match cycle {
            81 if arguments.end_at(5) => Ok(base),
            82 if arguments.end_at(6) => Ok(Self { dwell: said(5), ..base }),
            83 => {
                let plain = said(7) == 0.0 && said(9) == 0.0 && matches!(arguments.get(10), None | Some(1.0));
                let kind = match said(11) {
                    0.0 => CycleKind::ChipBreak,
                    1.0 => CycleKind::Peck,
                    _ => return Err(OTHER),
                };
                if !plain || said(8) != 0.0 || !arguments.end_at(12) {
                    return Err(OTHER);
                }
                // pecks are counted from the reference plane
                Ok(Self { kind, peck: length(1).ok_or(MISSING)? - depth(5, 6)?, ..base })
            }
            84 => {
                let pitch = length(8).filter(|pitch| *pitch != 0.0).ok_or(MISSING)?;
                let (kind, turns) = if pitch > 0.0 { (CycleKind::Tap, 3.0) } else { (CycleKind::LeftTap, 4.0) };
                let plain = said(5) == 0.0 && said(6) == turns && arguments.get(7).is_none() && said(9) == 0.0;
                if !plain || said(10) != said(11) || !arguments.end_at(12) {
                    return Err(OTHER);
                }
                Ok(Self { kind, pace: Pace::Pitch(pitch.abs(), arguments.get(10)), ..base })
            }
            _ => Err(OTHER),
        }
    }

    /// Cycles 200, 203 and 207 (TNC 320 user's manual 7/2008 p. 238, Autodesk Heidenhain post); `unit` is that of the program, mm.
    pub fn heidenhain(cycle: u32, parameters: &Parameters, unit: f64) -> Result<Self, ReadFault> {
        let said = |q: u32| parameters.value(q).unwrap_or(0.0);
        let length = |q: u32| parameters.value(q).map(|value| value * unit).ok_or(MISSING);
        let (surface, clearance, depth) = (length(203)?, length(200)?, length(201)?);
        if depth >= 0.0 || clearance < 0.0 {
            return Err(ReadFault::CycleUpwards);
        }
        let retract = surface + clearance;
        let pace = |feed: Option<Number>| feed.map(Pace::Feed).ok_or(MISSING);
        let base = Self {
            kind: CycleKind::Drill,
            retract,
            bottom: surface + depth,
            leave: retract.max(surface + length(204)?),
            peck: 0.0,
            dwell: said(211),
            pace: Pace::Standing,
            modal: false,
        };
        let known: &[u32] = match cycle {
            200 => &[200, 201, 202, 203, 204, 206, 211],
            203 => &[200, 201, 202, 203, 204, 206, 208, 211, 213, 256],
            _ => &[200, 201, 203, 204, 239],
        };
        if !parameters.others_say_nothing(known) {
            return Err(OTHER);
        }
        match cycle {
            200 => {
                let peck = length(202)?;
                let whole = peck >= -depth;
                let kind = if whole { CycleKind::Drill } else { CycleKind::Peck };
                Ok(Self { kind, peck: if whole { 0.0 } else { peck }, pace: pace(parameters.feed(206))?, ..base })
            }
            203 if said(213) > 0.0 && parameters.is_max(208) => {
                Ok(Self { kind: CycleKind::ChipBreak, peck: length(202)?, pace: pace(parameters.feed(206))?, ..base })
            }
            207 => {
                let pitch = length(239)?;
                let kind = if pitch < 0.0 { CycleKind::LeftTap } else { CycleKind::Tap };
                Ok(Self { kind, pace: Pace::Pitch(pitch.abs(), None), ..base })
            }
            _ => Err(OTHER),
        }
    }
}

/// The Q parameters of a cycle.
#[derive(Debug, Default)]
pub(super) struct Parameters(Vec<(u32, Option<Number>)>);

impl Parameters {
    /// One more; no number is `MAX`.
    pub fn push(&mut self, q: u32, value: Option<Number>) -> Result<(), ReadFault> {
        if self.0.iter().any(|(known, _)| *known == q) {
            return Err(ReadFault::WordTwice);
        }
        self.0.push((q, value));
        Ok(())
    }

    pub fn value(&self, q: u32) -> Option<f64> {
        self.feed(q).map(Number::value)
    }

    /// The value of one that holds it alone.
    pub fn natural(&self, q: u32) -> Option<u32> {
        match self.0.as_slice() {
            [(only, Some(number))] if *only == q => number.natural(),
            _ => None,
        }
    }

    fn feed(&self, q: u32) -> Option<Number> {
        self.0.iter().find(|(known, _)| *known == q).and_then(|(_, number)| *number)
    }

    fn is_max(&self, q: u32) -> bool {
        self.0.iter().any(|(known, number)| *known == q && number.is_none())
    }

    fn others_say_nothing(&self, known: &[u32]) -> bool {
        let idle = |number: &Option<Number>| number.is_some_and(|number| number.value() == 0.0);
        self.0.iter().all(|(q, number)| known.contains(q) || idle(number))
    }
}
