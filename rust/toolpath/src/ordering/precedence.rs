//! What of the passes has to come before what.
//!
//! A pass follows those of earlier stages near to it. Which are near is found on a grid of square cells in plan: two passes whose
//! surroundings, half the reach wide, share a cell. In each cell only the passes of the last two stages are kept: the others come
//! before those, by the same cell. Inside a loop with lower ground the surroundings are all of its inside for what comes later;
//! around higher ground a loop follows all that is inside it.

use styluscam_motion::{Cancelled, Watch};

use super::Freedom;
use crate::{Pass, PathPoint};

/// Cells in half a reach.
const FINE: f64 = 3.0;
/// Cells, at most: of larger parts they are larger, and with them the reach.
const MOST_CELLS: f64 = 250_000.0;
/// Pairs of passes for each pass, at most: of more nothing is known.
const MOST_PAIRS: usize = 64;

/// What comes before what.
#[derive(Clone, Debug)]
pub enum Precedence {
    /// Passes of lower groups come before those of higher ones.
    Groups(Vec<usize>),
    /// Each pass' predecessors and successors.
    Pairs {
        /// By pass.
        before: Vec<Vec<u32>>,
        /// By pass.
        after: Vec<Vec<u32>>,
    },
}

impl Precedence {
    /// Group after group.
    pub fn by_groups(passes: &[Pass]) -> Self {
        Self::Groups(passes.iter().map(|pass| pass.group).collect())
    }

    /// What areas, or rows, depend on; none where all of it is by groups, or nothing is known.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn of_areas(passes: &[Pass], freedom: Freedom<'_>, watch: &Watch) -> Result<Option<Self>, Cancelled> {
        let set_of = |group: usize, sets: &[usize]| sets.partition_point(|first| *first <= group);
        let (reach, inside_first, stages): (f64, bool, Vec<usize>) = match freedom {
            Freedom::WithinGroups => return Ok(None),
            Freedom::OfAreas { reach, inside_first } => {
                (reach, inside_first, passes.iter().map(|pass| pass.group).collect())
            }
            Freedom::OfRows { sets, reach, .. } => {
                (reach, false, passes.iter().map(|pass| set_of(pass.group, sets)).collect())
            }
        };
        let count = passes.len();
        if stages.windows(2).all(|pair| pair[0] == pair[1]) {
            return Ok(Some(Self::Pairs { before: vec![Vec::new(); count], after: vec![Vec::new(); count] }));
        }
        let mut grid = Grid::over(passes, reach);
        let (mut before, mut after) = (vec![Vec::new(); count], vec![Vec::<u32>::new(); count]);
        let mut pairs = 0;
        for (number, (pass, stage)) in passes.iter().zip(stages).enumerate() {
            watch.advance(0)?;
            let found = grid.follow(number, pass, stage, inside_first);
            pairs += found.len();
            if pairs > MOST_PAIRS * count {
                return Ok(None);
            }
            found.iter().for_each(|earlier| after[*earlier as usize].push(number as u32));
            before[number] = found;
        }
        Ok(Some(Self::Pairs { before, after }))
    }

    /// What comes before a pass.
    pub fn before(&self, pass: usize) -> &[u32] {
        match self {
            Self::Groups(_) => &[],
            Self::Pairs { before, .. } => &before[pass],
        }
    }

    /// What comes after a pass.
    pub fn after(&self, pass: usize) -> &[u32] {
        match self {
            Self::Groups(_) => &[],
            Self::Pairs { after, .. } => &after[pass],
        }
    }

    /// The group of a pass, where groups follow one after the other.
    pub fn group(&self, pass: usize) -> Option<usize> {
        match self {
            Self::Groups(groups) => groups.get(pass).copied(),
            Self::Pairs { .. } => None,
        }
    }
}

/// The passes of the last stage, and of the one before, that have been at a cell.
#[derive(Clone, Default)]
struct Last {
    stage: usize,
    before: Vec<u32>,
    current: Vec<u32>,
}

impl Last {
    /// Those of earlier stages.
    fn earlier(&self, stage: usize) -> &[u32] {
        if self.stage == stage {
            &self.before
        } else {
            &self.current
        }
    }

    fn push(&mut self, number: u32, stage: usize) {
        if self.stage != stage {
            self.before = std::mem::take(&mut self.current);
            self.stage = stage;
        }
        self.current.push(number);
    }
}

struct Grid {
    low: [f64; 2],
    cell: f64,
    columns: usize,
    rows: usize,
    /// Cells around a position, as far as half the reach.
    disc: Vec<[i64; 2]>,
    /// Of each cell: what has been near, and the loops that enclose it.
    near: Vec<Last>,
    inside: Vec<Last>,
    /// The pass that was there last, from 1, and the pass that was found last: once each.
    seen: Vec<u32>,
    found: Vec<u32>,
}

