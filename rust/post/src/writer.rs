//! Motion to text: the writer of G-code.

use styluscam_motion::{Arc, ArcWay, Event, EventKind, Move, MoveKind, Plane, Program, SpindleDirection, ToolRecord};

use crate::comment::CommentFormat;
use crate::inspect::inspect;
use crate::machine::{CoolantRules, Counted, LineEnd, Machine, Repeat, Separator, TimeUnit, ToolChange};
use crate::number::{write_integer, NumberFormat};
use crate::post_error::PostError;
use crate::rounded::RoundedArc;
use crate::template::Templater;

/// A posted program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Posted {
    /// The text, with the machine's line ends.
    pub text: String,
    /// For each move the line, from 1, with which the machine arrives at its end; for a move that rounds to no motion, the line that had arrived there.
    pub line_of_move: Vec<u32>,
}

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
    machine.check()?;
    inspect(program, machine)?;
    let mut writer = Writer::new(program, machine)?;
    writer.write_start()?;
    writer.write_body()?;
    writer.write_end()?;
    Ok(Posted { text: writer.out, line_of_move: writer.line_of_move })
}

const RAPID: &str = "G0";
const LINE: &str = "G1";
const CLOCKWISE: &str = "G2";
const COUNTERCLOCKWISE: &str = "G3";
const AXES: [char; 3] = ['X', 'Y', 'Z'];
/// The letters of a centre's offsets from its arc's start.
const OFFSETS: [char; 3] = ['I', 'J', 'K'];

/// Typical length of a motion block, to reserve memory.
const TYPICAL_BLOCK: usize = 24;

struct Writer<'a> {
    machine: &'a Machine,
    program: &'a Program,
    templater: Templater<'a>,
    names: std::collections::BTreeMap<String, minijinja::Value>,
    comments: CommentFormat,
    linear: NumberFormat,
    feed_format: NumberFormat,
    /// Output units in one mm.
    per_mm: f64,
    out: String,
    line_start: usize,
    line: u32,
    line_of_move: Vec<u32>,
    /// The last line with motion.
    motion_line: u32,
    block_number: Option<u32>,
    /// Where the posted point stands, in last places; none where that is not known.
    position: [Option<i64>; 3],
    motion: Option<&'static str>,
    plane: Option<Plane>,
    feed: Option<i64>,
    tool: Option<&'a ToolRecord>,
    operation: Option<u32>,
    spindle_turns: bool,
}

impl<'a> Writer<'a> {
    fn new(program: &'a Program, machine: &'a Machine) -> Result<Self, PostError> {
        let templater = Templater::new(machine);
        let names = templater.names(program)?;
        Ok(Self {
            machine,
            program,
            templater,
            names,
            comments: CommentFormat::new(machine),
            linear: machine.linear_format(),
            feed_format: machine.feed_format(),
            per_mm: machine.units.output.in_mm().recip(),
            out: String::with_capacity(program.moves.len().saturating_mul(TYPICAL_BLOCK)),
            line_start: 0,
            line: 1,
            line_of_move: Vec::with_capacity(program.moves.len()),
            motion_line: 0,
            block_number: machine.block_number.map(|b| b.start),
            position: [None; 3],
            motion: None,
            plane: None,
            feed: None,
            tool: None,
            operation: None,
            spindle_turns: false,
        })
    }

    fn write_start(&mut self) -> Result<(), PostError> {
        let text = self.templater.program_start(&self.names)?;
        self.write_text(&text)
    }

    fn write_end(&mut self) -> Result<(), PostError> {
        let text = self.templater.program_end(&self.names)?;
        self.write_text(&text)
    }

    fn write_body(&mut self) -> Result<(), PostError> {
        let mut events = self.program.events.iter().enumerate().peekable();
        for (index, step) in self.program.moves.iter().enumerate() {
            while let Some((number, event)) = events.next_if(|(_, e)| e.before <= index) {
                self.write_event(number, event)?;
            }
            self.start_operation(step.operation)?;
            self.write_move(index, step)?;
        }
        for (number, event) in events {
            self.write_event(number, event)?;
        }
        Ok(())
    }

