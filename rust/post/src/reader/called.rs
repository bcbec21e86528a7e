//! Cycles that are defined once and called at positions: Sinumerik's MCALL, Heidenhain's CYCL DEF.

use styluscam_motion::CycleKind;

use crate::block::{cut_number, Number};
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
    InForce,
    /// As the words of a block would state it.
    Feed(Number),
    /// mm in a revolution, and the speed where the cycle states it, rev/min.
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

    /// So many of them, from an index on, counted from 0.
    fn from<const N: usize>(&self, first: usize) -> [Option<f64>; N] {
        std::array::from_fn(|index| self.0.get(first + index).copied().flatten())
    }

    /// Whether those from an index on state nothing.
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
        let [return_plane, reference_plane, clearance, absolute_depth, depth] =
            arguments.from(0).map(|v| v.map(|v| v * unit));
        let reference = reference_plane.ok_or(MISSING)?;
        let height = |absolute: Option<f64>, below: Option<f64>| match (absolute, below) {
            (Some(height), None) => Ok(height),
            (None, Some(deep)) => Ok(reference - deep.abs()),
            (None, None) => Err(MISSING),
            _ => Err(OTHER),
        };
        let base = Self {
            kind: CycleKind::Drill,
            retract: reference + clearance.unwrap_or(0.0).abs(),
            bottom: height(absolute_depth, depth)?,
            leave: return_plane.ok_or(MISSING)?,
            peck: 0.0,
            dwell: 0.0,
            pace: Pace::InForce,
            modal: true,
        };
        let none = |value: Option<f64>| value.is_none_or(|value| value == 0.0);
        match cycle {
            81 if arguments.end_at(5) => Ok(base),
            82 if arguments.end_at(6) => {
                let [dwell] = arguments.from(5);
                Ok(Self { dwell: dwell.unwrap_or(0.0), ..base })
            }
            83 if arguments.end_at(12) => {
                let [first, first_below, degression, dwell, start_dwell, feed_factor, variant] = arguments.from(5);
                let plain = [degression, dwell, start_dwell].into_iter().all(none);
                if !plain || !matches!(feed_factor, None | Some(1.0)) {
                    return Err(OTHER);
                }
                let kind = match variant.unwrap_or(0.0) {
                    0.0 => CycleKind::ChipBreak,
                    1.0 => CycleKind::Peck,
                    _ => return Err(OTHER),
                };
                // pecks are counted from the reference plane
                let first = height(first.map(|v| v * unit), first_below.map(|v| v * unit))?;
                Ok(Self { kind, peck: reference - first, ..base })
            }
            84 if arguments.end_at(12) => {
                let [dwell, turns_after, size, pitch, position, speed, speed_back] = arguments.from(5);
                let pitch = pitch.map(|pitch| pitch * unit).filter(|pitch| *pitch != 0.0).ok_or(MISSING)?;
                let (kind, turns) = if pitch > 0.0 { (CycleKind::Tap, 3.0) } else { (CycleKind::LeftTap, 4.0) };
                let plain = none(dwell) && size.is_none() && none(position) && turns_after == Some(turns);
                if !plain || speed != speed_back {
                    return Err(OTHER);
                }
                Ok(Self { kind, pace: Pace::Pitch(pitch.abs(), speed), ..base })
            }
            _ => Err(OTHER),
        }
    }

    /// Cycles 200, 203 and 207 (TNC 320 user's manual 7/2008 p. 238, Autodesk Heidenhain post); `unit` is that of the program, mm.
    pub fn heidenhain(cycle: u32, parameters: &Parameters, unit: f64) -> Result<Self, ReadFault> {
        let stated = |q: u32| parameters.value(q).unwrap_or(0.0);
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
            dwell: stated(211),
            pace: Pace::InForce,
            modal: false,
        };
        let known: &[u32] = match cycle {
            200 => &[200, 201, 202, 203, 204, 206, 211],
            203 => &[200, 201, 202, 203, 204, 206, 208, 211, 213, 256],
            _ => &[200, 201, 203, 204, 239],
        };
        if !parameters.others_are_idle(known) {
            return Err(OTHER);
        }
        match cycle {
            200 => {
                let peck = length(202)?;
                let whole = peck >= -depth;
                let kind = if whole { CycleKind::Drill } else { CycleKind::Peck };
                Ok(Self { kind, peck: if whole { 0.0 } else { peck }, pace: pace(parameters.feed(206))?, ..base })
            }
            203 if stated(213) > 0.0 && parameters.is_max(208) => {
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

    fn others_are_idle(&self, known: &[u32]) -> bool {
        let idle = |number: &Option<Number>| number.is_some_and(|number| number.value() == 0.0);
        self.0.iter().all(|(q, number)| known.contains(q) || idle(number))
    }
}
