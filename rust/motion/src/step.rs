//! One move: its end, its arc, its feed, its role.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{Arc, ArcPath, Pose, UnitAxis};

/// What a move is for the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MoveKind {
    /// Positioning at the machine's rapid rate.
    Rapid,
    /// A line or an arc at a feed.
    Feed,
}

/// What a feed move is for the work. Posted texts state it in remarks; one without remarks states none, and its moves are checked as
/// if they were passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Role {
    /// Along a pass.
    Cut,
    /// Into or out of a pass.
    Lead,
    /// Down along a slope or a helix.
    Ramp,
    /// From one pass to the next.
    Link,
}

/// What the number of a feed means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FeedMode {
    /// mm/min (G94).
    #[default]
    PerMinute,
    /// mm per revolution of the spindle (G95).
    PerRevolution,
    /// The reciprocal of the move's time, 1/min (G93).
    InverseTime,
}

impl FeedMode {
    fn is_per_minute(&self) -> bool {
        *self == Self::PerMinute
    }
}

/// One move of the controlled point, straight unless it has an arc, from the end of the one before it.
///
/// [`Move::rapid`] and [`Move::feed`] make one, the other methods add what differs from an upright tool's plain move.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(from = "Written", into = "Written")]
pub struct Move {
    /// Rapid or feed.
    pub kind: MoveKind,
    /// Where it ends and how the tool stands there.
    pub end: Pose,
    /// How it turns on its path; straight when none. Rapids are straight.
    pub arc: Option<Arc>,
    /// Feed in the unit of its mode; 0 on rapids.
    pub feed: f64,
    /// What the feed's number means.
    pub feed_mode: FeedMode,
    /// What it is for, where the text states it.
    pub role: Option<Role>,
    /// Index into [`crate::Program::operations`].
    pub operation: u32,
    /// Line of the text that it was read from, from 1; 0 when it was not read from text.
    pub line: u32,
}

impl Move {
    /// A rapid of an upright tool to a point, mm.
    #[must_use]
    pub const fn rapid(tip: [f64; 3]) -> Self {
        Self::new(MoveKind::Rapid, tip, 0.0)
    }

    /// A straight feed move of an upright tool to a point, mm, at a feed in mm/min.
    #[must_use]
    pub const fn feed(tip: [f64; 3], mm_per_min: f64) -> Self {
        Self::new(MoveKind::Feed, tip, mm_per_min)
    }

    /// A straight move of either kind, of an upright tool: for readers, whose text decides the kind.
    #[must_use]
    pub const fn new(kind: MoveKind, tip: [f64; 3], feed: f64) -> Self {
        let end = Pose::upright(tip);
        Self { kind, end, arc: None, feed, feed_mode: FeedMode::PerMinute, role: None, operation: 0, line: 0 }
    }

    /// The same move along an arc, or straight.
    #[must_use]
    pub fn arc(self, arc: impl Into<Option<Arc>>) -> Self {
        Self { arc: arc.into(), ..self }
    }

    /// The same move to another point, mm; the axis at its end stays.
    #[must_use]
    pub const fn to(self, tip: [f64; 3]) -> Self {
        Self { end: Pose { tip, axis: self.end.axis }, ..self }
    }

    /// The same move with this axis at its end.
    #[must_use]
    pub const fn with_axis(self, axis: UnitAxis) -> Self {
        Self { end: Pose { tip: self.end.tip, axis }, ..self }
    }

    /// The same move with a number of another feed mode.
    #[must_use]
    pub const fn with_feed(self, feed: f64, feed_mode: FeedMode) -> Self {
        Self { feed, feed_mode, ..self }
    }

    /// The same move in a role.
    #[must_use]
    pub const fn role(self, role: Role) -> Self {
        Self { role: Some(role), ..self }
    }

    /// Whether it runs along a pass, or states nothing else.
    #[must_use]
    pub fn is_along_pass(&self) -> bool {
        self.role.is_none_or(|role| role == Role::Cut)
    }

    /// The same move in an operation, an index into [`crate::Program::operations`].
    #[must_use]
    pub const fn of_operation(self, operation: u32) -> Self {
        Self { operation, ..self }
    }

    /// The same move read from a line, from 1.
    #[must_use]
    pub const fn on_line(self, line: u32) -> Self {
        Self { line, ..self }
    }

    /// The path of an arc that starts at `start`; none when the move is straight.
    #[must_use]
    pub fn path(&self, start: [f64; 3]) -> Option<ArcPath> {
        self.arc.map(|arc| arc.path(start, self.end.tip))
    }

    /// The box around it, lowest and highest coordinates, mm; of a straight move without its start.
    #[must_use]
    pub fn bounds(&self, start: Option<[f64; 3]>) -> ([f64; 3], [f64; 3]) {
        start.and_then(|start| self.path(start)).map_or((self.end.tip, self.end.tip), |arc| arc.bounds())
    }

    /// Its length from `start`, mm.
    #[must_use]
    pub fn length(&self, start: [f64; 3]) -> f64 {
        let [dx, dy, dz] = [0, 1, 2].map(|axis| self.end.tip[axis] - start[axis]);
        self.path(start).map_or_else(|| (dx * dx + dy * dy + dz * dz).sqrt(), |arc| arc.length())
    }

