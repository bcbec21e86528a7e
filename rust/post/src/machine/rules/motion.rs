//! Feeds, arcs, holes, axes and limits: what shapes motion.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_motion::{Cycle, CycleKind, Plane};

use super::TimeUnit;

/// What an F word counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FeedMode {
    /// Output units in a minute: G94.
    #[default]
    PerMinute,
    /// Output units in a revolution of the spindle: G95.
    PerRevolution,
    /// Moves of this length in a minute: G93.
    InverseTime,
}

/// Feeds. A program's feeds are mm/min; the mode decides how they are written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FeedRules {
    /// How feeds are posted.
    #[serde(default)]
    pub mode: FeedMode,
    /// The code of feeds per minute: `G94`.
    pub per_minute: Option<String>,
    /// The code of feeds per revolution: `G95`.
    pub per_revolution: Option<String>,
    /// The code of inverse time: `G93`.
    pub inverse_time: Option<String>,
    /// How many F there are to a mm/min when the output is in mm.
    #[serde(default = "one")]
    pub mm_scale: f64,
    /// How many F there are to an inch/min when the output is in inches: 10 on controls that count tenths.
    #[serde(default = "one")]
    pub inch_scale: f64,
}

fn one() -> f64 {
    1.0
}

impl Default for FeedRules {
    fn default() -> Self {
        let (per_minute, per_revolution, inverse_time) = Default::default();
        Self { mode: FeedMode::PerMinute, per_minute, per_revolution, inverse_time, mm_scale: 1.0, inch_scale: 1.0 }
    }
}

impl FeedRules {
    /// The code of the mode in which feeds are posted.
    #[must_use]
    pub fn word(&self) -> Option<&str> {
        match self.mode {
            FeedMode::PerMinute => self.per_minute.as_deref(),
            FeedMode::PerRevolution => self.per_revolution.as_deref(),
            FeedMode::InverseTime => self.inverse_time.as_deref(),
        }
    }
}

/// How far an arc's ends may differ in their distance from its centre, mm: text is rounded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RadiusError {
    /// A difference that is always taken, mm.
    pub absolute: f64,
    /// A larger one is taken up to this share of the radius,
    pub relative: f64,
    /// and never beyond this, mm.
    pub most: f64,
}

impl RadiusError {
    /// Whether the controller takes an arc of this radius whose ends differ so much, mm.
    #[must_use]
    pub fn takes(&self, mismatch: f64, radius: f64) -> bool {
        mismatch <= self.absolute || mismatch <= (self.relative * radius).min(self.most)
    }
}

/// How an arc's centre is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ArcCentre {
    /// I, J and K from the start.
    #[default]
    Incremental,
    /// I, J and K from the zero point.
    Absolute,
}

/// How full turns beyond the first arrival are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Turns {
    /// They are not: each turn is a block.
    #[default]
    None,
    /// `P2`: arrivals at the end, one more than full turns.
    Arrivals,
    /// `TURN=1`: full turns.
    Extra,
}

/// Arcs: G2 and G3, the centre given by I, J and K.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArcRules {
    /// How exact an arc must be.
    pub radius_error: RadiusError,
    /// How its centre is written.
    #[serde(default)]
    pub centre: ArcCentre,
    /// How full turns are written.
    #[serde(default)]
    pub turns: Turns,
    /// Whether a full circle needs an axis word.
    #[serde(default)]
    pub needs_axis: bool,
    /// Planes that have arcs.
    #[serde(default = "all_planes")]
    pub planes: Vec<Plane>,
    /// Whether the third axis may move along.
    #[serde(default = "super::yes")]
    pub helix: bool,
    /// Largest angle of one block, degrees; larger ones are split evenly.
    #[serde(default = "full_turn")]
    pub max_sweep_deg: f64,
    /// Smaller ones become lines, mm.
    #[serde(default)]
    pub min_radius: f64,
    /// Larger ones become lines, mm.
    pub max_radius: Option<f64>,
    /// The letter of the radius, where people write it: `R`; empty where the controller reads none.
    #[serde(default = "letter_r")]
    pub radius_word: String,
}

fn all_planes() -> Vec<Plane> {
    vec![Plane::Xy, Plane::Zx, Plane::Yz]
}

fn full_turn() -> f64 {
    360.0
}

fn letter_r() -> String {
    "R".into()
}

