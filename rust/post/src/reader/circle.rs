//! The arc that a block's I, J, K or R describe.

use styluscam_motion::{Arc, Plane};

use super::block::Block;
use super::interpreter::Flaw;
use super::lexer::Word;
use crate::machine::ArcRules;
use crate::read_error::ReadFault;

/// Turns of one arc at most.
const TURNS: u32 = 1000;
/// An arc of a smaller angle, rad, may be none or a full circle: GRBL makes a full circle of 5e-7 and less.
const LEAST: f64 = 1e-6;
/// Radii are compared with this slack, mm.
const ROUNDED: f64 = 1e-9;
/// A chord may be this much longer than the circle's diameter, mm: R was rounded.
const CHORD: f64 = 0.005;

/// Where an arc starts and ends and how its words are to be taken.
pub(crate) struct Circle {
    pub start: [f64; 3],
    pub end: [f64; 3],
    pub plane: Plane,
    pub clockwise: bool,
    /// Whether I, J and K are places, not steps from the start.
    pub absolute: bool,
    /// Height of the posted point above the tip, mm.
    pub height: f64,
}

impl Circle {
    /// The arc of a block; `code` is the word to blame, `mm` gives a word's length.
    pub fn arc(
        &self,
        block: &Block,
        rules: &ArcRules,
        code: Word,
        mm: impl Fn(Word) -> Result<f64, Flaw>,
    ) -> Result<Arc, Flaw> {
        let [_, _, across] = self.plane.axes();
        if let Some(word) = block.offsets.get(across).copied().flatten() {
            return Err((ReadFault::ArcPlane, Some(word)));
        }
        let centre = match block.radius {
            Some(word) if block.offsets.iter().any(Option::is_some) => return Err((ReadFault::ArcForm, Some(word))),
            Some(word) => self.centre_by_radius(word, mm(word)?)?,
            None => self.centre_by_offsets(block, code, mm)?,
        };
        let arc = Arc { centre, plane: self.plane, clockwise: self.clockwise, turns: turns(block)? };
        let way = arc.way(self.start, self.end);
        let radius = way.radius();
        if radius <= 0.0 || radius < rules.min_radius - ROUNDED {
            return Err((ReadFault::ArcOfNoRadius, Some(code)));
        }
        if way.sweep().abs() < LEAST {
            return Err((ReadFault::ArcOfNoAngle, Some(code)));
        }
        if !rules.radius_error.takes(way.mismatch(), radius) {
            return Err((ReadFault::ArcEnds { mismatch: way.mismatch() }, Some(code)));
        }
        Ok(arc)
    }

    fn centre_by_offsets(
        &self,
        block: &Block,
        code: Word,
        mm: impl Fn(Word) -> Result<f64, Flaw>,
    ) -> Result<[f64; 3], Flaw> {
        if block.offsets.iter().all(Option::is_none) {
            return Err((ReadFault::MissingWord { what: "the arc's centre (I, J, K) or R" }, Some(code)));
        }
        let mut centre = self.start;
        for (axis, word) in block.offsets.iter().enumerate() {
            match word {
                Some(word) if self.absolute => {
                    centre[axis] = mm(*word)? - if axis == 2 { self.height } else { 0.0 };
                }
                Some(word) => centre[axis] += mm(*word)?,
                None if self.absolute && axis != self.plane.axes()[2] => {
                    return Err((
                        ReadFault::MissingWord { what: "one of the centre's two places (G90.1)" },
                        Some(code),
                    ));
                }
                None => {}
            }
        }
        Ok(centre)
    }

    /// R above zero is the shorter arc of the two, below zero the longer one.
    fn centre_by_radius(&self, word: Word, radius: f64) -> Result<[f64; 3], Flaw> {
        let [first, second, _] = self.plane.axes();
        let chord = [self.end[first] - self.start[first], self.end[second] - self.start[second]];
        let length = libm::hypot(chord[0], chord[1]);
        if length <= 0.0 {
            return Err((ReadFault::ArcForm, Some(word)));
        }
        if length > 2.0 * radius.abs() + CHORD {
            return Err((ReadFault::ArcOfShortRadius, Some(word)));
        }
        let over = (radius * radius - 0.25 * length * length).max(0.0).sqrt();
        let left = if self.clockwise == (radius < 0.0) { over } else { -over };
        let mut centre = self.start;
        centre[first] += 0.5 * chord[0] - left * chord[1] / length;
        centre[second] += 0.5 * chord[1] + left * chord[0] / length;
        Ok(centre)
    }
}

/// Full turns beyond the first arrival: P counts arrivals.
fn turns(block: &Block) -> Result<u32, Flaw> {
    if let Some(word) = block.polar {
        let turns = (word.number.value().abs() / 360.0).ceil() - 1.0;
        return if turns < f64::from(TURNS) {
            Ok(turns.max(0.0) as u32)
        } else {
            Err((ReadFault::ArcTurns { most: TURNS }, Some(word)))
        };
    }
    if let Some(word) = block.turns {
        let turns = word.number.natural().ok_or((ReadFault::NotNatural, Some(word)))?;
        return if turns < TURNS { Ok(turns) } else { Err((ReadFault::ArcTurns { most: TURNS }, Some(word))) };
    }
    let Some(word) = block.p else { return Ok(0) };
    let arrivals = word.number.natural().filter(|p| *p > 0).ok_or((ReadFault::NotNatural, Some(word)))?;
    if arrivals > TURNS {
        return Err((ReadFault::ArcTurns { most: TURNS }, Some(word)));
    }
    Ok(arrivals - 1)
}
