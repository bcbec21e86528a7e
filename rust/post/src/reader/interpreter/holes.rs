//! Canned cycles: a block's words, the hole that they make, and its moves.

use styluscam_motion::{Cycle, CycleKind, CycleStart, CycleStep, Move, MoveKind, Plane};

use super::{Interpreter, Z};
use crate::block::{CycleWords, Motion};
use crate::machine::CycleRules;
use crate::read_error::ReadFault;
use crate::reader::block::Block;
use crate::reader::called::{Called, Pace};
use crate::reader::drilling::Series;
use crate::reader::lexer::{Flaw, Word};

impl Interpreter<'_> {
    /// One hole of a canned cycle; nothing where a block states no position and no cycle.
    pub(super) fn drill(&mut self, block: &Block, number: u16, line: u32) -> Result<(), Flaw> {
        let stated = block.motion().map(|(_, word)| word);
        let [x, y, z] = block.axes();
        let Some(first) = x.or(y).or(z).or(stated) else { return Ok(()) };
        let Some(rules) = &self.machine.cycle else { return Err((self.refusal(), Some(first))) };
        if self.modes.incremental {
            return Err((ReadFault::NotRead { what: "canned cycles with G91" }, Some(first)));
        }
        if self.modes.plane != Plane::Xy {
            return Err((ReadFault::NotRead { what: "canned cycles outside G17" }, Some(first)));
        }
        self.allow_hole(block, first)?;
        self.require_angles(first)?;
        self.load_only_tool(first)?;
        self.allow_motion(first)?;
        let start = self.tip();
        let series = self.series_with(block, number, start[2], rules)?;
        for (axis, word) in [x, y].into_iter().enumerate() {
            if let Some(word) = word {
                let position = self.mm(word)?;
                self.set_position(axis, position);
            }
        }
        self.require_positions(first)?;
        let feed = self.feed_of(block, 1.0, first)?;
        let [x, y, _] = self.axes;
        let cycle =
            series.hole([x.position, y.position], feed, self.modes.low_return).map_err(|fault| (fault, Some(first)))?;
        if !rules.kinds.contains(&cycle.kind) {
            return Err((self.refusal(), stated.or(Some(first))));
        }
        self.make(cycle, start, line).map_err(|fault| (fault, block.words.get(b'Q').or(Some(first))))?;
        self.series = Some(series);
        Ok(())
    }

    /// The cycle that a block calls, and the word that does so.
    pub(super) fn calls(&self, block: &Block) -> Option<(Option<Called>, Word)> {
        let any = block.any_axis();
        match (self.called, block.call) {
            (called, Some(call)) => Some((called, call)),
            (Some(called), None) if called.modal => any.map(|word| (Some(called), word)),
            _ => None,
        }
    }

    /// A hole where a block's rapid ends. The path there is at the height where the tool stands.
    pub(super) fn drill_here(
        &mut self,
        block: &Block,
        called: Option<Called>,
        word: Word,
        line: u32,
    ) -> Result<(), Flaw> {
        let flaw = |fault| (fault, Some(word));
        let called = called.ok_or(flaw(ReadFault::MissingWord { what: "the cycle to call" }))?;
        let [x, y, z] = block.axes();
        let elsewhere = block.machine_coordinates().or(block.home()).or(block.probe().map(|(_, word)| word));
        let across = z.is_none() && elsewhere.is_none() && !self.modes.incremental && self.modes.plane == Plane::Xy;
        let rapid = self.motion == Some(Motion::Rapid) || x.or(y).is_none();
        if !across || !rapid {
            return Err(flaw(ReadFault::NotRead { what: "cycles called by other moves than rapids across" }));
        }
        let known = self.machine.cycle.as_ref().is_some_and(|rules| rules.kinds.contains(&called.kind));
        if !known {
            return Err(flaw(self.refusal()));
        }
        self.load_only_tool(word)?;
        self.allow_motion(word)?;
        if self.without_edge {
            return Err(flaw(ReadFault::NoLengthOffset { expected: 1 }));
        }
        let mut start = self.tip();
        self.position_axes(block)?;
        self.require_positions(word)?;
        let cycle = self.hole_of(&called, block, word)?;
        if start[2] < cycle.retract && x.or(y).is_some() {
            self.push_move(MoveKind::Rapid, None, 0.0, line);
            start = self.tip();
        }
        self.make(cycle, start, line).map_err(flaw)
    }

    #[allow(clippy::float_cmp)] // numbers as written
    fn hole_of(&self, called: &Called, block: &Block, word: Word) -> Result<Cycle, Flaw> {
        let feed = match called.pace {
            Pace::InForce => self.feed_of(block, 1.0, word)?,
            Pace::Feed(number) => self.mm(Word { number, ..word })? / self.machine.feed_scale_of(self.modes.unit),
            Pace::Pitch(pitch, speed) => {
                let turns = self.modes.direction.is_some()
                    && self.modes.speed > 0.0
                    && speed.is_none_or(|s| s == self.modes.speed);
                if !turns {
                    return Err((ReadFault::NoRevolutions, Some(word)));
                }
                pitch * self.modes.speed
            }
        };
        let (retract, bottom, leave) =
            (called.retract - self.height, called.bottom - self.height, called.leave - self.height);
        if bottom > retract || retract > leave {
            return Err((ReadFault::CycleUpwards, Some(word)));
        }
        if feed <= 0.0 || called.dwell < 0.0 || called.peck < 0.0 {
            return Err((ReadFault::Negative, Some(word)));
        }
        let pecks = matches!(called.kind, CycleKind::Peck | CycleKind::ChipBreak);
        if pecks && called.peck == 0.0 {
            return Err((ReadFault::MissingWord { what: "the peck of the cycle" }, Some(word)));
        }
        let [x, y, _] = self.tip();
        let Called { kind, peck, dwell, .. } = *called;
        Ok(Cycle { first: 0, count: 0, kind, at: [x, y], retract, bottom, leave, feed, dwell, peck })
    }

    /// The series in force, or a new one, with what a block states of it.
    fn series_with(&mut self, block: &Block, number: u16, height: f64, rules: &CycleRules) -> Result<Series, Flaw> {
        let [_, _, z] = block.axes();
        let mut series = Series::next(self.series.take(), number, height);
        let tip = |word: Word| Ok::<_, Flaw>(self.mm(word)? - self.height);
        series.words.take(CycleWords {
            initial: None,
            bottom: z.map(tip).transpose()?,
            retract: block.words.get(b'R').map(tip).transpose()?,
            peck: block.words.get(b'Q').map(|word| self.mm(word)).transpose()?,
            dwell: block.words.get(b'P').map(|word| self.seconds(word, rules.dwell_unit)).transpose()?,
        });
        Ok(series)
    }

    /// Makes a hole's moves and events, and notes it.
    fn make(&mut self, mut cycle: Cycle, start: [f64; 3], line: u32) -> Result<(), ReadFault> {
        if self.halted {
            return Err(ReadFault::Halted);
        }
        let spindle = self.modes.direction.map(|direction| (self.modes.speed, direction));
        let steps = cycle.steps(&CycleStart { position: start, spindle }).ok_or(ReadFault::TooManyPecks)?;
        cycle.first = self.record.program.moves.len();
        for step in steps {
            match step {
                CycleStep::Move(kind, position) => {
                    self.axes[Z].position = position[2] + self.height;
                    let feed = if kind == MoveKind::Feed { cycle.feed } else { 0.0 };
                    self.push_move_to(Move::new(kind, position, feed).on_line(line), None);
                }
                CycleStep::Event(kind) => self.event(kind),
            }
        }
        cycle.count = self.record.program.moves.len() - cycle.first;
        self.record.program.cycles.push(cycle);
        Ok(())
    }
}
