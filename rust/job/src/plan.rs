//! From a resolved job to programs: one operation at a time, one program a channel.

use std::collections::BTreeMap;

use serde::Serialize;
use styluscam_motion::{Event, EventKind, OperationRecord, Program, ToolRecord, Watch};
use styluscam_post::Machine;

use crate::operations::{Context, Coolant, Fact, OperationSection, Planned, Spindle, SurfaceFacts};
use crate::resolve::{faces_of, heights_of, tools};
use crate::{check, JobDocument, JobError, Scene, MAIN_CHANNEL};

mod pair;

/// Planned programs by channel.
#[derive(Clone, Debug)]
pub struct Plan {
    /// What each channel does.
    pub channels: BTreeMap<&'static str, Channel>,
}

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
}

/// Plans every operation of the job, in order, each for the setting of its channel; a channel on the other side of the sheet after
/// the main one, whose moves it follows.
///
/// # Errors
/// Anything of [`JobError`]; nothing is planned then.
pub fn plan(job: &JobDocument, settings: &[Setting<'_>], watch: &Watch) -> Result<Plan, JobError> {
    let (followers, leaders): (Vec<&Setting<'_>>, Vec<_>) = settings.iter().partition(|s| s.scene.opposite.is_some());
    let planned = leaders.iter().map(|setting| Ok((setting.scene.channel, channel(job, **setting, watch)?)));
    let mut channels = planned.collect::<Result<BTreeMap<_, _>, JobError>>()?;
    for follower in followers {
        let main =
            leaders.iter().find(|setting| setting.scene.channel == MAIN_CHANNEL).zip(channels.remove(MAIN_CHANNEL));
        let (setting, main) = main.ok_or_else(|| {
            let message =
                format!("channel {:?} follows {MAIN_CHANNEL:?}, which is not planned", follower.scene.channel);
            JobError::document("missing", "machine", message, "plan both")
        })?;
        let [main, below] = pair::planned(job, [**setting, *follower], main, watch)?;
        channels.extend([(MAIN_CHANNEL, main), (follower.scene.channel, below)]);
    }
    Ok(Plan { channels })
}

fn channel(job: &JobDocument, Setting { scene, machine }: Setting<'_>, watch: &Watch) -> Result<Channel, JobError> {
    let tools = tools(job)?;
    let mut channel = Channel::empty(job, scene);
    for (index, section) in job.operations_of(scene.channel) {
        let path = format!("operations[{index}]");
        let (tool, record) =
            tools.get(&section.common.tool).ok_or_else(|| check::no_tool(job, &path, &section.common.tool))?;
        let context = Context {
            scene,
            machine,
            common: &section.common,
            path,
            operation: channel.operations.len() as u32,
            tool,
            faces: faces_of(job, scene, section, index)?,
            heights: heights_of(job, scene, section),
            watch,
        };
        let planned = section.kind().plan(&context)?;
        channel.add((index, section), record, planned, None);
    }
    channel.end(job);
    Ok(channel)
}

impl Channel {
    fn empty(job: &JobDocument, scene: &Scene) -> Self {
        let program = Program::empty(scene.record(job), Vec::new(), Vec::new());
        Self { name: scene.channel, program, operations: Vec::new() }
    }

    /// Adds a planned operation, which has a number in the job; `wait` comes behind its first move.
    fn add(
        &mut self,
        (index, section): (usize, &OperationSection),
        record: &ToolRecord,
        Planned { moves, words, note, facts, surface }: Planned,
        wait: Option<EventKind>,
    ) {
        let program = &mut self.program;
        let (id, kind, tool) = (section.id(index), section.operation.name(), tool_index(program, record));
        program.events.extend(events_before(program, section, tool));
        program.events.extend(wait.map(|kind| Event { before: program.moves.len() + 1, kind }));
        program.operations.push(OperationRecord { id: id.clone(), kind: kind.to_owned(), tool });
        program.moves.extend(moves);
        self.operations.push(OperationSummary { id, kind, words, facts, surface, note });
    }

    fn end(&mut self, job: &JobDocument) {
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
fn events_before(program: &Program, section: &OperationSection, tool: u32) -> Vec<Event> {
    let before = program.moves.len();
    let changes_tool = program.operations.last().is_none_or(|last| last.tool != tool);
    let mut kinds = Vec::new();
    if changes_tool {
        kinds.push(EventKind::ToolChange { tool });
    }
    kinds.push(match section.common.spindle {
        Spindle::Off => EventKind::SpindleOff,
        Spindle::Fixed { rpm, direction } => EventKind::SpindleOn { rpm, direction },
    });
    if !program.operations.is_empty() || section.common.coolant == Coolant::Flood {
        kinds.push(EventKind::Flood { on: section.common.coolant == Coolant::Flood });
    }
    kinds.into_iter().map(|kind| Event { before, kind }).collect()
}

fn events_at_end(program: &Program, last: Option<&OperationSection>) -> Vec<Event> {
    let before = program.moves.len();
    let mut kinds = Vec::new();
    if let Some(section) = last {
        if section.common.spindle != Spindle::Off {
            kinds.push(EventKind::SpindleOff);
        }
        if section.common.coolant == Coolant::Flood {
            kinds.push(EventKind::Flood { on: false });
        }
    }
    kinds.into_iter().map(|kind| Event { before, kind }).collect()
}
