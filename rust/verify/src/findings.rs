//! What is wrong: one finding per fault, not one per move that shows it.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use styluscam_motion::{Move, Program};

use crate::groups::{regions, Cell, Cells, Group, Told};
use crate::words::{self, Extent};
use crate::SLACK;

/// Findings listed of a group at most, the worst ones; the report counts them all.
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
    /// The tool, its shank or its holder comes too near to the clamp frame.
    ClampCollision,
    /// The sheet is pressed against the backing plate.
    BackingCollision,
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
    /// A place that the tool could touch is left, and the distance between passes does not explain it.
    MissingPass,
    /// Levels are farther apart than ordered, or end too soon.
    MissingLevel,
    /// Rows are farther apart than ordered, or end too soon.
    MissingRow,
    /// A wall is steeper than the sheet bears.
    WallAngle,
    /// The sheet becomes thinner than it may.
    Thinning,
    /// The tool goes deeper than a step below all that is formed so far.
    Punch,
    /// The tool bridges faces by more than it may: it is less curved than they are.
    Bridged,
    /// The tool reaches less of the faces than it should.
    Unreached,
    /// The model is thicker or thinner than the sheet.
    SheetThickness,
    /// The model shows another face of the sheet than the job says.
    SheetFace,
    /// A solid is to be formed from a sheet.
    SolidFormed,
    /// The model's flange does not lie where the sheet is clamped.
    FlangeHeight,
    /// A level is formed after a lower one at the same place.
    FormingOrder,
    /// A rapid goes down below the height at which the job wants plunges to begin.
    DeepRapid,
    /// The program stops while the tool is below the clearance height.
    StopBelow,
    /// A feed move without a feed.
    MissingFeed,
    /// A feed move whose start is not known in all axes.
    UnplacedFeed,
    /// A feed move before any tool change.
    MissingToolChange,
    /// A tool change to a tool that the job does not have.
    UnknownTool,
    /// An operation of the job is not in the text.
    MissingOperation,
    /// An operation comes after one that the job has behind it.
    OperationOrder,
    /// The program begins with a move across before it has gone up, or goes across below the clearance height.
    UnsafeStart,
    /// The program ends, or changes the tool, below the clearance height.
    UnsafeEnd,
    /// A move goes across, or down, where it is not known at which height, or where, the tool is.
    UnknownPlace,
    /// A move in the machine's own coordinates that is not one to its top: nothing is known of the way.
    MachinePlace,
    /// The text does not say a mode that its moves rely on.
    UnsaidMode,
    /// Lines run or do not, as a switch at the machine stands.
    OptionalLines,
    /// The text names none of several operations: nothing can be held against what the job orders.
    UnnamedOperations,
    /// The text has no end mark.
    NoEnd,
    /// A feed is not the one that the job orders.
    FeedDiffers,
    /// The spindle does not do what the job orders.
    SpindleDiffers,
    /// Coolant flows and should not, or should and does not.
    CoolantDiffers,
    /// Another tool than the operation's.
    ToolDiffers,
    /// A wait while the tool is below the clearance height.
    Dwell,
    /// Moves in another plane than G17, and no arc that is for it.
    WorkPlane,
    /// A place beyond the machine's X.
    XLimit,
    /// A place beyond the machine's Y.
    YLimit,
    /// A place beyond the machine's Z.
    ZLimit,
    /// The program needs more travel than the machine has.
    Travel,
    /// A feed above the machine's largest.
    FeedLimit,
    /// A spindle speed that the machine does not have.
    SpindleLimit,
    /// A coordinate that is not a number, or absurd (beyond 10 km).
    NotFinite,
    /// Something that the verifier does not check, and why.
    NotChecked,
}

impl FindingKind {
    /// Whether it belongs to a place of the part, and not to a word of the text.
    fn lies_on_the_part(self) -> bool {
        matches!(
            self,
            Self::Gouge
                | Self::ShankCollision
                | Self::HolderCollision
                | Self::ClampCollision
                | Self::BackingCollision
                | Self::RapidIntoMaterial
                | Self::RapidPlunge
                | Self::Excess
                | Self::MissingPass
                | Self::MissingLevel
                | Self::MissingRow
                | Self::WallAngle
                | Self::Thinning
                | Self::Punch
        )
    }

    /// What a place beyond an axis' end is, by axis.
    pub(crate) const AXIS_LIMITS: [Self; 3] = [Self::XLimit, Self::YLimit, Self::ZLimit];

