//! Machines: everything about a controller that a post or a reader needs, as data from a TOML file.

mod check;
mod error;
mod option;
mod rules;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_motion::Dynamics;

pub(crate) use error::most_similar;
pub use error::MachineError;
pub use option::{OptionRule, OptionValue};
pub use rules::{
    AfterEnd, ArcRules, BlockDelete, BlockNumber, CommentForm, CommentRules, CoolantRules, Counted, Decimals,
    DwellRules, Family, LengthOffset, LengthUnit, Limits, LineEnd, LineRules, NumberRules, Point, RadiusError,
    ReaderRules, Repeat, Separator, SmoothingRules, Source, SpindleRules, Templates, TimeUnit, ToolChange, ToolRules,
    TrailingZeros, Units, WordRules,
};

use crate::number::NumberFormat;

/// Version of the machine document; newer ones are refused.
pub const MACHINE_SCHEMA: u32 = 1;

/// The machine files that come with the release: a name and the text.
const SHIPPED: [(&str, &str); 2] =
    [("grbl", include_str!("../machines/grbl.toml")), ("linuxcnc", include_str!("../machines/linuxcnc.toml"))];

/// The options that every machine has besides its own.
const UNITS_OPTION: &str = "units";
const SMOOTHING_OPTION: &str = "smoothing_tolerance";

/// A controller, as data. Lengths mm, feeds mm/min, speeds rev/min, times s, whatever the output's units.
///
/// Fields may be changed; [`post`](crate::post) and [`read`](crate::read) check them again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Machine {
    /// Version of this document.
    pub schema: u32,
    /// A short name: `linuxcnc`.
    pub name: String,
    /// The kind of text.
    pub family: Family,
    /// What it is, in words.
    pub description: String,
    /// Work offsets that it takes: `G54`.
    pub wcs: Vec<String>,
    /// The word that ends a program: `M2`.
    pub end: String,
    /// What the facts were taken from.
    pub source: Source,
    /// Units of the output.
    pub units: Units,
    /// How numbers are written.
    pub number: NumberRules,
    /// What a line may be.
    pub line: LineRules,
    /// How remarks are written.
    pub comment: CommentRules,
    /// Numbers before the blocks; none when left out.
    pub block_number: Option<BlockNumber>,
    /// How words are put together.
    #[serde(default)]
    pub words: WordRules,
    /// Tool changes and lengths.
    pub tool: ToolRules,
    /// Spindle words.
    #[serde(default)]
    pub spindle: SpindleRules,
    /// Coolant words.
    #[serde(default)]
    pub coolant: CoolantRules,
    /// Rounding of the path by the controller.
    #[serde(default)]
    pub smoothing: SmoothingRules,
    /// The wait; a machine without one refuses dwells.
    pub dwell: Option<DwellRules>,
    /// Arcs; a machine without them gets lines.
    pub arc: Option<ArcRules>,
    /// What the machine can do.
    pub limits: Limits,
    /// Options of the templates.
    #[serde(default)]
    pub options: BTreeMap<String, OptionRule>,
    /// Text around the moves.
    pub templates: Templates,
    /// How text of this machine is read.
    pub reader: ReaderRules,
}

