//! What cannot be measured.

use std::fmt;

use styluscam_motion::Cancelled;

use super::runs::{Ground, PlaneRun, CHIP};

/// Coordinates lie within this, mm.
const FARTHEST: f64 = 1e6;

/// The engagement could not be measured.
#[derive(Clone, Debug, PartialEq)]
pub enum EngagementError {
    /// A number is missing or out of its range: what, where it stands, what is expected.
    Number {
        /// The argument, with the number of the run or outline and of the point.
        key: String,
        /// The number as given.
        value: f64,
        /// What is allowed, in words.
        allowed: &'static str,
    },
    /// An outline with too few points to hold an area.
    Outline {
        /// The argument and the number of the outline.
        key: String,
        /// Points that it has.
        count: usize,
    },
    /// Stopped from outside.
    Cancelled,
}

impl EngagementError {
    /// A stable name for scripts.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Self::Number { .. } => "out-of-range",
            Self::Outline { .. } => "outline",
            Self::Cancelled => "cancelled",
        }
    }

    /// The argument that is at fault.
    #[must_use]
    pub fn key(&self) -> &str {
        match self {
            Self::Number { key, .. } | Self::Outline { key, .. } => key,
            Self::Cancelled => "",
        }
    }
}

impl fmt::Display for EngagementError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number { key, value, allowed } => write!(f, "{key} = {value}: expected {allowed}"),
            Self::Outline { key, count } => {
                write!(f, "{key} has {count} points: an outline needs three, or two with a bulge")
            }
            Self::Cancelled => write!(f, "cancelled"),
        }
    }
}

impl std::error::Error for EngagementError {}

impl From<Cancelled> for EngagementError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// Refuses what is no path, no outline, no tool.
pub fn check(runs: &[PlaneRun], ground: &Ground<'_>) -> Result<(), EngagementError> {
    let radius = ground.radius;
    if !(radius.is_finite() && radius > 2.0 * CHIP && radius <= FARTHEST) {
        let key = "tool_radius".to_owned();
        return Err(EngagementError::Number { key, value: radius, allowed: "a radius from 0.002 to 1e6 mm" });
    }
    for (number, run) in runs.iter().enumerate() {
        points(&format!("runs[{number}]"), &run.points)?;
    }
    for (number, swept) in ground.cleared.iter().enumerate() {
        let key = format!("cleared[{number}]");
        points(&key, &swept.points)?;
        if !(0.0..=FARTHEST).contains(&swept.radius) {
            let key = format!("{key}.radius");
            return Err(EngagementError::Number { key, value: swept.radius, allowed: "a radius from 0 to 1e6 mm" });
        }
    }
    for (name, outlines) in [("stock", ground.stock), ("boundary", ground.pocket)] {
        for (number, outline) in outlines.iter().enumerate() {
            let key = format!("{name}[{number}]");
            points(&key, outline)?;
            let is_curved = outline.iter().any(|[_, _, bulge]| *bulge != 0.0);
            if outline.len() < 2 || (outline.len() == 2 && !is_curved) {
                return Err(EngagementError::Outline { key, count: outline.len() });
            }
        }
    }
    Ok(())
}

fn points(key: &str, points: &[[f64; 3]]) -> Result<(), EngagementError> {
    for (number, point) in points.iter().enumerate() {
        if let Some(value) = point.iter().find(|value| !(-FARTHEST..=FARTHEST).contains(*value)) {
            let key = format!("{key}[{number}]");
            return Err(EngagementError::Number { key, value: *value, allowed: "finite numbers within +/-1e6" });
        }
    }
    Ok(())
}
