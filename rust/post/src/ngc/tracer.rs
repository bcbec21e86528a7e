//! The interpreter's course: line by line, and the codes of a block in the order in which LinuxCNC carries them out.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use styluscam_motion::{Cancelled, EventKind, Watch};

use super::block::Block;
use super::codes;
use super::fault::{TraceError, TraceFault};
use super::frame::Frame;
use super::modes::{Modes, NO_MOTION};
use super::note::{Gap, Notes};
use super::offsets::Offsets;
use super::parameters::Parameters;
use super::path::Path;
use super::source::{Content, Line, Source};
use super::trace::{Limits, Trace};
use crate::block::{Code, CycleWords, Motion};

/// A subroutine's text by its name.
pub(super) type Find<'f> = &'f dyn Fn(&str) -> Option<String>;

/// The interpreter's state.
pub(super) struct Tracer<'f> {
    pub(super) find: Find<'f>,
    pub(super) sources: Vec<Rc<Source>>,
    /// Labels of subroutines that are nowhere.
    pub(super) missing: HashSet<String>,
    /// Index of the file that is run.
    pub(super) file: usize,
    /// Index of the line that is run.
    pub(super) line: usize,
    pub(super) root: Frame,
    /// Whether a subroutine has run.
    pub(super) called: bool,
    /// The subroutines that are running.
    pub(super) frames: Vec<Frame>,
    pub(super) parameters: Parameters,
    pub(super) modes: Modes,
    pub(super) offsets: Offsets,
    /// Where the tip stands, in the program's coordinates, mm.
    pub(super) position: [f64; 3],
    /// Whether G20 or G21 came, or it was noted that none did.
    pub(super) unit_stated: bool,
    /// Which axes have had a position.
    pub(super) positioned: [bool; 3],
    /// T.
    pub(super) selected: Option<u32>,
    /// The tool in the spindle.
    pub(super) loaded: u32,
    /// By tool number, as far as the program sets them, mm.
    pub(super) lengths: HashMap<u32, [f64; 3]>,
    pub(super) cycle: CycleWords,
    /// The end of the last cubic curve: P and Q, mm.
    pub(super) tangent: Option<[f64; 2]>,
    pub(super) path: Path,
    notes: Notes,
    watch: &'f Watch,
    /// Of lines that are run.
    limit: u64,
    blocks: u64,
}

/// What comes after a line.
pub(super) enum Next {
    /// The line below.
    Line,
    /// Another line of this file.
    Jump(usize),
    /// Where file and line have been set to.
    Elsewhere,
    /// Nothing.
    End,
}

impl<'f> Tracer<'f> {
    pub(super) fn new(text: &str, find: Find<'f>, watch: &'f Watch, limits: Limits) -> Self {
        Self {
            find,
            sources: vec![Rc::new(Source::new("", text))],
            missing: HashSet::new(),
            file: 0,
            line: 0,
            root: Frame::default(),
            called: false,
            frames: Vec::new(),
            parameters: Parameters::new(),
            modes: Modes::default(),
            offsets: Offsets::default(),
            position: [0.0; 3],
            unit_stated: false,
            positioned: [false; 3],
            selected: None,
            loaded: 0,
            lengths: HashMap::new(),
            cycle: CycleWords::default(),
            tangent: None,
            path: Path::new(limits.moves),
            notes: Notes::default(),
            watch,
            limit: limits.blocks,
            blocks: 0,
        }
    }

    /// Runs the program to its end.
    pub(super) fn run(mut self) -> Result<Trace, TraceError> {
        self.watch.begin("reading", self.sources.first().map_or(0, |source| source.lines.len()));
        loop {
            match self.step() {
                Ok(Next::Line) => self.line += 1,
                Ok(Next::Jump(line)) => self.line = line,
                Ok(Next::Elsewhere) => {}
                Ok(Next::End) => break,
                Err(fault) => return Err(self.error(fault)),
            }
        }
        if self.path.is_empty() {
            return Err(TraceError { file: String::new(), line: 0, fault: self.nothing() });
        }
        Ok(Trace { program: self.path.finish(), notes: self.notes.into_inner() })
    }

    fn error(&self, fault: TraceFault) -> TraceError {
        let file = self.sources.get(self.file).map_or_else(String::new, |source| source.name.clone());
        TraceError { file, line: u32::try_from(self.line + 1).unwrap_or(u32::MAX), fault }
    }

    /// Why there is nothing to see.
    fn nothing(&self) -> TraceFault {
        let subroutines = self.sources.first().map(|source| source.subroutines()).unwrap_or_default();
        let left_out = self.notes.left_out();
        if subroutines.is_empty() || self.called || !left_out.is_empty() {
            return TraceFault::NoMoves { left_out };
        }
        let names: Vec<String> = subroutines.iter().map(|label| format!("o{label}")).collect();
        TraceFault::OnlySubroutines { names: names.join(", ") }
    }

    pub(super) fn note(&mut self, gap: Gap) {
        let file = self.sources.get(self.file).map_or("", |source| &source.name);
        self.notes.add(gap, file, u32::try_from(self.line + 1).unwrap_or(u32::MAX));
    }

