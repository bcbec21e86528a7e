//! The stock as it stands between two moves: heights over a grid, lowered move by move.

use styluscam_geometry::{Cutter, Tool};
use styluscam_motion::{Cancelled, Watch};

use super::cut::{Cut, Position};
use super::grid::Grid;
use super::underside::Underside;
use super::{lower, Level};
use crate::before::Stretch;
use crate::earlier::stretches;
use crate::segments::Segment;
use crate::subject::Subject;

/// Nodes along the sides of the tiles of which the highest node is kept.
const TILE: usize = 8;

/// The stock, node by node.
pub(crate) struct Material {
    grid: Grid,
    /// At every node, mm.
    heights: Vec<f64>,
    /// Of every tile no node is higher than this, mm.
    highest: Vec<f64>,
    /// Tiles along X.
    columns: usize,
}

/// The lower side of a solid that is moved; none of it is lower than on its axis.
pub(crate) struct Moved(Underside);

/// Material that is higher than the underside of a solid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Overlap {
    /// By so much, mm.
    pub by: f64,
    /// There in plan, at the lowest height of the tip, mm.
    pub at: [f64; 3],
}

impl Moved {
    /// What a tool cuts with.
    pub fn profile(tool: &Tool) -> Self {
        Self(Underside::new(tool, None))
    }

    /// A solid whose lowest point is `height` mm over the tool's tip.
    pub fn above(cutter: Cutter, height: f64) -> Self {
        Self(Underside::raised(cutter, height))
    }

    /// Height of its lowest point over the tool's tip, mm.
    pub fn lowest(&self) -> f64 {
        self.0.height(0.0)
    }

    /// mm.
    pub fn radius(&self) -> f64 {
        self.0.radius()
    }
}

impl Material {
    /// What programs before and some moves leave of the stock, which is no higher than `top` mm.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn after(moves: &[Segment], subject: &Subject, grid: Grid, top: f64, watch: &Watch) -> Result<Self, Cancelled> {
        watch.begin("stock as it stands", grid.count() * (1 + usize::from(subject.before.is_some())));
        let level = Level { grid, top, sheet: None, watch };
        let cut: Vec<Stretch> = moves.iter().flat_map(stretches).collect();
        let heights = lower(level.uncut(subject)?, &level.cut(&cut, subject.tools)?);
        let [columns, rows] = grid.nodes.map(|nodes| nodes.div_ceil(TILE));
        Ok(Self { grid, heights, highest: vec![top; columns * rows], columns })
    }

    /// The larger distance between nodes along X and Y, mm.
    pub fn spacing(&self) -> f64 {
        self.grid.step[0].max(self.grid.step[1])
    }

    /// Takes what a straight piece of a move sweeps.
    pub fn cut(&mut self, piece: &Segment, by: &Moved) {
        let path = straight(piece);
        let ([[x0, x1], [y0, y1]], lowest) = (nodes_around(&self.grid, &path, by.radius()), piece.lowest());
        for (x, y) in (y0..y1).flat_map(|y| (x0..x1).map(move |x| (x, y))) {
            let height = &mut self.heights[y * self.grid.nodes[0] + x];
            if *height > lowest {
                *height = height.min(path.over(&by.0, self.grid.at(x, y)).0);
            }
        }
    }

    /// Where the material is most above the underside of a solid on a straight piece of a move, if that is more than `least` mm; no
    /// farther from the path of its axis in plan than `within` mm.
    pub fn overlap(&mut self, piece: &Segment, solid: &Moved, within: f64, least: f64) -> Option<Overlap> {
        let (path, tip) = (straight(piece), piece.lowest());
        let [columns, rows] = nodes_around(&self.grid, &path, within).map(|[from, to]| from / TILE..to.div_ceil(TILE));
        let mut worst = None;
        for tile in rows.flat_map(|row| columns.clone().map(move |column| [column, row])) {
            let most = worst.map_or(least, |worst: Overlap| worst.by);
            if self.highest[tile[1] * self.columns + tile[0]] - (tip + solid.lowest()) > most {
                worst = self.overlap_in(tile, (&path, solid), (tip, within, most)).or(worst);
            }
        }
        worst
    }

    /// The same in a tile; the tip is nowhere lower than `tip`.
    fn overlap_in(
        &mut self,
        [column, row]: [usize; 2],
        (path, solid): (&Cut, &Moved),
        (tip, within, least): (f64, f64, f64),
    ) -> Option<Overlap> {
        let ([width, depth], mut highest, mut worst) = (self.grid.nodes, f64::NEG_INFINITY, None);
        let lowest = tip + solid.lowest();
        let nodes = |tile: usize, count: usize| tile * TILE..count.min((tile + 1) * TILE);
        for (x, y) in nodes(row, depth).flat_map(|y| nodes(column, width).map(move |x| (x, y))) {
            let height = self.heights[y * width + x];
            highest = highest.max(height);
            let most = worst.map_or(least, |worst: Overlap| worst.by);
            let at: Position = self.grid.at(x, y);
            if height - lowest > most && path.distance(at) <= within {
                let by = height - path.over(&solid.0, at).0;
                if by > most {
                    worst = Some(Overlap { by, at: [at[0], at[1], tip] });
                }
            }
        }
        self.highest[row * self.columns + column] = highest;
        worst
    }
}

fn straight(piece: &Segment) -> Cut {
    Cut::straight(piece.start.unwrap_or(piece.end), piece.end, 0)
}

/// The first node and the one beyond the last along X and Y of a box in plan around a path, with so many mm beside it.
fn nodes_around(grid: &Grid, path: &Cut, beside: f64) -> [[usize; 2]; 2] {
    let [low, high] = path.bounds();
    [0, 1].map(|k| {
        let [first, last] = [low[k] - beside, high[k] + beside].map(|at| (at - grid.origin[k]) / grid.step[k]);
        let beyond = grid.nodes[k].min((last.floor() + 1.0).max(0.0) as usize); // negative ones become 0
        [(first.ceil().max(0.0) as usize).min(beyond), beyond]
    })
}
