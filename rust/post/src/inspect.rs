//! Checks on a program before it is written: records, order of events, the machine's limits.

use styluscam_motion::{Cycle, EventKind, FeedMode, Move, MoveKind, Program, ToolRecord};

use crate::machine::Machine;
use crate::post_error::PostError;

/// How far Y may be from 0 on a machine without it, mm: rounding only.
const FLAT: f64 = 1e-9;

/// Inspects a program, move by move.
pub(crate) struct Inspector<'a> {
    head: &'a Program,
    machine: &'a Machine,
    /// Height of the posted point above the tip, mm.
    height: f64,
    moves: usize,
    low: [f64; 3],
    high: [f64; 3],
}

impl<'a> Inspector<'a> {
    /// Inspects the records of a program.
    pub fn new(head: &'a Program, machine: &'a Machine) -> Result<Self, PostError> {
        inspect_wcs(head, machine)?;
        inspect_tools(head, machine)?;
        // until a tool is called the first one is taken to be loaded
        let height = head.tools.first().map_or(0.0, |tool| tool.reference_height);
        Ok(Self { head, machine, height, moves: 0, low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] })
    }

    /// Whether events and cycles stand in the order of the moves.
    pub fn inspect_order(&self, program: &Program) -> Result<(), PostError> {
        if program.moves.is_empty() {
            return Err(PostError::Empty);
        }
        let mut last = 0;
        for (event, before) in program.events.iter().map(|e| e.before).enumerate() {
            if before < last || before > program.moves.len() {
                return Err(PostError::EventOrder { event });
            }
            last = before;
        }
        let mut free = 0;
        for (cycle, hole) in program.cycles.iter().enumerate() {
            let end = hole
                .first
                .checked_add(hole.count)
                .filter(|end| hole.first >= free && hole.count > 0 && *end <= program.moves.len());
            let end = end.ok_or(PostError::CycleOrder { cycle })?;
            let moves = program.moves.get(hole.first..end).unwrap_or_default();
            if !self.makes(hole, moves) {
                return Err(PostError::CycleMoves { cycle });
            }
            if hole.kind.is_tapping() && !self.machine.takes_cycle(hole) {
                return Err(PostError::Unsupported { what: "a tapping cycle, and plain moves cannot tap" });
            }
            free = end;
        }
        Ok(())
    }

    /// Whether a hole's numbers are those of its moves.
    fn makes(&self, hole: &Cycle, moves: &[Move]) -> bool {
        let lowest = moves.iter().map(|m| m.end.tip[2]).fold(f64::INFINITY, f64::min);
        let Some(last) = moves.last().map(|m| m.end.tip) else { return false };
        let pairs = [(lowest, hole.bottom), (last[2], hole.leave), (last[0], hole.at[0]), (last[1], hole.at[1])];
        pairs.iter().all(|(found, stated)| (found - stated).abs() <= self.machine.resolution_mm())
            && hole.retract >= hole.bottom
    }

    /// Inspects an event.
    pub fn event(&mut self, number: usize, kind: &EventKind) -> Result<(), PostError> {
        match *kind {
            EventKind::ToolChange { tool } => {
                self.height = self.head.tools.get(tool as usize).map_or(self.height, |tool| tool.reference_height);
                Ok(())
            }
            EventKind::SpindleOn { rpm, .. } => {
                let limits = &self.machine.limits;
                let (min, max) = (limits.min_rpm.unwrap_or(0.0), limits.max_rpm.unwrap_or(f64::INFINITY));
                if rpm != 0.0 && !(min..=max).contains(&rpm) || rpm.is_infinite() {
                    return Err(PostError::SpindleSpeed { rpm, min, max });
                }
                Ok(())
            }
            EventKind::Probe { end, feed, .. } => self.inspect_probe(end, feed),
            EventKind::Dwell { seconds } if seconds < 0.0 => Err(PostError::Dwell { event: number, seconds }),
            EventKind::Dwell { seconds } => finite("the dwell", || format!("events[{number}]"), seconds),
            _ => Ok(()),
        }
    }

    /// A probe goes no farther than commanded.
    fn inspect_probe(&self, end: [Option<f64>; 3], feed: f64) -> Result<(), PostError> {
        if !feed.is_finite() || feed <= 0.0 {
            return Err(PostError::Feed { index: self.moves, feed });
        }
        let limits = &self.machine.limits;
        let ranges = [limits.x, limits.y, limits.z];
        for (axis, position) in end.into_iter().enumerate() {
            let above = if axis == 2 { self.height } else { 0.0 };
            position.map_or(Ok(()), |position| inspect_limit(self.moves, axis, position + above, ranges[axis]))?;
        }
        Ok(())
    }

    /// Inspects a move from `start`: its operation, its feed, its path in the machine.
    pub fn step(&mut self, index: usize, start: Option<[f64; 3]>, step: &Move) -> Result<(), PostError> {
        self.inspect_operation(index, step)?;
        if !step.end.axis.is_up() && self.machine.rotary.is_none() {
            return Err(PostError::ToolAxis { index });
        }
        if self.machine.motion.lathe.is_some() && step.end.tip[1].abs() > FLAT {
            return Err(PostError::NoSuchAxis { index, axis: 'Y', value: step.end.tip[1] });
        }
        self.inspect_feed(index, step)?;
        let (least, most) = step.bounds(start);
        self.inspect_range(index, [least, most])
    }

    /// Inspects a move during which the linear axes stand at these positions, mm.
    pub fn lean(&mut self, index: usize, step: &Move, stands: &[[f64; 3]]) -> Result<(), PostError> {
        self.inspect_operation(index, step)?;
        self.inspect_feed(index, step)?;
        stands.iter().try_for_each(|stand| self.inspect_range(index, [*stand; 2]))
    }

    fn inspect_operation(&mut self, index: usize, step: &Move) -> Result<(), PostError> {
        self.moves += 1;
        if step.operation as usize >= self.head.operations.len() {
            let place = format!("moves[{index}]");
            return Err(PostError::NoSuchRecord { place, what: "operation", index: step.operation });
        }
        Ok(())
    }

    /// Compares the whole with the machine's travel.
    pub fn finish(&self) -> Result<(), PostError> {
        if self.moves == 0 {
            return Err(PostError::Empty);
        }
        let Some(travel) = self.machine.limits.travel else { return Ok(()) };
        for (axis, travel) in travel.into_iter().enumerate() {
            let needed = self.high[axis] - self.low[axis];
            if needed > travel {
                return Err(PostError::Travel { axis: axis_name(axis), needed, travel });
            }
        }
        Ok(())
    }

    fn inspect_feed(&self, index: usize, step: &Move) -> Result<(), PostError> {
        if step.kind == MoveKind::Rapid {
            return Ok(());
        }
        if step.feed_mode != FeedMode::PerMinute {
            return Err(PostError::FeedMode { index });
        }
        let max = self.machine.limits.max_feed.unwrap_or(f64::INFINITY);
        if !step.feed.is_finite() || step.feed <= 0.0 {
            return Err(PostError::Feed { index, feed: step.feed });
        }
        if step.feed > max {
            return Err(PostError::FeedTooHigh { index, feed: step.feed, max });
        }
        Ok(())
    }

    /// Compares the posted point, the tool's reference, between two corners with the machine's range.
    fn inspect_range(&mut self, index: usize, [least, most]: [[f64; 3]; 2]) -> Result<(), PostError> {
        let limits = &self.machine.limits;
        let ranges = [limits.x, limits.y, limits.z];
        if ranges.iter().all(Option::is_none) && limits.travel.is_none() {
            return Ok(());
        }
        for axis in 0..3 {
            let above = if axis == 2 { self.height } else { 0.0 };
            for value in [least[axis] + above, most[axis] + above] {
                inspect_limit(index, axis, value, ranges[axis])?;
            }
            self.low[axis] = self.low[axis].min(least[axis] + above);
            self.high[axis] = self.high[axis].max(most[axis] + above);
        }
        Ok(())
    }
}

