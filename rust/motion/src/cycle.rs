//! Holes: the moves that a controller's canned cycle makes, and the few numbers that call it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{EventKind, MoveKind, SpindleDirection};

/// How far above the last depth a peck goes on at feed, and how far a chip is broken by going up, mm: LinuxCNC's 0.010 in
/// (its G83 and G73). Other controllers have a parameter for it.
pub const PECK_CLEARANCE: f64 = 0.254;

/// Pecks of one hole at most.
pub const MOST_PECKS: usize = 10_000;

/// What is done at a hole, with the codes that most controllers have for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CycleKind {
    /// G81, and G82 with a dwell: down at feed, up at rapid.
    Drill,
    /// G83: down in pecks, out of the hole after each.
    Peck,
    /// G73: down in pecks, a little up after each.
    ChipBreak,
    /// G84: a right-hand thread; the spindle turns with the feed and back.
    Tap,
    /// G74: a left-hand thread.
    LeftTap,
    /// G85, and G89 with a dwell: down and up at feed.
    Bore,
    /// G86: down at feed, up at rapid with the spindle stopped.
    StopBore,
}

impl CycleKind {
    /// Whether the spindle must turn in step with the feed: such a hole cannot be made of plain moves.
    #[must_use]
    pub fn is_tapping(self) -> bool {
        matches!(self, Self::Tap | Self::LeftTap)
    }
}

/// A hole made by a canned cycle. Its moves and events stand in the program as well: a machine without such a cycle runs those.
///
/// Z are those of the tip, mm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Cycle {
    /// Index of its first move.
    pub first: usize,
    /// Number of its moves.
    pub count: usize,
    /// What is done.
    pub kind: CycleKind,
    /// Where, X and Y, mm.
    pub at: [f64; 2],
    /// Z down to which it goes at rapid.
    pub retract: f64,
    /// Z of the bottom.
    pub bottom: f64,
    /// Z at which it ends: `retract`, or where it came from.
    pub leave: f64,
    /// Feed, mm/min.
    pub feed: f64,
    /// Wait at the bottom, s.
    #[serde(default)]
    pub dwell: f64,
    /// Depth of a peck, mm; 0 where there are none.
    #[serde(default)]
    pub peck: f64,
}

/// One thing that a cycle does.
#[derive(Clone, Debug, PartialEq)]
pub enum CycleStep {
    /// A straight move to a point; the feed is the cycle's.
    Move(MoveKind, [f64; 3]),
    /// Something between moves.
    Event(EventKind),
}

/// Where a cycle starts and how the spindle turns then.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CycleStart {
    /// Where the tip is, mm.
    pub position: [f64; 3],
    /// Speed, rev/min, and sense of the spindle; none while it stands.
    pub spindle: Option<(f64, SpindleDirection)>,
}

impl Cycle {
    /// All that it does, in order (NIST RS274/NGC 3.5.16; LinuxCNC's manual, G73 and G81 to G89).
    ///
    /// None for a depth that takes more than [`MOST_PECKS`] pecks.
    #[must_use]
    pub fn steps(&self, start: &CycleStart) -> Option<Vec<CycleStep>> {
        let [x, y] = self.at;
        let mut steps = Vec::new();
        let high = start.position[2].max(self.retract);
        let [from_x, from_y, _] = start.position;
        for point in [[from_x, from_y, high], [x, y, high], [x, y, self.retract]] {
            rapid(&mut steps, start.position, point);
        }
        self.go_down(&mut steps)?;
        if self.dwell > 0.0 {
            steps.push(CycleStep::Event(EventKind::Dwell { seconds: self.dwell }));
        }
        self.go_up(&mut steps, start.spindle);
        Some(steps)
    }

    fn go_down(&self, steps: &mut Vec<CycleStep>) -> Option<()> {
        let [x, y] = self.at;
        let feed = |z: f64| CycleStep::Move(MoveKind::Feed, [x, y, z]);
        let quick = |z: f64| CycleStep::Move(MoveKind::Rapid, [x, y, z]);
        let pecking = matches!(self.kind, CycleKind::Peck | CycleKind::ChipBreak) && self.peck > 0.0;
        let pecks = if pecking { ((self.retract - self.bottom) / self.peck).ceil() } else { 1.0 };
        if !pecks.is_finite() || pecks > MOST_PECKS as f64 {
            return None;
        }
        let pecks = (pecks as usize).max(1);
        for peck in 1..pecks {
            let depth = self.retract - peck as f64 * self.peck;
            steps.push(feed(depth));
            match self.kind {
                CycleKind::Peck => {
                    steps.push(quick(self.retract));
                    steps.push(quick((depth + PECK_CLEARANCE).min(self.retract)));
                }
                _ => steps.push(quick((depth + PECK_CLEARANCE).min(self.retract))),
            }
        }
        steps.push(feed(self.bottom));
        Some(())
    }

