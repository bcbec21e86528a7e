//! Holes by the machine's own cycles.

use styluscam_motion::{Cycle, EventKind, Move, Program};

use super::dialect::{Hole, Thread};
use super::Poster;
use crate::post_error::PostError;

impl Poster<'_> {
    /// Whether the machine has a cycle for this.
    pub(super) fn has(&self, cycle: &Cycle) -> bool {
        self.machine.cycle.as_ref().is_some_and(|rules| rules.take(cycle))
    }

    /// A hole by the machine's own cycle; `moves` are those that it makes.
    pub(super) fn hole(&mut self, cycle: &Cycle, moves: &[Move]) -> Result<(), PostError> {
        let index = self.moves;
        if let Some(first) = moves.first() {
            self.start_operation(first.operation)?;
        }
        for (number, step) in moves.iter().enumerate() {
            self.inspector.step(index + number, self.tip, step)?;
            self.tip = Some(step.end);
        }
        let [x, y] = cycle.at;
        let low = self.target(index, [x, y, cycle.bottom])?;
        let high = self.target(index, [x, y, cycle.retract])?;
        let leave = self.target(index, [x, y, cycle.leave])?;
        let [x_now, y_now, z_now] = self.position(index)?;
        // a series that returns begins at the height to which it returns; none goes across below where it begins
        let z_first = if leave[2] > high[2] { leave[2] } else { z_now.max(high[2]) };
        if z_now != z_first {
            self.dialect.close(&mut self.lines)?;
            self.rapid([x_now, y_now, z_first])?;
        }
        let thread = match self.rpm.filter(|rpm| *rpm > 0.0) {
            _ if !cycle.kind.is_tapping() => None,
            Some(rpm) => Some(Thread { pitch: cycle.feed * self.per_mm / rpm, speed: self.speed_count(rpm)? }),
            None => return Err(PostError::NoRevolutions { index }),
        };
        let hole = Hole {
            kind: cycle.kind,
            at: [low[0], low[1]],
            retract: high[2],
            bottom: low[2],
            peck: self.count(index, "a peck", cycle.peck)?,
            dwell: cycle.dwell,
            feed: self.feed_count(index, cycle.feed, f64::INFINITY)?,
            leave: leave[2],
            thread,
        };
        self.motion_line = self.lines.line;
        self.dialect.hole(&mut self.lines, &hole)?;
        self.motion_line = self.lines.line - 1;
        self.position = leave.map(Some);
        self.moves += moves.len();
        Ok(())
    }
}

/// Whether something happens on a cycle's way that the cycle does not do itself: its code would leave that out.
pub(super) fn holds_others(program: &Program, cycle: &Cycle) -> bool {
    let on_its_way = cycle.first + 1..cycle.first + cycle.count;
    let own = |kind: &EventKind| {
        matches!(kind, EventKind::Dwell { .. } | EventKind::SpindleOn { .. } | EventKind::SpindleOff)
    };
    let first = program.events.partition_point(|event| event.before < on_its_way.start);
    let events = program.events.iter().skip(first).take_while(|event| on_its_way.contains(&event.before));
    events.into_iter().any(|event| !own(&event.kind))
}