    /// The unit of what is measured.
    fn unit(self) -> &'static str {
        match self {
            Self::FeedDiffers | Self::FeedLimit => "mm/min",
            Self::SpindleDiffers => "rev/min",
            Self::Dwell => "s",
            Self::WallAngle => "deg",
            _ => "mm",
        }
    }
}

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Severity {
    /// The program must not run.
    Error,
    /// Worth knowing; the program may run.
    Warning,
    /// What the report does not answer for; the program may run.
    Note,
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
    /// Their length, mm.
    pub length_mm: f64,
    /// The tool's tip at the worst place, work coordinates, mm.
    pub position: Option<[f64; 3]>,
    /// What was measured there, where that is a length, mm: depth, distance or height.
    pub value_mm: Option<f64>,
    /// What was measured there, in `unit`.
    pub value: Option<f64>,
    /// What is allowed, in `unit`.
    pub limit: Option<f64>,
    /// "mm", "mm/min", "rev/min", "s" or "deg".
    pub unit: String,
    /// What, where and what to do.
    pub message: String,
}

impl Finding {
    /// A finding about the whole program.
    pub(crate) fn of_all(kind: FindingKind, severity: Severity, message: String) -> Self {
        Self {
            kind,
            severity,
            line: 0,
            first_line: 0,
            last_line: 0,
            moves: 0,
            length_mm: 0.0,
            position: None,
            value_mm: None,
            value: None,
            limit: None,
            unit: "mm".to_owned(),
            message,
        }
    }

    /// Makes it a warning: the job takes this risk by name.
    pub(crate) fn accept(&mut self) {
        if self.severity == Severity::Error {
            self.severity = Severity::Warning;
            self.message += " (accepted by the job)";
        }
    }

    /// The same, told at a line.
    pub(crate) fn at_line(self, line: u32) -> Self {
        Self { line, first_line: line, last_line: line, ..self }
    }
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

impl Fault {
    /// An error of which nothing is measured.
    pub fn new(kind: FindingKind, index: usize, line: u32, position: [f64; 3]) -> Self {
        Self { kind, severity: Severity::Error, index, line, position, measure: None, weight: 0.0 }
    }

    /// An error at the end of a move.
    pub fn of(kind: FindingKind, index: usize, step: &Move) -> Self {
        Self::new(kind, index, step.line, step.end)
    }

    /// With what was measured and what is allowed; it weighs what lies between them.
    pub fn measured(self, value: f64, limit: f64) -> Self {
        Self { measure: Some((value, limit)), weight: (value - limit).abs().max(0.0), ..self }
    }

    /// The same as a warning.
    pub fn warning(self) -> Self {
        Self { severity: Severity::Warning, ..self }
    }
}

/// Consecutive faults of one kind.
#[derive(Clone)]
struct Run {
    worst: Fault,
    first_line: u32,
    last: usize,
    last_line: u32,
    moves: usize,
    /// Length of the moves, mm.
    length: f64,
    /// Where they are.
    cells: Vec<Cell>,
    /// Corners of the box around them.
    extent: [[f64; 3]; 2],
}

/// Faults, merged.
pub(crate) struct Merged {
    /// The worst of each kind, kind by kind in the order of the moves, and what they come to.
    pub told: Told,
    /// How many there are of each kind.
    pub counts: BTreeMap<FindingKind, usize>,
    /// The length of all moves that show each kind, mm.
    pub lengths: BTreeMap<FindingKind, f64>,
}

/// Merges faults, given kind by kind in the order of the program's moves, of a part of this size, mm.
pub(crate) fn merge(faults: &[Fault], program: &Program, size: f64) -> Merged {
    let mut runs: BTreeMap<FindingKind, Vec<Run>> = BTreeMap::new();
    let cells = Cells::of(size);
    for fault in faults {
        let runs = runs.entry(fault.kind).or_default();
        let (length, cell) = (length_of(fault.index, program), cells.at(fault.position));
        match runs.last_mut().filter(|run| fault.index <= run.last + 1) {
            Some(run) => run.extend(fault, length, cell),
            None => runs.push(Run::new(fault, length, cell)),
        }
    }
    let counts = runs.iter().map(|(kind, runs)| (*kind, runs.len())).collect();
    let lengths = runs.iter().map(|(kind, runs)| (*kind, runs.iter().map(|run| run.length).sum())).collect();
    let mut told = Told::default();
    for runs in runs.into_values() {
        let mut by_severity: BTreeMap<Severity, Vec<Run>> = BTreeMap::new();
        for run in runs {
            by_severity.entry(run.worst.severity).or_default().push(run);
        }
        for runs in by_severity.into_values() {
            group(runs, &mut told);
        }
    }
    Merged { told, counts, lengths }
}

/// Adds the groups that runs of one kind and severity come to, and the worst findings of each.
fn group(runs: Vec<Run>, told: &mut Told) {
    let regional = runs.first().is_some_and(|run| run.worst.kind.lies_on_the_part());
    let (of_runs, regions) =
        if regional { regions(runs.iter().map(|run| &run.cells[..])) } else { (vec![0; runs.len()], 1) };
    let mut by_region: BTreeMap<usize, Vec<Run>> = BTreeMap::new();
    for (run, region) in runs.into_iter().zip(of_runs) {
        by_region.entry(region).or_default().push(run);
    }
    let count = by_region.len();
    for runs in by_region.into_values() {
        let whole = runs.iter().cloned().reduce(|all, later| all.and(&later));
        let index = told.groups.len();
        told.groups.extend(whole.map(|whole| whole.group(runs.len(), count, regions)));
        told.findings.extend(worst_in_order(runs).into_iter().map(|run| (run.finding(), index)));
    }
}

/// Length of a move, mm; 0 when its start or its end is not known.
fn length_of(index: usize, program: &Program) -> f64 {
    let start = index.checked_sub(1).and_then(|before| program.moves.get(before));
    let length = start.zip(program.moves.get(index)).map_or(0.0, |(start, step)| step.length(start.end));
    if length.is_finite() {
        length
    } else {
        0.0
    }
}

/// The worst runs, in the order of the moves.
fn worst_in_order(mut runs: Vec<Run>) -> Vec<Run> {
    runs.sort_by(|a, b| b.worst.weight.total_cmp(&a.worst.weight).then(a.last.cmp(&b.last)));
    runs.truncate(LISTED);
    runs.sort_by_key(|run| run.last);
    runs
}

impl Run {
    fn new(fault: &Fault, length: f64, cell: Cell) -> Self {
        Self {
            worst: *fault,
            first_line: fault.line,
            last: fault.index,
            last_line: fault.line,
            moves: 1,
            length,
            cells: vec![cell],
            extent: [fault.position; 2],
        }
    }

