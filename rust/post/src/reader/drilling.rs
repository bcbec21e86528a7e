//! A series of canned cycles: the words that hold from hole to hole.

use styluscam_motion::{Cycle, CycleKind};

use crate::read_error::ReadFault;

/// What was stated since the cycle's code.
#[derive(Clone, Copy, Debug)]
pub(super) struct Series {
    /// G81 to G89, G73, G74.
    pub number: u16,
    /// Z before the first hole, the tip's, mm.
    initial: f64,
    /// Z of the bottom, of the tip, mm.
    pub bottom: Option<f64>,
    /// Z of the retract plane, of the tip, mm.
    pub retract: Option<f64>,
    /// Depth of a peck, mm.
    pub peck: f64,
    /// Wait at the bottom, s.
    pub dwell: f64,
}

impl Series {
    /// The one before, or a new one: it begins at a height, or where the cycles before it began.
    pub fn next(before: Option<Self>, number: u16, height: f64) -> Self {
        let initial = before.map_or(height, |series| series.initial);
        let new = Self { number, initial, bottom: None, retract: None, peck: 0.0, dwell: 0.0 };
        before.filter(|series| series.number == number).unwrap_or(new)
    }

    /// The hole at a position; `low` is set when it ends at the retract plane.
    pub fn hole(&self, at: [f64; 2], feed: f64, low: bool) -> Result<Cycle, ReadFault> {
        let missing = |what| ReadFault::MissingWord { what };
        let bottom = self.bottom.ok_or(missing("the depth (Z) of the cycle"))?;
        let retract = self.retract.ok_or(missing("the retract plane (R) of the cycle"))?;
        let (kind, dwells) = kind(self.number);
        let pecks = matches!(kind, CycleKind::Peck | CycleKind::ChipBreak);
        if pecks && self.peck <= 0.0 {
            return Err(missing("the peck (Q) of the cycle"));
        }
        if self.peck != 0.0 && !pecks || self.dwell != 0.0 && !dwells {
            return Err(ReadFault::NotRead { what: "a peck or a wait in a cycle of this code" });
        }
        if bottom > retract {
            return Err(ReadFault::CycleUpwards);
        }
        if self.dwell < 0.0 {
            return Err(ReadFault::Negative);
        }
        Ok(Cycle {
            first: 0,
            count: 0,
            kind,
            at,
            retract,
            bottom,
            leave: if low { retract } else { retract.max(self.initial) },
            feed,
            dwell: self.dwell,
            peck: self.peck,
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
