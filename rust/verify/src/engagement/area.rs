//! Areas bounded by lines and arcs: whether a point lies in one, and what of the rim does.

use std::collections::HashMap;

use styluscam_geometry::{PlanePiece, PlanePoint};

use super::cells::Cells;
use super::rim::Rim;

/// An area within outlines, by the even-odd rule: islands are outlines within outlines.
#[derive(Debug)]
pub struct Area {
    pieces: Vec<PlanePiece>,
    near: Cells,
    rows: HashMap<i64, Vec<u32>>,
    height: f64,
}

impl Area {
    /// The area within closed outlines (x, y, bulge); `reach` is how far from its centre a rim asks, mm.
    pub fn new(outlines: &[Vec<[f64; 3]>], reach: f64) -> Self {
        let pieces: Vec<PlanePiece> = outlines.iter().flat_map(|outline| PlanePiece::outline(outline)).collect();
        let mut near = Cells::new(reach, reach);
        let mut rows: HashMap<i64, Vec<u32>> = HashMap::new();
        for (number, piece) in (0u32..).zip(&pieces) {
            near.insert(number, piece);
            let [low, high] = piece.bounds();
            for row in libm::floor(low[1] / reach) as i64..=libm::floor(high[1] / reach) as i64 {
                rows.entry(row).or_default().push(number);
            }
        }
        Self { pieces, near, rows, height: reach }
    }

    /// Whether a point lies in the area: the parity of the chords to its right, turned over for every arc's segment it lies in.
    pub fn holds(&self, point: PlanePoint) -> bool {
        let row = libm::floor(point[1] / self.height) as i64;
        let Some(numbers) = self.rows.get(&row) else { return false };
        let pieces = numbers.iter().filter_map(|number| self.pieces.get(*number as usize));
        pieces.fold(false, |inside, piece| inside ^ crosses_chord(piece, point) ^ lies_in_segment(piece, point))
    }

    /// Distance to the nearest outline, mm; infinite where none is within the reach.
    pub fn clearance(&self, point: PlanePoint) -> f64 {
        let nearest = self.around(point).map(|piece| piece.distance(point)).fold(f64::INFINITY, f64::min);
        if nearest > self.height {
            return f64::INFINITY; // pieces are listed by cells, some of them from farther away
        }
        nearest
    }

    /// Leaves of an interval of the rim what lies in the area.
    pub fn within(&self, rim: &Rim, interval: [f64; 2], scratch: &mut Vec<f64>, left: &mut Vec<[f64; 2]>) {
        scratch.clear();
        for piece in self.around(rim.centre) {
            if piece.distance(rim.centre) > rim.radius {
                continue;
            }
            match &piece.circle {
                Some(circle) => rim.crossings_with_circle(circle.centre, circle.radius, scratch),
                None => rim.crossings_with_line(piece.start, piece.end, 0.0, scratch),
            }
        }
        rim.split(interval, scratch, left, |point| self.holds(point));
    }

    fn around(&self, point: PlanePoint) -> impl Iterator<Item = &PlanePiece> {
        self.near.near(point).iter().filter_map(|number| self.pieces.get(*number as usize))
    }
}

/// Whether the ray from a point to +X crosses the piece's chord.
fn crosses_chord(piece: &PlanePiece, point: PlanePoint) -> bool {
    let y = point[1];
    (piece.start[1] > y) != (piece.end[1] > y) && is_left_of_rising(piece, point).0
}

/// Whether a point lies between the piece's chord and its arc.
fn lies_in_segment(piece: &PlanePiece, point: PlanePoint) -> bool {
    let Some(circle) = &piece.circle else { return false };
    if libm::hypot(point[0] - circle.centre[0], point[1] - circle.centre[1]) > circle.radius {
        return false;
    }
    let (is_left, falls) = is_left_of_rising(piece, point);
    // an arc that turns left lies right of its chord
    (is_left != falls) != (circle.turn > 0.0)
}

/// Whether a point lies left of a piece's chord, or above it, as this rises or, if level, goes to +X, and whether the piece goes the other
/// way. Both pieces along one chord have the same answer, whatever rounding makes of a point on it.
fn is_left_of_rising(piece: &PlanePiece, [x, y]: PlanePoint) -> (bool, bool) {
    let (a, b) = (piece.start, piece.end);
    let falls = [b[1], b[0]] < [a[1], a[0]];
    let (a, b) = if falls { (b, a) } else { (a, b) };
    let side = (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
    (side > 0.0 || (side == 0.0 && a[1] >= b[1]), falls)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disc_of_two_arcs_holds_what_lies_on_their_chord() {
        for [x, y] in [[1.0, 0.0], [0.0, 1.0], [0.6, 0.8], [-0.8, 0.6]] {
            let area = Area::new(&[vec![[x, y, 1.0], [-x, -y, 1.0]]], 1.0);
            for share in [-0.9, -0.5, 0.0, 0.25, 0.9] {
                assert!(area.holds([share * x, share * y]), "{share} of {x} {y}");
            }
            assert!(!area.holds([1.1 * x, 1.1 * y]) && !area.holds([-1.1 * x, -1.1 * y]));
        }
    }
}
