//! A channel's program as it grows, operation by operation.

use serde::Serialize;
use styluscam_motion::{Cycle, Event, EventKind, Move, OperationRecord, Program, SpindleDirection, ToolRecord};
use styluscam_post::Machine;
use styluscam_verify::{FrameLevel, OrderedPasses};

use crate::operations::{Coolant, Fact, OperationSection, Planned, Spindle, SurfaceFacts};
use crate::{clamp, JobDocument, Scene};

/// What the operator has to do for a spindle that is not driven.
const FREE: &str = "the spindle must turn freely: release its brake";

/// What a channel is planned for.
#[derive(Clone, Copy)]
pub struct Setting<'a> {
    /// The part as it lies on the channel's machine.
    pub scene: &'a Scene,
    /// The machine.
    pub machine: &'a Machine,
}

/// A channel's program and what there is to report of it.
#[derive(Clone, Debug)]
pub struct Channel {
    /// Its name.
    pub name: &'static str,
    /// The program.
    pub program: Program,
    /// What each of its operations amounts to.
    pub operations: Vec<OperationSummary>,
    /// Height of the sheet in a clamp frame that goes down with the path, mm.
    frame: f64,
}

/// What an operation amounts to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OperationSummary {
    /// Its id.
    pub id: String,
    /// Its kind.
    pub kind: &'static str,
    /// Its extent in words.
    pub words: String,
    /// Its figures.
    pub facts: Vec<Fact>,
    /// What becomes of the faces, where it follows faces.
    #[serde(flatten)]
    pub surface: Option<SurfaceFacts>,
    /// Its extent in the words of the program's header.
    #[serde(skip)]
    pub note: String,
    /// Further lines of that header.
    #[serde(skip)]
    pub lines: Vec<String>,
}

/// An operation that is added to a channel.
pub(super) struct Added {
    /// What was planned.
    pub planned: Planned,
    /// Speed and sense of the spindle; it stands when there are none.
    pub turns: Option<(f64, SpindleDirection)>,
    /// Further lines of the program's header.
    pub lines: Vec<String>,
    /// Where a clamp frame that goes down with the path goes meanwhile.
    pub frame: Vec<FrameLevel>,
    /// What comes behind its first move.
    pub wait: Option<EventKind>,
}

impl Channel {
    /// One without operations.
    pub(super) fn empty(job: &JobDocument, scene: &Scene) -> Self {
        let program = Program::empty(scene.record(job), Vec::new(), Vec::new());
        Self { name: scene.channel, program, operations: Vec::new(), frame: scene.top }
    }

    /// Where a clamp frame that goes down with the path goes along the next operation's moves.
    pub(super) fn frame(&self, passes: &OrderedPasses, moves: &[Move]) -> Vec<FrameLevel> {
        clamp::heights(passes, moves, self.frame)
    }

    /// Adds a planned operation, which is called `id`.
    pub(super) fn add(
        &mut self,
        (id, section): (String, &OperationSection),
        record: &ToolRecord,
        Added { planned, turns, lines, frame, wait }: Added,
    ) {
        let Planned { moves, events, cycles, words, note, facts, surface } = planned;
        let program = &mut self.program;
        let (kind, tool) = (section.operation.name(), tool_index(program, record));
        program.events.extend(events_before(program, section, tool, turns));
        let first = program.moves.len();
        program.events.extend(wait.map(|kind| Event { before: first + 1, kind }));
        let event = |(behind, kind)| Event { before: first + behind + 1, kind };
        program.events.extend(events.into_iter().map(event));
        program.cycles.extend(cycles.into_iter().map(|cycle| Cycle { first: first + cycle.first, ..cycle }));
        self.frame = frame.last().map_or(self.frame, |level| level.z);
        program.events.extend(frame.into_iter().map(|level| clamp::remark(level, first)));
        program.operations.push(OperationRecord { id: id.clone(), kind: kind.to_owned(), tool });
        if first == 0 {
            program.moves = moves; // of millions of moves there are not two lists
        } else {
            program.moves.extend(moves);
        }
        self.operations.push(OperationSummary { id, kind, words, facts, surface, note, lines });
    }

    /// Adds what follows the last operation.
    pub(super) fn end(&mut self, job: &JobDocument) {
        let last = job.operations_of(self.name).last().map(|(_, last)| last);
        self.program.events.extend(events_at_end(&self.program, last));
    }
}

fn tool_index(program: &mut Program, record: &ToolRecord) -> u32 {
    let known = program.tools.iter().position(|t| t.number == record.number);
    let index = known.unwrap_or_else(|| {
        program.tools.push(record.clone());
        program.tools.len() - 1
    });
    index as u32
}

/// Tool change, spindle and coolant as far as they differ from the operation before.
fn events_before(
    program: &Program,
    section: &OperationSection,
    tool: u32,
    turns: Option<(f64, SpindleDirection)>,
) -> Vec<Event> {
    let before = program.moves.len();
    let changes_tool = program.operations.last().is_none_or(|last| last.tool != tool);
    let mut kinds = Vec::new();
    if changes_tool {
        kinds.push(EventKind::ToolChange { tool });
    }
    kinds.push(turns.map_or(EventKind::SpindleOff, |(rpm, direction)| EventKind::SpindleOn { rpm, direction }));
    if section.common.spindle == Spindle::Free {
        kinds.push(EventKind::Comment { text: FREE.to_owned() });
    }
    if !program.operations.is_empty() || section.common.coolant == Coolant::Flood {
        kinds.push(EventKind::Flood { on: section.common.coolant == Coolant::Flood });
    }
    kinds.into_iter().map(|kind| Event { before, kind }).collect()
}

fn events_at_end(program: &Program, last: Option<&OperationSection>) -> Vec<Event> {
    let before = program.moves.len();
    let mut kinds = Vec::new();
    if let Some(section) = last {
        if section.common.spindle.direction().is_some() {
            kinds.push(EventKind::SpindleOff);
        }
        if section.common.coolant == Coolant::Flood {
            kinds.push(EventKind::Flood { on: false });
        }
    }
    kinds.into_iter().map(|kind| Event { before, kind }).collect()
}
