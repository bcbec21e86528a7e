//! The controller's state while a program is read, and the motion that its blocks make.

mod holes;
mod machine_frame;
mod numbers;
mod positions;
mod switches;
mod tools;
mod turns;

use std::collections::BTreeMap;
use std::ops::Range;

use styluscam_motion::{Arc, EventKind, MachineMove, Move, MoveKind, Plane, ToolRecord, UnitAxis};

use super::block::Block;
use super::called::Called;
use super::circle::Circle;
use super::codes::Codes;
use super::drilling::Series;
use super::in_force::InForce;
use super::lexer::{Flaw, Word};
use super::reading::Reading;
use super::rotary::Rotary;
use super::turned::turned;
use crate::block::arc::Ends;
use crate::block::{Code, Modes, Motion, Recorder};
use crate::machine::Machine;
use crate::read_error::ReadFault;
use crate::role;

const AXES: [char; 3] = ['X', 'Y', 'Z'];
const Z: usize = 2;
/// How remarks begin that name what follows.
const OPERATION: &str = "operation ";

/// Typical length of a line, to reserve memory.
const TYPICAL_LINE: usize = 20;

/// One axis: where the posted point stands, in mm.
#[derive(Clone, Copy, Debug, Default)]
struct Axis {
    /// The last position commanded.
    position: f64,
    /// Whether it stands there still.
    known: bool,
    /// Whether it ever had a position.
    ever: bool,
    /// The first move since it is not known; that move and the following ones take the next position commanded.
    pending: usize,
}

/// The controller's state.
pub(crate) struct Interpreter<'m> {
    machine: &'m Machine,
    modes: Modes,
    distance_stated: bool,
    /// Codes that the first move relies on and that no block has stated.
    not_stated: Vec<&'static str>,
    motion: Option<Motion>,
    /// Since which move another plane than G17 is in force and no arc has used it.
    plane_not_needed_since: Option<usize>,
    planes_not_needed: Vec<Range<usize>>,
    /// Since which move Z is not known.
    unknown_height_since: Option<usize>,
    unknown_heights: Vec<Range<usize>>,
    machine_moves: Vec<MachineMove>,
    stops: Vec<usize>,
    /// Whether a stop has stopped the spindle, which turned, and nothing has started it since.
    halted: bool,
    series: Option<Series>,
    /// The cycle that is called at positions.
    called: Option<Called>,
    selected: Option<u32>,
    /// Height of the posted point above the tip, mm.
    height: f64,
    tools_given: bool,
    /// Length offsets that the text gives its tools.
    learned: BTreeMap<u32, u32>,
    /// The line of the first feed move without a length offset.
    bare_line: Option<u32>,
    /// Whether these are FreeCAD's commands: rapids before the first tool are left out (the path to the work is stated after it
    /// again), and so are the feeds of rapids and those of 0.
    loose: bool,
    in_force: InForce,
    /// Whether D0 is in force.
    without_edge: bool,
    axes: [Axis; 3],
    rotary: Option<Rotary>,
    unknown_since: Option<usize>,
    unknown_positions: Vec<Range<usize>>,
    wcs: Option<String>,
    /// The work offset in force, where one was called between moves.
    wcs_now: Option<String>,
    record: Recorder,
}

impl<'m> Interpreter<'m> {
    pub(crate) fn new(machine: &'m Machine, tools: &[ToolRecord], text_length: usize) -> Self {
        Self {
            machine,
            modes: Modes::new(machine.reader.default_units, false),
            distance_stated: false,
            not_stated: Vec::new(),
            motion: None,
            plane_not_needed_since: None,
            planes_not_needed: Vec::new(),
            unknown_height_since: Some(0),
            unknown_heights: Vec::new(),
            machine_moves: Vec::new(),
            stops: Vec::new(),
            halted: false,
            series: None,
            called: None,
            selected: None,
            height: 0.0,
            tools_given: !tools.is_empty(),
            learned: BTreeMap::new(),
            bare_line: None,
            loose: false,
            in_force: InForce::new(),
            without_edge: false,
            axes: [Axis::default(); 3],
            rotary: Rotary::of(machine),
            unknown_since: Some(0),
            unknown_positions: Vec::new(),
            wcs: None,
            wcs_now: None,
            record: Recorder::new(tools, text_length / TYPICAL_LINE),
        }
    }