    fn extend(&mut self, fault: &Fault, length: f64, cell: Cell) {
        if fault.weight > self.worst.weight + SLACK {
            self.worst = *fault;
        }
        if fault.index != self.last {
            self.moves += 1;
            self.length += length;
        }
        self.last = fault.index;
        self.last_line = fault.line;
        if self.cells.last() != Some(&cell) {
            self.cells.push(cell);
        }
        self.extent = around(self.extent, [fault.position; 2]);
    }

    /// With one that comes later: the worst place is the worse of theirs.
    fn and(self, later: &Self) -> Self {
        let worst = if later.worst.weight > self.worst.weight + SLACK { later.worst } else { self.worst };
        Self {
            worst,
            last: later.last,
            last_line: later.last_line,
            moves: self.moves + later.moves,
            length: self.length + later.length,
            extent: around(self.extent, later.extent),
            ..self
        }
    }

    /// Its extent for the words.
    fn extent(&self) -> Extent {
        Extent { lines: [self.first_line, self.last_line], moves: self.moves, length: self.length }
    }

    /// What `count` runs come to, of which this is the whole; `told` groups tell of all the `regions` of their kind.
    fn group(self, count: usize, told: usize, regions: usize) -> Group {
        let extent = Some(self.extent).filter(|corners| corners.as_flattened().iter().all(|x| x.is_finite()));
        let regions = if told == 1 { regions } else { 1 };
        let region = extent.filter(|_| told > 1);
        let message = if count == 1 {
            words::message(&self.worst, &self.extent())
        } else {
            words::of_many(&self.worst, &self.extent(), count, regions, region)
        };
        Group { count, regions, extent, message, ..Group::of(&self.finding()) }
    }

    fn finding(self) -> Finding {
        let worst = self.worst;
        let unit = worst.kind.unit();
        let [value, limit] = [worst.measure.map(|m| m.0), worst.measure.map(|m| m.1)];
        Finding {
            kind: worst.kind,
            severity: worst.severity,
            line: worst.line,
            first_line: self.first_line,
            last_line: self.last_line,
            moves: self.moves,
            length_mm: self.length,
            position: Some(worst.position).filter(|place| place.iter().all(|x| x.is_finite())),
            value_mm: value.filter(|_| unit == "mm"),
            value,
            limit,
            unit: unit.to_owned(),
            message: words::message(&worst, &self.extent()),
        }
    }
}

/// The box around two boxes, by their corners.
fn around([low, high]: [[f64; 3]; 2], other: [[f64; 3]; 2]) -> [[f64; 3]; 2] {
    let axes = [0, 1, 2];
    [axes.map(|i| low[i].min(other[0][i])), axes.map(|i| high[i].max(other[1][i]))]
}
