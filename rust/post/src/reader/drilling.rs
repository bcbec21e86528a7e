//! A series of canned cycles: the words that hold from hole to hole.

use styluscam_motion::{Cycle, CycleKind};

use crate::block::{end_height, CycleWords};
use crate::read_error::ReadFault;

/// What was stated since the cycle's code.
#[derive(Clone, Copy, Debug)]
pub(super) struct Series {
    /// G81 to G89, G73, G74.
    pub number: u16,
    /// Heights are those of the tip; mm.
    pub words: CycleWords,
}

impl Series {
    /// The one before, or a new one: it begins at a height, or where the cycles before it began.
    pub fn next(before: Option<Self>, number: u16, height: f64) -> Self {
        let initial = before.and_then(|series| series.words.initial).or(Some(height));
        let new = Self { number, words: CycleWords { initial, ..CycleWords::default() } };
        before.filter(|series| series.number == number).unwrap_or(new)
    }

    /// The hole at a position; `low` is set when it ends at the retract plane.
    pub fn hole(&self, at: [f64; 2], feed: f64, low: bool) -> Result<Cycle, ReadFault> {
        let missing = |what| ReadFault::MissingWord { what };
        let bottom = self.words.bottom.ok_or(missing("the depth (Z) of the cycle"))?;
        let retract = self.words.retract.ok_or(missing("the retract plane (R) of the cycle"))?;
        let [peck, dwell] = [self.words.peck, self.words.dwell].map(Option::unwrap_or_default);
        let (kind, dwells) = kind(self.number);
        let pecks = matches!(kind, CycleKind::Peck | CycleKind::ChipBreak);
        if pecks && peck <= 0.0 {
            return Err(missing("the peck (Q) of the cycle"));
        }
        if peck != 0.0 && !pecks || dwell != 0.0 && !dwells {
            return Err(ReadFault::NotRead { what: "a peck or a wait in a cycle of this code" });
        }
        if bottom > retract {
            return Err(ReadFault::CycleUpwards);
        }
        if dwell < 0.0 {
            return Err(ReadFault::Negative);
        }
        Ok(Cycle {
            first: 0,
            count: 0,
            kind,
            at,
            retract,
            bottom,
            leave: end_height(low, retract, self.words.initial.unwrap_or(retract)),
            feed,
            dwell,
            peck,
        })
    }
}

/// What a code makes, and whether it waits at the bottom.
fn kind(number: u16) -> (CycleKind, bool) {
    match number {
        73 => (CycleKind::ChipBreak, false),
        74 => (CycleKind::LeftTap, false),
        82 => (CycleKind::Drill, true),
        83 => (CycleKind::Peck, false),
        84 => (CycleKind::Tap, false),
        85 => (CycleKind::Bore, false),
        86 => (CycleKind::StopBore, true),
        89 => (CycleKind::Bore, true),
        _ => (CycleKind::Drill, false),
    }
}
