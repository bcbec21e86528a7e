//! Contours over the surface between which the same scallop stands everywhere.
//!
//! Passes are lines of equal distance from the border of the selected faces, in a metric in which two of them that leave the
//! scallop are one apart. They are found over a lattice in plan, and followed exactly. See docs/concepts/constant-scallop.md.

mod borders;
mod chains;
mod creases;
mod crossing;
mod distances;
mod level_lines;
mod measured;
mod net;
mod ridges;
mod stations;
mod thinning;

use rayon::prelude::*;
use styluscam_geometry::ToolBody;
use styluscam_motion::{Cancelled, Watch};

use self::creases::Creases;
use self::net::Net;
use self::stations::{Spacing, Station};
use super::{over_line, Grid};
use crate::{Pass, PathPoint, PlanError, Surface};

/// Nodes from pass to pass: first, and then where they lie closest but for creases.
const NODES: [f64; 2] = [2.0, 5.0];
/// Share of a lattice's sides that are no longer than that.
const MOST: f64 = 0.99;
/// How much finer the second lattice is at most.
const FINEST: f64 = 0.1;
/// Times that the ridges are measured and the field is found again.
const MEASURED: usize = 2;
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

/// What is asked of pencil passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PencilRule {
    /// The least angle between the faces' normals where the tool touches them, rad.
    pub least_turn: f64,
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
    let mut net = net(surface, body, contours, watch)?.ok_or_else(|| PlanError::NothingReached(String::new()))?;
    watch.begin("distances", net.stations.len());
    let mut sources = borders::beside(&net, surface, 1.0 - FIRST);
    sources.extend(Creases::of(&net).beside_walls(&net, 1.0 - FIRST));
    let mut values = net.distances(&sources, f64::INFINITY, watch)?;
    for _ in 0..MEASURED {
        let factors = measured::factors(&net, surface, &values, net.spacing.height(), watch)?;
        net.scale(&factors);
        values = net.distances(&sources, f64::INFINITY, watch)?;
    }
    let by_level = cells_by_level(&net, &values, contours.scallop)?;
    let creases = Creases::of(&net);
    let lines = (0..by_level.len()).into_par_iter().flat_map_iter(|number| {
        let lines = level_lines::level_lines(&net, &values, (number + 1) as f64, &by_level[number]);
        lines.into_iter().map(move |line| (number, line))
    });
    let mut lines: Vec<(usize, Vec<[f64; 2]>)> = lines.collect();
    let ridges = ridges::lines(&net, &values, &creases, watch)?;
    let last = by_level.len();
    lines.extend(ridges.into_iter().map(|line| (last, line)));
    let mut passes = followed(surface, &lines, contours.narrow, deviation, watch)?;
    let creases: Vec<_> = creases.lines(surface, 2.0 * net.lattice.cell).into_iter().map(|line| (last, line)).collect();
    passes.extend(followed(&surface.keeping_witnesses(), &creases, contours.narrow, deviation, watch)?);
    Ok(passes)
}

/// The passes along all hollow creases over the selected faces, each a group of its own.
///
/// `body` is the tool with the sheet that it touches; chords deviate by at most `deviation` mm along the normal.
///
/// # Errors
/// Nothing to touch, `Cancelled`.
pub fn pencil(
    surface: &Surface<'_>,
    body: &ToolBody,
    rule: &PencilRule,
    deviation: f64,
    watch: &Watch,
) -> Result<Vec<Pass>, PlanError> {
    let net = over(surface, Spacing::new(body, deviation), rule.spacing, watch)?;
    let net = net.ok_or_else(|| PlanError::NothingReached(String::new()))?;
    let creases = Creases::of_turn(&net, rule.least_turn);
    let lines: Vec<_> = creases.lines(surface, 2.0 * rule.spacing).into_iter().enumerate().collect();
    followed(&surface.keeping_witnesses(), &lines, rule.narrow, deviation, watch)
}

/// The passes over lines in plan, each with the number of its group; closed lines repeat their first point. Lines along creases need a
/// surface that keeps their witnesses: chords that are as near to the floor as is asked may be too near to the wall.
fn followed(
    surface: &Surface<'_>,
    lines: &[(usize, Vec<[f64; 2]>)],
    narrow: f64,
    deviation: f64,
    watch: &Watch,
) -> Result<Vec<Pass>, PlanError> {
    watch.begin("contours", lines.len());
    let along = |(group, line): &(usize, Vec<[f64; 2]>)| {
        let runs = over_line(surface, line.iter().copied(), narrow, deviation, watch)?;
        watch.advance(1)?;
        let is_closed =
            |points: &[PathPoint]| points.len() > 2 && points.first().map(|p| p.tip) == points.last().map(|p| p.tip);
        Ok(runs.into_iter().map(|points| Pass { closed: is_closed(&points), points, group: *group }).collect())
    };
    let passes: Result<Vec<Vec<Pass>>, Cancelled> = lines.par_iter().map(along).collect();
    Ok(passes?.into_iter().flatten().collect())
}

/// The positions over a lattice that is fine enough for the contours.
fn net(surface: &Surface<'_>, body: &ToolBody, contours: &Contours, watch: &Watch) -> Result<Option<Net>, Cancelled> {
    let spacing = Spacing::new(body, contours.scallop);
    let cell = (spacing.on_floor() / NODES[0]).min(contours.spacing);
    let Some(coarse) = over(surface, spacing.clone(), cell, watch)? else { return Ok(None) };
    let mut lengths: Vec<f64> = coarse.lengths().collect();
    lengths.sort_unstable_by(f64::total_cmp);
    let longest = lengths.get((MOST * lengths.len() as f64) as usize).copied().unwrap_or(0.0);
    let share = (longest * NODES[1]).recip().clamp(FINEST, 1.0);
    over(surface, spacing, share * cell, watch)
}

/// The positions over a lattice of cells of a size, mm.
fn over(surface: &Surface<'_>, spacing: Spacing, cell: f64, watch: &Watch) -> Result<Option<Net>, Cancelled> {
    let Some(grid) = Grid::sample(surface, cell, watch)? else { return Ok(None) };
    watch.begin("sides", grid.contacts().len());
    Net::new(surface, grid.lattice().clone(), stations(surface, &grid), spacing, watch).map(Some)
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
fn cells_by_level(net: &Net, values: &[f64], scallop: f64) -> Result<Vec<Vec<usize>>, PlanError> {
    let last = values.iter().copied().filter(|value| value.is_finite()).fold(0.0, f64::max);
    if last > LIMIT as f64 {
        return Err(PlanError::TooMany { what: "scallop", value: scallop, count: last as usize, limit: LIMIT });
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
