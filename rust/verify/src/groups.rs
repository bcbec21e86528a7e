//! Findings reported together: those of one kind, and of one region of the part where there are clearly separate ones.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::findings::{Finding, FindingKind, Severity};

/// Regions are separate where nothing is found for this share of the part's size.
const APART: f64 = 0.1;
/// More separate regions than this are reported as one group: their list would be the noise that groups are against.
const REGIONS: usize = 3;
/// Cells are counted to this far from the origin, so that their neighbours can be named.
const FARTHEST: f64 = 1e12;

/// Findings of one kind, one severity and one region, and the worst of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Group {
    /// What is wrong.
    pub kind: FindingKind,
    /// How bad it is.
    pub severity: Severity,
    /// How many findings there are, listed or not.
    pub count: usize,
    /// In how many separate regions of the part they lie: more than one where these are too many to be distinguished.
    pub regions: usize,
    /// Corners of the box that holds the tool's tip at all of them, work coordinates, mm.
    #[serde(rename = "box")]
    pub extent: Option<[[f64; 3]; 2]>,
    /// Line of the worst position, from 1; 0 when there is none.
    pub line: u32,
    /// First line of all of them.
    pub first_line: u32,
    /// Last line of all of them.
    pub last_line: u32,
    /// Moves that show them.
    pub moves: usize,
    /// The length of these moves, mm.
    pub length_mm: f64,
    /// The tool's tip at the worst position, work coordinates, mm.
    pub position: Option<[f64; 3]>,
    /// What was measured there, in `unit`.
    pub value: Option<f64>,
    /// What is allowed, in `unit`.
    pub limit: Option<f64>,
    /// "mm", "mm/min", "rev/min", "s" or "deg".
    pub unit: String,
    /// What, where, how much of it, and what to do.
    pub message: String,
    /// Those of them that the report lists: indices of its findings.
    pub findings: Vec<usize>,
}

impl Group {
    /// The group that a finding makes by itself.
    pub(crate) fn of(finding: &Finding) -> Self {
        Self {
            kind: finding.kind,
            severity: finding.severity,
            count: 1,
            regions: 1,
            extent: finding.position.map(|position| [position, position]),
            line: finding.line,
            first_line: finding.first_line,
            last_line: finding.last_line,
            moves: finding.moves,
            length_mm: finding.length_mm,
            position: finding.position,
            value: finding.value,
            limit: finding.limit,
            unit: finding.unit.clone(),
            message: finding.message.clone(),
            findings: Vec::new(),
        }
    }
}

/// Findings, and the group of each by its position in the second list.
#[derive(Default)]
pub(crate) struct Reported {
    pub findings: Vec<(Finding, usize)>,
    pub groups: Vec<Group>,
}

impl Reported {
    /// Adds findings about the whole program.
    pub fn add(&mut self, wholes: Vec<Finding>) {
        let mut by_kind: BTreeMap<(Severity, FindingKind), Vec<Finding>> = BTreeMap::new();
        for whole in wholes {
            by_kind.entry((whole.severity, whole.kind)).or_default().push(whole);
        }
        for wholes in by_kind.into_values() {
            let index = self.groups.len();
            let group = wholes.first().map(|first| {
                let message = match wholes.len() - 1 {
                    0 => first.message.clone(),
                    more => format!("{} (and {more} more of this kind)", first.message),
                };
                Group { count: wholes.len(), message, ..Group::of(first) }
            });
            self.groups.extend(group);
            self.findings.extend(wholes.into_iter().map(|whole| (whole, index)));
        }
    }

    /// Makes warnings of the kinds that the job takes by name.
    pub fn accept(&mut self, kinds: &[FindingKind]) {
        self.findings
            .iter_mut()
            .filter(|(finding, _)| kinds.contains(&finding.kind))
            .for_each(|(finding, _)| finding.accept());
        for group in self.groups.iter_mut().filter(|group| kinds.contains(&group.kind)) {
            if group.severity == Severity::Error {
                group.severity = Severity::Warning;
                group.message += " (accepted by the job)";
            }
        }
    }

    /// The findings and the groups, each group with its findings' indices: errors first, kind by kind.
    pub fn in_order(mut self) -> (Vec<Finding>, Vec<Group>) {
        self.findings.sort_by_key(|(finding, _)| (finding.severity, finding.kind));
        for (index, (_, group)) in self.findings.iter().enumerate() {
            self.groups[*group].findings.push(index);
        }
        self.groups.sort_by_key(|group| (group.severity, group.kind, group.first_line));
        (self.findings.into_iter().map(|(finding, _)| finding).collect(), self.groups)
    }
}