    /// Notes a remark; one as the shipped templates write them, `operation ID: KIND`, names what follows.
    pub(crate) fn remark(&mut self, text: &str) {
        if let Some(role) = role::of_remark(text) {
            self.record.set_role(role);
            return;
        }
        // a machine without lower case or a colon has them otherwise
        let named = text.get(..OPERATION.len()).filter(|start| start.eq_ignore_ascii_case(OPERATION));
        let rest = named.and_then(|_| text.get(OPERATION.len()..));
        if let Some((id, kind)) = rest.and_then(|rest| rest.split_once(": ").or_else(|| rest.split_once("= "))) {
            self.record.start_operation(id, kind);
        }
        self.event(EventKind::Comment { text: text.into() });
    }

    /// FreeCAD's commands are read; the work offset may change between moves, as in a program that no job is known of.
    pub(crate) fn loosen(&mut self) {
        self.loose = true;
    }

    /// A cycle is defined for the positions that call it, or none.
    pub(super) fn define(&mut self, called: Option<Called>) {
        self.called = called;
    }

    /// What follows is an operation of its own.
    pub(crate) fn start_operation(&mut self, id: &str, kind: &str) {
        self.record.start_operation(id, kind);
    }

    /// How many moves were read.
    pub(crate) fn moves(&self) -> usize {
        self.record.program.moves.len()
    }

    /// Sets the tool's axis at the ends of moves from the `first` on, by their lines.
    pub(crate) fn lean(&mut self, first: usize, axes: &BTreeMap<u32, UnitAxis>) {
        for step in self.record.program.moves.iter_mut().skip(first) {
            if let Some(axis) = axes.get(&step.line) {
                step.end.axis = *axis;
            }
        }
    }

    /// Something that happens beside the text.
    pub(crate) fn hand_on(&mut self, kind: Option<&EventKind>) {
        kind.into_iter().for_each(|kind| self.event(kind.clone()));
    }

    /// Carries out a block, in the order in which controllers do; returns whether it ended the program.
    pub(crate) fn run(&mut self, block: &Block, codes: &Codes, line: u32) -> Result<bool, Flaw> {
        self.set_units(block)?;
        self.take_modes(block, |code| matches!(code, Code::FeedMode(_)));
        self.set_feed(block)?;
        self.set_tool(block)?;
        self.set_speed(block)?;
        let late = !self.machine.reader.stops_first;
        self.set_spindle(block, !late);
        self.set_coolant(block, !late);
        self.dwell(block)?;
        let letter = self.length_word();
        self.in_force.take_length(block, self.job_tool().map(|tool| tool.length_offset), letter)?;
        self.learn_length(block)?;
        self.set_tracking(block);
        self.set_path(block)?;
        self.set_edge(block)?;
        self.set_wcs(block, codes)?;
        self.distance_stated |= block.incremental().is_some();
        if let Some((plane, _)) = block.plane() {
            self.set_plane(plane);
        }
        self.take_modes(block, |code| !matches!(code, Code::Unit(_)));
        self.go(block, line)?;
        if late {
            self.stop_spindle(block);
            self.stop_coolant(block);
        }
        Ok(self.stop(block))
    }

    fn take_modes(&mut self, block: &Block, which: impl Fn(Code) -> bool) {
        block.codes().filter(|code| which(*code)).for_each(|code| self.modes.take(code));
    }

    fn event(&mut self, kind: EventKind) {
        self.record.event(kind);
    }

    fn set_path(&mut self, block: &Block) -> Result<(), Flaw> {
        let mut in_force = self.in_force;
        in_force.take_path(block, |word| self.mm(word))?;
        self.in_force = in_force;
        if let Some(code) = block.smoothing().filter(|_| self.loose) {
            let text = format!("G{} left out, the path mode is set by the machine file", code.number.value());
            self.event(EventKind::Comment { text });
        }
        Ok(())
    }

    fn refusal(&self) -> ReadFault {
        ReadFault::Refused { machine: self.machine.name.clone() }
    }

    fn set_wcs(&mut self, block: &Block, codes: &Codes) -> Result<(), Flaw> {
        let Some(word) = block.wcs() else { return Ok(()) };
        let index =
            codes.wcs(word, block.words.get(b'P'), block.words.get(b'H')).ok_or((ReadFault::Wcs, Some(word)))?;
        self.choose_wcs(index).map_err(|fault| (fault, Some(word)))
    }

