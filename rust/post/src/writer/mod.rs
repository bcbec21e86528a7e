//! Motion to text: who walks through a program and decides what is written next.

mod arcs;
mod cycl_def;
mod dialect;
mod events;
mod holes;
mod klartext;
mod leaning;
mod lines;
mod mcall;
mod rotary;
mod words;

use std::collections::BTreeMap;
use std::io;

use styluscam_motion::{
    Event, EventKind, Move, MoveKind, OperationRecord, Program, Role, SpindleDirection, ToolRecord,
};

use crate::inspect::Inspector;
use crate::machine::{Family, FeedMode, Machine};
use crate::number::NumberFormat;
use crate::post_error::PostError;
use crate::role;
use crate::template::{Facts, Templater};
use dialect::{Dialect, Position};
pub(crate) use lines::counted_length;
use lines::{Lines, Outlet};
use rotary::Rotary;

/// A posted program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Posted {
    /// The text, with the machine's line ends.
    pub text: String,
    /// For each move the line, from 1, with which the machine arrives at its end; for a move that rounds to no motion, the
    /// line that had arrived there; for the moves of a canned cycle, its line.
    pub line_of_move: Vec<u32>,
}

/// Typical length of a motion block, to reserve memory.
const TYPICAL_BLOCK: usize = 24;

/// Writes `program` for `machine`.
///
/// Coordinates are rounded to the machine's decimals, and moves that round to no motion are left out. Z is that of the
/// active tool's reference point (`reference_height` above the tip). The first move, and the first after a tool change,
/// goes to its height first and then across. Any other rapid that goes across and down, or up and across, becomes two
/// blocks, the higher path: rapids of many machines do not follow a straight line. The spindle stops before a tool change.
///
/// # Errors
/// [`PostError`], and no text: a program that the machine cannot be given, or a machine file that is at fault.
pub fn post(program: &Program, machine: &Machine) -> Result<Posted, PostError> {
    let mut line_of_move = Vec::with_capacity(program.moves.len());
    let capacity = program.moves.len().saturating_mul(TYPICAL_BLOCK);
    let mut poster = Poster::new(program, &Facts::of(program), machine, Outlet::Memory, capacity)?;
    poster.walk(program, |line| line_of_move.push(line))?;
    Ok(Posted { text: poster.finish()?, line_of_move })
}

/// Writes `program` for `machine` piece by piece: the text is never whole in memory.
///
/// # Errors
/// [`PostError`]; what was written by then is no program and must not be kept.
pub fn post_to(program: &Program, machine: &Machine, out: &mut dyn io::Write) -> Result<(), PostError> {
    let mut poster = Poster::streaming(program, &Facts::of(program), machine, out)?;
    poster.walk(program, |_| ())?;
    poster.finish().map(|_| ())
}

/// Writes a program that comes move by move.
///
/// Set-up, tools and operations are known from the start; moves and events come in their order.
pub struct Poster<'a> {
    machine: &'a Machine,
    head: &'a Program,
    templater: Templater<'a>,
    names: BTreeMap<String, minijinja::Value>,
    inspector: Inspector<'a>,
    rotary: Option<Rotary<'a>>,
    lines: Lines<'a>,
    dialect: Box<dyn Dialect + 'a>,
    linear: NumberFormat,
    feed_format: NumberFormat,
    /// Output units in one mm.
    per_mm: f64,
    /// How often X is counted: twice where it is a diameter.
    x_scale: f64,
    /// Moves and events that came before.
    moves: usize,
    events: usize,
    /// The tools that are called, in order; those that were are taken away.
    calls: std::collections::VecDeque<u32>,
    /// The last line with motion.
    motion_line: u32,
    position: Position,
    /// The tip's last position, as planned.
    tip: Option<[f64; 3]>,
    tool: Option<&'a ToolRecord>,
    operation: Option<u32>,
    /// What the text states that its feed moves are for.
    role: Option<Role>,
    /// Speed, rev/min, and sense of the spindle, while it turns.
    spindle: Option<(f64, SpindleDirection)>,
    mist: bool,
    flood: bool,
}

impl<'a> Poster<'a> {
    /// A poster of a program whose `head` has the set-up, the tools and the operations; its moves and events are not looked at.
    ///
    /// # Errors
    /// [`PostError`]: a machine file that is at fault, tools or a work offset that the machine does not take.
    pub fn streaming(
        head: &'a Program,
        facts: &Facts,
        machine: &'a Machine,
        out: &'a mut dyn io::Write,
    ) -> Result<Self, PostError> {
        Self::new(head, facts, machine, Outlet::Stream(out), 0)
    }

