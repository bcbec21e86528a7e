//! Pieces by the square cells of the plane that they come near to.

use std::collections::HashMap;

use styluscam_geometry::{PlanePiece, PlanePoint};

/// Numbers of the pieces that come within a reach of each cell, in ascending order.
#[derive(Debug)]
pub struct Cells {
    size: f64,
    reach: f64,
    cells: HashMap<[i64; 2], Vec<u32>>,
}

impl Cells {
    /// Cells of a `size`; a piece is listed where it comes as near as `reach`, mm.
    pub fn new(size: f64, reach: f64) -> Self {
        Self { size, reach, cells: HashMap::new() }
    }

    /// The cell that holds a point.
    pub fn cell(&self, point: PlanePoint) -> [i64; 2] {
        point.map(|x| libm::floor(x / self.size) as i64)
    }

    /// Lists a piece. Numbers have to ascend.
    pub fn insert(&mut self, number: u32, piece: &PlanePiece) {
        // long pieces in parts, for their boxes would hold much that is far from them
        let parts = libm::ceil(piece.length() / self.size).max(1.0) as usize;
        for part in 0..parts {
            let ends = [part, part + 1].map(|i| piece.at(i as f64 / parts as f64));
            let sag = if piece.circle.is_some() { 0.5 * piece.length() / parts as f64 } else { 0.0 };
            let low = [0, 1].map(|i| ends[0][i].min(ends[1][i]) - self.reach - sag);
            let high = [0, 1].map(|i| ends[0][i].max(ends[1][i]) + self.reach + sag);
            let ([x0, y0], [x1, y1]) = (self.cell(low), self.cell(high));
            for x in x0..=x1 {
                for y in y0..=y1 {
                    let listed = self.cells.entry([x, y]).or_default();
                    if listed.last() != Some(&number) {
                        listed.push(number);
                    }
                }
            }
        }
    }

    /// The pieces near a point, in ascending order.
    pub fn near(&self, point: PlanePoint) -> &[u32] {
        self.cells.get(&self.cell(point)).map_or(&[], Vec::as_slice)
    }
}