    /// The work offset with this index is in force from here on.
    pub(crate) fn choose_wcs(&mut self, index: usize) -> Result<(), ReadFault> {
        let name = self.machine.wcs.get(index).cloned().ok_or(ReadFault::Wcs)?;
        // Before the first G54 to G59 the controller is in its first work offset.
        let called = self.wcs_now.as_deref().or(self.wcs.as_deref());
        let now = called.or(self.machine.wcs.first().map(String::as_str));
        if !self.record.program.moves.is_empty() && now != Some(name.as_str()) {
            if self.tools_given && !self.loose {
                return Err(ReadFault::WcsChanged);
            }
            let what = "work offsets that change while rotary axes are turned";
            self.require_upright(what, None).map_err(|(fault, _)| fault)?;
            self.event(EventKind::WorkOffset { wcs: name.clone() });
            self.wcs_now = Some(name);
            (0..3).for_each(|axis| self.forget(axis));
            return Ok(());
        }
        self.wcs = Some(name);
        Ok(())
    }

    fn set_plane(&mut self, plane: Plane) {
        self.close_plane_not_needed();
        self.modes.plane = plane;
        self.plane_not_needed_since = (plane != Plane::Xy).then_some(self.record.program.moves.len());
    }

    fn close_plane_not_needed(&mut self) {
        let moves = self.record.program.moves.len();
        self.planes_not_needed
            .extend(self.plane_not_needed_since.take().map(|since| since..moves).filter(|run| !run.is_empty()));
    }

    fn go(&mut self, block: &Block, line: u32) -> Result<(), Flaw> {
        if let Some((motion, _)) = block.motion() {
            self.motion = Some(motion);
        }
        self.note_start();
        if let Some((called, word)) = self.calls(block) {
            return self.drill_here(block, called, word, line);
        }
        if let Some(code) = block.machine_coordinates() {
            return self.go_to_machine_position(block, code, line);
        }
        if let Some(code) = block.home() {
            return self.go_home(block, code, line);
        }
        if let Some((must_touch, code)) = block.probe() {
            return self.probe(block, must_touch, code);
        }
        if let Some(Motion::Cycle(number)) = self.motion {
            return self.drill(block, number, line);
        }
        self.series = None;
        self.travel(block, line)
    }

    /// A line or an arc.
    fn travel(&mut self, block: &Block, line: u32) -> Result<(), Flaw> {
        let arc_words = matches!(self.motion, Some(Motion::Arc(_))).then(|| block.arc_words().next()).flatten();
        let Some(first) = block.any_axis().or(arc_words) else { return Ok(()) };
        let kind = match self.motion {
            Some(Motion::Rapid) => MoveKind::Rapid,
            Some(Motion::Feed | Motion::Arc(_)) => MoveKind::Feed,
            _ => return Err((ReadFault::NoMotionMode, Some(first))),
        };
        if self.loose && self.record.tool.is_none() && kind == MoveKind::Rapid {
            return self.turn_to(block);
        }
        self.load_only_tool(first)?;
        if kind == MoveKind::Rapid && self.only_turns(block)? {
            return self.turn_to(block);
        }
        self.allow_motion(first)?;
        if self.without_edge {
            return Err((ReadFault::NoLengthOffset { expected: 1 }, Some(first)));
        }
        let (start, from) = (self.tip(), self.angles());
        if let Some(Motion::Arc(_)) = self.motion {
            self.require_positions(first)?;
        }
        if kind == MoveKind::Feed {
            self.require_angles(first)?;
        }
        self.position_axes(block)?;
        self.turn_to(block)?;
        self.turn_axes(block)?;
        if kind == MoveKind::Feed {
            self.require_positions(first)?;
            if self.halted {
                return Err((ReadFault::Halted, Some(first)));
            }
            let bare = self.machine.tool.length.is_some() && !self.in_force.has_length();
            self.bare_line = self.bare_line.or(bare.then_some(line));
        }
        let arc = match self.motion {
            Some(Motion::Arc(clockwise)) => {
                self.plane_not_needed_since = None;
                Some(self.arc(block, start, clockwise, first)?)
            }
            _ => None,
        };
        let (feed, minutes) = match kind {
            MoveKind::Rapid => (0.0, None),
            MoveKind::Feed => {
                let length = Move::new(kind, self.tip(), 0.0).arc(arc).length(start);
                let feed = self.feed_of(block, length, first)?;
                (feed, self.minutes(from, length, feed))
            }
        };
        self.push_move_to(Move::new(kind, self.tip(), feed).arc(arc).on_line(line), minutes);
        Ok(())
    }

