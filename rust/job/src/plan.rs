//! From a resolved job to programs: one operation at a time, one program a channel.

use std::collections::BTreeMap;

use styluscam_motion::Watch;

use crate::operations::{Before, Context};
use crate::resolve::{check_part, descent_of, faces_of, heights_of, region_of, selection_of, tools};
use crate::{check, clamp, die, forming, shaping, spindle, JobDocument, JobError, Selection, MAIN_CHANNEL};

mod channel;
mod pair;

use channel::Added;
pub use channel::{Channel, OperationSummary, Setting};

/// Planned programs by channel.
#[derive(Clone, Debug)]
pub struct Plan {
    /// What each channel does.
    pub channels: BTreeMap<&'static str, Channel>,
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
    shaping::fits(job, scene)?;
    let mut channel = Channel::empty(job, scene);
    let mut before = Vec::new();
    let of_stage = |stage| job.operations_of(scene.channel).map(move |operation| (stage, operation));
    for (scene, (index, section)) in scene.stages.iter().chain([scene]).flat_map(of_stage) {
        let path = format!("operations[{index}]");
        let (tool, record) =
            tools.get(&section.common.tool).ok_or_else(|| check::no_tool(job, &path, &section.common.tool))?;
        let faces = faces_of(job, scene, section, index)?;
        check_part(job, (scene, &faces), tool, section, index)?;
        let touching = section.touching(tool);
        let context = Context {
            scene,
            machine,
            common: &section.common,
            path,
            operation: channel.operations.len() as u32,
            tool: &touching,
            reference_height: record.reference_height,
            region: region_of(job, scene, section, index, &faces)?,
            faces,
            are_faces_named: matches!(selection_of(job, section, index).0, Selection::Named(_)),
            heights: heights_of(job, scene, section),
            before: Before { earlier: scene.earlier.as_deref(), moves: &channel.program.moves, tools: &before },
            watch,
        };
        let selected = scene.facing_up(&context.faces);
        die::check(job, scene, &selected, &context.path)?;
        let turns = spindle::turns(job, scene, tool, section, index)?;
        let mut planned = section.kind().plan(&context)?;
        let (thinnest, force) = forming::facts(job, scene, tool, section, &selected);
        let descent = descent_of(job, scene, tool, section).filter(|_| clamp::goes_down(job));
        let frame = descent.map_or_else(Vec::new, |passes| channel.frame(&passes, &planned.moves));
        let of_frame = clamp::fact(&frame);
        let lines = force.iter().chain(&of_frame).map(|fact| fact.words.clone()).collect();
        if scene.stage.is_some() {
            planned.facts.extend(scene.changes.iter().cloned());
        }
        planned.facts.extend(thinnest.into_iter().chain(force).chain(of_frame));
        channel.add(
            (scene.operation_id(section.id(index)), section),
            record,
            Added { planned, turns, lines, frame, wait: None },
        );
        before.push(tool);
    }
    channel.end(job);
    Ok(channel)
}