/// Names of the machines that come with the release, sorted.
#[must_use]
pub fn shipped() -> Vec<&'static str> {
    SHIPPED.iter().map(|(name, _)| *name).collect()
}

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
        SHIPPED
            .iter()
            .find(|(known, _)| *known == name)
            .map(|(_, text)| *text)
            .ok_or_else(|| MachineError::UnknownMachine { name: name.into(), similar: most_similar(name, shipped()) })
    }

    /// Reads a machine file and checks it.
    ///
    /// # Errors
    /// [`MachineError`]: text that is not TOML, unknown or missing keys, values out of range, templates that do not compile.
    pub fn from_toml(text: &str) -> Result<Self, MachineError> {
        let document = toml::de::Deserializer::parse(text).map_err(|e| syntax_error(text, &e))?;
        let machine: Self = serde_path_to_error::deserialize(document).map_err(|e| document_error(text, &e))?;
        machine.check()?;
        Ok(machine)
    }

    /// Checks every value and compiles every template.
    ///
    /// # Errors
    /// [`MachineError`] for the first thing that is wrong.
    pub fn check(&self) -> Result<(), MachineError> {
        check::check(self)
    }

    /// The JSON Schema of machine files.
    #[must_use]
    pub fn schema() -> schemars::Schema {
        schemars::schema_for!(Machine)
    }

    /// Sets an option: `units` ("mm" or "inch"), `smoothing_tolerance` (mm; where the machine has a word for it), or one of its own.
    ///
    /// # Errors
    /// [`MachineError::UnknownOption`], [`MachineError::Option`], [`MachineError::Value`]; the machine stays as it was.
    pub fn set_option(&mut self, name: &str, value: OptionValue) -> Result<(), MachineError> {
        let mut machine = self.clone();
        match (name, &value) {
            (UNITS_OPTION, _) => machine.units.output = length_unit(&value)?,
            (SMOOTHING_OPTION, OptionValue::Number(mm)) if self.smoothing.on.is_some() => {
                machine.smoothing.tolerance = *mm;
            }
            _ => machine.set_own_option(name, value)?,
        }
        machine.check()?;
        *self = machine;
        Ok(())
    }

    fn set_own_option(&mut self, name: &str, value: OptionValue) -> Result<(), MachineError> {
        let built_in = [UNITS_OPTION, SMOOTHING_OPTION];
        let similar = most_similar(name, self.options.keys().map(String::as_str).chain(built_in));
        let Some(rule) = self.options.get_mut(name) else {
            return Err(MachineError::UnknownOption { name: name.into(), similar });
        };
        if let Some(problem) = rule.refuses(&value) {
            return Err(MachineError::Option { name: name.into(), problem });
        }
        rule.value = value;
        Ok(())
    }

    /// One unit of the last posted place, mm: rounding moves a coordinate by half of it at most.
    #[must_use]
    pub fn resolution_mm(&self) -> f64 {
        self.units.output.in_mm() / self.linear_format().per_one()
    }

    /// One unit of the last posted place of a feed, mm/min.
    #[must_use]
    pub fn feed_resolution_mm(&self) -> f64 {
        self.units.output.in_mm() / self.feed_format().per_one()
    }

    /// How far the controller itself may leave the posted path, mm: part of the path's tolerance.
    #[must_use]
    pub fn path_tolerance_mm(&self) -> f64 {
        if self.smoothing.on.is_some() {
            self.smoothing.tolerance
        } else {
            0.0
        }
    }

    /// What decides how fast it follows a path.
    #[must_use]
    pub fn dynamics(&self) -> Dynamics {
        let limits = &self.limits;
        Dynamics {
            rapid_rate: limits.rapid_rate,
            acceleration: limits.acceleration,
            corner_tolerance: limits.corner_tolerance.unwrap_or(self.path_tolerance_mm()),
            blocks_per_second: limits.blocks_per_second,
        }
    }

    /// Decimal places in the output's units.
    pub(crate) fn decimals(&self) -> Decimals {
        match self.units.output {
            LengthUnit::Mm => self.number.mm,
            LengthUnit::Inch => self.number.inch,
        }
    }

    /// The way coordinates are written.
    pub(crate) fn linear_format(&self) -> NumberFormat {
        NumberFormat::new(&self.number, self.decimals().linear)
    }

    /// The way feeds are written.
    pub(crate) fn feed_format(&self) -> NumberFormat {
        NumberFormat::new(&self.number, self.decimals().feed)
    }

    /// The word that selects the output's units.
    pub(crate) fn units_word(&self) -> Option<&str> {
        match self.units.output {
            LengthUnit::Mm => self.units.mm.as_deref(),
            LengthUnit::Inch => self.units.inch.as_deref(),
        }
    }
}

fn length_unit(value: &OptionValue) -> Result<LengthUnit, MachineError> {
    match value {
        OptionValue::Text(text) if text == "mm" => Ok(LengthUnit::Mm),
        OptionValue::Text(text) if text == "inch" => Ok(LengthUnit::Inch),
        _ => Err(MachineError::Option { name: UNITS_OPTION.into(), problem: "it takes \"mm\" or \"inch\"".into() }),
    }
}

fn syntax_error(text: &str, error: &toml::de::Error) -> MachineError {
    MachineError::Document { place: line_of(text, error), message: error.message().into(), similar: None }
}

fn document_error(text: &str, error: &serde_path_to_error::Error<toml::de::Error>) -> MachineError {
    let message = error.inner().message().to_string();
    let path = error.path().to_string();
    let line = line_of(text, error.inner());
    let place = if path == "." { line } else { format!("{path} ({line})") };
    MachineError::Document { place, similar: similar_key(&message), message }
}

fn line_of(text: &str, error: &toml::de::Error) -> String {
    let start = error.span().map_or(0, |s| s.start);
    let before = text.get(..start).unwrap_or_default();
    format!("line {}", before.matches('\n').count() + 1)
}

/// The known key most like the unknown one: serde names both between backticks.
fn similar_key(message: &str) -> Option<String> {
    let mut names = message.strip_prefix("unknown field `")?.split('`').step_by(2);
    let unknown = names.next()?;
    most_similar(unknown, names)
}