    /// A block of the machine's own, which moves nothing; `tolerance` is what it sets the path's to, mm.
    pub(crate) fn pass(&mut self, text: &str, tolerance: Option<f64>) {
        if let Some(tolerance) = tolerance {
            self.in_force.keep_path(tolerance);
        }
        self.event(EventKind::Raw { text: text.trim().into() });
    }

    /// Whether a canned cycle is in force after a block.
    pub(crate) fn cycle_after(&self, block: &Block) -> bool {
        matches!(block.motion().map(|(motion, _)| motion).or(self.motion), Some(Motion::Cycle(_)))
    }

    /// Whether an arc is in force after a block.
    pub(crate) fn arc_after(&self, block: &Block) -> bool {
        matches!(block.motion().map(|(motion, _)| motion).or(self.motion), Some(Motion::Arc(_)))
    }

    fn arc(&self, block: &Block, start: [f64; 3], clockwise: bool, code: Word) -> Result<Arc, Flaw> {
        let Some(rules) = &self.machine.arc else { return Err((self.refusal(), Some(code))) };
        let [first, second, _] = self.modes.plane.axes();
        if rules.needs_axis && [first, second].iter().all(|axis| block.axes().get(*axis).is_none_or(Option::is_none)) {
            return Err((ReadFault::ArcNeedsAxis, Some(code)));
        }
        let circle = Circle {
            ends: Ends { start, end: self.tip(), plane: self.modes.plane, clockwise },
            absolute: self.modes.absolute_centre,
            height: self.height,
        };
        circle.arc(block, rules, code, |word| self.mm(word))
    }

    fn push_move(&mut self, kind: MoveKind, arc: Option<Arc>, feed: f64, line: u32) {
        self.push_move_to(Move::new(kind, self.tip(), feed).arc(arc).on_line(line), None);
    }

    /// A move; `minutes` is how long it takes, where its feed follows from that.
    fn push_move_to(&mut self, step: Move, minutes: Option<f64>) {
        self.close_unknown();
        if self.record.program.moves.is_empty() {
            self.not_stated.extend((!self.distance_stated).then_some("G90"));
            let choice = self.machine.wcs.len() > 1;
            self.not_stated.extend((choice && self.wcs.is_none()).then_some("G54"));
        }
        self.record.push(step);
        self.note_stretch(minutes);
    }

    /// What was read; whether the program ended is the reader's to decide.
    pub(crate) fn finish(mut self, ended: bool, lines: u32, optional_lines: Vec<u32>) -> Result<Reading, ReadFault> {
        if let Some(since) = self.unknown_since {
            self.note_unknown(since);
        }
        self.end_unknown_height();
        self.close_plane_not_needed();
        if !self.record.program.moves.is_empty() {
            if let Some((_, axis)) = self.axes.iter().zip(AXES).find(|(axis, _)| !axis.ever) {
                return Err(ReadFault::NeverPlaced { axis });
            }
            if let Some(axis) = self.rotary.as_ref().and_then(Rotary::never_placed) {
                return Err(ReadFault::NeverPlaced { axis });
            }
        }
        let first = self.machine.wcs.first().cloned().unwrap_or_default();
        self.record.program.setup.wcs = self.wcs.unwrap_or(first);
        let first_known_move = self.unknown_positions.first().filter(|run| run.start == 0).map_or(0, |run| run.end);
        let reading = Reading {
            first_known_move,
            unknown_heights: self.unknown_heights,
            machine_moves: self.machine_moves,
            optional_lines,
            bare_line: self.bare_line,
            not_stated: self.not_stated,
            unknown_positions: self.unknown_positions,
            planes_not_needed: self.planes_not_needed,
            stops: self.stops,
            lines,
            ended,
            program: self.record.program,
            axes: None,
        };
        match &self.rotary {
            Some(rotary) => turned(reading, &rotary.axes, &rotary.stretches, self.machine),
            None => Ok(reading),
        }
    }
}