    /// Its feed over a length, mm/min, with the spindle at `rpm`; none for a feed per revolution of a spindle that
    /// stands, and for a rapid.
    #[must_use]
    pub fn mm_per_min(&self, length: f64, rpm: Option<f64>) -> Option<f64> {
        match (self.kind, self.feed_mode) {
            (MoveKind::Rapid, _) => None,
            (MoveKind::Feed, FeedMode::PerMinute) => Some(self.feed),
            (MoveKind::Feed, FeedMode::PerRevolution) => rpm.map(|rpm| self.feed * rpm),
            (MoveKind::Feed, FeedMode::InverseTime) => Some(self.feed * length),
        }
    }
}

/// A move as it is written: what is usual is left out.
#[derive(Serialize, Deserialize, JsonSchema)]
struct Written {
    /// Rapid or feed.
    kind: MoveKind,
    /// Where it ends, work coordinates, mm.
    end: [f64; 3],
    /// The tool's axis there, a unit vector from the tip up; +Z when left out.
    #[serde(default, skip_serializing_if = "is_plain_up")]
    axis: UnitAxis,
    /// How it turns on its path; straight when left out. Rapids are straight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    arc: Option<Arc>,
    /// Feed in the unit of its mode; 0 on rapids.
    feed: f64,
    /// What the feed's number means; mm/min when left out.
    #[serde(default, skip_serializing_if = "FeedMode::is_per_minute")]
    feed_mode: FeedMode,
    /// What it is for; not stated when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    role: Option<Role>,
    /// Index of its operation.
    operation: u32,
    /// Line of the text that it was read from, from 1; 0, or left out, when it was not read from text.
    #[serde(default, skip_serializing_if = "is_zero")]
    line: u32,
}

impl From<Written> for Move {
    fn from(written: Written) -> Self {
        let Written { kind, end: tip, axis, arc, feed, feed_mode, role, operation, line } = written;
        Self { kind, end: Pose { tip, axis }, arc, feed, feed_mode, role, operation, line }
    }
}

impl From<Move> for Written {
    fn from(step: Move) -> Self {
        let Move { kind, end: Pose { tip: end, axis }, arc, feed, feed_mode, role, operation, line } = step;
        Self { kind, end, axis, arc, feed, feed_mode, role, operation, line }
    }
}

#[allow(clippy::trivially_copy_pass_by_ref)] // serde hands a reference
fn is_zero(line: &u32) -> bool {
    *line == 0
}

/// Exactly +Z: what is only nearly so is written as it is.
fn is_plain_up(axis: &UnitAxis) -> bool {
    *axis == UnitAxis::UP
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Plane;

    #[test]
    fn what_is_usual_is_left_out_of_files() {
        let text = |step: Move| serde_json::to_string(&step).unwrap();
        let plain = Move::feed([1.0, 2.0, 3.0], 500.0).of_operation(2);
        assert_eq!(text(plain), r#"{"kind":"feed","end":[1.0,2.0,3.0],"feed":500.0,"operation":2}"#);
        let axis = UnitAxis::new([0.6, 0.0, 0.8]).unwrap();
        let arc = Arc { centre: [0.0; 3], plane: Plane::Xy, clockwise: true, turns: 0 };
        let full = plain.arc(arc).with_axis(axis).with_feed(0.1, FeedMode::PerRevolution).role(Role::Ramp).on_line(7);
        assert_eq!(
            text(full),
            concat!(
                r#"{"kind":"feed","end":[1.0,2.0,3.0],"axis":[0.6,0.0,0.8],"#,
                r#""arc":{"centre":[0.0,0.0,0.0],"plane":"xy","clockwise":true,"turns":0},"#,
                r#""feed":0.1,"feed_mode":"per-revolution","role":"ramp","operation":2,"line":7}"#
            )
        );
        for step in [plain, full, Move::rapid([0.0; 3])] {
            assert_eq!(serde_json::from_str::<Move>(&text(step)).unwrap(), step);
        }
    }

    #[test]
    fn an_axis_that_is_no_direction_is_refused() {
        let text = r#"{"kind":"feed","end":[1.0,2.0,3.0],"axis":[0.0,0.0,2.0],"feed":500.0,"operation":2}"#;
        let error = serde_json::from_str::<Move>(text).unwrap_err().to_string();
        assert!(error.contains("(0, 0, 2) is not a unit vector"), "{error}");
    }

    #[test]
    fn feeds_of_all_modes_in_mm_per_min() {
        let step = |feed, mode| Move::feed([0.0; 3], 1.0).with_feed(feed, mode);
        assert_eq!(step(300.0, FeedMode::PerMinute).mm_per_min(20.0, None), Some(300.0));
        assert_eq!(step(0.5, FeedMode::PerRevolution).mm_per_min(20.0, Some(1000.0)), Some(500.0));
        assert_eq!(step(0.5, FeedMode::PerRevolution).mm_per_min(20.0, None), None);
        // 3 per minute: 20 s for 20 mm
        assert_eq!(step(3.0, FeedMode::InverseTime).mm_per_min(20.0, None), Some(60.0));
        assert_eq!(Move::rapid([0.0; 3]).mm_per_min(20.0, None), None);
    }
}
