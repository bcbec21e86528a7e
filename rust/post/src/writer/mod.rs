//! Motion to text: who walks through a program and decides what is said next.

mod cycl_def;
mod dialect;
mod klartext;
mod lines;
mod mcall;
mod words;

use std::collections::BTreeMap;
use std::io;

use styluscam_motion::{
    Arc, ArcWay, Cycle, Event, EventKind, Move, MoveKind, OperationRecord, Program, SpindleDirection, ToolRecord,
};

use crate::inspect::Inspector;
use crate::machine::{CoolantRules, Family, FeedMode, Lathe, Machine, SpeedUnit, ToolChange, Turns};
use crate::number::NumberFormat;
use crate::post_error::PostError;
use crate::rounded::RoundedArc;
use crate::template::{Facts, Templater};
use dialect::{Dialect, Hole, Place, Thread};
pub(crate) use lines::counted_length;
use lines::{Lines, Outlet};

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
/// blocks, the higher way: rapids of many machines do not follow a straight line. The spindle stops before a tool change.
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
    position: Place,
    /// The tip's last place, as planned.
    tip: Option<[f64; 3]>,
    tool: Option<&'a ToolRecord>,
    operation: Option<u32>,
    /// Speed of the spindle, rev/min, while it turns.
    rpm: Option<f64>,
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
            lines: Lines::new(machine, outlet, capacity),
            dialect,
            linear: machine.linear_format(),
            feed_format: machine.feed_format(),
            per_mm: machine.units.output.in_mm().recip(),
            x_scale: if machine.motion.lathe == Some(Lathe::Diameter) { 2.0 } else { 1.0 },
            moves: 0,
            events: 0,
            calls: tool_calls(head),
            motion_line: 0,
            position: [None; 3],
            tip: None,
            tool: None,
            operation: None,
            rpm: None,
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
        self.switch_off()?;
        let end = self.templater.program_end(&self.names)?;
        self.lines.text(&end)?;
        self.lines.finish()
    }

    /// All of a program; `arrived` takes the line of every move.
    fn walk(&mut self, program: &Program, mut arrived: impl FnMut(u32)) -> Result<(), PostError> {
        self.inspector.inspect_order(program)?;
        let mut events = program.events.iter().peekable();
        let mut cycles = program.cycles.iter().peekable();
        let mut index = 0;
        while let Some(step) = program.moves.get(index) {
            if self.operation.is_some_and(|operation| operation != step.operation) {
                self.end_operation()?;
            }
            while let Some(event) = events.next_if(|e| e.before <= index) {
                self.event(&event.kind)?;
            }
            let cycle = cycles.next_if(|cycle| cycle.first == index).filter(|cycle| self.has(cycle));
            if cycle.is_some_and(|cycle| cycle.kind.is_tapping() && holds_others(program, cycle)) {
                return Err(PostError::Unsupported { what: "something between the moves of a tapping cycle" });
            }
            let cycle = cycle.filter(|cycle| !holds_others(program, cycle));
            if let Some(cycle) = cycle {
                let count = cycle.count.max(1);
                self.hole(cycle, program.moves.get(index..index + count).unwrap_or_default())?;
                // its last event may come after its last move: the spindle turns again, as it did before
                let own = |e: &&Event| e.before < index + count || e.before == index + count && self.turns_so(&e.kind);
                while events.next_if(own).is_some() {}
                (0..count).for_each(|_| arrived(self.motion_line));
                index += count;
            } else {
                self.step(step)?;
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

    // Events

    /// What happens before the next move.
    ///
    /// # Errors
    /// [`PostError`]: something that the machine does not have.
    pub fn event(&mut self, event: &EventKind) -> Result<(), PostError> {
        let number = self.events;
        self.events += 1;
        self.inspector.event(number, event)?;
        self.dialect.close(&mut self.lines)?;
        match event {
            EventKind::ToolChange { tool } => self.change_tool(number, *tool),
            EventKind::SpindleOn { rpm, direction } => self.start_spindle(number, *rpm, *direction),
            EventKind::SpindleOff => self.stop_spindle(),
            EventKind::Mist { on } => {
                self.mist = *on;
                self.switch_coolant(*on, |words| words.mist.as_deref())
            }
            EventKind::Flood { on } => {
                self.flood = *on;
                self.switch_coolant(*on, |words| words.flood.as_deref())
            }
            EventKind::Comment { text } => self.lines.comment(text),
            EventKind::Dwell { seconds } => self.dwell(number, *seconds),
            EventKind::Stop { optional } => self.stop(*optional),
            EventKind::WorkOffset { wcs } => self.change_wcs(wcs),
            EventKind::Probe { end, feed, must_touch } => self.probe(number, *end, *feed, *must_touch),
            EventKind::Raw { text } => self.raw(text),
            EventKind::Sync { mark } => self.sync(*mark),
        }
    }

    fn change_tool(&mut self, event: usize, tool: u32) -> Result<(), PostError> {
        let first = self.tool.is_none();
        if !first && matches!(self.machine.tool.change, ToolChange::LoadBeforeStart | ToolChange::Unsaid) {
            return Err(PostError::ToolChange { event });
        }
        if self.rpm.is_some() {
            self.stop_spindle()?;
        }
        let record = self.head.tools.get(tool as usize);
        let record =
            record.ok_or(PostError::NoSuchRecord { place: format!("events[{event}]"), what: "tool", index: tool })?;
        let next = self.next_tool();
        let text = self.templater.tool_change(&self.names, record, first, next)?;
        self.lines.mark();
        self.speak(&text)?;
        self.tool = Some(record);
        self.dialect.tool_changed(record.length_offset);
        self.position = [None; 3];
        self.dialect.forget();
        Ok(())
    }

    /// The number of the tool after this one, where the head of the program says so.
    fn next_tool(&mut self) -> Option<u32> {
        self.calls.pop_front();
        let next = self.calls.front()?;
        self.head.tools.get(*next as usize).map(|tool| tool.number)
    }

    fn start_spindle(&mut self, event: usize, rpm: f64, direction: SpindleDirection) -> Result<(), PostError> {
        let words = &self.machine.spindle;
        let word = match direction {
            SpindleDirection::Clockwise => words.clockwise.as_deref(),
            SpindleDirection::Counterclockwise => words.counterclockwise.as_deref(),
        };
        let word = word.ok_or(PostError::SpindleDirection { direction })?;
        let speed = self.speed_count(rpm)?;
        self.dialect.spindle(&mut self.lines, speed, word)?;
        self.rpm = Some(rpm);
        if words.start_dwell > 0.0 && rpm > 0.0 {
            return self.dwell(event, words.start_dwell);
        }
        Ok(())
    }

    /// A speed as the machine counts it, in last places.
    fn speed_count(&self, rpm: f64) -> Result<i64, PostError> {
        let speed = match (self.machine.spindle.unit, self.machine.limits.max_rpm) {
            (SpeedUnit::Percent, Some(most)) => 100.0 * rpm / most,
            _ => rpm,
        };
        let too_large = PostError::SpindleSpeed { rpm, min: 0.0, max: f64::INFINITY };
        NumberFormat::plain(self.machine.number.rpm).count(speed).ok_or(too_large)
    }

    /// Whether an event turns the spindle as it turns.
    #[allow(clippy::float_cmp)] // the same number, not a near one
    fn turns_so(&self, kind: &EventKind) -> bool {
        matches!(kind, EventKind::SpindleOn { rpm, .. } if self.rpm == Some(*rpm))
    }

    fn stop_spindle(&mut self) -> Result<(), PostError> {
        self.rpm = None;
        let words = &self.machine.spindle;
        if words.clockwise.is_none() && words.counterclockwise.is_none() {
            return Ok(()); // what cannot turn stands
        }
        self.block_of(self.machine.spindle.off.as_deref(), "the spindle's stop")
    }

    /// One word switches all coolant off: what is to stay on is said again.
    fn switch_coolant(&mut self, on: bool, word: fn(&CoolantRules) -> Option<&str>) -> Result<(), PostError> {
        let words = &self.machine.coolant;
        if !on && words.mist.is_none() && words.flood.is_none() {
            return Ok(()); // there is nothing to switch off
        }
        self.block_of(if on { word(words) } else { words.off.as_deref() }, "coolant")?;
        let left = [(self.mist, &words.mist), (self.flood, &words.flood)];
        let left = left.into_iter().filter(|(stays, _)| *stays && !on);
        left.map(|(_, word)| word.as_deref()).try_for_each(|word| self.lines.block(word.unwrap_or_default()))
    }

    /// Not every program's end stops what still runs.
    fn switch_off(&mut self) -> Result<(), PostError> {
        if std::mem::take(&mut self.mist) | std::mem::take(&mut self.flood) {
            self.switch_coolant(false, |_| None)?;
        }
        if self.rpm.is_some() {
            self.stop_spindle()?;
        }
        Ok(())
    }

    fn block_of(&mut self, word: Option<&str>, what: &'static str) -> Result<(), PostError> {
        let word = word.ok_or(PostError::Unsupported { what })?;
        self.lines.block(word)
    }

    fn dwell(&mut self, event: usize, seconds: f64) -> Result<(), PostError> {
        if self.machine.dwell.is_none() {
            return Err(PostError::Unsupported { what: "a dwell" });
        }
        if self.dialect.dwell(&mut self.lines, seconds)? {
            return Ok(());
        }
        Err(PostError::Number { what: "the dwell", place: format!("events[{event}]"), value: seconds })
    }

    fn stop(&mut self, optional: bool) -> Result<(), PostError> {
        if self.machine.templates.stop.is_some() {
            let text = self.templater.stop(&self.names, optional)?;
            return self.speak(&text);
        }
        let words = &self.machine.stop;
        let (word, what) =
            if optional { (&words.optional, "an optional stop") } else { (&words.always, "a program stop") };
        self.block_of(word.as_deref(), what)
    }

    /// Where the tool stands in the new work offset is not known.
    fn change_wcs(&mut self, wcs: &str) -> Result<(), PostError> {
        if !self.machine.wcs.iter().any(|known| known == wcs) {
            return Err(PostError::Wcs { wcs: wcs.into(), allowed: self.machine.wcs.join(", ") });
        }
        let text = self.templater.work_offset(&self.names, wcs)?;
        self.position = [None; 3];
        self.speak(&text)
    }

    fn probe(&mut self, event: usize, end: [Option<f64>; 3], feed: f64, must_touch: bool) -> Result<(), PostError> {
        let rules = self.machine.probe.as_ref().ok_or(PostError::Unsupported { what: "probing" })?;
        let word = if must_touch { Some(&rules.must_touch) } else { rules.may_touch.as_ref() };
        let word = word.ok_or(PostError::Unsupported { what: "probing that may miss" })?;
        let height = self.tool.ok_or(PostError::NoTool { index: self.moves })?.reference_height;
        let mut to = [None; 3];
        for (axis, place) in end.into_iter().enumerate() {
            let Some(place) = place else { continue };
            let place = place + if axis == 2 { height } else { 0.0 };
            let count = self.linear.count(place * self.per_mm);
            let at = || PostError::Number { what: "a place", place: format!("events[{event}]"), value: place };
            to[axis] = Some(count.ok_or_else(at)?);
        }
        let count = self.feed_count(self.moves, feed, f64::INFINITY)?;
        self.dialect.probe(&mut self.lines, word, to, count)?;
        self.dialect.forget();
        for (axis, place) in to.into_iter().enumerate() {
            if place.is_some() {
                self.position[axis] = None;
            }
        }
        Ok(())
    }

    /// A line of one's own must not move an axis, and it may change modes.
    fn raw(&mut self, text: &str) -> Result<(), PostError> {
        self.speak(text)
    }

    fn sync(&mut self, mark: u32) -> Result<(), PostError> {
        if self.machine.templates.sync.is_none() {
            return Err(PostError::Unsupported { what: "waiting for another program" });
        }
        let text = self.templater.sync(&self.names, mark)?;
        self.speak(&text)
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
        let target = self.target(index, step.end)?;
        match (step.kind, step.arc) {
            (MoveKind::Rapid, _) => self.rapid(target)?,
            (MoveKind::Feed, None) => self.feed(index, target, step.feed, step.length(self.tip.unwrap_or(step.end)))?,
            (MoveKind::Feed, Some(arc)) => self.arc(index, step, arc)?,
        }
        self.tip = Some(step.end);
        self.moves += 1;
        Ok(())
    }

    /// A tip's place as the active tool's reference point, in last places.
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

    fn rapid(&mut self, target: [i64; 3]) -> Result<(), PostError> {
        let goal = target.map(Some);
        if self.position == goal {
            return Ok(());
        }
        for place in self.rapids_to(target).into_iter().flatten() {
            if place != self.position {
                self.motion_line = self.lines.line;
                self.dialect.rapid(&mut self.lines, self.position, place)?;
                self.position = place;
            }
        }
        Ok(())
    }

    /// The place on the way, if any, and the goal. From a place that is not known: away from the work first, then across.
    fn rapids_to(&self, target: [i64; 3]) -> [Option<Place>; 2] {
        let away = if self.machine.motion.lathe.is_some() { 0 } else { 2 };
        let goal = target.map(Some);
        let mut on_the_way = self.position;
        let known = self.position.iter().all(Option::is_some);
        let across = (0..3).any(|axis| axis != away && self.position[axis] != goal[axis]);
        let rises = self.position[away].is_none_or(|from| target[away] > from);
        match self.machine.motion.split_rapids || !known {
            true if across && (!known || rises) => on_the_way[away] = goal[away],
            true if across => on_the_way = std::array::from_fn(|i| if i == away { self.position[i] } else { goal[i] }),
            _ => return [Some(goal), None],
        }
        [Some(on_the_way), Some(goal)]
    }

    fn feed(&mut self, index: usize, target: [i64; 3], feed: f64, length: f64) -> Result<(), PostError> {
        let from = self.position(index)?;
        if from == target {
            return Ok(());
        }
        let feed = self.feed_count(index, feed, length)?;
        self.motion_line = self.lines.line;
        self.dialect.feed(&mut self.lines, self.position, target.map(Some), feed)?;
        self.position = target.map(Some);
        Ok(())
    }

    fn position(&self, index: usize) -> Result<[i64; 3], PostError> {
        let [Some(x), Some(y), Some(z)] = self.position else { return Err(PostError::FeedFromUnknown { index }) };
        Ok([x, y, z])
    }

    /// A feed, mm/min, as the mode in force says it, in last places; `length` is that of the block's way, mm.
    fn feed_count(&self, index: usize, feed: f64, length: f64) -> Result<i64, PostError> {
        let per_mm = self.per_mm * self.machine.feed_scale();
        let said = match self.machine.feed.mode {
            FeedMode::PerMinute => feed * per_mm,
            FeedMode::PerRevolution => {
                let rpm = self.rpm.filter(|rpm| *rpm > 0.0).ok_or(PostError::NoRevolutions { index })?;
                feed * per_mm / rpm
            }
            FeedMode::InverseTime => feed / length,
        };
        self.feed_format.count(said).filter(|c| *c > 0).ok_or(PostError::Feed { index, feed })
    }

    // Arcs

    /// An arc in as many blocks as the machine needs; as lines where it would not take the rounded numbers.
    fn arc(&mut self, index: usize, step: &Move, arc: Arc) -> Result<(), PostError> {
        self.position(index)?;
        let way = arc.way(self.tip.unwrap_or(step.end), step.end);
        let rules = self.machine.arc.as_ref();
        let (pieces, turns) = match rules {
            Some(rules) if rules.turns != Turns::None && rules.max_sweep_deg >= 360.0 => (1, arc.turns),
            Some(rules) => ((way.sweep().abs().to_degrees() / rules.max_sweep_deg - 1e-9).ceil().max(1.0) as u32, 0),
            None => (1, 0),
        };
        let arc = Arc { turns, ..arc };
        let share = |i: u32| f64::from(i) / f64::from(pieces);
        for piece in 0..pieces {
            let part = way.part(share(piece), share(piece + 1));
            let rounded = self.rounded(index, arc, &part)?;
            match rules.filter(|rules| rounded.stands_for(&part, rules, self.machine.resolution_mm())) {
                Some(_) => self.circle(index, step.feed, &rounded, part.length())?,
                None => self.chords(index, step.feed, &part)?,
            }
        }
        Ok(())
    }

    fn rounded(&self, index: usize, arc: Arc, way: &ArcWay) -> Result<RoundedArc, PostError> {
        let from = self.position(index)?;
        let to = self.target(index, way.at(1.0))?;
        let mut arc_centre = [0; 3];
        let height = self.tool.map_or(0.0, |tool| tool.reference_height);
        for axis in arc.plane.axes().into_iter().take(2) {
            let mm = arc.centre[axis] + if axis == 2 { height } else { 0.0 };
            arc_centre[axis] = self.count(index, "the centre", mm)?;
        }
        Ok(RoundedArc::new(arc, from, to, arc_centre, self.x_scale))
    }

    fn circle(&mut self, index: usize, feed: f64, rounded: &RoundedArc, length: f64) -> Result<(), PostError> {
        let feed = self.feed_count(index, feed, length)?;
        let before = self.lines.line;
        self.dialect.arc(&mut self.lines, rounded, feed)?;
        self.motion_line = (self.lines.line - 1).max(before);
        self.position = rounded.to.map(Some);
        Ok(())
    }

    fn chords(&mut self, index: usize, feed: f64, way: &ArcWay) -> Result<(), PostError> {
        let count = way.chords(self.machine.resolution_mm());
        for chord in 1..=count {
            let target = self.target(index, way.at(chord as f64 / count as f64))?;
            self.feed(index, target, feed, way.length() / count as f64)?;
        }
        Ok(())
    }

    // Holes

    /// Whether the machine has a cycle for this.
    fn has(&self, cycle: &Cycle) -> bool {
        self.machine.cycle.as_ref().is_some_and(|rules| rules.take(cycle))
    }

    /// A hole by the machine's own cycle; `moves` are those that it makes.
    fn hole(&mut self, cycle: &Cycle, moves: &[Move]) -> Result<(), PostError> {
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
fn holds_others(program: &Program, cycle: &Cycle) -> bool {
    let on_its_way = cycle.first + 1..cycle.first + cycle.count;
    let own = |kind: &EventKind| {
        matches!(kind, EventKind::Dwell { .. } | EventKind::SpindleOn { .. } | EventKind::SpindleOff)
    };
    let first = program.events.partition_point(|event| event.before < on_its_way.start);
    let events = program.events.iter().skip(first).take_while(|event| on_its_way.contains(&event.before));
    events.into_iter().any(|event| !own(&event.kind))
}

/// The tools that a program calls, in order.
fn tool_calls(program: &Program) -> std::collections::VecDeque<u32> {
    let tool = |event: &Event| match event.kind {
        EventKind::ToolChange { tool } => Some(tool),
        _ => None,
    };
    program.events.iter().filter_map(tool).collect()
}