    fn step(&mut self) -> Result<Next, TraceFault> {
        let Some(source) = self.sources.get(self.file).cloned() else { return Ok(Next::End) };
        let Some(line) = source.lines.get(self.line) else { return Ok(self.end_of_file()) };
        self.watch.advance(1).map_err(|Cancelled| TraceFault::Cancelled)?;
        self.blocks += 1;
        if self.blocks > self.limit {
            return Err(TraceFault::TooManyBlocks { limit: self.limit });
        }
        self.remarks(line)?;
        match &line.content {
            Content::Nothing => Ok(Next::Line),
            Content::Percent if self.end_of_subroutine() => Ok(Next::Elsewhere),
            Content::Percent => Ok(Next::End),
            Content::Words(code) => self.words(code),
            Content::Flow(label, flow, rest) => self.flow(&source, label, *flow, rest),
            Content::Fault(fault) => Err(fault.clone()),
        }
    }

    fn end_of_file(&mut self) -> Next {
        if self.end_of_subroutine() {
            return Next::Elsewhere;
        }
        self.line = 0;
        self.notes.add(Gap::NoEnd, "", 0);
        Next::End
    }

    /// What the program states to the operator: `(MSG, ...)`, `(PRINT, ...)`, `(DEBUG, ...)`.
    fn remarks(&mut self, line: &Line) -> Result<(), TraceFault> {
        for comment in &line.comments {
            let Some((kind, text)) = comment.split_once(',') else { continue };
            if ["msg", "print", "debug"].contains(&kind.trim().to_ascii_lowercase().as_str()) {
                self.path.event(EventKind::Comment { text: text.trim().into() })?;
            }
        }
        Ok(())
    }

    fn words(&mut self, code: &str) -> Result<Next, TraceFault> {
        let mut block = Block::read(code, self)?;
        for name in std::mem::take(&mut block.unset) {
            self.note(Gap::Unset { name });
        }
        for (key, value) in &block.sets {
            self.assign(key, *value)?;
        }
        self.execute(&block)
    }

    /// Carries out a block, in the order of the manual's chapter "G-Code Order of Execution".
    fn execute(&mut self, block: &Block) -> Result<Next, TraceFault> {
        self.note_unknown(block);
        self.set_feed(block);
        self.set_speed(block);
        self.select_tool(block)?;
        self.wait_for_input(block);
        self.change_tool(block)?;
        self.turn_spindle(block)?;
        self.store_modes(block);
        self.set_coolant(block)?;
        self.dwell(block)?;
        self.set_modes(block);
        self.set_tool_length(block)?;
        self.set_system(block);
        self.set_distance_modes(block);
        self.turn_local_offset(block);
        let next = self.move_axes(block)?;
        self.stop(block, next)
    }

    fn move_axes(&mut self, block: &Block) -> Result<Next, TraceFault> {
        if block.axes().iter().any(Option::is_some) && !std::mem::replace(&mut self.unit_stated, true) {
            self.note(Gap::Unit);
        }
        let mut users = block.g.iter().filter(|code| codes::takes_axes(**code));
        let user = users.next().copied();
        if users.next().is_some() {
            return Err(TraceFault::SameGroup);
        }
        if block.has(Code::Motion(Motion::Cancel)) {
            self.modes.motion = NO_MOTION;
            self.cycle = CycleWords::default();
        }
        match user {
            Some(code) if codes::moves(code) => self.motion(block, code),
            Some(code) => self.set_offsets(block, code).map(|()| Next::Line),
            None if self.unknown_motion(block) => Ok(Next::Line),
            None if block.m.iter().any(|code| !codes::knows_m(*code)) => Ok(Next::Line),
            None if self.goes_on(block) => self.motion(block, self.modes.motion),
            None => Ok(Next::Line),
        }
    }

    /// A code that is not known takes the axis words, of this block and of those that go on with it.
    fn unknown_motion(&mut self, block: &Block) -> bool {
        let unknown = block.g.iter().copied().find(|code| codes::known_g(*code).is_none());
        self.modes.motion = unknown.unwrap_or(self.modes.motion);
        unknown.is_some()
    }

    /// Whether a block without a motion code moves by the one in force.
    fn goes_on(&self, block: &Block) -> bool {
        let arc = matches!(self.modes.motion, 20 | 30);
        block.positions() || arc && block.offsets().iter().any(Option::is_some)
    }

    fn stop(&mut self, block: &Block, next: Next) -> Result<Next, TraceFault> {
        for code in &block.m {
            match code {
                0 | 60 => self.path.event(EventKind::Comment { text: format!("M{code}: program stop") })?,
                1 => self.path.event(EventKind::Comment { text: "M1: optional stop".into() })?,
                2 | 30 => return Ok(Next::End),
                98 => return self.call_number(block),
                99 if self.end_of_subroutine() => return Ok(Next::Elsewhere),
                99 => {
                    self.note(Gap::Forever);
                    return Ok(Next::End);
                }
                _ => {}
            }
        }
        Ok(next)
    }
}
