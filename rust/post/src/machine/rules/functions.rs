//! Tools, spindle, coolant, waits and stops: what is not motion.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How a tool comes into the spindle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ToolChange {
    /// `T1 M6`: the machine changes it, or asks for it.
    M6,
    /// `T1` alone changes it.
    T,
    /// `TOOL CALL 1 Z`: the block changes it and gives its length (Klartext).
    ToolCall,
    /// The program stops and the operator changes it; lengths must be equal, since nothing corrects them.
    Pause,
    /// The one tool is in the spindle before the start; T names it. A second one is an error.
    LoadBeforeStart,
    /// The same, and no word names it: T does something else here.
    Unsaid,
}

/// How a tool's length is applied: `G43 H1`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LengthRules {
    /// The code: `G43`.
    pub code: String,
    /// The letter of the offset's number: `H`.
    pub word: char,
    /// Whether it stands in the first block that moves Z, not in one of its own.
    #[serde(default)]
    pub with_z: bool,
    /// The code that takes it back: `G49`.
    pub cancel: Option<String>,
}

/// Tools.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ToolRules {
    /// How a tool comes into the spindle.
    pub change: ToolChange,
    /// How its length is applied; a controller without this has no offsets, or applies them by itself.
    pub length: Option<LengthRules>,
    /// Largest tool number.
    pub max_number: u32,
    /// Whether T alone makes the next tool ready: `next_tool` in the templates is its number, else 0.
    #[serde(default)]
    pub preselect: bool,
}

/// A unit of the spindle's speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SpeedUnit {
    /// Revolutions in a minute.
    #[default]
    Rpm,
    /// Hundredths of `limits.max_rpm`.
    Percent,
}

/// Spindle words; a word left out is a direction that the machine does not have.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpindleRules {
    /// Turn clockwise: `M3`; the speed comes before it.
    pub clockwise: Option<String>,
    /// Turn counterclockwise: `M4`.
    pub counterclockwise: Option<String>,
    /// Stop: `M5`.
    pub off: Option<String>,
    /// The letter of the speed: `S`; Marlin forks with `P` for percent exist.
    #[serde(default = "letter_s")]
    pub word: char,
    /// The speed's unit.
    #[serde(default)]
    pub unit: SpeedUnit,
    /// A wait after every start, s: for controllers that do not wait for the speed.
    #[serde(default)]
    pub start_dwell: f64,
}

fn letter_s() -> char {
    'S'
}

/// Coolant words; a word left out is something that the machine does not have.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CoolantRules {
    /// Mist on: `M7`.
    pub mist: Option<String>,
    /// Flood on: `M8`.
    pub flood: Option<String>,
    /// Everything off: `M9`.
    pub off: Option<String>,
}

/// A unit of time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TimeUnit {
    /// Seconds, with a fraction.
    S,
    /// Milliseconds, whole.
    Ms,
}

/// The wait, `G4`, in a block of its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DwellRules {
    /// The letter that carries the time: P, X, S, F or K.
    pub word: char,
    /// Its unit.
    pub unit: TimeUnit,
    /// What stands before `G4` while feeds are per revolution, since many controls count revolutions then; the code of feeds
    /// per minute when left out.
    pub before: Option<String>,
}

/// Words that stop the program; one left out is a stop that the controller does not have.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StopRules {
    /// Until the operator goes on: `M0`.
    pub always: Option<String>,
    /// The same where the operator's switch is on: `M1`.
    pub optional: Option<String>,
    /// Whether they stop spindle and coolant as well: they are switched on again behind them.
    #[serde(default)]
    pub stops_spindle: bool,
}

/// The retract to a height without obstacles.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RetractRules {
    /// Lines that send Z to the machine's top: `G53 G0 Z0`; `retract` in the templates. Where there are none, the program's own last rapid must do.
    #[serde(default)]
    pub lines: String,
}
