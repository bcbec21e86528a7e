//! Canned cycles: a block's words, the hole that they make, and its moves.

use styluscam_motion::{Cycle, CycleStart, CycleStep, MoveKind, Plane};

use super::{Flaw, Interpreter, Z};
use crate::machine::{CycleRules, TimeUnit};
use crate::read_error::ReadFault;
use crate::reader::block::Block;
use crate::reader::drilling::Series;
use crate::reader::lexer::Word;

impl Interpreter<'_> {
    /// One hole of a canned cycle; nothing where a block says no place and no cycle.
    pub(super) fn drill(&mut self, block: &Block, number: u16, line: u32) -> Result<(), Flaw> {
        let said = block.motion.map(|(_, word)| word);
        let [x, y, z] = block.axes;
        let Some(first) = x.or(y).or(z).or(said) else { return Ok(()) };
        let Some(rules) = &self.machine.cycle else { return Err((self.refusal(), Some(first))) };
        if self.incremental {
            return Err((ReadFault::NotRead { what: "canned cycles with G91" }, Some(first)));
        }
        if self.plane != Plane::Xy {
            return Err((ReadFault::NotRead { what: "canned cycles outside G17" }, Some(first)));
        }
        self.load_only_tool(first)?;
        self.allow_motion(first)?;
        let start = self.tip();
        let series = self.series_with(block, number, start[2], rules)?;
        for (axis, word) in [x, y].into_iter().enumerate() {
            if let Some(word) = word {
                let place = self.mm(word)?;
                self.place(axis, place);
            }
        }
        self.require_places(first)?;
        let feed = self.feed_of(block, 1.0, first)?;
        let [x, y, _] = self.axes;
        let cycle = series.hole([x.place, y.place], feed, self.low_return).map_err(|fault| (fault, Some(first)))?;
        if !rules.kinds.contains(&cycle.kind) {
            return Err((self.refusal(), said.or(Some(first))));
        }
        self.make(cycle, start, line).map_err(|fault| (fault, block.q.or(Some(first))))?;
        self.series = Some(series);
        Ok(())
    }

    /// The series in force, or a new one, with what a block says of it.
    fn series_with(&mut self, block: &Block, number: u16, height: f64, rules: &CycleRules) -> Result<Series, Flaw> {
        let [_, _, z] = block.axes;
        let mut series = Series::next(self.series.take(), number, height);
        let tip = |word: Word| Ok::<_, Flaw>(self.mm(word)? - self.height);
        series.bottom = z.map(tip).transpose()?.or(series.bottom);
        series.retract = block.radius.map(tip).transpose()?.or(series.retract);
        if let Some(word) = block.q {
            series.peck = self.mm(word)?;
        }
        if let Some(word) = block.p {
            let per_second = if rules.dwell_unit == TimeUnit::S { 1.0 } else { 1000.0 };
            series.dwell = word.number.value() / per_second;
        }
        Ok(series)
    }

    /// Makes a hole's moves and events, and notes it.
    fn make(&mut self, mut cycle: Cycle, start: [f64; 3], line: u32) -> Result<(), ReadFault> {
        let spindle = self.direction.map(|direction| (self.speed, direction));
        let steps = cycle.steps(&CycleStart { place: start, spindle }).ok_or(ReadFault::TooManyPecks)?;
        cycle.first = self.program.moves.len();
        for step in steps {
            match step {
                CycleStep::Move(kind, place) => {
                    self.axes[Z].place = place[2] + self.height;
                    let feed = if kind == MoveKind::Feed { cycle.feed } else { 0.0 };
                    self.push_move_to(place, kind, None, feed, line);
                }
                CycleStep::Event(kind) => self.event(kind),
            }
        }
        cycle.count = self.program.moves.len() - cycle.first;
        self.program.cycles.push(cycle);
        Ok(())
    }
}
