//! What happens between moves.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Sense of the spindle's rotation, seen from above the tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SpindleDirection {
    /// M3.
    Clockwise,
    /// M4.
    Counterclockwise,
}

impl SpindleDirection {
    /// The other one.
    #[must_use]
    pub fn reversed(self) -> Self {
        match self {
            Self::Clockwise => Self::Counterclockwise,
            Self::Counterclockwise => Self::Clockwise,
        }
    }
}

/// What happens between moves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", tag = "kind")]
pub enum EventKind {
    /// Load a tool and apply its length: index into [`Program::tools`].
    ToolChange {
        /// Index of the tool.
        tool: u32,
    },
    /// Turn the spindle.
    SpindleOn {
        /// Speed, rev/min.
        rpm: f64,
        /// Sense of rotation.
        direction: SpindleDirection,
    },
    /// Stop the spindle.
    SpindleOff,
    /// Mist coolant on or off.
    Mist {
        /// On.
        on: bool,
    },
    /// Flood coolant (or forming lubricant) on or off.
    Flood {
        /// On or off.
        on: bool,
    },
    /// The program stops until the operator goes on.
    Stop {
        /// Only where the operator's switch is on (M1).
        optional: bool,
    },
    /// Another work offset: coordinates count from another zero from here on.
    WorkOffset {
        /// Its code: `G55`.
        wcs: String,
    },
    /// A straight move towards a point until the probe touches: where it ends is not known.
    Probe {
        /// Where it ends when nothing is touched, work coordinates, mm; none for axes that stay.
        end: [Option<f64>; 3],
        /// Feed, mm/min.
        feed: f64,
        /// Whether a probe that does not touch stops the program.
        must_touch: bool,
    },
    /// A line of the machine's own language, posted as it stands. It must not move an axis.
    Raw {
        /// The line.
        text: String,
    },
    /// The two programs of a pair wait for one another.
    Sync {
        /// The same in both programs.
        mark: u32,
    },
    /// A remark for the operator.
    Comment {
        /// One line of text.
        text: String,
    },
    /// Wait.
    Dwell {
        /// How long, s.
        seconds: f64,
    },
}

/// An event and its position in the program: it happens before move `before`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Event {
    /// Index of the move that follows; the number of moves when none does.
    pub before: usize,
    /// What happens.
    #[serde(flatten)]
    pub kind: EventKind,
}

/// The events of a program that have not been taken yet.
#[derive(Clone, Debug)]
pub struct Upcoming<'a> {
    events: &'a [Event],
}

impl<'a> Upcoming<'a> {
    /// All of these, in order of `before`.
    pub(crate) fn of(events: &'a [Event]) -> Self {
        Self { events }
    }

    /// Takes those that come before a move, in their order.
    pub fn before(&mut self, index: usize) -> impl Iterator<Item = &'a EventKind> + use<'a> {
        let count = self.events.iter().take_while(|event| event.before <= index).count();
        let (now, later) = self.events.split_at(count);
        self.events = later;
        now.iter().map(|event| &event.kind)
    }
}