fn inspect_wcs(program: &Program, machine: &Machine) -> Result<(), PostError> {
    let wcs = &program.setup.wcs;
    if machine.wcs.contains(wcs) {
        return Ok(());
    }
    Err(PostError::Wcs { wcs: wcs.clone(), allowed: machine.wcs.join(", ") })
}

fn inspect_tools(program: &Program, machine: &Machine) -> Result<(), PostError> {
    let max = machine.tool.max_number;
    for (index, tool) in program.tools.iter().enumerate() {
        if !(1..=max).contains(&tool.number) {
            return Err(PostError::ToolNumber { number: tool.number, max });
        }
        finite("the reference height", || format!("tools[{index}]"), tool.reference_height)?;
        let earlier = program.tools.iter().take(index);
        if let Some(other) = earlier.into_iter().find(|o| o.number == tool.number && !moves_alike(o, tool)) {
            let (first, second) = (other.name.clone(), tool.name.clone());
            return Err(PostError::ToolNumberTwice { number: tool.number, first, second });
        }
    }
    Ok(())
}

/// Whether two records mean the same motion in the text.
#[allow(clippy::float_cmp)] // the same number, not a near one
fn moves_alike(a: &ToolRecord, b: &ToolRecord) -> bool {
    a.length_offset == b.length_offset && a.reference_height == b.reference_height
}

fn inspect_limit(index: usize, axis: usize, value: f64, range: Option<[f64; 2]>) -> Result<(), PostError> {
    match range {
        Some([min, max]) if !(min..=max).contains(&value) => {
            Err(PostError::AxisLimit { index, axis: axis_name(axis), value, min, max })
        }
        _ => Ok(()),
    }
}

fn axis_name(axis: usize) -> char {
    ['X', 'Y', 'Z'].get(axis).copied().unwrap_or('?')
}

fn finite(what: &'static str, place: impl Fn() -> String, value: f64) -> Result<(), PostError> {
    if value.is_finite() {
        return Ok(());
    }
    Err(PostError::Number { what, place: place(), value })
}
