//! The stock as it stands between two moves: heights over a grid, lowered move by move.

use styluscam_geometry::{Cutter, Tool};
use styluscam_motion::{Cancelled, Watch};

use super::cut::Cut;
use super::grid::Grid;
use super::underside::Underside;
use super::Level;
use crate::segments::Segment;
use crate::subject::Subject;

/// The stock, node by node.
pub(crate) struct Material {
    grid: Grid,
    /// mm.
    heights: Vec<f64>,
}

/// The lower side of a solid that tools move.
pub(crate) struct Moved(Underside);

impl Moved {
    /// What a tool cuts with.
    pub fn profile(tool: &Tool) -> Self {
        Self(Underside::new(tool, None))
    }

    /// A solid whose lowest point is `height` mm over the tool's tip.
    pub fn above(cutter: Cutter, height: f64) -> Self {
        Self(Underside::raised(cutter, height))
    }
}

impl Material {
    /// What programs before have left of the stock.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn uncut(subject: &Subject, grid: Grid, top: f64, watch: &Watch) -> Result<Self, Cancelled> {
        let heights = Level { grid, top, sheet: None, watch }.uncut(subject)?;
        Ok(Self { grid, heights })
    }

    /// Takes what a piece of a move sweeps.
    pub fn cut(&mut self, piece: &Segment, by: &Moved) {
        let cut = Cut::of_piece(piece);
        let lowest = piece.lowest();
        let Self { grid, heights } = self;
        for node in nodes(grid, &cut, by) {
            let height = &mut heights[node];
            if *height > lowest {
                *height = height.min(cut.over(&by.0, grid.position(node)).0);
            }
        }
    }

    /// By how much the material is higher than the underside of a solid on a piece of a move, where that is most, mm; none where
    /// it is nowhere. What the solid enters from its side by less than `aside` mm does not count.
    pub fn most_over(&self, piece: &Segment, solid: &Moved, aside: f64) -> Option<f64> {
        let cut = Cut::of_piece(piece);
        let inside = solid.0.radius() - aside - cut.sag;
        let over = |node: usize| {
            let position = self.grid.position(node);
            let is_inside = self.heights[node] > piece.lowest() && cut.distance(position) <= inside;
            is_inside.then(|| self.heights[node] - cut.over(&solid.0, position).0)
        };
        nodes(&self.grid, &cut, solid).filter_map(over).filter(|over| *over > 0.0).reduce(f64::max)
    }
}

/// The nodes in the box in plan that holds all positions of a solid on a path.
fn nodes<'a>(grid: &'a Grid, cut: &Cut, solid: &Moved) -> impl Iterator<Item = usize> + 'a {
    let ([low, high], reach) = (cut.bounds(), solid.0.radius());
    let first = |k: usize| ((low[k] - reach - grid.origin[k]) / grid.step[k]).ceil().max(0.0) as usize;
    let beyond = |k: usize| {
        let last = ((high[k] + reach - grid.origin[k]) / grid.step[k]).floor();
        grid.nodes[k].min((last + 1.0).max(0.0) as usize)
    };
    let ([x0, x1], [y0, y1]) = ([first(0), beyond(0)], [first(1), beyond(1)]);
    (y0..y1).flat_map(move |y| (x0..x1).map(move |x| y * grid.nodes[0] + x))
}
