//! What is done to the part: one file a process, each with its own keys and its answers to what the rest of the job asks.
//!
//! A further process is one file here and one line in the table below.

mod die;

use std::sync::LazyLock;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use styluscam_verify::Support;

pub use die::Die;

use crate::tagged::{self, kinds, Family};

/// The channel of a program that needs no second one.
pub const MAIN_CHANNEL: &str = "main";

/// What a process answers.
pub trait ProcessKind {
    /// Whether its tools push a sheet into its shape; else they cut.
    fn forms(&self) -> bool;

    /// Whether it works on a sheet: `setup.sheet` is required then, and refused otherwise.
    fn takes_sheet(&self) -> bool {
        self.forms()
    }

    /// Whether the part rests on a table, below which no tip goes unless the job states so; else it hangs free.
    fn rests_on_table(&self) -> bool {
        !self.forms()
    }

    /// Whether the spindle turns the part, about X = Y = 0, and not the tool.
    fn turns_part(&self) -> bool {
        false
    }

    /// What holds the sheet up where it is not formed yet.
    fn support(&self) -> Support {
        Support::Rim
    }

    /// The die under the sheet, if there is one.
    fn die(&self) -> Option<Die> {
        None
    }

    /// The channels: programs that run side by side, each on a machine of its own; [`MAIN_CHANNEL`] first.
    fn channels(&self) -> &'static [&'static str] {
        &[MAIN_CHANNEL]
    }

    /// The tool of a channel that comes from the other side of the sheet and follows the operations of the main channel.
    fn opposite(&self, _channel: &str) -> Option<Opposite<'_>> {
        None
    }

    /// The file with a shop's own table of cutting data, if stated.
    fn cutting_data(&self) -> Option<&str> {
        None
    }
}

/// A tool on the other side of the sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opposite<'a> {
    /// Its name among the job's tools.
    pub tool: &'a str,
    /// What is left between it and the main tool, as a share of the sheet's thickness there.
    pub squeeze: f64,
}

/// What a starter job states of a process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct About {
    /// What it is, in a few words; empty where its name is enough.
    pub words: &'static str,
    /// Whether a starter job takes it for a sheet; for solid parts otherwise.
    pub for_sheets: bool,
}

kinds! {
    /// Processes.
    Process: ProcessKind, About {
        spif::Spif = "spif",
        dsif::Dsif = "dsif",
        milling::Milling = "milling",
        spinning::Spinning = "spinning",
        tpif::Tpif = "tpif",
    }
}

/// Keys of `[process]` that every process takes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ProcessKeys {
    /// What the part is made of, by a name. Of a sheet, that of a shipped material (`styluscam material list`): it sets the steepest wall
    /// that the sheet withstands. Of what is milled, that of a table of cutting data (`styluscam material cutting`): feeds and the spindle
    /// that an operation leaves out follow from it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    /// Most that may be left on the faces where the tool cannot get, mm; 1 mm of a sheet, and not checked in milling, when left
    /// out.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-advanced" = true, "x-unit" = "mm", "minimum" = 0.0, "maximum" = 1000.0))]
    pub max_bridged: Option<f64>,
    /// Share of the faces, 0 to 1, that the tool may be unable to get to.
    #[schemars(extend("x-advanced" = true, "x-unit" = "1", "minimum" = 0.0, "maximum" = 1.0))]
    pub max_unreached: f64,
}

impl Default for ProcessKeys {
    fn default() -> Self {
        Self { material: None, max_bridged: None, max_unreached: 0.1 }
    }
}

/// What is done to the part: forming a sheet, or milling.
///
/// Read from its parted form and written flat: see [`crate::tagged`].
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct ProcessSection {
    /// Keys that every process takes.
    #[serde(rename = "$common")]
    pub common: ProcessKeys,
    /// The process, with its own keys.
    #[serde(rename = "$own")]
    pub process: Process,
}

impl ProcessSection {
    /// The material whose cutting data give feeds and spindles; none where a sheet is worked, whose material is one to form.
    pub(crate) fn cut_material(&self) -> Option<&str> {
        self.common.material.as_deref().filter(|_| !self.process.as_kind().takes_sheet())
    }
}

impl Default for ProcessSection {
    fn default() -> Self {
        Self { common: ProcessKeys::default(), process: Process::Spif(Spif::default()) }
    }
}

impl Serialize for ProcessSection {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Flat<'a> {
            #[serde(flatten)]
            process: &'a Process,
            #[serde(flatten)]
            common: &'a ProcessKeys,
        }
        Flat { process: &self.process, common: &self.common }.serialize(serializer)
    }
}

impl JsonSchema for ProcessSection {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "ProcessSection".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let kinds = Process::schemas(generator);
        tagged::schema_of(&ProcessKeys::json_schema(generator), kinds, Some(DEFAULT))
    }
}

/// The process of a job that states none.
const DEFAULT: &str = "spif";

/// What `[process]` may hold.
pub fn family() -> &'static Family {
    static FAMILY: LazyLock<Family> = LazyLock::new(|| {
        let mut generator = SchemaGenerator::default();
        let kinds = Process::schemas(&mut generator);
        Family::of("process", &ProcessKeys::json_schema(&mut generator), &kinds, Some(DEFAULT))
    });
    &FAMILY
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every process, with its own defaults, and with the examples of the keys that it must have.
    fn every() -> impl Iterator<Item = (Process, About)> {
        let schemas: std::collections::BTreeMap<_, _> =
            Process::schemas(&mut SchemaGenerator::default()).into_iter().collect();
        Process::ABOUT.iter().map(move |(name, about)| {
            let schema = schemas[name].as_value();
            let required = schema.get("required").and_then(|keys| keys.as_array()).into_iter().flatten();
            let example = |key: &serde_json::Value| {
                let key = key.as_str().unwrap();
                let example = schema["properties"][key]["x-example"].as_str().unwrap();
                let table: toml::Table = toml::from_str(&format!("{key} = {example}")).unwrap();
                (key.to_owned(), serde_json::to_value(&table[key]).unwrap())
            };
            let own: serde_json::Map<_, _> = required.map(example).collect();
            let section = serde_json::json!({ tagged::COMMON: {}, tagged::OWN: { *name: own } });
            let section: ProcessSection = serde_json::from_value(section).unwrap_or_else(|e| panic!("{name}: {e}"));
            (section.process, *about)
        })
    }

    #[test]
    fn schema_starter_and_engine_agree_on_which_process_takes_a_sheet() {
        let schema = crate::schema();
        let alternatives = schema.pointer("/$defs/ProcessSection/oneOf").and_then(|all| all.as_array()).unwrap();
        assert_eq!(alternatives.len(), every().count());
        for (alternative, (process, about)) in alternatives.iter().zip(every()) {
            let (name, takes_sheet) = (process.name(), process.as_kind().takes_sheet());
            assert_eq!(alternative["title"], name);
            assert_eq!(alternative.get("x-takes-sheet") == Some(&true.into()), takes_sheet, "{name}");
            assert_eq!(about.for_sheets, takes_sheet, "{name}");
        }
    }

    #[test]
    fn the_first_channel_of_every_process_is_the_main_one() {
        for (process, _) in every() {
            let channels = process.as_kind().channels();
            assert_eq!(channels[0], MAIN_CHANNEL);
            let unique: std::collections::BTreeSet<_> = channels.iter().collect();
            assert_eq!(unique.len(), channels.len(), "{}", process.name());
        }
    }

    #[test]
    fn a_job_without_a_process_has_the_default_of_the_schema() {
        assert_eq!(ProcessSection::default().process.name(), DEFAULT);
    }
}
