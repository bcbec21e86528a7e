//! What tools have swept before the path that is looked at.

use styluscam_geometry::{PlanePiece, PlanePoint};

use super::cells::Cells;
use super::runs::Swept;

/// Paths of tools, each piece with its tool's radius.
#[derive(Debug)]
pub struct Cleared {
    pieces: Vec<(PlanePiece, f64)>,
    near: Cells,
}

impl Cleared {
    /// Of paths; what they sweep is looked for up to `reach` from a point, mm.
    pub fn new(paths: &[Swept], reach: f64) -> Self {
        let pieces = |path: &Swept| path.pieces().into_iter().map(|piece| (piece, path.radius)).collect::<Vec<_>>();
        let pieces: Vec<(PlanePiece, f64)> = paths.iter().flat_map(pieces).collect();
        let widest = pieces.iter().fold(0.0, |widest: f64, (_, radius)| widest.max(*radius));
        let mut near = Cells::new(0.5 * (reach + widest), reach + widest);
        (0_u32..).zip(&pieces).for_each(|(number, (piece, _))| near.insert(number, piece));
        Self { pieces, near }
    }

    /// The pieces whose sweep comes within the reach of a point, and some beyond.
    pub fn near(&self, point: PlanePoint) -> impl Iterator<Item = &(PlanePiece, f64)> {
        self.near.near(point).iter().filter_map(|number| self.pieces.get(*number as usize))
    }

    /// Whether a point has been swept.
    pub fn holds(&self, point: PlanePoint) -> bool {
        self.near(point).any(|(piece, radius)| piece.distance(point) < *radius)
    }
}
