//! What discs have swept, by the square cells of the plane: of each it is known whether one sweep covers it whole, or else which sweeps
//! have their edge in it. Along the rim only the edges in the cells that it passes are looked at, exactly.

use std::collections::HashMap;
use std::f64::consts::SQRT_2;

use styluscam_geometry::{PlanePiece, PlanePoint};

use super::rim::Rim;
use super::runs::Swept;

/// Side of a cell, in radii of the widest disc. 1/2 to 1/8 were measured (docs/performance.md).
const CELL: f64 = 0.25;

/// Cells along the side of a tile.
const TILE: i64 = 32;
/// States of a cell: no sweep is near it; one covers it whole; from [`LISTS`] on, the number of its list.
const NONE: u32 = 0;
const WHOLE: u32 = 1;
const LISTS: u32 = 2;
/// So many sweeps are looked at first, from the one on that left nothing last: a tool that goes along above its own path is covered
/// by one of them alone.
const FOLLOWING: u32 = 3;

/// Sweeps of discs along pieces.
#[derive(Debug)]
pub struct Sweeps {
    /// Side of a cell, mm.
    size: f64,
    /// Pieces, with the radius of the disc that is swept along each, mm.
    sweeps: Vec<(PlanePiece, f64)>,
    tiles: HashMap<[i64; 2], Box<[u32]>>,
    /// Numbers of the sweeps that have their edge in a cell.
    lists: Vec<Vec<u32>>,
}

/// What one search leaves for the next.
#[derive(Debug, Default)]
pub struct Search {
    /// Number of the sweep that left nothing last.
    covering: u32,
    crossings: Vec<f64>,
    cuts: Vec<f64>,
    uncovered: Vec<[f64; 2]>,
    open: Vec<[f64; 2]>,
    spare: Vec<[f64; 2]>,
}

impl Sweeps {
    /// None yet; discs are to have a radius, mm, or about that.
    pub fn new(radius: f64) -> Self {
        Self { size: CELL * radius, sweeps: Vec::new(), tiles: HashMap::new(), lists: Vec::new() }
    }

    /// Those of paths, each disc `more` mm larger than its tool; `least` is a radius for the cells where no tool is wider, mm.
    pub fn along(paths: &[Swept], more: f64, least: f64) -> Self {
        let mut sweeps = Self::new(paths.iter().fold(least, |widest, path| widest.max(path.radius)));
        for path in paths {
            path.pieces().iter().for_each(|piece| sweeps.insert(piece, path.radius + more));
        }
        sweeps
    }

    /// Sweeps a disc along a piece.
    pub fn insert(&mut self, piece: &PlanePiece, radius: f64) {
        let number = self.sweeps.len() as u32;
        self.sweeps.push((*piece, radius));
        // long pieces in parts, for their boxes would hold much that is far from them
        let parts = libm::ceil(piece.length() / (2.0 * radius).max(self.size)).max(1.0);
        for part in 0..parts as usize {
            let ends = [part, part + 1].map(|i| piece.at(i as f64 / parts));
            let sag = if piece.circle.is_some() { 0.5 * piece.length() / parts } else { 0.0 };
            let low = [0, 1].map(|i| ends[0][i].min(ends[1][i]) - radius - sag);
            let high = [0, 1].map(|i| ends[0][i].max(ends[1][i]) + radius + sag);
            let ([x0, y0], [x1, y1]) = (self.cell(low), self.cell(high));
            for x in x0..=x1 {
                for y in y0..=y1 {
                    self.reach([x, y], number);
                }
            }
        }
    }

