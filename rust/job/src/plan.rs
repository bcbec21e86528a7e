//! From a resolved job to programs: one operation at a time, one program a channel.

use std::collections::BTreeMap;

use serde::Serialize;
use styluscam_motion::{Event, EventKind, OperationRecord, Program, ToolRecord, Watch};
use styluscam_post::Machine;

use crate::operations::{Context, Coolant, Fact, OperationSection, Planned, Spindle, SurfaceFacts};
use crate::resolve::{faces_of, heights_of, tools};
use crate::{check, JobDocument, JobError, Scene};

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

/// Plans every operation of the job, in order, each for the setting of its channel.
///
/// # Errors
/// Anything of [`JobError`]; nothing is planned then.
pub fn plan(job: &JobDocument, settings: &[Setting<'_>], watch: &Watch) -> Result<Plan, JobError> {
    let planned = settings.iter().map(|setting| Ok((setting.scene.channel, channel(job, *setting, watch)?)));
    Ok(Plan { channels: planned.collect::<Result<_, JobError>>()? })
}

fn channel(job: &JobDocument, Setting { scene, machine }: Setting<'_>, watch: &Watch) -> Result<Channel, JobError> {
    let tools = tools(job)?;
    let mut program = Program::empty(scene.record(job), Vec::new(), Vec::new());
    let mut operations = Vec::new();
    for (index, section) in job.operations_of(scene.channel) {
        let path = format!("operations[{index}]");
        let (tool, record) =
            tools.get(&section.common.tool).ok_or_else(|| check::no_tool(job, &path, &section.common.tool))?;
        let context = Context {
            scene,
            machine,
            common: &section.common,
            path,
            operation: operations.len() as u32,
            tool,
            reference_height: record.reference_height,
            faces: faces_of(job, scene, section, index)?,
            heights: heights_of(job, scene, section),
            watch,
        };
        let Planned { moves, words, note, facts, surface } = section.kind().plan(&context)?;
        let (id, kind, tool) = (section.id(index), section.operation.name(), tool_index(&mut program, record));
        program.events.extend(events_before(&program, section, tool));
        program.operations.push(OperationRecord { id: id.clone(), kind: kind.to_owned(), tool });
        program.moves.extend(moves);
        operations.push(OperationSummary { id, kind, words, facts, surface, note });
    }
    program.events.extend(events_at_end(&program, job.operations_of(scene.channel).last().map(|(_, last)| last)));
    Ok(Channel { program, operations })
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