    fn start_operation(&mut self, operation: u32) -> Result<(), PostError> {
        if self.operation == Some(operation) {
            return Ok(());
        }
        self.operation = Some(operation);
        let Some(record) = self.program.operations.get(operation as usize) else { return Ok(()) };
        let text = self.templater.operation_start(&self.names, record)?;
        self.forget_modes();
        self.write_text(&text)
    }

    /// Text of templates may have changed modes: say them again.
    fn forget_modes(&mut self) {
        self.motion = None;
        self.plane = None;
        self.feed = None;
    }

    // Events

    fn write_event(&mut self, number: usize, event: &Event) -> Result<(), PostError> {
        match &event.kind {
            EventKind::ToolChange { tool } => self.change_tool(number, *tool),
            EventKind::SpindleOn { rpm, direction } => self.start_spindle(*rpm, *direction),
            EventKind::SpindleOff => self.stop_spindle(),
            EventKind::Mist { on } => self.switch_coolant(*on, |words| words.mist.as_deref()),
            EventKind::Flood { on } => self.switch_coolant(*on, |words| words.flood.as_deref()),
            EventKind::Comment { text } => self.write_comment(text),
            EventKind::Dwell { seconds } => self.dwell(number, *seconds),
        }
    }

    fn change_tool(&mut self, event: usize, tool: u32) -> Result<(), PostError> {
        let first = self.tool.is_none();
        if !first && self.machine.tool.change == ToolChange::LoadBeforeStart {
            return Err(PostError::ToolChange { event });
        }
        if self.spindle_turns {
            self.stop_spindle()?;
        }
        let record = self.program.tools.get(tool as usize);
        let record =
            record.ok_or(PostError::NoSuchRecord { place: format!("events[{event}]"), what: "tool", index: tool })?;
        let text = self.templater.tool_change(&self.names, record, first)?;
        self.write_text(&text)?;
        self.tool = Some(record);
        self.position = [None; 3];
        self.forget_modes();
        Ok(())
    }

    fn start_spindle(&mut self, rpm: f64, direction: SpindleDirection) -> Result<(), PostError> {
        let words = &self.machine.spindle;
        let word = match direction {
            SpindleDirection::Clockwise => words.clockwise.as_deref(),
            SpindleDirection::Counterclockwise => words.counterclockwise.as_deref(),
        };
        let word = word.ok_or(PostError::SpindleDirection { direction })?;
        let format = NumberFormat::plain(self.machine.number.rpm);
        let too_large = PostError::SpindleSpeed { rpm, max: f64::INFINITY };
        let speed = format.count(rpm).ok_or(too_large)?;
        self.begin_block();
        self.out.push('S');
        format.write(&mut self.out, speed);
        self.separate();
        self.out.push_str(word);
        self.spindle_turns = true;
        self.end_block()
    }

    fn stop_spindle(&mut self) -> Result<(), PostError> {
        self.spindle_turns = false;
        self.write_word(self.machine.spindle.off.as_deref(), "the spindle's stop")
    }

    /// One word switches all coolant off.
    fn switch_coolant(&mut self, on: bool, word: fn(&CoolantRules) -> Option<&str>) -> Result<(), PostError> {
        let words = &self.machine.coolant;
        self.write_word(if on { word(words) } else { words.off.as_deref() }, "coolant")
    }

    fn write_word(&mut self, word: Option<&str>, what: &'static str) -> Result<(), PostError> {
        let word = word.ok_or(PostError::Unsupported { what })?;
        self.begin_block();
        self.out.push_str(word);
        self.end_block()
    }

