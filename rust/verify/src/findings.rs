//! What is wrong: one finding per fault, not one per move that shows it.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::words;
use crate::SLACK;

/// Findings listed per kind at most, the worst ones; the report counts them all.
const LISTED: usize = 20;

/// What is wrong. In the order in which a report lists them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FindingKind {
    /// No feed move at all.
    NoFeedMoves,
    /// Not one contact move touches the part: zero, units or tool reference are wrong.
    NoContact,
    /// The program runs in another work offset than the one in which the part stands.
    WorkOffset,
    /// A feed move enters the part.
    Gouge,
    /// The shank, or what joins it to the profile, enters the part.
    ShankCollision,
    /// The holder enters the part.
    HolderCollision,
    /// A rapid enters the part.
    RapidIntoMaterial,
    /// A rapid straight down enters the part, or ends with too little air under it.
    RapidPlunge,
    /// A rapid goes sideways and down at once below the clearance height: its way is not defined.
    DogLegRapid,
    /// A rapid goes sideways below the clearance height.
    LowRapid,
    /// A contact move does not touch.
    Excess,
    /// A feed move without a feed.
    MissingFeed,
    /// A feed move whose start is not known in all axes.
    UnplacedFeed,
    /// A feed move before any tool change.
    MissingToolChange,
    /// A tool change to a tool that the job does not have.
    UnknownTool,
    /// A coordinate that is not a number, or absurd (beyond 10 km).
    NotFinite,
}

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Severity {
    /// The program must not run.
    Error,
    /// Worth knowing; the program may run.
    Warning,
}

/// One fault: its worst place and the lines over which it lasts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Finding {
    /// What is wrong.
    pub kind: FindingKind,
    /// How bad it is.
    pub severity: Severity,
    /// Line of the worst place, from 1; 0 when the program was not read from text or has no such place.
    pub line: u32,
    /// First line of the fault.
    pub first_line: u32,
    /// Last line of the fault.
    pub last_line: u32,
    /// Consecutive moves that show it.
    pub moves: usize,
    /// The tool's tip at the worst place, work coordinates, mm.
    pub position: Option<[f64; 3]>,
    /// What was measured there, mm: depth, distance or height.
    pub value_mm: Option<f64>,
    /// What is allowed, mm.
    pub limit: Option<f64>,
    /// What, where and what to do.
    pub message: String,
}

/// A fault that one move shows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fault {
    pub kind: FindingKind,
    pub severity: Severity,
    /// Index of the move.
    pub index: usize,
    pub line: u32,
    pub position: [f64; 3],
    /// Measured value and limit, mm.
    pub measure: Option<(f64, f64)>,
    /// How bad this place is, for comparison with others of its kind, mm.
    pub weight: f64,
}

/// Consecutive faults of one kind.
struct Run {
    worst: Fault,
    first_line: u32,
    last: usize,
    last_line: u32,
    moves: usize,
}

/// Merges faults, given in the order of the moves, and keeps the worst of each kind; counts them all.
pub(crate) fn merge(faults: &[Fault]) -> (Vec<Finding>, BTreeMap<FindingKind, usize>) {
    let mut runs: BTreeMap<FindingKind, Vec<Run>> = BTreeMap::new();
    for fault in faults {
        let runs = runs.entry(fault.kind).or_default();
        match runs.last_mut().filter(|run| fault.index <= run.last + 1) {
            Some(run) => run.extend(fault),
            None => runs.push(Run::new(fault)),
        }
    }
    let counts = runs.iter().map(|(kind, runs)| (*kind, runs.len())).collect();
    (runs.into_values().flat_map(worst_in_order).map(|run| run.finding()).collect(), counts)
}

/// The worst runs, in the order of the moves.
fn worst_in_order(mut runs: Vec<Run>) -> Vec<Run> {
    runs.sort_by(|a, b| b.worst.weight.total_cmp(&a.worst.weight).then(a.last.cmp(&b.last)));
    runs.truncate(LISTED);
    runs.sort_by_key(|run| run.last);
    runs
}

impl Run {
    fn new(fault: &Fault) -> Self {
        Self { worst: *fault, first_line: fault.line, last: fault.index, last_line: fault.line, moves: 1 }
    }

    fn extend(&mut self, fault: &Fault) {
        if fault.weight > self.worst.weight + SLACK {
            self.worst = *fault;
        }
        self.moves += usize::from(fault.index != self.last);
        self.last = fault.index;
        self.last_line = fault.line;
    }

    fn finding(self) -> Finding {
        let worst = self.worst;
        Finding {
            kind: worst.kind,
            severity: worst.severity,
            line: worst.line,
            first_line: self.first_line,
            last_line: self.last_line,
            moves: self.moves,
            position: Some(worst.position),
            value_mm: worst.measure.map(|m| m.0),
            limit: worst.measure.map(|m| m.1),
            message: words::message(&worst, self.first_line, self.last_line, self.moves),
        }
    }
}
