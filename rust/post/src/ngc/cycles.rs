//! Drilling cycles: G73, G74, G81 to G89.

use super::block::Block;
use super::fault::TraceFault;
use super::tracer::Tracer;
use crate::block::{end_height, CycleWords};

/// mm: how far a peck goes back to break the chip, and how far above the last depth the next one begins.
const BACK: f64 = 0.254;

/// The heights of a cycle along the drilling axis, mm.
#[derive(Clone, Copy)]
struct Heights {
    begin: f64,
    retract: f64,
    bottom: f64,
    /// Where it ends.
    clear: f64,
}

impl Tracer<'_> {
    pub(super) fn drill(&mut self, block: &Block, code: u32) -> Result<(), TraceFault> {
        let along = self.modes.common.plane.axes()[2];
        let heights = self.heights(block, along)?;
        if heights.begin < heights.retract {
            self.rapid_along(along, heights.retract)?;
        }
        for _ in 0..block.count(b'l', "L of a cycle")?.unwrap_or(1) {
            let mut over = self.target(block, false)?;
            over[along] = self.position[along].max(heights.retract);
            self.rapid(over)?;
            self.rapid_along(along, heights.retract)?;
            self.begin()?;
            self.hole(code, along, heights)?;
        }
        Ok(())
    }

    fn heights(&mut self, block: &Block, along: usize) -> Result<Heights, TraceFault> {
        let begin = *self.cycle.initial.get_or_insert(self.position[along]);
        // as written: a change of the unit changes the words in force
        let unit = self.modes.unit();
        self.cycle.take(CycleWords {
            initial: None,
            bottom: self.lengths(block)[along].map(|length| length / unit),
            retract: block.word(b'r'),
            peck: block.word(b'q'),
            dwell: block.word(b'p'),
        });
        let retract = unit * self.cycle.retract.ok_or(TraceFault::WordMissing { what: "R of a cycle" })?;
        let bottom = unit * self.cycle.bottom.ok_or(TraceFault::WordMissing { what: "the depth of a cycle" })?;
        let (retract, bottom) =
            if self.modes.common.incremental { (begin + retract, begin + retract + bottom) } else { (retract, bottom) };
        if bottom > retract {
            return Err(TraceFault::CycleDepths);
        }
        let clear = end_height(self.modes.common.low_return, retract, begin);
        Ok(Heights { begin, retract, bottom, clear })
    }

    fn hole(&mut self, code: u32, along: usize, heights: Heights) -> Result<(), TraceFault> {
        match code {
            730 | 830 => self.pecks(along, heights, code == 830)?,
            _ => self.feed_along(along, heights.bottom)?,
        }
        if matches!(code, 740 | 820 | 840 | 860 | 880 | 890) {
            if let Some(seconds) = self.cycle.dwell {
                self.wait(seconds)?;
            }
        }
        match code {
            850 => self.feed_along(along, heights.retract)?,
            740 | 840 | 890 => self.feed_along(along, heights.clear)?,
            _ => {}
        }
        self.rapid_along(along, heights.clear)
    }

    /// Down by and by, out to the retract plane between, or a little back only.
    fn pecks(&mut self, along: usize, heights: Heights, out: bool) -> Result<(), TraceFault> {
        let peck = self.cycle.peck.filter(|peck| *peck > 0.0).ok_or(TraceFault::CycleDepths)? * self.modes.unit();
        let mut count = 1.0;
        let mut depth = heights.retract - peck;
        while depth > heights.bottom {
            self.feed_along(along, depth)?;
            if out {
                self.rapid_along(along, heights.retract)?;
            }
            self.rapid_along(along, depth + BACK)?;
            count += 1.0;
            depth = heights.retract - count * peck;
        }
        self.feed_along(along, heights.bottom)
    }

    fn rapid_along(&mut self, along: usize, height: f64) -> Result<(), TraceFault> {
        let mut end = self.position;
        end[along] = height;
        if (height - self.position[along]).abs() > 0.0 {
            self.rapid(end)?;
        }
        Ok(())
    }

    fn feed_along(&mut self, along: usize, height: f64) -> Result<(), TraceFault> {
        let mut end = self.position;
        end[along] = height;
        self.feed_to(end)
    }
}