    fn write_comment(&mut self, text: &str) -> Result<(), PostError> {
        self.comments.lines(text).iter().try_for_each(|line| self.write_line(line))
    }

    fn dwell(&mut self, event: usize, seconds: f64) -> Result<(), PostError> {
        let rules = self.machine.dwell.as_ref().ok_or(PostError::Unsupported { what: "a dwell" })?;
        let (decimals, per_second) = if rules.unit == TimeUnit::S { (3, 1.0) } else { (0, 1000.0) };
        let format = match rules.unit {
            TimeUnit::S => NumberFormat::new(&self.machine.number, decimals),
            TimeUnit::Ms => NumberFormat::plain(decimals),
        };
        let number = PostError::Number { what: "the dwell", place: format!("events[{event}]"), value: seconds };
        let time = format.count(seconds * per_second).ok_or(number)?;
        self.begin_block();
        self.out.push_str("G4");
        self.separate();
        self.out.push(rules.word);
        format.write(&mut self.out, time);
        self.end_block()
    }

    // Moves

    fn write_move(&mut self, index: usize, step: &Move) -> Result<(), PostError> {
        let target = self.target(index, step.end)?;
        match (step.kind, step.arc) {
            (MoveKind::Rapid, _) => self.write_rapid(target)?,
            (MoveKind::Feed, None) => self.write_feed(index, target, step.feed)?,
            (MoveKind::Feed, Some(arc)) => self.write_arc(index, step, arc)?,
        }
        self.line_of_move.push(self.motion_line);
        Ok(())
    }

    /// A tip's place as the active tool's reference point, in last places.
    fn target(&self, index: usize, tip: [f64; 3]) -> Result<[i64; 3], PostError> {
        let height = self.tool.ok_or(PostError::NoTool { index })?.reference_height;
        let [x, y, z] = [tip[0], tip[1], tip[2] + height];
        Ok([self.count(index, "X", x)?, self.count(index, "Y", y)?, self.count(index, "Z", z)?])
    }

    fn count(&self, index: usize, what: &'static str, mm: f64) -> Result<i64, PostError> {
        let count = self.linear.count(mm * self.per_mm);
        count.ok_or_else(|| PostError::Number { what, place: format!("moves[{index}]"), value: mm })
    }

    fn write_rapid(&mut self, target: [i64; 3]) -> Result<(), PostError> {
        let [from_x, from_y, from_z] = self.position;
        let [x, y, z] = target;
        let (Some(from_x), Some(from_y), Some(from_z)) = (from_x, from_y, from_z) else {
            return self.write_first_rapid(target);
        };
        let across = from_x != x || from_y != y;
        if across && z > from_z {
            self.write_block(RAPID, [from_x, from_y, z], None)?;
        } else if across && z < from_z {
            self.write_block(RAPID, [x, y, from_z], None)?;
        }
        self.write_block(RAPID, target, None)
    }

    /// From wherever the machine stands: to the height first, then across.
    fn write_first_rapid(&mut self, [x, y, z]: [i64; 3]) -> Result<(), PostError> {
        self.begin_motion(RAPID);
        self.write_axis('Z', z);
        self.end_block()?;
        self.begin_motion(RAPID);
        self.write_axis('X', x);
        self.write_axis('Y', y);
        self.position = [Some(x), Some(y), Some(z)];
        self.end_block()
    }

    fn write_feed(&mut self, index: usize, target: [i64; 3], feed: f64) -> Result<(), PostError> {
        self.position(index)?;
        let count = self.feed_count(index, feed)?;
        self.write_block(LINE, target, Some(count))
    }

    fn position(&self, index: usize) -> Result<[i64; 3], PostError> {
        let [Some(x), Some(y), Some(z)] = self.position else { return Err(PostError::FeedFromUnknown { index }) };
        Ok([x, y, z])
    }

