//! Rows for regions that the tool can touch, but that lie between the rows: grooves, narrow floors, strips beside a wall.

use std::collections::BTreeSet;

use styluscam_geometry::Vector;
use styluscam_motion::{Cancelled, Watch};

use super::{
    pattern::{share, spread, Pattern, Row},
    stances::stances_of,
    untouched::Untouched,
};
use crate::Pass;

/// Positions that are looked at, about so many at most.
const POSITIONS: f64 = 100_000.0;
/// Positions per stepover, at least.
const FINE: f64 = 4.0;
/// Floors whose corners' heights differ by less are level, mm: a pass above or below one, beyond this and what it may deviate,
/// is none over it.
const LEVEL: f64 = 0.02;
/// A pass farther off the plane of a slope than this share of a stepover is none over it: on a floor that is rounder than half a
/// stepover the nearest row is not so far off.
const OFF: f64 = 0.25;
/// Walls whose normal rises by less, a sine, are narrow in plan: what rows leave there is the steep wall's.
const STEEP: f64 = 0.5;

/// A square of a [`Lattice`].
type Cell = [i64; 2];

/// Squares along and across the rows, from a corner of what is looked at: a part that is moved has the same.
struct Lattice {
    pattern: Pattern,
    /// Least positions along and across, mm.
    corner: [f64; 2],
    /// Side of a square, mm.
    spacing: f64,
}

/// Rows, by their positions across the others, for the positions of the selection that the tool can touch, and which have no pass
/// within a stepover in plan that lies on the triangle's plane, or lie in a connected region of triangles that no pass
/// touches.
///
/// What is neither as wide nor as long as `least` mm may be passed over.
///
/// # Errors
/// `Cancelled` when `watch` is cancelled.
pub(super) fn extra_rows(
    untouched: &Untouched<'_>,
    planned: &[(Row, Vec<Pass>)],
    pattern: &Pattern,
    (least, deviation): (f64, f64),
    watch: &Watch,
) -> Result<Vec<Row>, Cancelled> {
    let surface = untouched.surface();
    let mesh = surface.envelope().mesh();
    let triangles: Vec<usize> = surface.triangles().filter(|triangle| !mesh.is_upright(*triangle)).collect();
    let area: f64 = triangles.iter().map(|t| mesh.area(*t) * mesh.normal(*t).z.max(0.0)).sum();
    let spacing = least.min(pattern.stepover / FINE).max((area / POSITIONS).sqrt());
    let stances = stances_of(surface, &triangles);
    let lattice = Lattice::over(stances.iter().flat_map(|(_, tips)| tips), pattern, spacing);
    let covered = Covered::by(planned, pattern);
    let mut asked: Vec<(usize, [f64; 2])> = Vec::new();
    let mut floors = Vec::new();
    for (triangle, tips) in &stances {
        let floor = Floor::of(tips, pattern, deviation);
        let is_open = untouched.is_open(*triangle);
        for position in
            lattice.positions(tips).filter(|position| is_open || !covered.is_near(*position, floor.as_ref()))
        {
            asked.push((*triangle, position));
            floors.push(floor.filter(|_| !is_open));
        }
    }
    let in_plan = |[s, t]: [f64; 2]| [0, 1].map(|axis| s * pattern.along[axis] + t * pattern.across[axis]);
    let positions: Vec<(usize, [f64; 2])> =
        asked.iter().map(|(triangle, position)| (*triangle, in_plan(*position))).collect();
    watch.begin("between rows", positions.len());
    let tips = untouched.tips(&positions, watch)?;
    let touches =
        |position: [f64; 2], floor: &Option<Floor>, tip: f64| floor.is_none_or(|floor| floor.has(position, tip));
    let touched = asked.iter().zip(&floors).zip(tips);
    let touched = touched.filter(|(((_, position), floor), tip)| tip.is_some_and(|tip| touches(*position, floor, tip)));
    let touched = touched.map(|((asked, _), _)| asked);
    let cells = touched.map(|(_, position)| lattice.cell(*position)).collect();
    let patches = patches(cells).into_iter().filter(|patch| extent(patch) as f64 * spacing >= least);
    let mut rows: Vec<Row> = patches.flat_map(|patch| lattice.through(&patch)).collect();
    rows.sort_by(|a, b| a.across.total_cmp(&b.across));
    Ok(rows)
}

