//! Whether levels may hide in the cells of a grid, where all corners lie on one side of them.

use rayon::prelude::*;
use styluscam_motion::{Cancelled, Watch};

use super::{
    grid::Grid,
    level_curve::{self, LevelCurve},
    sides::Sides,
    square::Square,
};
use crate::{lattice::Node, Cells, Surface};

/// What is known of the envelope in the cells of a grid.
pub struct Bounds {
    /// Heights under which no tip is.
    floors: Vec<f64>,
    /// Heights over which no tip is.
    ceilings: Vec<f64>,
}

impl Bounds {
    /// Bounds that decide of each of the `heights` whether it may hide.
    ///
    /// # Errors
    /// `Cancelled` when `watch` is cancelled.
    pub fn of(grid: &Grid, surface: &Surface<'_>, heights: &[f64], watch: &Watch) -> Result<Self, Cancelled> {
        let levels = Levels::of(grid, heights);
        let lattice = grid.lattice();
        watch.begin("bounds", lattice.columns * lattice.rows);
        let limit = |cells: &Cells| cells.iter().map(|cell| levels.next_over(grid, cell)).fold(f64::INFINITY, f64::min);
        let ceilings = surface.envelope().ceilings(lattice, limit, watch)?;
        let floors = (0..ceilings.len()).into_par_iter().map(|number| {
            let cell = lattice.cell_of(number);
            levels.next_under(grid, cell).map_or(f64::NEG_INFINITY, |level| floor(grid, surface, cell, level))
        });
        Self { floors: floors.collect(), ceilings }.tightened(grid, surface, &levels, watch)
    }

    /// Cells in which a level may hide are looked into once, at the level next to their corners: where no node looked at
    /// is beyond that one, none is beyond the next.
    fn tightened(self, grid: &Grid, surface: &Surface<'_>, levels: &Levels, watch: &Watch) -> Result<Self, Cancelled> {
        watch.begin("hidden", self.floors.len());
        let hides = |cell: Node, level: f64| {
            Sides::new(grid, level).look_into(&Square::cell(cell), &mut LevelCurve::new(surface, level))
        };
        let tightened: Result<Vec<(f64, f64)>, Cancelled> = (0..self.floors.len())
            .into_par_iter()
            .map(|number| {
                let cell = grid.lattice().cell_of(number);
                let under = levels.next_under(grid, cell).filter(|level| self.may_dip(number, *level));
                let floor = under.filter(|level| !hides(cell, *level)).map(level_curve::least_over);
                let over = Some(levels.next_over(grid, cell)).filter(|level| self.may_rise(number, *level));
                let ceiling = over.filter(|level| !hides(cell, *level));
                watch.advance(1)?;
                Ok((floor.unwrap_or(self.floors[number]), ceiling.unwrap_or(self.ceilings[number])))
            })
            .collect();
        let (floors, ceilings) = tightened?.into_iter().unzip();
        Ok(Self { floors, ceilings })
    }

    /// Whether a level hides in a cell whose corners are all above it.
    pub fn may_dip(&self, number: usize, z: f64) -> bool {
        !level_curve::is_over(self.floors[number], z)
    }

    /// Whether a level hides in a cell whose corners are all below it.
    pub fn may_rise(&self, number: usize, z: f64) -> bool {
        level_curve::is_over(self.ceilings[number], z)
    }
}

/// A height under which no tip is in a cell, over a level if that can be seen.
fn floor(grid: &Grid, surface: &Surface<'_>, cell: Node, level: f64) -> f64 {
    let corners = grid.lattice().corners(&Cells::single(cell));
    let mut most = f64::NEG_INFINITY;
    for contact in grid.corner_contacts(cell).into_iter().flatten() {
        most = most.max(surface.envelope().least(contact, &corners));
        if level_curve::is_over(most, level) {
            break;
        }
    }
    most
}

/// The levels between the nodes of a grid.
struct Levels {
    ascending: Vec<f64>,
    /// By node, how many levels lie under it.
    under: Vec<usize>,
}

impl Levels {
    fn of(grid: &Grid, heights: &[f64]) -> Self {
        let mut ascending = heights.to_vec();
        ascending.sort_by(f64::total_cmp);
        let under = |tip: f64| ascending.partition_point(|z| level_curve::is_over(tip, *z));
        let under = grid.tips().map(|tip| tip.map_or(0, under)).collect();
        Self { ascending, under }
    }

    /// The lowest level over all corners of a cell; infinite where there is none.
    fn next_over(&self, grid: &Grid, cell: Node) -> f64 {
        let most = self.under_corners(grid, cell).into_iter().max().unwrap_or(0);
        self.ascending.get(most).copied().unwrap_or(f64::INFINITY)
    }

    /// The highest level under all corners of a cell.
    fn next_under(&self, grid: &Grid, cell: Node) -> Option<f64> {
        let least = self.under_corners(grid, cell).into_iter().min()?;
        least.checked_sub(1).map(|level| self.ascending[level])
    }

    fn under_corners(&self, grid: &Grid, cell: Node) -> [usize; 4] {
        grid.lattice().corner_numbers(cell).map(|number| self.under[number])
    }
}