    fn go_up(&self, steps: &mut Vec<CycleStep>, spindle: Option<(f64, SpindleDirection)>) {
        let [x, y] = self.at;
        let on = |(rpm, direction)| CycleStep::Event(EventKind::SpindleOn { rpm, direction });
        let off = CycleStep::Event(EventKind::SpindleOff);
        match self.kind {
            CycleKind::Drill | CycleKind::Peck | CycleKind::ChipBreak => {
                rapid(steps, [x, y, self.bottom], [x, y, self.leave]);
            }
            CycleKind::Bore => steps.push(CycleStep::Move(MoveKind::Feed, [x, y, self.retract])),
            CycleKind::StopBore => {
                steps.extend(spindle.map(|_| off));
                rapid(steps, [x, y, self.bottom], [x, y, self.leave]);
                steps.extend(spindle.map(on));
            }
            CycleKind::Tap | CycleKind::LeftTap => {
                steps.extend(spindle.map(|(rpm, direction)| on((rpm, direction.reversed()))));
                steps.push(CycleStep::Move(MoveKind::Feed, [x, y, self.retract]));
                steps.extend(spindle.map(on));
            }
        }
        if self.leave > self.retract && matches!(self.kind, CycleKind::Bore | CycleKind::Tap | CycleKind::LeftTap) {
            rapid(steps, [x, y, self.retract], [x, y, self.leave]);
        }
    }
}

/// A rapid, unless the tool stands there.
#[allow(clippy::float_cmp)] // the same point, not a near one
fn rapid(steps: &mut Vec<CycleStep>, start: [f64; 3], end: [f64; 3]) {
    let at = steps.iter().rev().find_map(|step| match step {
        CycleStep::Move(_, point) => Some(*point),
        CycleStep::Event(_) => None,
    });
    if at.unwrap_or(start) != end {
        steps.push(CycleStep::Move(MoveKind::Rapid, end));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hole(kind: CycleKind) -> Cycle {
        Cycle {
            first: 0,
            count: 0,
            kind,
            at: [10.0, 20.0],
            retract: 2.0,
            bottom: -4.0,
            leave: 2.0,
            feed: 100.0,
            dwell: 0.0,
            peck: 0.0,
        }
    }

    fn heights(cycle: &Cycle, from: [f64; 3]) -> Vec<(MoveKind, f64)> {
        let start = CycleStart { position: from, spindle: None };
        let steps = cycle.steps(&start).unwrap();
        let moves = steps.iter().filter_map(|s| match s {
            CycleStep::Move(kind, point) => Some((*kind, point[2])),
            CycleStep::Event(_) => None,
        });
        moves.collect()
    }

    #[test]
    fn a_hole_is_reached_across_and_then_down() {
        use MoveKind::{Feed, Rapid};
        let heights_down = heights(&hole(CycleKind::Drill), [0.0, 0.0, 10.0]);
        assert_eq!(heights_down, [(Rapid, 10.0), (Rapid, 2.0), (Feed, -4.0), (Rapid, 2.0)]);
        let from_below = heights(&hole(CycleKind::Drill), [0.0, 0.0, 1.0]);
        assert_eq!(from_below, [(Rapid, 2.0), (Rapid, 2.0), (Feed, -4.0), (Rapid, 2.0)]);
    }

    #[test]
    fn pecks_leave_the_hole_and_come_back_to_just_above() {
        use MoveKind::{Feed, Rapid};
        let cycle = Cycle { peck: 4.0, leave: 9.0, ..hole(CycleKind::Peck) };
        let heights_down = heights(&cycle, [10.0, 20.0, 2.0]);
        assert_eq!(heights_down, [(Feed, -2.0), (Rapid, 2.0), (Rapid, -2.0 + 0.254), (Feed, -4.0), (Rapid, 9.0)]);
        let chips = Cycle { kind: CycleKind::ChipBreak, ..cycle };
        assert_eq!(heights(&chips, [10.0, 20.0, 2.0])[1], (Rapid, -2.0 + 0.254));
    }

    #[test]
    fn endless_pecks_are_none() {
        let start = CycleStart { position: [0.0; 3], spindle: None };
        let hair = Cycle { peck: 1e-9, ..hole(CycleKind::Peck) };
        assert_eq!(hair.steps(&start), None);
    }

    #[test]
    fn a_tap_turns_back_at_the_bottom() {
        let start = CycleStart { position: [10.0, 20.0, 2.0], spindle: Some((300.0, SpindleDirection::Clockwise)) };
        let steps = hole(CycleKind::Tap).steps(&start).unwrap();
        let turns: Vec<_> = steps
            .iter()
            .filter_map(|s| match s {
                CycleStep::Event(EventKind::SpindleOn { direction, .. }) => Some(*direction),
                _ => None,
            })
            .collect();
        assert_eq!(turns, [SpindleDirection::Counterclockwise, SpindleDirection::Clockwise]);
    }
}