impl Lattice {
    fn over<'a>(tips: impl Iterator<Item = &'a Vector>, pattern: &Pattern, spacing: f64) -> Self {
        let least = |least: [f64; 2], position: [f64; 2]| [0, 1].map(|axis| least[axis].min(position[axis]));
        let corner = tips.map(|tip| pattern.along_across([tip.x, tip.y])).reduce(least);
        Self { pattern: *pattern, corner: corner.unwrap_or_default(), spacing }
    }

    fn cell(&self, position: [f64; 2]) -> Cell {
        [0, 1].map(|axis| ((position[axis] - self.corner[axis]) / self.spacing).floor() as i64)
    }

    /// The position across in the middle of a line of squares, mm.
    fn middle(&self, line: i64) -> f64 {
        self.corner[1] + (line as f64 + 0.5) * self.spacing
    }

    /// Positions (along, across) a square apart in a triangle's plan, one at least on each line that cuts it.
    fn positions(&self, tips: &[Vector; 3]) -> impl Iterator<Item = [f64; 2]> + use<'_> {
        let plan = tips.map(|tip| self.pattern.along_across([tip.x, tip.y]));
        let [low, high] = [f64::min, f64::max].map(|of| plan.iter().map(|p| p[1]).fold(plan[0][1], of));
        let on_line = move |line: i64| {
            let across = self.middle(line);
            share(&plan, across).into_iter().flat_map(move |[from, to]| {
                let count = ((to - from) / self.spacing).ceil().max(1.0) as usize;
                (0..count).map(move |i| [from + (to - from) * (i as f64 + 0.5) / count as f64, across])
            })
        };
        let line = |across: f64| (across - self.corner[1]) / self.spacing - 0.5;
        (line(low).ceil() as i64..=line(high).floor() as i64).flat_map(on_line)
    }

    /// Rows through a patch, no farther apart than a stepover, each as long as the patch is beside it.
    fn through(&self, patch: &[Cell]) -> Vec<Row> {
        let (step, side) = (self.pattern.stepover, self.spacing);
        let lines = || patch.iter().map(|cell| cell[1]);
        let (Some(low), Some(high)) = (lines().min(), lines().max()) else { return Vec::new() };
        let band = [low, high].map(|line| self.middle(line));
        let count = ((band[1] - band[0]) / step).floor() as usize + 1;
        let rows = spread(band, count, step).filter_map(|across| {
            let beside = |cell: &&Cell| (self.middle(cell[1]) - across).abs() <= 0.5 * step + side;
            let ends = || patch.iter().filter(beside).map(|cell| cell[0]);
            let (from, to) = (ends().min()?, ends().max()?);
            Some(Row { across, range: [from - 1, to + 2].map(|cell| self.corner[0] + cell as f64 * side) })
        });
        rows.collect()
    }
}

/// The plane on which the tip is where the tool touches a triangle.
#[derive(Clone, Copy, Debug)]
struct Floor {
    /// The height at position 0, mm, and how much it grows along and across.
    height: f64,
    growth: [f64; 2],
    /// By how much the height of a pass over it may differ, mm.
    most: f64,
}

impl Floor {
    /// None of a steep wall.
    fn of(tips: &[Vector; 3], pattern: &Pattern, deviation: f64) -> Option<Self> {
        let up = (tips[1] - tips[0]).cross(&(tips[2] - tips[0])).try_normalize(0.0)?;
        let up = up * up.z.signum();
        let [low, high] = [f64::min, f64::max].map(|of| tips.iter().map(|tip| tip.z).fold(tips[0].z, of));
        if high - low <= LEVEL {
            return Some(Self { height: 0.5 * (low + high), growth: [0.0; 2], most: LEVEL + 2.0 * deviation });
        }
        let growth = [pattern.along, pattern.across].map(|axis| -(up.x * axis[0] + up.y * axis[1]) / up.z);
        let [s, t] = pattern.along_across([tips[0].x, tips[0].y]);
        let height = tips[0].z - growth[0] * s - growth[1] * t;
        (up.z >= STEEP).then(|| Self { height, growth, most: OFF * pattern.stepover / up.z + 2.0 * deviation })
    }

    /// How far above the plane a tip is, mm.
    fn above(&self, [s, t]: [f64; 2], tip: f64) -> f64 {
        tip - self.height - self.growth[0] * s - self.growth[1] * t
    }

    /// Whether a tip is as high as it should be.
    fn has(&self, position: [f64; 2], tip: f64) -> bool {
        self.above(position, tip).abs() <= self.most
    }
}

/// A pass along its row: its points by their positions along the row, ascending, with their heights, mm.
type Run = Vec<[f64; 2]>;

/// Where the passes of rows lie.
struct Covered {
    pattern: Pattern,
    /// By row, ascending: its position across, and its passes.
    rows: Vec<(f64, Vec<Run>)>,
}

impl Covered {
    fn by(planned: &[(Row, Vec<Pass>)], pattern: &Pattern) -> Self {
        let run = |pass: &Pass| {
            let along = |tip: &Vector| pattern.along_across([tip.x, tip.y])[0];
            let mut run: Run = pass.points.iter().map(|point| [along(&point.tip), point.tip.z]).collect();
            run.sort_by(|a, b| a[0].total_cmp(&b[0]));
            run
        };
        let rows = planned.iter().map(|(row, passes)| (row.across, passes.iter().map(run).collect()));
        Self { pattern: *pattern, rows: rows.collect() }
    }

    /// Whether a pass lies within a stepover of a position (along, across); of a position on a floor, whether one lies
    /// there on its plane.
    fn is_near(&self, [s, t]: [f64; 2], floor: Option<&Floor>) -> bool {
        let step = self.pattern.stepover;
        let first = self.rows.partition_point(|(across, _)| *across < t - step);
        let mut rows = self.rows[first..].iter().take_while(|(across, _)| *across <= t + step);
        rows.any(|(across, runs)| {
            let reach = ((step + t - across) * (step - t + across)).max(0.0).sqrt();
            runs.iter().filter(|run| !run.is_empty()).any(|run| match floor {
                None => run[0][0] <= s + reach && s - reach <= run[run.len() - 1][0],
                Some(floor) => lies_on(run, [s - reach, s + reach], *across, floor),
            })
        })
    }
}

