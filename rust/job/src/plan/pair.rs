//! Two channels that work together: the main one's moves, planned before, and those of the tool on the other side.

use styluscam_motion::{EventKind, Move, Watch};

use super::channel::{Added, Channel, Setting};
use crate::operations::{Fact, Planned};
use crate::paired::{paired, Member, Paired};
use crate::resolve::tools;
use crate::{check, spindle, JobDocument, JobError};

/// The main channel as it has to be for the other, and the other.
///
/// # Errors
/// Those of [`paired`].
pub fn planned(
    job: &JobDocument,
    settings: [Setting<'_>; 2],
    alone: Channel,
    watch: &Watch,
) -> Result<[Channel; 2], JobError> {
    let tools = tools(job)?;
    let mut channels = settings.map(|setting| Channel::empty(job, setting.scene));
    let own: Vec<Vec<Move>> = (0..alone.operations.len() as u32)
        .map(|number| alone.program.moves.iter().filter(|step| step.operation == number).copied().collect())
        .collect();
    let sections = job.operations_of(alone.name);
    for (((index, section), summary), moves) in sections.zip(alone.operations).zip(own) {
        let path = format!("operations[{index}]");
        let of = |setting: &Setting<'_>| {
            let name = job.tool_of(setting.scene.channel, section);
            tools.get(name).ok_or_else(|| check::no_tool(job, &path, name))
        };
        let [(tool, record), (tool_below, record_below)] = [of(&settings[0])?, of(&settings[1])?];
        let members = [(settings[0], tool), (settings[1], tool_below)]
            .map(|(Setting { scene, machine }, tool)| Member { scene, machine, tool });
        let Paired { main, below, divided } = paired(members, &section.common, &moves, &path, watch)?;
        let count = main.len();
        let planned = Planned {
            moves: main,
            events: Vec::new(),
            cycles: Vec::new(),
            words: summary.words,
            note: summary.note,
            facts: summary.facts,
            surface: summary.surface,
        };
        let follows = Planned {
            moves: below,
            events: Vec::new(),
            cycles: Vec::new(),
            words: format!("{count} moves, as many as the main tool's, {divided} of them for this side"),
            note: format!("follows the main tool, {count} moves"),
            facts: vec![Fact::count(count, "move", "moves")],
            surface: None,
        };
        let wait = wait(settings, index as u32 + 1);
        let [main, other] = &mut channels;
        let added = |planned, setting: Setting<'_>, tool, lines| {
            let turns = spindle::turns(job, setting.scene, tool, section, index)?;
            Ok::<_, JobError>(Added { planned, turns, lines, frame: Vec::new(), wait: Some(wait.clone()) })
        };
        main.add((section.id(index), section), record, added(planned, settings[0], tool, summary.lines)?);
        other.add((section.id(index), section), record_below, added(follows, settings[1], tool_below, Vec::new())?);
    }
    channels.iter_mut().for_each(|channel| channel.end(job));
    Ok(channels)
}

/// What lets both programs begin an operation at one time: marks at which they wait for each other where both machines have
/// them, else a stop from which the operator starts both.
fn wait(settings: [Setting<'_>; 2], mark: u32) -> EventKind {
    if settings.iter().all(|setting| setting.machine.templates.sync.is_some()) {
        EventKind::Sync { mark }
    } else {
        EventKind::Stop { optional: false }
    }
}
