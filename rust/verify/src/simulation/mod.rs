//! The material as a program leaves it: heights over a grid in plan, cut by every move.
//!
//! Tools come from above and are open upwards, so what they leave is one height over each position in plan: the lowest that the
//! tool's lower surface was there. At the nodes of the grid it is exact, between them nothing is known. Straight moves
//! are swept as they are, arcs as parabolas that are off them by less than 1e-6 mm. Rapids cut too, as straight lines.
//!
//! A formed sheet follows the tool: the face that it touches is the same lowest surface, the others are its offsets by the
//! sheet's law. That is kinematics and no more: the sheet lies where tool and blank put it, does not spring back, and where the
//! tool was not it stays as flat as it was.

mod compare;
mod cut;
mod field;
mod grid;
mod material;
mod mesh;
mod stock;
mod underside;

use rayon::prelude::*;
use styluscam_geometry::{PlanePiece, Sheet, Solid, Stock, Tool};
use styluscam_motion::{ArcPath, Cancelled, Program, Watch};

use crate::before::Stretch;
use crate::earlier::stretches;
use crate::engagement::Area;
use crate::segments::placed;
use crate::subject::{Limits, Subject};
use crate::tolerances::SLACK;
use cut::Cut;
use field::{Field, Tile};
use underside::Underside;

pub use grid::Grid;
pub(crate) use material::{Material, Moved, Overlap};
pub use mesh::Skin;
pub use stock::Simulation;

/// Cuts the subject's stock, or a sheet with a flat top, with all moves of a program. Beside the stock there is nothing down to its
/// underside.
///
/// With a sheet, the face that is followed is the one that `subject.sheet` names; `top` (mm) is its height on the blank.
///
/// # Errors
/// `Cancelled` when the watch is cancelled.
pub fn simulate(
    program: &Program,
    subject: &Subject,
    limits: &Limits,
    grid: Grid,
    top: f64,
    watch: &Watch,
) -> Result<Simulation, Cancelled> {
    watch.begin("simulating", grid.count());
    let level = Level { grid, top, sheet: subject.sheet.as_ref(), watch };
    let own: Vec<Stretch> = placed(program, subject, limits).iter().flat_map(stretches).collect();
    let uncut = level.uncut(subject)?;
    let heights = lower(level.cut(&own, subject.tools)?, &uncut);
    let is_level = subject.before.is_none() && subject.stock.is_none_or(|stock| stock.solid().is_none());
    Ok(Simulation { grid, heights, top, before: (!is_level).then_some(uncut) })
}

/// The lower of two heights at every node.
fn lower(mut heights: Vec<f64>, others: &[f64]) -> Vec<f64> {
    heights.iter_mut().zip(others).for_each(|(height, other)| *height = height.min(*other));
    heights
}

/// What is level before it is cut.
struct Level<'a> {
    grid: Grid,
    /// mm.
    top: f64,
    sheet: Option<&'a Sheet>,
    watch: &'a Watch,
}

impl Level<'_> {
    /// Heights at every node of what programs before have left of the stock, mm.
    fn uncut(&self, subject: &Subject) -> Result<Vec<f64>, Cancelled> {
        let heights = match subject.stock.map(|stock| (stock, stock.solid())) {
            Some((stock, Some(solid))) => upper_side(solid, stock.bottom, self.grid, self.watch)?,
            Some((stock, None)) => self.upright(stock),
            None => vec![self.top; self.grid.count()],
        };
        match subject.before {
            Some(before) => Ok(lower(heights, &self.cut(&before.stretches, &before.tools)?)),
            None => Ok(heights),
        }
    }

    /// Heights at every node over upright stock, mm: beside it that of its underside.
    fn upright(&self, stock: &Stock) -> Vec<f64> {
        let outlines = stock.outlines_between([stock.top, stock.bottom]);
        let area = Area::new(&outlines, self.grid.step[0].max(self.grid.step[1]));
        let pieces: Vec<PlanePiece> = outlines.iter().flat_map(|outline| PlanePiece::outline(outline)).collect();
        // its own border belongs to it, whatever arithmetic makes of that
        let is_in = |at: [f64; 2]| area.holds(at) || pieces.iter().any(|piece| piece.distance(at) <= SLACK);
        let height = |at| if is_in(at) { self.top } else { self.top.min(stock.bottom) };
        (0..self.grid.count()).map(|node| height(self.grid.position(node))).collect()
    }

    /// Heights at every node after some moves, mm.
    fn cut(&self, stretches: &[Stretch], tools: &[Tool]) -> Result<Vec<f64>, Cancelled> {
        let tools: Vec<Underside> = tools.iter().map(|tool| Underside::new(tool, self.sheet)).collect();
        let (cuts, arcs) = cuts(stretches);
        let field = Field { grid: self.grid, top: self.top, tools: &tools, arcs: &arcs, watch: self.watch };
        Ok(assembled(self.grid, &field.tiles(self.grid.whole(), &cuts)?))
    }
}

/// Height of a body's upper side at every node, and of its underside beside it.
fn upper_side(solid: &Solid, bottom: f64, grid: Grid, watch: &Watch) -> Result<Vec<f64>, Cancelled> {
    let height = |node: usize| {
        watch.advance(0)?;
        let [x, y] = grid.position(node);
        // its own border belongs to it, whatever arithmetic makes of that
        let beside = [[-SLACK, -SLACK], [SLACK, -SLACK], [-SLACK, SLACK], [SLACK, SLACK]];
        let around = || beside.into_iter().filter_map(|[dx, dy]| solid.height_at([x + dx, y + dy])).reduce(f64::max);
        Ok(solid.height_at([x, y]).or_else(around).unwrap_or(bottom))
    };
    (0..grid.count()).into_par_iter().with_min_len(1024).map(height).collect()
}

/// What every move cuts, and the arcs that some of them are parts of.
fn cuts(stretches: &[Stretch]) -> (Vec<Cut>, Vec<ArcPath>) {
    let mut arcs = Vec::new();
    let cut = |stretch: &Stretch| {
        let tool = stretch.tool? as u32;
        let Some(path) = stretch.bend else {
            return Some(Cut::straight(stretch.start.unwrap_or(stretch.end), stretch.end, tool));
        };
        arcs.push(path);
        Some(Cut::bent(&path, arcs.len() as u32 - 1, tool))
    };
    (stretches.iter().filter_map(cut).collect(), arcs)
}

/// The tiles' heights in the order of the grid.
fn assembled(grid: Grid, tiles: &[Tile]) -> Vec<f64> {
    let mut heights = vec![0.0; grid.count()];
    for tile in tiles {
        let [width, _] = tile.region.size();
        for (row, line) in tile.heights.chunks_exact(width).enumerate() {
            let start = (tile.region.from[1] + row) * grid.nodes[0] + tile.region.from[0];
            heights[start..start + width].copy_from_slice(line);
        }
    }
    heights
}
