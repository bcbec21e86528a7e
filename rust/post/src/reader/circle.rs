//! The arc that a block's I, J, K or R describe.

use styluscam_motion::Arc;

use super::block::Block;
use super::lexer::{Flaw, Word};
use crate::block::arc::{centre_by_offsets, ArcFault, Ends, Least, Slack, MOST_TURNS};
use crate::machine::ArcRules;
use crate::read_error::ReadFault;

/// An arc of a smaller angle, rad, may be none or a full circle: GRBL makes a full circle of 5e-7 and less.
const LEAST_ANGLE: f64 = 1e-6;
/// R was rounded: half the chord may exceed it by so much.
const SLACK: Slack = Slack { absolute: 0.0025, relative: 0.0 };

/// Where an arc starts and ends and how its words are to be taken.
pub(crate) struct Circle {
    pub ends: Ends,
    /// Whether I, J and K are positions, not steps from the start.
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
        let [_, _, across] = self.ends.plane.axes();
        if let Some(word) = block.offsets().get(across).copied().flatten() {
            return Err((ReadFault::ArcPlane, Some(word)));
        }
        let centre = match block.words.get(b'R') {
            Some(word) if block.offsets().iter().any(Option::is_some) => return Err((ReadFault::ArcForm, Some(word))),
            Some(word) => {
                let centre = self.ends.centre_by_radius(mm(word)?, SLACK);
                centre.map_err(|fault| (read_fault(fault), Some(word)))?
            }
            None => self.centre_by_offsets(block, code, mm)?,
        };
        let arc = self.ends.about(centre, turns(block)?);
        let least = Least { radius: rules.min_radius, angle: LEAST_ANGLE };
        let path = self.ends.path(&arc, least).map_err(|fault| (read_fault(fault), Some(code)))?;
        let mismatch = path.mismatch();
        if !rules.radius_error.takes(mismatch, path.radius()) {
            return Err((ReadFault::ArcEnds { mismatch }, Some(code)));
        }
        Ok(arc)
    }

    fn centre_by_offsets(
        &self,
        block: &Block,
        code: Word,
        mm: impl Fn(Word) -> Result<f64, Flaw>,
    ) -> Result<[f64; 3], Flaw> {
        if block.offsets().iter().all(Option::is_none) {
            return Err((ReadFault::MissingWord { what: "the arc's centre (I, J, K) or R" }, Some(code)));
        }
        let [first, second, _] = self.ends.plane.axes();
        if self.absolute && [first, second].iter().any(|axis| block.offsets()[*axis].is_none()) {
            return Err((ReadFault::MissingWord { what: "one of the centre's two coordinates (G90.1)" }, Some(code)));
        }
        let mut offsets = [None; 3];
        for (offset, word) in offsets.iter_mut().zip(block.offsets()) {
            *offset = word.map(&mm).transpose()?;
        }
        let start = self.ends.start;
        let zero = if self.absolute { [0.0, 0.0, -self.height] } else { start };
        Ok(centre_by_offsets(zero, start, offsets))
    }
}

fn read_fault(fault: ArcFault) -> ReadFault {
    match fault {
        ArcFault::FullByRadius => ReadFault::ArcForm,
        ArcFault::ShortRadius => ReadFault::ArcOfShortRadius,
        ArcFault::NoRadius => ReadFault::ArcOfNoRadius,
        ArcFault::NoAngle => ReadFault::ArcOfNoAngle,
    }
}

/// Full turns beyond the first arrival: P counts arrivals.
fn turns(block: &Block) -> Result<u32, Flaw> {
    if let Some(word) = block.polar {
        let turns = (word.number.value().abs() / 360.0).ceil() - 1.0;
        return if turns < f64::from(MOST_TURNS) {
            Ok(turns.max(0.0) as u32)
        } else {
            Err((ReadFault::ArcTurns { most: MOST_TURNS }, Some(word)))
        };
    }
    if let Some(word) = block.turns {
        let turns = word.number.natural().ok_or((ReadFault::NotNatural, Some(word)))?;
        return if turns < MOST_TURNS {
            Ok(turns)
        } else {
            Err((ReadFault::ArcTurns { most: MOST_TURNS }, Some(word)))
        };
    }
    let Some(word) = block.words.get(b'P') else { return Ok(0) };
    let arrivals = word.number.natural().filter(|p| *p > 0).ok_or((ReadFault::NotNatural, Some(word)))?;
    if arrivals > MOST_TURNS {
        return Err((ReadFault::ArcTurns { most: MOST_TURNS }, Some(word)));
    }
    Ok(arrivals - 1)
}