    /// Notes what a sweep does to a cell.
    fn reach(&mut self, cell: [i64; 2], number: u32) {
        let (tile, at) = in_tile(cell);
        let known = self.tiles.get(&tile).map_or(NONE, |tile| tile[at]);
        if known == WHOLE {
            return;
        }
        let (piece, radius) = &self.sweeps[number as usize];
        let middle = cell.map(|i| (i as f64 + 0.5) * self.size);
        let (distance, half) = (piece.distance(middle), self.size / SQRT_2);
        if distance >= radius + half {
            return;
        }
        let state = &mut self.tiles.entry(tile).or_insert_with(|| vec![NONE; (TILE * TILE) as usize].into())[at];
        if distance <= radius - half {
            if *state >= LISTS {
                self.lists[(*state - LISTS) as usize] = Vec::new();
            }
            *state = WHOLE;
            return;
        }
        if *state == NONE {
            *state = self.lists.len() as u32 + LISTS;
            self.lists.push(Vec::new());
        }
        let list = &mut self.lists[(*state - LISTS) as usize];
        if list.last() != Some(&number) {
            list.push(number);
        }
    }

    fn cell(&self, point: PlanePoint) -> [i64; 2] {
        point.map(|x| libm::floor(x / self.size) as i64)
    }

    /// Whether a point has been swept.
    pub fn holds(&self, point: PlanePoint) -> bool {
        let sweeps = |number: &u32| self.sweeps.get(*number as usize);
        let holds = |(piece, radius): &(PlanePiece, f64)| piece.distance(point) < *radius;
        self.edges_at(point).is_none_or(|edges| edges.iter().filter_map(sweeps).any(holds))
    }

    /// Leaves of an interval of a rim what lies outside of all sweeps.
    pub fn outside(&self, rim: &Rim, interval: [f64; 2], search: &mut Search, left: &mut Vec<[f64; 2]>) {
        search.open.clear();
        search.open.push(interval);
        for number in search.covering..search.covering.saturating_add(FOLLOWING) {
            self.take(rim, number, search);
            if search.open.is_empty() {
                return;
            }
        }
        let mut uncovered = std::mem::take(&mut search.uncovered);
        std::mem::swap(&mut uncovered, &mut search.open);
        for part in uncovered.drain(..) {
            self.outside_in_cells(rim, part, search, left);
        }
        search.uncovered = uncovered;
    }

    /// The same, cell by cell.
    fn outside_in_cells(&self, rim: &Rim, interval: [f64; 2], search: &mut Search, left: &mut Vec<[f64; 2]>) {
        let mut cuts = std::mem::take(&mut search.cuts);
        rim.crossings_with_grid(interval, self.size, &mut cuts);
        let mut from = interval[0];
        for to in cuts.drain(..) {
            if let Some(edges) = self.edges_at(rim.at(0.5 * (from + to))) {
                search.open.clear();
                search.open.push([from, to]);
                for number in edges {
                    self.take(rim, *number, search);
                    if search.open.is_empty() {
                        break;
                    }
                }
                search.open.iter().for_each(|part| join(left, *part));
            }
            from = to;
        }
        search.cuts = cuts;
    }

    /// Takes a sweep off what is open.
    fn take(&self, rim: &Rim, number: u32, search: &mut Search) {
        let Search { crossings, open, spare, .. } = search;
        let Some((piece, radius)) = self.sweeps.get(number as usize) else { return };
        spare.clear();
        open.iter().for_each(|part| rim.outside_sweep(*part, piece, *radius, crossings, spare));
        std::mem::swap(open, spare);
        if open.is_empty() {
            search.covering = number;
        }
    }

    /// The sweeps that have their edge in the cell of a point; none where one covers it.
    fn edges_at(&self, point: PlanePoint) -> Option<&[u32]> {
        let (tile, at) = in_tile(self.cell(point));
        match self.tiles.get(&tile).map_or(NONE, |tile| tile[at]) {
            NONE => Some(&[]),
            WHOLE => None,
            list => Some(&self.lists[(list - LISTS) as usize]),
        }
    }
}

/// Appends an interval, to the last one where it goes on from there.
fn join(left: &mut Vec<[f64; 2]>, part: [f64; 2]) {
    match left.last_mut() {
        Some(last) if last[1] >= part[0] => last[1] = part[1],
        Some(_) | None => left.push(part),
    }
}