    fn new(
        head: &'a Program,
        facts: &Facts,
        machine: &'a Machine,
        outlet: Outlet<'a>,
        capacity: usize,
    ) -> Result<Self, PostError> {
        machine.check()?;
        let inspector = Inspector::new(head, machine)?;
        let templater = Templater::new(machine);
        let names = templater.names(head, facts)?;
        let dialect: Box<dyn Dialect> = match machine.family {
            Family::Gcode | Family::Siemens => Box::new(words::Words::new(machine)),
            Family::Klartext => Box::new(klartext::Klartext::new(machine)),
        };
        let mut poster = Self {
            machine,
            head,
            templater,
            names,
            inspector,
            rotary: Rotary::of(machine)?,
            lines: Lines::new(machine, outlet, capacity),
            dialect,
            linear: machine.linear_format(),
            feed_format: machine.feed_format(),
            per_mm: machine.units.output.in_mm().recip(),
            x_scale: machine.x_scale(),
            moves: 0,
            events: 0,
            calls: tool_calls(head),
            motion_line: 0,
            position: [None; 3],
            tip: None,
            tool: None,
            operation: None,
            role: None,
            spindle: None,
            mist: false,
            flood: false,
        };
        let start = poster.templater.program_start(&poster.names)?;
        poster.lines.text(&start)?;
        Ok(poster)
    }

    /// Ends the program; gives the text that was kept.
    ///
    /// # Errors
    /// [`PostError`]: nothing moved, or the whole is longer than the machine.
    pub fn finish(mut self) -> Result<String, PostError> {
        self.inspector.finish()?;
        self.end_operation()?;
        self.dialect.close(&mut self.lines)?;
        self.stop_tracking()?;
        self.switch_off()?;
        let end = self.templater.program_end(&self.names)?;
        self.lines.text(&end)?;
        self.lines.finish()
    }

    /// All of a program; `arrived` takes the line of every move.
    fn walk(&mut self, program: &Program, mut arrived: impl FnMut(u32)) -> Result<(), PostError> {
        self.inspector.inspect_order(program)?;
        let course = self.course(program)?;
        let mut poses = course.iter().flat_map(|course| course.chunk_by(|a, b| a.index == b.index));
        let mut events = program.events.iter().peekable();
        let mut cycles = program.cycles.iter().filter(|_| course.is_none()).peekable();
        let mut index = 0;
        while let Some(step) = program.moves.get(index) {
            if self.operation.is_some_and(|operation| operation != step.operation) {
                self.end_operation()?;
            }
            while let Some(event) = events.next_if(|e| e.before <= index) {
                self.event(&event.kind)?;
            }
            let cycle = cycles.next_if(|cycle| cycle.first == index);
            let own = cycle.and_then(|cycle| self.own_events(program, cycle));
            if let (Some(cycle), None) = (cycle.filter(|cycle| cycle.kind.is_tapping()), own) {
                return Err(PostError::TapMoves { index: cycle.first });
            }
            if let (Some(cycle), Some(own)) = (cycle, own) {
                let count = cycle.count.max(1);
                self.hole(cycle, program.moves.get(index..index + count).unwrap_or_default())?;
                (0..own).for_each(|_| _ = events.next());
                (0..count).for_each(|_| arrived(self.motion_line));
                index += count;
            } else {
                match poses.next() {
                    Some(poses) => self.lean(step, poses)?,
                    None => self.step(step)?,
                }
                arrived(self.motion_line);
                index += 1;
            }
        }
        self.end_operation()?;
        events.try_for_each(|event| self.event(&event.kind))
    }

    // Operations

    fn start_operation(&mut self, operation: u32) -> Result<(), PostError> {
        if self.operation == Some(operation) {
            return Ok(());
        }
        self.end_operation()?;
        self.operation = Some(operation);
        let Some(record) = self.head.operations.get(operation as usize) else { return Ok(()) };
        let text = self.templater.operation_start(&self.names, record)?;
        self.speak(&text)
    }

    fn end_operation(&mut self) -> Result<(), PostError> {
        let record: Option<&OperationRecord> = self.operation.take().and_then(|o| self.head.operations.get(o as usize));
        if self.role.take().is_some() {
            self.dialect.close(&mut self.lines)?;
            self.lines.comment(&role::remark(None))?;
        }
        let Some(record) = record else { return Ok(()) };
        let text = self.templater.operation_end(&self.names, record)?;
        self.speak(&text)
    }

    /// Text of a template; it may have changed modes.
    fn speak(&mut self, text: &str) -> Result<(), PostError> {
        if text.trim().is_empty() {
            return Ok(());
        }
        self.dialect.close(&mut self.lines)?;
        self.dialect.forget();
        self.lines.text(text)
    }

    /// A remark where a feed move is for something else than those before it.
    fn state_role(&mut self, step: &Move) -> Result<(), PostError> {
        if step.kind == MoveKind::Rapid || step.role == self.role {
            return Ok(());
        }
        self.role = step.role;
        self.lines.comment(&role::remark(step.role))
    }

    // Moves

