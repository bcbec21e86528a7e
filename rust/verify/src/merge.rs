//! Faults of single moves, merged: one finding per fault, not one per move that shows it.

use std::collections::BTreeMap;

use styluscam_motion::Program;

use crate::faults::Fault;
use crate::findings::{Finding, FindingKind, Severity};
use crate::groups::{regions, Cell, Cells, Group, Reported};
use crate::tolerances::SLACK;
use crate::words::{self, Extent};

/// Findings listed of a group at most, the worst ones; the report counts them all.
const LISTED: usize = 20;

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
    pub reported: Reported,
    /// How many there are of each kind.
    pub counts: BTreeMap<FindingKind, usize>,
    /// The length of all moves that show each kind, mm.
    pub lengths: BTreeMap<FindingKind, f64>,
}

/// Merges faults of programs, given kind by kind in the order of the program's moves, of a part of this size, mm. All faults of a
/// kind are of one program.
pub(crate) fn merge(faults: [(&[Fault], &Program); 2], size: f64) -> Merged {
    let mut runs: BTreeMap<FindingKind, Vec<Run>> = BTreeMap::new();
    let cells = Cells::of(size);
    for (fault, program) in faults.into_iter().flat_map(|(faults, program)| faults.iter().map(move |f| (f, program))) {
        let runs = runs.entry(fault.kind.finding).or_default();
        let (length, cell) = (length_of(fault.index, program), cells.at(fault.position));
        match runs.last_mut().filter(|run| fault.index <= run.last + 1) {
            Some(run) => run.extend(fault, length, cell),
            None => runs.push(Run::new(fault, length, cell)),
        }
    }
    let counts = runs.iter().map(|(kind, runs)| (*kind, runs.len())).collect();
    let lengths = runs.iter().map(|(kind, runs)| (*kind, runs.iter().map(|run| run.length).sum())).collect();
    let mut reported = Reported::default();
    for runs in runs.into_values() {
        let mut by_severity: BTreeMap<Severity, Vec<Run>> = BTreeMap::new();
        for run in runs {
            by_severity.entry(run.worst.severity).or_default().push(run);
        }
        for runs in by_severity.into_values() {
            group(runs, &mut reported);
        }
    }
    Merged { reported, counts, lengths }
}

/// Adds the groups that runs of one kind and severity come to, and the worst findings of each.
fn group(runs: Vec<Run>, reported: &mut Reported) {
    let regional = runs.first().is_some_and(|run| run.worst.kind.is_on_part);
    let (of_runs, regions) =
        if regional { regions(runs.iter().map(|run| &run.cells[..])) } else { (vec![0; runs.len()], 1) };
    let mut by_region: BTreeMap<usize, Vec<Run>> = BTreeMap::new();
    for (run, region) in runs.into_iter().zip(of_runs) {
        by_region.entry(region).or_default().push(run);
    }
    let count = by_region.len();
    for runs in by_region.into_values() {
        let whole = runs.iter().cloned().reduce(|all, later| all.and(&later));
        let index = reported.groups.len();
        reported.groups.extend(whole.map(|whole| whole.group(runs.len(), count, regions)));
        reported.findings.extend(worst_in_order(runs).into_iter().map(|run| (run.finding(), index)));
    }
}

/// Length of a move, mm; 0 when its start or its end is not known.
fn length_of(index: usize, program: &Program) -> f64 {
    let start = index.checked_sub(1).and_then(|before| program.moves.get(before));
    let length = start.zip(program.moves.get(index)).map_or(0.0, |(start, step)| step.length(start.end.tip));
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

    /// With one that comes later: the worst position is the worse of theirs.
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

    /// What `count` runs come to, of which this is the whole; `reported` groups stand for all the `regions` of their kind.
    fn group(self, count: usize, reported: usize, regions: usize) -> Group {
        let extent = Some(self.extent).filter(|corners| corners.as_flattened().iter().all(|x| x.is_finite()));
        let regions = if reported == 1 { regions } else { 1 };
        let region = extent.filter(|_| reported > 1);
        let message = if count == 1 {
            words::message(&self.worst, &self.extent())
        } else {
            words::of_many(&self.worst, &self.extent(), count, regions, region)
        };
        Group { count, regions, extent, message, ..Group::of(&self.finding()) }
    }

    fn finding(self) -> Finding {
        let worst = self.worst;
        let unit = worst.kind.unit;
        let [value, limit] = [worst.measure.map(|m| m.0), worst.measure.map(|m| m.1)];
        Finding {
            kind: worst.kind.finding,
            severity: worst.severity,
            line: worst.line,
            first_line: self.first_line,
            last_line: self.last_line,
            moves: self.moves,
            length_mm: self.length,
            position: Some(worst.position).filter(|position| position.iter().all(|x| x.is_finite())),
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