/// The tile of a cell, and its number in it.
fn in_tile(cell: [i64; 2]) -> ([i64; 2], usize) {
    let [x, y] = cell.map(|i| i.rem_euclid(TILE));
    (cell.map(|i| i.div_euclid(TILE)), (x * TILE + y) as usize)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use proptest::prelude::*;

    use super::*;

    /// Coordinates, mm; also those of lines between cells.
    fn coordinate() -> impl Strategy<Value = f64> {
        prop_oneof![-6.0..6.0, (-12i32..12).prop_map(|i| 0.5 * f64::from(i))]
    }

    fn sweep() -> impl Strategy<Value = (PlanePiece, f64)> {
        let ends = [coordinate(), coordinate(), coordinate(), coordinate()];
        let bulge = prop_oneof![Just(0.0), -2.0..2.0];
        let piece = |([x, y, u, v], bulge): ([f64; 4], f64)| PlanePiece::new([x, y], [u, v], bulge);
        let still = [coordinate(), coordinate()].prop_map(|at| PlanePiece::new(at, at, 0.0));
        (prop_oneof![(ends, bulge).prop_map(piece), still], prop_oneof![Just(1.0), 0.4..3.0])
    }

    fn interval() -> impl Strategy<Value = [f64; 2]> {
        prop_oneof![
            Just([0.0, TAU]),
            (0.0..TAU, 0.01..1.0).prop_map(|(from, share)| [from, from + share * (TAU - from)])
        ]
    }

    proptest! {
        #[test]
        fn what_is_left_is_what_no_sweep_covers(
            sweeps in proptest::collection::vec(sweep(), 0..20),
            rims in proptest::collection::vec((coordinate(), coordinate(), 0.2..3.0, interval()), 1..8),
            size in 0.1..1.5,
        ) {
            let mut found = Sweeps::new(size / CELL);
            sweeps.iter().for_each(|(piece, radius)| found.insert(piece, *radius));
            let (mut search, mut left, mut crossings) = (Search::default(), Vec::new(), Vec::new());
            for (x, y, radius, interval) in rims {
                let rim = Rim { centre: [x, y], radius };
                left.clear();
                found.outside(&rim, interval, &mut search, &mut left);
                let mut expected = vec![interval];
                for (piece, radius) in &sweeps {
                    let mut spare = Vec::new();
                    expected.iter().for_each(|part| rim.outside_sweep(*part, piece, *radius, &mut crossings, &mut spare));
                    expected = spare;
                }
                let total = |parts: &[[f64; 2]]| parts.iter().map(|[from, to]| to - from).sum::<f64>();
                prop_assert!((total(&left) - total(&expected)).abs() < 1e-6, "{left:?} {expected:?}");
                prop_assert!(left.windows(2).all(|pair| pair[0][1] < pair[1][0]), "{left:?}");
                let is_swept = sweeps.iter().any(|(piece, radius)| piece.distance([x, y]) < *radius);
                prop_assert_eq!(found.holds([x, y]), is_swept);
                for [from, to] in left.iter().filter(|[from, to]| to - from > 1e-6) {
                    let middle = rim.at(0.5 * (from + to));
                    prop_assert!(sweeps.iter().all(|(piece, radius)| piece.distance(middle) > radius - 1e-9));
                }
            }
        }

        #[test]
        fn a_grid_cuts_a_rim_into_pieces_that_lie_in_one_cell_each(
            [x, y] in [coordinate(), coordinate()], radius in 0.2..3.0, interval in interval(), size in 0.1..1.5,
        ) {
            let (rim, sweeps) = (Rim { centre: [x, y], radius }, Sweeps::new(size / CELL));
            let mut cuts = Vec::new();
            rim.crossings_with_grid(interval, sweeps.size, &mut cuts);
            prop_assert_eq!(cuts.last(), Some(&interval[1]));
            let starts = std::iter::once(interval[0]).chain(cuts.iter().copied());
            for (from, to) in starts.zip(&cuts).filter(|(from, to)| *to - from > 1e-6) {
                let inside = [0.01, 0.3, 0.5, 0.7, 0.99].map(|share| sweeps.cell(rim.at(from + share * (to - from))));
                prop_assert!(inside.iter().all(|cell| *cell == inside[0]), "{from} {to} {inside:?}");
            }
        }
    }
}