/// Drilling cycles that the controller has; holes of other kinds are made of plain moves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CycleRules {
    /// What they are.
    pub kinds: Vec<CycleKind>,
    /// Unit of the dwell, P.
    pub dwell_unit: TimeUnit,
    /// Whether G86 needs a P, of 0 where nothing waits.
    #[serde(default)]
    pub stop_bore_dwell: bool,
}

impl CycleRules {
    /// Whether the machine has a cycle for this. Only cycles that drill or bore to a depth wait there.
    #[must_use]
    pub fn take(&self, cycle: &Cycle) -> bool {
        let waits = matches!(cycle.kind, CycleKind::Drill | CycleKind::Bore | CycleKind::StopBore);
        self.kinds.contains(&cycle.kind) && (cycle.dwell == 0.0 || waits)
    }
}

/// The codes of straight probing.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProbeRules {
    /// Stops the program when nothing is touched: `G38.2`.
    pub must_touch: String,
    /// Goes on then: `G38.3`.
    pub may_touch: Option<String>,
}

/// How X counts on a machine with a turning part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Lathe {
    /// X is the distance from the turning axis.
    Radius,
    /// X is twice that.
    Diameter,
}

/// How rapids run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Rapids {
    /// All axes arrive together.
    Straight,
    /// Each axis at its own speed, or it is not known.
    #[default]
    DogLeg,
}

/// How moves are written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MotionRules {
    /// Whether a rapid that goes across and down, or up and across, becomes two blocks, along the higher path.
    #[serde(default = "super::yes")]
    pub split_rapids: bool,
    /// How rapids run.
    #[serde(default)]
    pub rapids: Rapids,
    /// Whether a rapid needs F, as `limits.rapid_rate`: it runs at the last feed otherwise.
    #[serde(default)]
    pub rapid_feed: bool,
    /// A machine with X and Z only, around a turning part.
    pub lathe: Option<Lathe>,
}

impl Default for MotionRules {
    fn default() -> Self {
        Self { split_rapids: true, rapids: Rapids::DogLeg, rapid_feed: false, lathe: None }
    }
}

/// Rounding of the path by the controller. The tolerance is part of the path's error: planning subtracts it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SmoothingRules {
    /// How far the controller may leave the programmed path, mm; 0 is exact.
    #[serde(default)]
    pub tolerance: f64,
    /// Template of the block that sets it; `tolerance` is in output units, rounded down.
    pub on: Option<String>,
    /// The block for an exact path.
    pub off: Option<String>,
}

/// What the machine can do. Lengths mm in work coordinates, feeds mm/min, speeds rev/min.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Lowest and highest posted X, mm, with the zero point where the job puts it.
    pub x: Option<[f64; 2]>,
    /// Lowest and highest posted Y, mm.
    pub y: Option<[f64; 2]>,
    /// Lowest and highest posted Z, mm.
    pub z: Option<[f64; 2]>,
    /// Lengths of the axes, mm, wherever the zero point is.
    pub travel: Option<[f64; 3]>,
    /// Largest feed, mm/min.
    pub max_feed: Option<f64>,
    /// Speed of rapids, mm/min: for estimates of time.
    pub rapid_rate: f64,
    /// Fastest of X, Y and Z, mm/min, of rapids and feeds: for estimates of time.
    pub axis_rate: Option<[f64; 3]>,
    /// Acceleration along the path, mm/s^2: for estimates of time, and for `slow_corners`; without it speeds change at once.
    pub acceleration: Option<f64>,
    /// Accelerations of X, Y and Z, mm/s^2: for estimates of time, where a move is accelerated as far as its axes allow.
    pub axis_acceleration: Option<[f64; 3]>,
    /// How far the controller cuts corners, mm: for estimates of time, where it is the smoothing's tolerance when left out, and for `slow_corners`, where it is 0.01.
    pub corner_tolerance: Option<f64>,
    /// Whether it runs along arcs that cut corners so far and take half of a move at most: for estimates of time. Else a corner is as fast as such an arc of any length.
    #[serde(default)]
    pub blends: bool,
    /// Whether it stops between rapids and feeds: for estimates of time.
    #[serde(default)]
    pub stops_at_rapids: bool,
    /// Blocks that the controller reads in a second: for estimates of time.
    pub blocks_per_second: Option<f64>,
    /// Smallest spindle speed, rev/min.
    pub min_rpm: Option<f64>,
    /// Largest spindle speed, rev/min.
    pub max_rpm: Option<f64>,
    /// Largest force along the spindle that it withstands, N: for forming.
    pub max_axial_force: Option<f64>,
}
