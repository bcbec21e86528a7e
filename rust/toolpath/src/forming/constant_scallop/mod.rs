//! Contours over the surface between which the same scallop stands everywhere.
//!
//! Passes are lines of equal distance from the border of the selected faces, in a metric in which two of them that leave the
//! scallop are one apart. They are found over a lattice in plan, and followed exactly. See docs/concepts/scallops.md.

mod borders;
mod field;
mod level_lines;
mod stations;

use rayon::prelude::*;
use styluscam_geometry::ToolBody;
use styluscam_motion::{Cancelled, Watch};

use self::field::Net;
use self::stations::{Spacing, Station};
use super::{over_line, Grid};
use crate::{Pass, PlanError, Surface};

/// Nodes between two passes at least.
const NODES: f64 = 5.0;
/// Slopes up to which nodes lie so near, rad: 75 degrees. Steeper walls have fewer.
const STEEPEST: f64 = 1.309;
/// Passes at most.
const LIMIT: usize = 100_000;
/// From the border to the first pass, in passes: a little less than half of what lies between two.
const FIRST: f64 = 0.48;

/// What is asked of contours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contours {
    /// The scallop, mm.
    pub scallop: f64,
    /// Largest distance between nodes, mm.
    pub spacing: f64,
    /// What is narrower may be missed, mm.
    pub narrow: f64,
}

/// All contours over the selected faces, numbered from the border inwards.
///
/// `body` is the tool with the sheet that it touches; chords deviate by at most `deviation` mm along the normal.
///
/// # Errors
/// Nothing to touch, more passes than a program can hold, `Cancelled`.
pub fn constant_scallop(
    surface: &Surface<'_>,
    body: &ToolBody,
    contours: &Contours,
    deviation: f64,
    watch: &Watch,
) -> Result<Vec<Pass>, PlanError> {
    let nothing = || PlanError::NothingReached(String::new());
    let spacing = Spacing::new(body, contours.scallop);
    let mesh = surface.envelope().mesh();
    let steepest = surface.triangles().map(|triangle| libm::acos(mesh.normal(triangle).z.clamp(-1.0, 1.0)));
    let steepest = steepest.fold(0.0, f64::max).min(STEEPEST);
    let cell = (spacing.smallest(steepest) / NODES).min(contours.spacing);
    let grid = Grid::sample(surface, cell, watch)?.ok_or_else(nothing)?;
    let net = Net::new(grid.lattice().clone(), stations(surface, &grid), spacing);
    watch.begin("distances", net.stations.len());
    let values = net.distances(&borders::beside(&net, surface, 1.0 - FIRST), watch)?;
    let by_level = cells_by_level(&net, &values)?;
    watch.begin("contours", by_level.len());
    let of_level = |(number, cells): (usize, &Vec<usize>)| {
        let mut passes = Vec::new();
        for line in level_lines::level_lines(&net, &values, (number + 1) as f64, cells) {
            for points in over_line(surface, line, contours.narrow, deviation, watch)? {
                let closed = points.len() > 2 && points.first().map(|p| p.tip) == points.last().map(|p| p.tip);
                passes.push(Pass { points, closed, group: number });
            }
        }
        watch.advance(1)?;
        Ok(passes)
    };
    let passes: Result<Vec<Vec<Pass>>, Cancelled> = by_level.par_iter().enumerate().map(of_level).collect();
    Ok(passes?.into_iter().flatten().collect())
}

/// The stations at the nodes of a grid.
fn stations(surface: &Surface<'_>, grid: &Grid) -> Vec<Option<Station>> {
    let lattice = grid.lattice();
    let of_node = |(number, contact): (usize, &Option<crate::offset::Contact>)| {
        let width = lattice.columns + 1;
        let at = lattice.point([number % width, number / width].map(|i| i as f64));
        Station::of(surface, at, contact.as_ref()?)
    };
    grid.contacts().par_iter().enumerate().map(of_node).collect()
}

/// For each pass, the cells over which it goes.
fn cells_by_level(net: &Net, values: &[f64]) -> Result<Vec<Vec<usize>>, PlanError> {
    let last = values.iter().copied().filter(|value| value.is_finite()).fold(0.0, f64::max);
    if last > LIMIT as f64 {
        return Err(PlanError::TooMany { what: "scallop", value: 0.0, count: last as usize, limit: LIMIT });
    }
    let mut by_level = vec![Vec::new(); last as usize];
    for cell in net.lattice.cells().iter() {
        let corners = net.lattice.corner_numbers(cell).map(|node| values[node]);
        let finite = corners.iter().copied().filter(|value| value.is_finite());
        let low = finite.clone().fold(f64::INFINITY, f64::min);
        let high = finite.fold(f64::NEG_INFINITY, f64::max);
        let mut level = low.max(0.0).ceil().max(1.0);
        while level <= high {
            if let Some(cells) = by_level.get_mut(level as usize - 1) {
                cells.push(net.lattice.number(cell));
            }
            level += 1.0;
        }
    }
    Ok(by_level)
}