impl Grid {
    fn over(passes: &[Pass], reach: f64) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in passes.iter().flat_map(|pass| &pass.points) {
            let at = [point.tip.x, point.tip.y];
            low = [0, 1].map(|i| low[i].min(at[i]));
            high = [0, 1].map(|i| high[i].max(at[i]));
        }
        let size = [0, 1].map(|i| (high[i] - low[i]).max(0.0) + 2.0 * reach);
        let cell = (0.5 * reach / FINE).max((size[0] * size[1] / MOST_CELLS).sqrt());
        let [columns, rows] = size.map(|size| (size / cell).ceil() as usize + 1);
        let radius = 0.5 * reach / cell + std::f64::consts::FRAC_1_SQRT_2;
        let most = radius.ceil() as i64;
        let all = (-most..=most).flat_map(|i| (-most..=most).map(move |j| [i, j]));
        let disc = all.filter(|[i, j]| ((i * i + j * j) as f64) <= radius * radius).collect();
        let cells = columns * rows;
        Self {
            low: low.map(|low| low - reach),
            cell,
            columns,
            rows,
            disc,
            near: vec![Last::default(); cells],
            inside: vec![Last::default(); cells],
            seen: vec![0; cells],
            found: vec![0; passes.len()],
        }
    }

    /// What a pass comes after; it is there from now on.
    fn follow(&mut self, number: usize, pass: &Pass, stage: usize, inside_first: bool) -> Vec<u32> {
        let stamp = number as u32 + 1;
        let near = self.surroundings(&pass.points, stamp);
        let inside = if pass.closed { self.enclosed(&pass.points, stamp) } else { Vec::new() };
        // with lower ground inside, what comes later is inside; else what came before
        let around_lower = pass.closed && (inside_first || is_counterclockwise(&pass.points));
        let around_higher = pass.closed && (inside_first || !around_lower);
        let asked = near.iter().chain(inside.iter().filter(|_| around_higher));
        let mut earlier = Vec::new();
        for cell in asked {
            for last in [&self.near[*cell], &self.inside[*cell]] {
                for number in last.earlier(stage) {
                    if std::mem::replace(&mut self.found[*number as usize], stamp) != stamp {
                        earlier.push(*number);
                    }
                }
            }
        }
        near.into_iter().for_each(|cell| self.near[cell].push(number as u32, stage));
        if around_lower {
            inside.into_iter().for_each(|cell| self.inside[cell].push(number as u32, stage));
        }
        earlier.sort_unstable();
        earlier
    }

    /// Cells no farther than half the reach from a polyline, each once.
    fn surroundings(&mut self, points: &[PathPoint], stamp: u32) -> Vec<usize> {
        let mut cells = Vec::new();
        let mut last = None;
        let ends = points.windows(2).map(|pair| [pair[0].tip, pair[1].tip]);
        let single = points.first().filter(|_| points.len() == 1).map(|point| [point.tip; 2]);
        for [a, b] in ends.chain(single) {
            let count = ((b - a).xy().norm() / (0.5 * self.cell)).ceil().max(1.0) as u32;
            for i in 0..=count {
                let at = a + (b - a) * (f64::from(i) / f64::from(count));
                let middle = [at.x, at.y];
                let place = [0, 1].map(|i| ((middle[i] - self.low[i]) / self.cell) as i64);
                if last.replace(place) == Some(place) {
                    continue;
                }
                for [i, j] in &self.disc {
                    let Some(cell) = self.cell_at([place[0] + i, place[1] + j]) else { continue };
                    if std::mem::replace(&mut self.seen[cell], stamp) != stamp {
                        cells.push(cell);
                    }
                }
            }
        }
        cells
    }

    fn cell_at(&self, [i, j]: [i64; 2]) -> Option<usize> {
        let (i, j) = (usize::try_from(i).ok()?, usize::try_from(j).ok()?);
        (i < self.columns && j < self.rows).then_some(i + j * self.columns)
    }

    /// Cells whose middles are inside a closed polyline, those that are seen already left out.
    fn enclosed(&self, points: &[PathPoint], stamp: u32) -> Vec<usize> {
        let at = |point: &PathPoint| [point.tip.x, point.tip.y];
        let mut crossings: Vec<(usize, f64)> = Vec::new();
        for pair in points.windows(2) {
            let [[ax, ay], [bx, by]] = [at(&pair[0]), at(&pair[1])];
            let row = |y: f64| ((y - self.low[1]) / self.cell - 0.5).ceil().max(0.0) as usize;
            for j in row(ay.min(by))..row(ay.max(by)).min(self.rows) {
                let y = self.low[1] + (j as f64 + 0.5) * self.cell;
                crossings.push((j, ax + (y - ay) / (by - ay) * (bx - ax)));
            }
        }
        crossings.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let mut cells = Vec::new();
        for pair in crossings.chunk_by(|a, b| a.0 == b.0).flat_map(|row| row.chunks_exact(2)) {
            let column = |x: f64| ((x - self.low[0]) / self.cell - 0.5).ceil().max(0.0) as usize;
            let columns = column(pair[0].1)..column(pair[1].1).min(self.columns);
            let row = pair[0].0 * self.columns;
            cells.extend(columns.map(|i| i + row).filter(|cell| self.seen[*cell] != stamp));
        }
        cells
    }
}

fn is_counterclockwise(points: &[PathPoint]) -> bool {
    let crosses = points.windows(2).map(|pair| pair[0].tip.x * pair[1].tip.y - pair[0].tip.y * pair[1].tip.x);
    crosses.sum::<f64>() > 0.0
}
