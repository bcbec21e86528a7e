//! Holes by the machine's own cycles.

use styluscam_motion::{Cycle, CycleKind, CycleStart, CycleStep, EventKind, Move, MoveKind, Program, SpindleDirection};

use super::dialect::{Hole, Thread};
use super::Poster;
use crate::machine::{Family, Machine};
use crate::post_error::PostError;

impl Poster<'_> {
    /// How many events are the cycle's own; none where it is posted as moves, because the machine has no such cycle, or
    /// because the moves and events that stand there are not those of its numbers: they count.
    pub(super) fn own_events(&self, program: &Program, cycle: &Cycle) -> Option<usize> {
        if !self.machine.takes_cycle(cycle) {
            return None;
        }
        let [x, y] = cycle.at;
        let start = CycleStart { position: [x, y, cycle.retract], spindle: self.spindle };
        made_by(program, cycle, &cycle.steps(&start)?, self.machine)
    }

    /// A hole by the machine's own cycle; `moves` are those that it makes.
    pub(super) fn hole(&mut self, cycle: &Cycle, moves: &[Move]) -> Result<(), PostError> {
        let index = self.moves;
        if let Some(first) = moves.first() {
            self.start_operation(first.operation)?;
            self.stand_upright(index, first)?;
        }
        for (number, step) in moves.iter().enumerate() {
            self.inspector.step(index + number, self.tip, step)?;
            self.tip = Some(step.end.tip);
        }
        let [x, y] = cycle.at;
        let low = self.target(index, [x, y, cycle.bottom])?;
        let high = self.target(index, [x, y, cycle.retract])?;
        let leave = self.target(index, [x, y, cycle.leave])?;
        let lifts = leave[2] > high[2];
        let across = self.rise_to(high, leave)?;
        // a return to where a series began ends too high after a path across from farther up: a rapid does the rest
        let by_rapid = lifts && across > leave[2] && self.machine.family == Family::Gcode;
        let hole = Hole {
            kind: cycle.kind,
            at: [low[0], low[1]],
            retract: high[2],
            bottom: low[2],
            peck: self.count(index, "a peck", cycle.peck)?,
            dwell: cycle.dwell,
            feed: self.feed_count(index, cycle.feed, f64::INFINITY)?,
            leave: if by_rapid { high[2] } else { leave[2] },
            thread: self.thread(index, cycle)?,
        };
        self.motion_line = self.lines.line;
        self.dialect.hole(&mut self.lines, &hole)?;
        self.motion_line = self.lines.line - 1;
        self.position = [leave[0], leave[1], hole.leave].map(Some);
        if by_rapid {
            self.dialect.close(&mut self.lines)?;
            self.rapid(leave)?;
        }
        self.moves += moves.len();
        Ok(())
    }

    /// Up to where the path across to a hole may begin; gives that height. From an unknown position: to the hole, high up.
    fn rise_to(&mut self, high: [i64; 3], leave: [i64; 3]) -> Result<i64, PostError> {
        let [Some(x_now), Some(y_now), Some(z_now)] = self.position else {
            self.dialect.close(&mut self.lines)?;
            let above = [high[0], high[1], high[2].max(leave[2])];
            self.rapid(above)?;
            return Ok(above[2]);
        };
        // a series of G-code returns to the height at which it began
        let returns = leave[2] > high[2] && self.machine.family == Family::Gcode;
        let across = z_now.max(high[2]).max(if returns { leave[2] } else { high[2] });
        if z_now != across {
            self.dialect.close(&mut self.lines)?;
            self.rapid([x_now, y_now, across])?;
        }
        Ok(across)
    }

    fn thread(&self, index: usize, cycle: &Cycle) -> Result<Option<Thread>, PostError> {
        if !cycle.kind.is_tapping() {
            return Ok(None);
        }
        let turning = self.spindle.filter(|(rpm, _)| *rpm > 0.0);
        let (rpm, direction) = turning.ok_or(PostError::NoRevolutions { index })?;
        let right = direction == SpindleDirection::Clockwise;
        if right != (cycle.kind == CycleKind::Tap) {
            return Err(PostError::Unsupported { what: "a tap whose hand is not the spindle's" });
        }
        Ok(Some(Thread { pitch: cycle.feed * self.per_mm / rpm, speed: self.speed_count(rpm)? }))
    }
}

/// How many events of a program are a cycle's own, if its moves and events are the steps that the cycle makes.
///
/// How it gets to the retract plane over the hole is the program's to decide: by rapids, none below that plane.
fn made_by(program: &Program, cycle: &Cycle, steps: &[CycleStep], machine: &Machine) -> Option<usize> {
    let unit = machine.resolution_mm();
    let end = cycle.first + cycle.count;
    let moves = program.moves.get(cycle.first..end)?;
    let approach = moves.iter().position(|step| step.kind == MoveKind::Feed)?;
    let (path, made) = moves.split_at(approach);
    let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= unit);
    let from = path.last().or(cycle.first.checked_sub(1).and_then(|before| program.moves.get(before)))?;
    let above = path.iter().all(|step| step.end.tip[2] >= cycle.retract - unit);
    if !above || !near(from.end.tip, [cycle.at[0], cycle.at[1], cycle.retract]) {
        return None;
    }
    let first = program.events.partition_point(|event| event.before <= cycle.first);
    let mut events = program.events.iter().skip(first).peekable();
    let (mut at, mut own) = (cycle.first + approach, 0);
    let mut made = made.iter();
    for step in steps {
        match step {
            CycleStep::Move(kind, position) => {
                let found = made.next()?;
                let interrupted = events.peek().is_some_and(|event| event.before <= at);
                let feed = *kind == MoveKind::Rapid || (found.feed - cycle.feed).abs() <= 1e-9 * cycle.feed;
                if interrupted || !feed || found.kind != *kind || found.arc.is_some() || !near(found.end.tip, *position)
                {
                    return None;
                }
                at += 1;
            }
            CycleStep::Event(kind) => {
                events.next_if(|event| event.before == at && same(&event.kind, kind))?;
                own += 1;
            }
        }
    }
    made.next().is_none().then_some(own)
}

/// Whether an event is a cycle's.
fn same(event: &EventKind, own: &EventKind) -> bool {
    match (event, own) {
        (EventKind::Dwell { seconds: a }, EventKind::Dwell { seconds: b }) => (a - b).abs() <= 1e-9,
        (a, b) => a == b,
    }
}
