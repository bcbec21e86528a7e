//! Machines: everything about a controller that a post or a reader needs, as data from a TOML file.

mod check;
mod error;
mod inherit;
mod option;
mod rules;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_motion::{Cycle, Dynamics};

pub(crate) use error::most_similar;
pub use error::MachineError;
pub use option::{OptionRule, OptionValue, BUILT_IN_OPTIONS};
pub use rules::*;

use crate::number::NumberFormat;

/// Holes of fewer last places are made of plain moves: controllers refuse a cycle of no depth.
const LEAST_DEPTH: f64 = 3.0;

/// Version of the machine document; newer ones are refused.
pub const MACHINE_SCHEMA: u32 = 1;

/// The machine files that come with the release: a name and the text.
const SHIPPED: [(&str, &str); 21] = [
    ("brother", include_str!("../machines/brother.toml")),
    ("carvera", include_str!("../machines/carvera.toml")),
    ("centroid", include_str!("../machines/centroid.toml")),
    ("fanuc", include_str!("../machines/fanuc.toml")),
    ("fluidnc", include_str!("../machines/fluidnc.toml")),
    ("grbl", include_str!("../machines/grbl.toml")),
    ("grblhal", include_str!("../machines/grblhal.toml")),
    ("haas", include_str!("../machines/haas.toml")),
    ("heidenhain", include_str!("../machines/heidenhain.toml")),
    ("linuxcnc", include_str!("../machines/linuxcnc.toml")),
    ("mach3", include_str!("../machines/mach3.toml")),
    ("mach4", include_str!("../machines/mach4.toml")),
    ("marlin", include_str!("../machines/marlin.toml")),
    ("masso", include_str!("../machines/masso.toml")),
    ("mazak", include_str!("../machines/mazak.toml")),
    ("mitsubishi", include_str!("../machines/mitsubishi.toml")),
    ("okuma", include_str!("../machines/okuma.toml")),
    ("reprapfirmware", include_str!("../machines/reprapfirmware.toml")),
    ("siemens", include_str!("../machines/siemens.toml")),
    ("smoothieware", include_str!("../machines/smoothieware.toml")),
    ("uccnc", include_str!("../machines/uccnc.toml")),
];

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
    /// Work offsets that it takes: `G54`, `G54.1 P1`. The first is in force when a program says none.
    pub wcs: Vec<String>,
    /// What the controller calls them, one for one, where that differs: `G15 H1`.
    #[serde(default)]
    pub wcs_words: Vec<String>,
    /// The word that ends a program: `M2`; empty where there is none.
    pub end: String,
    /// What the facts were taken from.
    pub source: Source,
    /// How programs are named.
    #[serde(default)]
    pub program: ProgramRules,
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
    /// How moves are written.
    #[serde(default)]
    pub motion: MotionRules,
    /// Feeds.
    #[serde(default)]
    pub feed: FeedRules,
    /// Tool changes and lengths.
    pub tool: ToolRules,
    /// The way up between tools.
    #[serde(default)]
    pub retract: RetractRules,
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
    /// Words that stop the program.
    #[serde(default)]
    pub stop: StopRules,
    /// Arcs; a machine without them gets lines.
    pub arc: Option<ArcRules>,
    /// Drilling cycles; a machine without them gets moves.
    pub cycle: Option<CycleRules>,
    /// Probing; a machine without it refuses it.
    pub probe: Option<ProbeRules>,
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
    /// Those of [`from_toml`](Self::from_toml), with keys for places.
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
    /// [`MachineError::Document`] for values that a file cannot say.
    pub fn to_toml(&self) -> Result<String, MachineError> {
        toml::to_string_pretty(self).map_err(|e| MachineError::Document {
            place: self.name.clone(),
            message: e.to_string(),
            similar: None,
        })
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

    /// Sets an option: one that every machine has (see [`BUILT_IN_OPTIONS`]), or one of its own.
    ///
    /// # Errors
    /// [`MachineError::UnknownOption`], [`MachineError::Option`], [`MachineError::Value`]; the machine stays as it was.
    pub fn set_option(&mut self, name: &str, value: OptionValue) -> Result<(), MachineError> {
        let mut machine = self.clone();
        if !option::set_built_in(&mut machine, name, &value)? {
            machine.set_own_option(name, value)?;
        }
        machine.check()?;
        *self = machine;
        Ok(())
    }

    fn set_own_option(&mut self, name: &str, value: OptionValue) -> Result<(), MachineError> {
        let built_in = BUILT_IN_OPTIONS.iter().map(|(name, _)| *name);
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
        self.units.output.in_mm() / self.feed_format().per_one() / self.feed_scale()
    }

    /// One unit of the last posted place of a spindle's speed, rev/min.
    #[must_use]
    pub fn speed_resolution(&self) -> f64 {
        let unit = NumberFormat::plain(self.number.rpm).per_one().recip();
        match (self.spindle.unit, self.limits.max_rpm) {
            (SpeedUnit::Percent, Some(most)) => unit * most / 100.0,
            _ => unit,
        }
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

    /// The way feeds are written in the mode in force; they are never negative.
    pub(crate) fn feed_format(&self) -> NumberFormat {
        let decimals = self.decimals();
        let places = match self.feed.mode {
            FeedMode::PerMinute => decimals.feed,
            FeedMode::PerRevolution => decimals.feed_per_revolution,
            FeedMode::InverseTime => decimals.inverse_time,
        };
        NumberFormat::new(&self.number, places).unsigned()
    }

    /// How many F there are to one output unit in a minute.
    pub(crate) fn feed_scale(&self) -> f64 {
        self.feed_scale_of(Some(self.units.output))
    }

    /// Whether a hole is posted as a cycle; cycles have no inverse time.
    pub(crate) fn takes_cycle(&self, cycle: &Cycle) -> bool {
        let feeds = self.feed.mode != FeedMode::InverseTime;
        let unit = self.resolution_mm();
        let deep = cycle.retract - cycle.bottom >= LEAST_DEPTH * unit && (cycle.peck <= 0.0 || cycle.peck >= unit);
        feeds && deep && self.cycle.as_ref().is_some_and(|rules| rules.take(cycle))
    }

    /// How many F there are to one of these units in a minute.
    pub(crate) fn feed_scale_of(&self, units: Option<LengthUnit>) -> f64 {
        match units {
            Some(LengthUnit::Inch) => self.feed.inch_scale,
            _ => self.feed.mm_scale,
        }
    }

    /// What the controller calls a work offset.
    pub(crate) fn wcs_words_of(&self, wcs: &str) -> Option<&str> {
        let index = self.wcs.iter().position(|name| name == wcs)?;
        self.wcs_words.get(index).or_else(|| self.wcs.get(index)).map(String::as_str)
    }

    /// The word that selects the output's units.
    pub(crate) fn units_word(&self) -> Option<&str> {
        match self.units.output {
            LengthUnit::Mm => self.units.mm.as_deref(),
            LengthUnit::Inch => self.units.inch.as_deref(),
        }
    }
}
