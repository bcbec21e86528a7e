//! Channels by their names.

use pyo3::prelude::*;

use crate::errors::raise;

/// Characters of a name that a message shows.
const SHOWN: usize = 40;

/// What stands for the channel of that name; an error of class `class` where there is none.
pub fn channel_of<'a, T>(name: &str, channels: impl Iterator<Item = (&'a str, T)> + Clone, class: &str) -> PyResult<T> {
    channels.clone().find(|(channel, _)| *channel == name).map(|(_, found)| found).ok_or_else(|| {
        let shown: String = name.chars().take(SHOWN).collect();
        let known: Vec<&str> = channels.map(|(channel, _)| channel).collect();
        let hint = format!("channels: {}", known.join(", "));
        raise(class, &format!("unknown channel {shown:?}"), "argument", "channel", &hint)
    })
}

/// Refuses a name that is none of the channels.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)] // PyO3 hands lists by value
pub fn require_channel(name: &str, channels: Vec<String>, class: &str) -> PyResult<()> {
    channel_of(name, channels.iter().map(|channel| (channel.as_str(), ())), class)
}