/// Positions, in cells as large as what must lie between separate regions.
#[derive(Clone, Copy)]
pub(crate) struct Cells {
    size: f64,
}

/// One of them.
pub(crate) type Cell = [i64; 3];

impl Cells {
    /// For a part of this size, mm.
    pub fn of(size: f64) -> Self {
        Self { size: APART * size }
    }

    pub fn at(self, position: [f64; 3]) -> Cell {
        position.map(|x| (x / self.size).clamp(-FARTHEST, FARTHEST).floor() as i64)
    }
}

/// The region of each of some sets of cells, from 0 in their order, and how many there are; all are in one where they are
/// too many to be distinguished. Cells of a set belong together, and so do those that touch.
pub(crate) fn regions<'a>(sets: impl Iterator<Item = &'a [Cell]> + Clone) -> (Vec<usize>, usize) {
    let cells: BTreeMap<Cell, usize> = sets.clone().flatten().map(|cell| (*cell, 0)).collect();
    let cells: BTreeMap<Cell, usize> = cells.into_keys().enumerate().map(|(i, cell)| (cell, i)).collect();
    let mut joined = Joined((0..cells.len()).collect());
    for set in sets.clone() {
        set.windows(2).for_each(|pair| joined.join(cells[&pair[0]], cells[&pair[1]]));
    }
    for ([x, y, z], index) in &cells {
        for neighbour in (0..27).map(|i| [x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1]) {
            if let Some(other) = cells.get(&neighbour) {
                joined.join(*index, *other);
            }
        }
    }
    let mut numbers = BTreeMap::new();
    let number = |set: &[Cell]| {
        let root = set.first().map_or(usize::MAX, |cell| joined.root(cells[cell]));
        let next = numbers.len();
        *numbers.entry(root).or_insert(next)
    };
    let numbered: Vec<usize> = sets.map(number).collect();
    let count = numbers.len();
    (if count > REGIONS { vec![0; numbered.len()] } else { numbered }, count)
}

/// Sets that grow together: each element names one nearer to its set's first.
struct Joined(Vec<usize>);

impl Joined {
    fn root(&mut self, mut element: usize) -> usize {
        while self.0[element] != element {
            self.0[element] = self.0[self.0[element]];
            element = self.0[element];
        }
        element
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(sets: &[&[Cell]]) -> (Vec<usize>, usize) {
        regions(sets.iter().copied())
    }

    #[test]
    fn errors_come_first_and_groups_know_their_findings() {
        let mut reported = Reported::default();
        let whole = |kind, severity| Finding::of_all(kind, severity, format!("{kind:?}"));
        reported.add(vec![
            whole(FindingKind::UnsaidMode, Severity::Warning),
            whole(FindingKind::Travel, Severity::Error),
            whole(FindingKind::MissingOperation, Severity::Error),
            whole(FindingKind::MissingOperation, Severity::Error),
        ]);
        let (findings, groups) = reported.in_order();
        let kinds: Vec<FindingKind> = findings.iter().map(|finding| finding.kind).collect();
        let [missing, travel] = [FindingKind::MissingOperation, FindingKind::Travel];
        assert_eq!(kinds, [missing, missing, travel, FindingKind::UnsaidMode]);
        let listed: Vec<_> = groups.iter().map(|group| (group.kind, group.count, group.findings.clone())).collect();
        assert_eq!(listed, [(missing, 2, vec![0, 1]), (travel, 1, vec![2]), (FindingKind::UnsaidMode, 1, vec![3])]);
        assert_eq!(groups[0].message, "MissingOperation (and 1 more of this kind)");
    }

    #[test]
    fn cells_that_touch_are_one_region() {
        let [a, b, far]: [Cell; 3] = [[0, 0, 0], [1, -1, 1], [3, 0, 0]];
        assert_eq!(of(&[&[a], &[b], &[far]]), (vec![0, 0, 1], 2));
        // a set that goes from one to the other joins them
        assert_eq!(of(&[&[a], &[far], &[b, far]]), (vec![0, 0, 0], 1));
    }

    #[test]
    fn too_many_regions_are_one() {
        let cells: Vec<[Cell; 1]> = (0..5).map(|i| [[3 * i, 0, 0]]).collect();
        let sets: Vec<&[Cell]> = cells.iter().map(|cell| &cell[..]).collect();
        assert_eq!(of(&sets[..3]), (vec![0, 1, 2], 3));
        assert_eq!(of(&sets), (vec![0; 5], 5));
    }

    #[test]
    fn positions_beyond_all_cells_have_neighbours() {
        let cells = Cells::of(0.0);
        let position = [f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
        assert_eq!(of(&[&[cells.at(position)]]), (vec![0], 1));
    }
}
