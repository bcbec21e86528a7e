//! The channels of a job: programs that run side by side, each with its machine and its operations.

use crate::process::Opposite;
use crate::{JobDocument, JobError, MachineSection, OperationSection, MAIN_CHANNEL};

impl JobDocument {
    /// Its channels, "main" first.
    #[must_use]
    pub fn channels(&self) -> &'static [&'static str] {
        self.process.process.as_kind().channels()
    }

    /// The machine of a channel.
    #[must_use]
    pub fn machine_of(&self, channel: &str) -> Option<&MachineSection> {
        if channel == MAIN_CHANNEL {
            Some(&self.machine)
        } else {
            self.machines.get(channel)
        }
    }

    /// The operations of a channel, in order, each with its number in the job. A tool on the other side of the sheet does
    /// those of the main channel.
    pub fn operations_of<'a>(&'a self, channel: &'a str) -> impl Iterator<Item = (usize, &'a OperationSection)> {
        let channel = if self.opposite(channel).is_some() { MAIN_CHANNEL } else { channel };
        self.operations.iter().enumerate().filter(move |(_, section)| section.channel() == channel)
    }

    /// The tool of a channel that follows the main one from the other side of the sheet.
    #[must_use]
    pub fn opposite(&self, channel: &str) -> Option<Opposite<'_>> {
        self.process.process.as_kind().opposite(channel)
    }

    /// The channel whose tool follows the main one from the other side of the sheet, where there is one.
    #[must_use]
    pub fn follower(&self) -> Option<&'static str> {
        self.channels().iter().copied().find(|channel| self.opposite(channel).is_some())
    }

    /// The channel that works together with another, move by move, where there is one.
    #[must_use]
    pub fn partner_of(&self, channel: &str) -> Option<&'static str> {
        let follower = self.follower()?;
        match channel {
            MAIN_CHANNEL => Some(follower),
            _ if channel == follower => Some(MAIN_CHANNEL),
            _ => None,
        }
    }

    /// The name of the tool with which a channel does an operation.
    #[must_use]
    pub fn tool_of<'a>(&'a self, channel: &str, section: &'a OperationSection) -> &'a str {
        self.opposite(channel).map_or(section.common.tool.as_str(), |opposite| opposite.tool)
    }

    /// The names of all tools that a channel uses, one for each of its operations.
    pub fn tools_of<'a>(&'a self, channel: &'a str) -> impl Iterator<Item = &'a str> {
        self.operations_of(channel).map(move |(_, section)| self.tool_of(channel, section))
    }
}

/// Checks that operations and machines name channels of the process, and that every channel has both.
///
/// # Errors
/// A channel that the process does not have, or one without a machine or an operation.
pub fn check(job: &JobDocument) -> Result<(), JobError> {
    let stated = job.operations.iter().enumerate();
    let in_operations = stated.map(|(index, section)| (format!("operations[{index}].channel"), section.channel()));
    let in_machines = job.machines.keys().map(|name| (format!("machines.{name}"), name.as_str()));
    for (path, channel) in in_operations.clone().chain(in_machines) {
        known(job, path, channel)?;
    }
    if let Some((path, channel)) = in_operations.into_iter().find(|(_, channel)| job.opposite(channel).is_some()) {
        let message =
            format!("channel {channel:?} has no operations of its own: its tool follows those of {MAIN_CHANNEL:?}");
        return Err(JobError::document("conflict", path, message, "remove the operation, or its channel"));
    }
    if job.machines.contains_key(MAIN_CHANNEL) {
        let message = format!("machines.{MAIN_CHANNEL}: the machine of channel {MAIN_CHANNEL:?} is [machine]");
        return Err(JobError::document("conflict", format!("machines.{MAIN_CHANNEL}"), message, "remove it"));
    }
    job.channels().iter().try_for_each(|channel| complete(job, channel))
}

fn known(job: &JobDocument, path: String, channel: &str) -> Result<(), JobError> {
    if job.channels().contains(&channel) {
        return Ok(());
    }
    let message = format!("process.kind = {:?} has no channel {channel:?}", job.process.process.name());
    Err(JobError::document("unknown", path, message, format!("it has {}", job.channels().join(", "))))
}

fn complete(job: &JobDocument, channel: &str) -> Result<(), JobError> {
    let kind = job.process.process.name();
    if job.machine_of(channel).is_none() {
        let message = format!("process.kind = {kind:?} has a channel {channel:?}, and the job has no machine for it");
        let hint = format!("add [machines.{channel}] with a name or a file");
        return Err(JobError::document("missing", format!("machines.{channel}"), message, hint));
    }
    if job.operations_of(channel).next().is_none() {
        let message = format!("process.kind = {kind:?} has a channel {channel:?}, and no operation is for it");
        let hint = format!("add an [[operations]] table with channel = {channel:?}");
        return Err(JobError::document("empty", "operations", message, hint));
    }
    Ok(())
}