/// Whether a run on a row lies on a floor's plane somewhere between two positions along it.
fn lies_on(run: &[[f64; 2]], [from, to]: [f64; 2], row: f64, floor: &Floor) -> bool {
    let first = run.partition_point(|[s, _]| *s < from).saturating_sub(1);
    let lies = |[[s0, z0], [s1, z1]]: [[f64; 2]; 2]| {
        let at = |s: f64| {
            let share = if s1 > s0 { ((s - s0) / (s1 - s0)).clamp(0.0, 1.0) } else { 0.0 };
            floor.above([s0 + share * (s1 - s0), row], z0 + share * (z1 - z0))
        };
        let ends = [at(from), at(to)];
        s0 <= to && from <= s1 && ends[0].min(ends[1]) <= floor.most && -floor.most <= ends[0].max(ends[1])
    };
    match run {
        [only] => lies([*only, *only]),
        _ => run[first..].windows(2).take_while(|pair| pair[0][0] <= to).any(|pair| lies([pair[0], pair[1]])),
    }
}

/// The longer side of the box round some cells, in cells.
fn extent(patch: &[Cell]) -> i64 {
    let along = |axis: usize| {
        let positions = || patch.iter().map(|cell| cell[axis]);
        positions().max().unwrap_or(0) - positions().min().unwrap_or(0) + 1
    };
    along(0).max(along(1))
}

/// Cells that join, also over a corner.
fn patches(mut cells: BTreeSet<Cell>) -> Vec<Vec<Cell>> {
    let mut patches = Vec::new();
    while let Some(first) = cells.pop_first() {
        let mut patch = vec![first];
        let mut next = 0;
        while let Some([s, t]) = patch.get(next).copied() {
            next += 1;
            let around = (0..9).map(|i| [s + i % 3 - 1, t + i / 3 - 1]);
            patch.extend(around.filter(|cell| cells.remove(cell)));
        }
        patches.push(patch);
    }
    patches
}

#[cfg(test)]
mod tests {
    use super::*;

    const PATTERN: Pattern = Pattern { along: [1.0, 0.0], across: [0.0, 1.0], stepover: 3.0 };

    #[test]
    fn cells_that_meet_in_a_corner_are_one_patch() {
        let patches = patches([[0, 0], [1, 1], [3, 1], [4, 0], [2, 5]].into_iter().collect());
        assert_eq!(patches, [vec![[0, 0], [1, 1]], vec![[2, 5]], vec![[3, 1], [4, 0]]]);
    }

    #[test]
    fn a_narrow_patch_has_one_row_and_a_wide_one_as_many_as_it_takes() {
        let lattice = Lattice { pattern: PATTERN, corner: [7.0, 1.0], spacing: 0.5 };
        let patch = |lines: i64| (0..lines).map(|line| [line, line]).collect::<Vec<Cell>>();
        let positions = |lines: i64| lattice.through(&patch(lines)).iter().map(|row| row.across).collect::<Vec<_>>();
        assert_eq!(positions(3), [1.75]);
        assert_eq!(positions(11), [2.25, 5.25]);
        let first = Row { across: 2.25, range: [6.5, 11.0] };
        assert_eq!(lattice.through(&patch(11))[0], first, "as long as the patch is beside it");
    }

    #[test]
    fn a_place_is_near_a_pass_within_a_stepover() {
        let run = |from: f64, to: f64| vec![[from, 0.0], [to, 0.0]];
        let rows = vec![(0.0, vec![run(0.0, 10.0)]), (3.0, vec![run(0.0, 4.0), run(8.0, 10.0)])];
        let covered = Covered { pattern: PATTERN, rows };
        let is_near = |position| covered.is_near(position, None);
        assert!(is_near([5.0, 2.9]) && is_near([6.0, 4.0]) && is_near([-2.0, 1.0]));
        assert!(!is_near([6.0, 5.5]) && !is_near([5.0, -3.1]) && !is_near([13.0, 1.5]));
    }

    #[test]
    fn a_pass_over_the_land_is_none_in_the_groove() {
        // a row that comes down from the land, 5 mm over the floor, between 4 and 5 along it
        let rows = vec![(0.0, vec![vec![[0.0, 5.0], [4.0, 5.0], [5.0, 0.0], [9.0, 0.0]]])];
        let covered = Covered { pattern: PATTERN, rows };
        let level = |height| Floor { height, growth: [0.0; 2], most: 0.1 };
        let is_near = |position| covered.is_near(position, Some(&level(0.0)));
        assert!(is_near([7.0, 0.0]) && is_near([2.5, 1.0]) && !is_near([1.5, 1.0]) && !is_near([12.5, 0.0]));
        assert!(covered.is_near([1.5, 1.0], Some(&level(5.0))) && covered.is_near([1.5, 1.0], None));
    }
}