    fn feed_count(&self, index: usize, feed: f64) -> Result<i64, PostError> {
        let count = self.feed_format.count(feed * self.per_mm).filter(|c| *c > 0);
        count.ok_or(PostError::Feed { index, feed })
    }

    // Arcs

    /// An arc, turn by turn where the machine has no word for turns; as lines where it would not take the rounded numbers.
    fn write_arc(&mut self, index: usize, step: &Move, arc: Arc) -> Result<(), PostError> {
        self.position(index)?;
        let start = index.checked_sub(1).and_then(|before| self.program.moves.get(before));
        let way = arc.way(start.map_or(step.end, |m| m.end), step.end);
        let pieces = if self.machine.arc.is_some_and(|r| r.turns) { 1 } else { arc.turns + 1 };
        let arc = Arc { turns: if pieces == 1 { arc.turns } else { 0 }, ..arc };
        let share = |i: u32| f64::from(i) / f64::from(pieces);
        for piece in 0..pieces {
            let part = way.part(share(piece), share(piece + 1));
            let rounded = self.rounded(index, arc, &part)?;
            let unit = self.machine.resolution_mm();
            match self.machine.arc.filter(|rules| rounded.stands_for(&part, rules, unit)) {
                Some(_) => self.write_circle(index, step.feed, &rounded)?,
                None => self.write_chords(index, step.feed, &part)?,
            }
        }
        Ok(())
    }

    fn rounded(&self, index: usize, arc: Arc, way: &ArcWay) -> Result<RoundedArc, PostError> {
        let from = self.position(index)?;
        let centre = self.target(index, arc.centre)?;
        let offset = [0, 1, 2].map(|axis| centre[axis] - from[axis]);
        Ok(RoundedArc { arc, from, to: self.target(index, way.at(1.0))?, offset })
    }

    fn write_circle(&mut self, index: usize, feed: f64, rounded: &RoundedArc) -> Result<(), PostError> {
        let feed = self.feed_count(index, feed)?;
        let [first, second, third] = rounded.arc.plane.axes();
        self.write_plane(rounded.arc.plane)?;
        self.begin_motion(if rounded.arc.clockwise { CLOCKWISE } else { COUNTERCLOCKWISE });
        let places = AXES.into_iter().zip(rounded.from).zip(rounded.to).enumerate();
        for (axis, ((letter, from), to)) in places {
            if axis != third || from != to {
                self.write_axis(letter, to);
            }
        }
        for axis in [first, second] {
            self.write_axis(OFFSETS[axis], rounded.offset[axis]);
        }
        if rounded.arc.turns > 0 {
            self.separate();
            self.out.push('P');
            write_integer(&mut self.out, u64::from(rounded.arc.turns) + 1);
        }
        self.write_changed_feed(feed);
        self.position = rounded.to.map(Some);
        self.end_block()
    }

    fn write_plane(&mut self, plane: Plane) -> Result<(), PostError> {
        if self.plane == Some(plane) {
            return Ok(());
        }
        self.plane = Some(plane);
        self.begin_block();
        self.out.push_str(match plane {
            Plane::Xy => "G17",
            Plane::Zx => "G18",
            Plane::Yz => "G19",
        });
        self.end_block()
    }

    fn write_chords(&mut self, index: usize, feed: f64, way: &ArcWay) -> Result<(), PostError> {
        let count = way.chords(self.machine.resolution_mm());
        for chord in 1..=count {
            let target = self.target(index, way.at(chord as f64 / count as f64))?;
            self.write_feed(index, target, feed)?;
        }
        Ok(())
    }

    /// A block of motion from a known place; nothing when there is no motion in it.
    fn write_block(&mut self, word: &'static str, target: [i64; 3], feed: Option<i64>) -> Result<(), PostError> {
        let goal = target.map(Some);
        if self.position == goal {
            return Ok(());
        }
        let every_axis = self.machine.words.repeat_axes == Repeat::Always;
        self.begin_motion(word);
        let places = self.position.into_iter().zip(target);
        for (axis, (from, to)) in AXES.into_iter().zip(places) {
            if every_axis || from != Some(to) {
                self.write_axis(axis, to);
            }
        }
        if let Some(feed) = feed {
            self.write_changed_feed(feed);
        }
        self.position = goal;
        self.end_block()
    }

