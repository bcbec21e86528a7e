//! The values of a machine file, and what follows from them.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_motion::{Cornering, Cycle, Dynamics, FeedRounding};

use super::option::OptionRule;
use super::rules::*;
use crate::number::NumberFormat;

/// Holes of fewer units of the last decimal are made of plain moves: controllers refuse a cycle of no depth.
const LEAST_DEPTH: f64 = 3.0;

/// A path whose ends are rounded may be longer or shorter by so many units of the last decimal.
const COORDINATES_OF_A_LENGTH: f64 = 4.0;

/// Version of the machine document; newer ones are refused.
pub const MACHINE_SCHEMA: u32 = 1;

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
    /// Work offsets that it takes: `G54`, `G54.1 P1`. The first is in force when a program states none.
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
    /// The retract between tools.
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
    /// Axes that turn the part or the tool; a machine without them refuses tools that lean.
    pub rotary: Option<RotaryRules>,
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

/// How far a path may be from corners, mm, where a machine file does not state it: what GRBL is shipped with ($11).
const JUNCTION_DEVIATION: f64 = 0.01;

impl Machine {
    /// One unit of the last posted decimal, mm: rounding moves a coordinate by half of it at most.
    #[must_use]
    pub fn resolution_mm(&self) -> f64 {
        self.units.output.in_mm() / self.linear_format().per_one()
    }

    /// One unit of the last posted decimal of a feed, mm/min.
    #[must_use]
    pub fn feed_resolution_mm(&self) -> f64 {
        self.units.output.in_mm() / self.feed_format().per_one() / self.feed_scale()
    }

    /// How far feeds may be off that are read back, with the spindle at `rpm`, 0 while it stands: by half a unit of their last
    /// decimal, and by what the speed and the coordinates are off where feeds follow from them.
    #[must_use]
    pub fn feed_rounding(&self, rpm: f64) -> FeedRounding {
        let half = self.feed_resolution_mm() / 2.0;
        let none = FeedRounding::default();
        match self.feed.mode {
            FeedMode::PerMinute => FeedRounding { per_minute: half, ..none },
            FeedMode::PerRevolution if rpm > 0.0 => {
                FeedRounding { per_minute: half * rpm, share: self.speed_resolution() / rpm, ..none }
            }
            FeedMode::PerRevolution => none,
            FeedMode::InverseTime => FeedRounding {
                per_mm: half * self.feed_scale() / self.units.output.in_mm(),
                length: COORDINATES_OF_A_LENGTH * self.resolution_mm(),
                ..none
            },
        }
    }

    /// One unit of the last posted decimal of a spindle's speed, rev/min.
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
            axis_rate: limits.axis_rate,
            acceleration: limits.acceleration,
            axis_acceleration: limits.axis_acceleration,
            blends: limits.blends,
            stops_at_rapids: limits.stops_at_rapids,
            corner_tolerance: limits.corner_tolerance.unwrap_or(self.path_tolerance_mm()),
            blocks_per_second: limits.blocks_per_second,
        }
    }

    /// What decides how fast it may turn; none where its acceleration is not known.
    #[must_use]
    pub fn cornering(&self) -> Option<Cornering> {
        let deviation = self.limits.corner_tolerance.filter(|cut| *cut > 0.0).unwrap_or(JUNCTION_DEVIATION);
        let unit = self.resolution_mm();
        self.limits.acceleration.map(|acceleration| Cornering { acceleration, deviation, unit })
    }

    /// Decimal places in the output's units.
    pub(crate) fn decimals(&self) -> Decimals {
        match self.units.output {
            LengthUnit::Mm => self.number.mm,
            LengthUnit::Inch => self.number.inch,
        }
    }

    /// How coordinates are written.
    pub(crate) fn linear_format(&self) -> NumberFormat {
        NumberFormat::new(&self.number, self.decimals().linear)
    }

    /// How angles of rotary axes are written.
    pub(crate) fn angle_format(&self) -> NumberFormat {
        NumberFormat::new(&self.number, self.rotary.as_ref().map_or(0, |rules| rules.angle_decimals))
    }

    /// How feeds are written in the mode in force; they are never negative.
    pub(crate) fn feed_format(&self) -> NumberFormat {
        let decimals = self.decimals();
        let places = match self.feed.mode {
            FeedMode::PerMinute => decimals.feed,
            FeedMode::PerRevolution => decimals.feed_per_revolution,
            FeedMode::InverseTime => decimals.inverse_time,
        };
        NumberFormat::new(&self.number, places).unsigned()
    }

    /// The length, mm, whose feed a block takes whose tip goes so far while an axis turns so much, deg: a turn on the spot takes as
    /// long as a mm for each degree.
    pub(crate) fn way(&self, length: f64, turned_deg: f64) -> f64 {
        if length < self.resolution_mm() {
            turned_deg.max(length)
        } else {
            length
        }
    }

    /// How many F there are to one output unit in a minute.
    pub(crate) fn feed_scale(&self) -> f64 {
        self.feed_scale_of(Some(self.units.output))
    }

    /// Whether a hole is posted as a cycle; cycles have no inverse time.
    #[must_use]
    pub fn takes_cycle(&self, cycle: &Cycle) -> bool {
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