    /// The next move.
    ///
    /// # Errors
    /// [`PostError`]: a move that the machine cannot make, or that cannot be written.
    pub fn step(&mut self, step: &Move) -> Result<(), PostError> {
        self.start_operation(step.operation)?;
        let index = self.moves;
        self.inspector.step(index, self.tip, step)?;
        self.dialect.close(&mut self.lines)?;
        self.state_role(step)?;
        let target = self.target(index, step.end.tip)?;
        self.stand_upright(index, step)?;
        match (step.kind, step.arc) {
            (MoveKind::Rapid, _) => self.rapid(target)?,
            (MoveKind::Feed, None) => self.feed(index, target, step.feed)?,
            (MoveKind::Feed, Some(arc)) => self.arc(index, step, arc)?,
        }
        self.tip = Some(step.end.tip);
        self.moves += 1;
        Ok(())
    }

    /// A tip's position as the active tool's reference point, in units of the last decimal.
    fn target(&self, index: usize, tip: [f64; 3]) -> Result<[i64; 3], PostError> {
        let height = self.tool.ok_or(PostError::NoTool { index })?.reference_height;
        let [x, y, z] = [tip[0], tip[1], tip[2] + height];
        let x_count = self.count(index, "X", x * self.x_scale)?;
        Ok([x_count, self.count(index, "Y", y)?, self.count(index, "Z", z)?])
    }

    fn count(&self, index: usize, what: &'static str, mm: f64) -> Result<i64, PostError> {
        let count = self.linear.count(mm * self.per_mm);
        count.ok_or_else(|| PostError::Number { what, place: format!("moves[{index}]"), value: mm })
    }

    /// A position in units of the last decimal, mm.
    fn mm(&self, count: [i64; 3]) -> [f64; 3] {
        let unit = self.machine.resolution_mm();
        [count[0] as f64 * unit / self.x_scale, count[1] as f64 * unit, count[2] as f64 * unit]
    }

    fn rapid(&mut self, target: [i64; 3]) -> Result<(), PostError> {
        let goal = target.map(Some);
        if self.position == goal {
            return Ok(());
        }
        for position in self.rapids_to(target).into_iter().flatten() {
            if position != self.position {
                self.motion_line = self.lines.line;
                self.dialect.rapid(&mut self.lines, self.position, position)?;
                self.position = position;
            }
        }
        Ok(())
    }

    /// The position between, if any, and the goal. From a position that is not known: away from the work first, then across.
    fn rapids_to(&self, target: [i64; 3]) -> [Option<Position>; 2] {
        let away = if self.machine.motion.lathe.is_some() { 0 } else { 2 };
        let goal = target.map(Some);
        let mut between = self.position;
        let known = self.position.iter().all(Option::is_some);
        let across = (0..3).any(|axis| axis != away && self.position[axis] != goal[axis]);
        let rises = self.position[away].is_none_or(|from| target[away] > from);
        match self.machine.motion.split_rapids || !known {
            true if across && (!known || rises) => between[away] = goal[away],
            true if across => between = std::array::from_fn(|i| if i == away { self.position[i] } else { goal[i] }),
            _ => return [Some(goal), None],
        }
        [Some(between), Some(goal)]
    }

    fn feed(&mut self, index: usize, target: [i64; 3], feed: f64) -> Result<(), PostError> {
        let from = self.position(index)?;
        if from == target {
            return Ok(());
        }
        // the length of what is posted decides how long it takes: a short line is another once rounded
        let [from, to] = [from, target].map(|count| self.mm(count));
        let feed = self.feed_count(index, feed, Move::rapid(to).length(from))?;
        self.motion_line = self.lines.line;
        self.dialect.feed(&mut self.lines, self.position, target.map(Some), feed)?;
        self.position = target.map(Some);
        Ok(())
    }

    fn position(&self, index: usize) -> Result<[i64; 3], PostError> {
        let [Some(x), Some(y), Some(z)] = self.position else { return Err(PostError::FeedFromUnknown { index }) };
        Ok([x, y, z])
    }

    /// A feed, mm/min, as the mode in force states it, in units of the last decimal; `length` is that of the block's path, mm.
    fn feed_count(&self, index: usize, feed: f64, length: f64) -> Result<i64, PostError> {
        let per_mm = self.per_mm * self.machine.feed_scale();
        let stated = match self.machine.feed.mode {
            FeedMode::PerMinute => feed * per_mm,
            FeedMode::PerRevolution => {
                let rpm = self.spindle.map(|(rpm, _)| rpm).filter(|rpm| *rpm > 0.0);
                let rpm = rpm.ok_or(PostError::NoRevolutions { index })?;
                feed * per_mm / rpm
            }
            FeedMode::InverseTime => feed / length,
        };
        self.feed_format.count(stated).filter(|c| *c > 0).ok_or(PostError::Feed { index, feed })
    }
}

/// The tools that a program calls, in order.
fn tool_calls(program: &Program) -> std::collections::VecDeque<u32> {
    let tool = |event: &Event| match event.kind {
        EventKind::ToolChange { tool } => Some(tool),
        _ => None,
    };
    program.events.iter().filter_map(tool).collect()
}
