//! Machines from files and to files.

use serde::Deserialize;

use super::error::{most_similar, MachineError};
use super::inherit;
use super::shipped::{shipped, SHIPPED};
use super::values::Machine;

impl Machine {
    /// The shipped machine of this name.
    ///
    /// # Errors
    /// [`MachineError::UnknownMachine`] when there is none.
    pub fn shipped(name: &str) -> Result<Self, MachineError> {
        Self::from_toml(Self::shipped_text(name)?)
    }

    /// The text of a shipped machine file: a start for a file of one's own.
    ///
    /// # Errors
    /// [`MachineError::UnknownMachine`] when there is none.
    pub fn shipped_text(name: &str) -> Result<&'static str, MachineError> {
        SHIPPED.iter().find(|(known, _)| *known == name).map(|(_, text)| *text).ok_or_else(|| {
            MachineError::UnknownMachine { key: "name", name: name.into(), similar: most_similar(name, shipped()) }
        })
    }

    /// Reads a machine file and checks it. It may extend a shipped machine: `extends = "fanuc"`.
    ///
    /// # Errors
    /// [`MachineError`]: text that is not TOML, unknown or missing keys, values out of range, templates that do not compile.
    pub fn from_toml(text: &str) -> Result<Self, MachineError> {
        Self::from_toml_beside(text, &|_| None)
    }

    /// The same for a file that may extend other files: `extends = "ours.toml"`; `file` gives their text, or nothing.
    ///
    /// # Errors
    /// Those of [`from_toml`](Self::from_toml).
    pub fn from_toml_beside(text: &str, file: &dyn Fn(&str) -> Option<String>) -> Result<Self, MachineError> {
        let machine = inherit::machine(text, file)?;
        machine.check()?;
        Ok(machine)
    }

    /// The same for what a machine file holds in another form than TOML, such as JSON; null is no value.
    ///
    /// # Errors
    /// Those of [`from_toml`](Self::from_toml), with keys in place of lines.
    pub fn from_values<'de, D: serde::Deserializer<'de>>(
        values: D,
        file: &dyn Fn(&str) -> Option<String>,
    ) -> Result<Self, MachineError> {
        let own = <toml::Table as Deserialize>::deserialize(values).map_err(|e| MachineError::Document {
            place: "machine".into(),
            message: e.to_string(),
            similar: None,
        })?;
        let machine = inherit::of_table(own, "", file)?;
        machine.check()?;
        Ok(machine)
    }

    /// The whole of it as a machine file that extends nothing.
    ///
    /// # Errors
    /// [`MachineError::Document`] for values that a file cannot hold.
    pub fn to_toml(&self) -> Result<String, MachineError> {
        toml::to_string_pretty(self).map_err(|e| MachineError::Document {
            place: self.name.clone(),
            message: e.to_string(),
            similar: None,
        })
    }

    /// The JSON Schema of machine files.
    #[must_use]
    pub fn schema() -> schemars::Schema {
        schemars::schema_for!(Machine)
    }
}