    fn write_changed_feed(&mut self, feed: i64) {
        if self.feed == Some(feed) {
            return;
        }
        self.separate();
        self.out.push('F');
        self.feed_format.write(&mut self.out, feed);
        self.feed = Some(feed);
    }

    fn begin_motion(&mut self, word: &'static str) {
        self.motion_line = self.line;
        self.begin_block();
        if self.motion != Some(word) || self.machine.words.repeat_g == Repeat::Always {
            self.out.push_str(word);
            self.motion = Some(word);
        }
    }

    fn write_axis(&mut self, axis: char, count: i64) {
        self.separate();
        self.out.push(axis);
        self.linear.write(&mut self.out, count);
    }

    // Lines

    /// Lines of a template, without the empty ones.
    fn write_text(&mut self, text: &str) -> Result<(), PostError> {
        text.lines().map(str::trim_end).filter(|l| !l.is_empty()).try_for_each(|line| self.write_line(line))
    }

    fn write_line(&mut self, line: &str) -> Result<(), PostError> {
        if let Some(character) = line.chars().find(|c| !self.takes(*c)) {
            return Err(PostError::Character { line: self.line, character });
        }
        if !line.starts_with(['(', ';', '%']) {
            self.begin_block();
        }
        self.out.push_str(line);
        self.end_block()
    }

    fn takes(&self, c: char) -> bool {
        // A line that is a program's mark holds nothing else, and the template's author wrote it.
        (' '..='~').contains(&c) && !self.machine.line.forbidden.contains(c)
    }

    fn begin_block(&mut self) {
        let (Some(rules), Some(number)) = (self.machine.block_number, self.block_number) else { return };
        self.out.push('N');
        write_integer(&mut self.out, u64::from(number));
        if self.machine.words.separator == Separator::Space {
            self.out.push(' ');
        }
        let next = number.saturating_add(rules.step);
        self.block_number = Some(if next > rules.max { rules.start } else { next });
    }

    /// A space between two words; none at a line's start or after a number's.
    fn separate(&mut self) {
        let at_start = self.out.len() == self.line_start || self.out.ends_with(' ');
        if !at_start && self.machine.words.separator == Separator::Space {
            self.out.push(' ');
        }
    }

    fn end_block(&mut self) -> Result<(), PostError> {
        self.check_length()?;
        self.out.push_str(match self.machine.line.eol {
            LineEnd::Lf => "\n",
            LineEnd::Crlf => "\r\n",
        });
        self.line_start = self.out.len();
        self.line = self.line.saturating_add(1);
        Ok(())
    }

    fn check_length(&self) -> Result<(), PostError> {
        let max = self.machine.line.max_chars;
        if self.out.len() - self.line_start <= max as usize {
            return Ok(());
        }
        let length = counted_length(self.out.get(self.line_start..).unwrap_or_default(), self.machine.line.counted);
        if length <= max as usize {
            return Ok(());
        }
        Err(PostError::LineTooLong { line: self.line, length, max })
    }
}

/// A line's length as the controller counts it.
pub(crate) fn counted_length(line: &str, counted: Counted) -> usize {
    match counted {
        Counted::All => line.chars().count(),
        Counted::Code => code_length(line),
    }
}

/// Characters outside comments, without white space.
fn code_length(line: &str) -> usize {
    let mut inside = false;
    let mut length = 0;
    for c in line.chars() {
        match c {
            ';' if !inside => break,
            '(' => inside = true,
            ')' => inside = false,
            _ if inside || c.is_whitespace() => {}
            _ => length += 1,
        }
    }
    length
}
